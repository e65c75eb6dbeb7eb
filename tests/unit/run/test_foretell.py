"""What `check` foretells: when ice comes and goes, how long a run takes, as words and as JSON."""

import json
import re

import numpy as np
import pytest
from typer.testing import CliRunner

from dilatedem.case.schema import Case
from dilatedem.cli import app
from dilatedem.run.arrivals import drift, presence
from dilatedem.run.foretell import as_json, check, duration, told
from dilatedem.run.simulation import Simulation

#: a floe of 2 m by 2 m; its middle is at the origin
SQUARE = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]


def one_floe(*, center=(6.0, 0.0), kind=None, duration=60.0, **tables) -> dict:
    """A square floe, and a box of 2 m by 2 m at `center`."""
    structure = {"kind": "box", "name": "box", "center": list(center), "size": [2.0, 2.0]}
    case = {
        "domain": {"size": [40.0, 40.0]}, "field": {"source": "bodies"}, "body": [{"outline": SQUARE}],
        "structure": [structure | (kind or {})], "time": {"duration": duration}, "water": {"velocity": [0.5, 0.0]},
    }  # fmt: skip
    return case | tables


def foretold(case: dict):
    return presence(Simulation.from_case(case))["box"]


@pytest.mark.parametrize("velocity", [(0.5, 0.0), (-0.5, 0.0), (0.0, 0.5), (0.3, 0.4), (-0.3, -0.4)])
def test_a_floe_comes_after_the_gap_and_goes_after_both_lengths(velocity):
    """Gap g, speed u: at g/u; past the box of 2 m and itself of 2 m, (g + 4)/u, along the axes; between them in between."""
    u = np.array(velocity)
    along_an_axis = (u == 0.0).any()
    found = foretold(one_floe(center=tuple(6.0 * u / 0.5), water={"velocity": list(velocity)}))
    looks = 0.1 * 2.0 / 0.5  # s from one look to the next
    first, last = (8.0, 16.0) if along_an_axis else (12.0 - 2.0 / max(abs(u)), 12.0 + 2.0 / max(abs(u)))
    assert found.first_s == pytest.approx(first, abs=looks)
    assert found.last_s == pytest.approx(last, abs=looks)
    assert not found.ongoing


def test_ice_that_is_there_that_stays_and_that_never_comes():
    assert re.fullmatch(r"from 8\S* s to the end, about", foretold(one_floe(duration=10.0)).words())
    none = foretold(one_floe(center=(-6.0, 0.0)))
    assert (none.first_s, none.last_s, none.ongoing) == (None, None, False)
    assert "none" in none.words()


def test_what_leaves_a_periodic_side_comes_again():
    case = one_floe(center=(-6.0, 0.0), domain={"size": [40.0, 40.0], "x_boundary": "periodic"}, duration=80.0)
    assert foretold(case).first_s == pytest.approx((40.0 - 12.0 + 4.0) / 0.5, abs=0.5)


def test_a_structure_that_is_driven_comes_to_ice_at_rest():
    driven = {"support": {"kind": "driven", "velocity": [-1.0, 0.0]}}
    assert foretold(one_floe(kind=driven, water={"velocity": [0.0, 0.0]})).first_s == pytest.approx(4.0, abs=0.3)


def test_without_water_ice_keeps_its_velocity():
    case = one_floe(water={"enabled": False}, gravity={"acceleration": 0.0}, body=[{"outline": SQUARE, "velocity": [0.25, 0, 0]}])
    assert foretold(case).first_s == pytest.approx(16.0, abs=0.8)


def test_a_current_that_changes_is_followed():
    """0.5 m/s that turns round within 20 s: 5 m forward at t = 10 s, and back again."""
    case = Case.model_validate({"water": {"velocity_table": [[0.0, 0.5, 0.0], [10.0, 0.5, 0.0], [30.0, -0.5, 0.2]]}})
    way = drift(case, np.array([0.0, 10.0, 20.0, 30.0, 40.0]), np.zeros(2))
    assert way[:, 0] == pytest.approx([0.0, 5.0, 7.5, 5.0, 0.0])
    assert way[:, 1] == pytest.approx([0.0, 0.0, 0.5, 2.0, 4.0])


def test_words_and_json_say_the_same():
    facts = check(Case.model_validate(one_floe()))
    words, plain = told(facts), as_json(facts)
    assert words["ice at box"] == facts["ice at"]["box"].words()
    assert plain["ice_at"]["box"]["first_s"] == facts["ice at"]["box"].first_s
    assert plain["steps"] == facts["steps"] and plain["step_s"] == facts["step, s"]
    assert plain["memory_MB"] > 0.0 and plain["output_MB"] > 0.0 and plain["mass_t"] > 0.0
    assert plain["wall_time_in_a_jam_s"] > plain["wall_time_s"] > 0.0 and plain["wall_time_was_tried"] is False
    assert json.loads(json.dumps(plain)) == plain


def test_steps_are_tried_where_machine_code_is_there(crowded, monkeypatch):
    """`crowded` has compiled it; the trial moves a simulation of its own, and its rate is that of the steps."""
    from dilatedem.case.load import load

    case = load(crowded / "case.toml")
    facts = check(case, trial_s=0.05)
    assert facts["wall time was tried"]
    assert facts["wall time, s, about"] / facts["steps"] < 1e-3
    assert told(facts)["wall time, about"].endswith("(its first steps tried)")
    assert check(case)["steps"] == facts["steps"]


def test_the_command_prints_json(tmp_path):
    import tomli_w

    path = tmp_path / "one.toml"
    path.write_text(tomli_w.dumps(one_floe(center=(-6.0, 0.0))))
    done = CliRunner().invoke(app, ["check", str(path), "--json"])
    assert done.exit_code == 0
    found = json.loads(done.stdout)
    assert found["ice_at"]["box"] == {"first_s": None, "last_s": None, "ongoing": False}
    assert any("no ice can reach" in warning or "downstream" in warning for warning in found["warnings"])
    assert [path.name for path in tmp_path.iterdir()] == ["one.toml"]


def test_times_are_told_by_their_size():
    seconds = (0.4, 12.0, 150.0, 1500.0, 8000.0, 3e5)
    assert [duration(s) for s in seconds] == ["0.4 s", "12 s", "2.5 min", "25 min", "2.2 h", "3.5 days"]

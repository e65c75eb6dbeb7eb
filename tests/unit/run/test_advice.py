"""What is hardly meant is warned of, by `check` and by `run`, and nothing that may well be meant."""

import json

import pytest
from typer.testing import CliRunner

from dilatedem.cli import app
from dilatedem.errors import CaseError
from dilatedem.run.foretell import check
from dilatedem.run.simulation import Simulation

PILE = {"kind": "pile", "center": [10.0, 0.0], "radius": 2.0}
FIELD = {"domain": {"size": [50.0, 50.0]}, "field": {"floe_count": 60, "concentration": 0.5}}


def advice(**tables) -> list[str]:
    return Simulation.from_case({**FIELD, "structure": [PILE], **tables}).advice()


def test_nothing_to_say_of_an_ordinary_case():
    assert advice() == []
    assert advice(structure=[]) == []
    assert advice(structure=[{"kind": "plane", "point": [25.0, 0.0, 0.0], "normal": [-1.0, 0.0, 0.0]}]) == []


@pytest.mark.parametrize("structure", [PILE, {"kind": "box", "name": "pile", "size": [2.0, 2.0]}])
@pytest.mark.parametrize(
    ("center", "tables", "expected"),
    [
        ([70.0, 0.0], {}, "m from the nearest floe, and 100 s at 0.3 m/s are enough for 30 m"),
        ([70.0, 0.0], {"time": {"duration": 200.0}}, None),
        ([70.0, 0.0], {"ice": {"initial_velocity": [0.8, 0.0, 0.0]}}, None),
        ([-35.0, 0.0], {}, "all ice starts downstream of it, and the current leads it away"),
        ([-35.0, 0.0], {"water": {"velocity": [-0.3, 0.0]}}, None),
        ([-35.0, 0.0], {"ice": {"initial_velocity": [-0.5, 0.0, 0.0]}}, None),
        ([-35.0, 0.0], {"wind": {"velocity": [-9.0, 0.0]}}, None),
        ([35.0, 0.0], {"water": {"velocity": [-0.3, 0.0]}}, "all ice starts downstream of it, and the current leads it away"),
        ([0.0, 45.0], {}, "all ice drifts past it, "),
        ([0.0, 45.0], {"water": {"velocity": [0.2, 0.2]}}, None),
        ([0.0, 45.0], {"wind": {"velocity": [0.0, 9.0]}}, None),
        ([0.0, 27.0], {}, None),  # floes may be pushed aside
        ([35.0, 0.0], {"water": {"velocity": [0.0, 0.0]}}, "nothing moves, and it lies "),
        ([35.0, 0.0], {"water": {"enabled": False}}, None),  # on a slope, gravity might bring it there
    ],
)
def test_structures_that_no_ice_can_reach(structure, center, tables, expected):
    found = advice(structure=[structure | {"center": center}], **tables)
    if expected is None:
        assert found == []
    else:
        assert len(found) == 1 and found[0].startswith('no ice can reach structure "pile": ') and expected in found[0]


def test_ice_comes_back_over_a_seam():
    domain = {"size": [50.0, 50.0], "x_boundary": "periodic"}
    assert advice(structure=[PILE | {"center": [-24.0, 0.0]}], domain=domain) == []
    domain = {"size": [50.0, 50.0], "y_boundary": "periodic"}
    assert advice(structure=[PILE | {"center": [0.0, 45.0]}], domain=domain) == []


def test_structures_that_are_all_left_behind_are_one_line():
    structures = [PILE | {"name": f"leg{i}", "center": [-40.0, 5.0 * i]} for i in range(3)]
    assert advice(structure=structures) == [
        "no ice can reach any structure: all ice starts downstream of it, and the current leads it away"
    ]
    assert [sentence[:34] for sentence in advice(structure=[*structures[:2], PILE])] == [
        'no ice can reach structure "leg0":', 'no ice can reach structure "leg1":'
    ]  # fmt: skip


def test_a_held_body_is_a_structure():
    body = {"outline": [[-42.0, -1.0], [-40.0, -1.0], [-40.0, 1.0], [-42.0, 1.0]], "fixed": True}
    assert advice(structure=[], body=[body]) == [
        'no ice can reach structure "body_0": all ice starts downstream of it, and the current leads it away'
    ]


@pytest.mark.parametrize(("fraction", "warned"), [(0.1, False), (0.5, False), (0.55, True), (0.9, True)])
def test_long_steps(fraction, warned):
    found = advice(time={"step_fraction": fraction})
    assert bool(found) == warned
    assert not warned or "of the critical one: above 0.5 the peaks of loads overshoot" in found[0]


def test_a_long_step_of_ones_own():
    critical = Simulation.from_case({**FIELD}).critical
    assert len(advice(time={"step": 0.7 * critical})) == 1
    assert advice(time={"step": 0.3 * critical}) == []


def test_a_force_window_that_makes_the_step_short():
    [sentence] = advice(output={"force_interval": 1e-9})
    assert sentence.startswith("output.force_interval = 1e-09 s makes the time step ")
    assert " times shorter than contacts need" in sentence
    assert advice(output={"force_interval": 1e-4}) == []
    assert advice(output={"force_interval": 1e-9}, time={"step": 1e-9}) == []
    assert advice(time={"duration": 1e-9}) == []


def test_floes_thicker_than_wide():
    assert advice(ice={"thickness": 8.0})[0].startswith("the floes: 8 m thick, 4.54 m wide: ice thicker than wide tips over")
    pillar = {"outline": [[30.0, -1.0], [32.0, -1.0], [32.0, 1.0], [30.0, 1.0]], "thickness": 2.5}
    assert advice(body=[pillar])[0].startswith("body 0: 2.5 m thick, 2 m wide: ")
    assert advice(body=[pillar | {"thickness": 1.9}]) == []
    assert advice(body=[pillar], water={"enabled": False}) == []


FAR = (
    'title = "a floe far from a pile"\n[field]\nsource = "bodies"\n[time]\nduration = 0.02\n[output]\nsnapshot_interval = 0\n'
    '[[structure]]\nkind = "pile"\n[[body]]\noutline = [[-1, -1], [1, -1], [1, 1], [-1, 1]]\n'
)


def test_commands_warn_and_go_on(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "case.toml").write_text(FAR)
    sentence = 'warning: no ice can reach structure "pile": it lies '
    checked = CliRunner().invoke(app, ["check", "case.toml"])
    assert (checked.exit_code, checked.stderr.count("\n")) == (0, 1)
    assert checked.stderr.startswith(sentence) and "warning" not in checked.stdout
    done = CliRunner().invoke(app, ["run", "case.toml"])
    assert done.exit_code == 0 and done.stderr.startswith(sentence)
    assert done.stdout.startswith("runs/case: 0.02 s simulated in ") and done.stdout.endswith("; no ice touched pile\n")
    summary = json.loads((tmp_path / "runs/case/summary.json").read_text())
    assert (summary["status"], summary["message"]) == ("completed", "no ice touched any structure")
    assert summary["loads"]["pile"]["touched"] is False and summary["loads"]["pile"]["fh_max_time_s"] is None
    assert "warning" not in CliRunner().invoke(app, ["run", "case.toml", "--out", "quiet", "--quiet"]).stderr


def test_a_structure_that_bears_weight_alone_is_touched(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "case.toml").write_text(
        '[field]\nsource = "bodies"\n[water]\nenabled = false\n[time]\nduration = 0.05\n[output]\nsnapshot_interval = 0\n'
        '[[structure]]\nkind = "plane"\npoint = [0, 0, 0]\nnormal = [0, 0, 1]\n'
        "[[body]]\nvertices = [[0, 0, 0]]\ndilated_radius = 0.1\nposition = [0, 0, 0.1001]\n"
    )
    done = CliRunner().invoke(app, ["run", "case.toml"])
    assert done.exit_code == 0 and done.stdout.endswith("; no horizontal load on plane\n")
    summary = json.loads((tmp_path / "runs/case/summary.json").read_text())
    assert summary["message"] == "" and summary["loads"]["plane"]["touched"] is True


@pytest.mark.parametrize(
    "tables",
    [
        {"time": {"duration": 1e10, "step": 1e-12}},
        {"time": {"duration": 1e10}, "ice": {"elastic_modulus": 1e21}},
        {"output": {"track": "all", "track_interval": 1e10}, "time": {"step": 1e-9}},
    ],
)
def test_more_steps_than_can_be_counted(tables):
    sentence = r"^the longest of time.duration and the intervals of \[output\], 1e\+10 s, takes .* steps of "
    with pytest.raises(CaseError, match=sentence):
        Simulation.from_case({**FIELD, **tables})


def test_check_gives_warnings_to_python():
    from dilatedem.case.load import case_from

    facts = check(case_from({**FIELD, "structure": [PILE], "ice": {"thickness": 8.0}}, {}))
    assert len(facts["warnings"]) == 1 and facts["memory, MB, about"] > 100.0


def test_structures_in_each_other_are_named_but_not_the_parts_of_one():
    brace = {"kind": "brace", "name": "brace", "from": [6.0, 0.0, -3.0], "to": [10.0, 0.0, 1.0], "radius": 0.3}
    (found,) = advice(structure=[PILE, brace])
    assert found == 'structures "pile" and "brace" lie in each other, by 2.3 m; make them parts of one structure if they are one'
    assert advice(structure=[{"kind": "parts", "name": "both", "part": [PILE, brace]}]) == []
    assert advice(structure=[PILE, brace | {"from": [4.0, 0.0, -3.0], "to": [7.0, 0.0, 1.0]}]) == []


@pytest.mark.parametrize(
    ("start", "end", "expected"),
    [
        ([8.0, 0.0, 9.0], [9.0, 0.0, 15.0], "it begins at z = 8.5 m, and the ice reaches up to "),
        ([8.0, 0.0, -40.0], [9.0, 0.0, -9.0], "it ends at z = -8.5 m, and the ice reaches down to "),
        ([8.0, 0.0, -40.0], [9.0, 0.0, -1.5], None),  # a floe on edge comes there
    ],
)
def test_structures_above_and_below_all_ice(start, end, expected):
    brace = {"kind": "brace", "name": "brace", "from": start, "to": end, "radius": 0.5}
    found = advice(structure=[brace])
    assert found == [] if expected is None else found[0].startswith(f'no ice can reach structure "brace": {expected}')
    assert advice(structure=[{"kind": "parts", "name": "both", "part": [PILE, brace]}]) == []


def test_structures_beyond_sides_that_no_ice_passes():
    beyond = PILE | {"center": [60.0, 0.0]}
    domain = {"size": [50.0, 50.0], "x_boundary": "outflow"}
    (found,) = advice(structure=[beyond], domain=domain, time={"duration": 300.0})
    assert found == 'no ice can reach structure "pile": it stands 33 m beyond a side of the domain that is "outflow"'
    assert advice(structure=[PILE | {"center": [27.5, 0.0]}], domain=domain, time={"duration": 300.0}) == []

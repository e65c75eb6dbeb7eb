"""What ends a run before its duration is over."""

from pathlib import Path

import numpy as np
import pytest

from dilatedem.case.load import load
from dilatedem.errors import CaseError
from dilatedem.results.load import load as results
from dilatedem.run import loop
from dilatedem.run.ending import PARTS, is_steady

CASES = Path(__file__).parents[2] / "cases"


def test_a_run_ends_when_all_ice_has_gone_by(tmp_path):
    case = load(CASES / "crowded.toml", [
        "field.source=bodies", "body=[{outline=[[0.5,2],[1.5,2],[1.5,3],[0.5,3]],velocity=[2.0,0,0]}]", "water.velocity=[2.0,0.0]",
        "time.until.ice_gone=true", "time.duration=20", "output.track=[0]", "time.step_fraction=0.4",
    ])  # fmt: skip
    out = loop.run(case, tmp_path / "run", quiet=True)
    told, last = results(out), results(out).bodies.iloc[-1]
    assert told.summary["until"]["met"] == ["ice_gone"]
    # at 2 m/s from x = 1 m, the floe's reach and the pile's radius behind the pile's centre: after 2.6 s, at the next look
    reach = np.sqrt(0.5**2 + 0.5**2 + 0.25**2)
    behind = last.x_m - 4.0 - 1.5 - reach
    assert -0.05 < behind < 2.0 + 0.05 and told.summary["simulated_s"] == pytest.approx(3.0, abs=0.01)


def test_steady_is_what_student_says():
    random = np.random.default_rng(3)
    spread = 0.2
    known = [is_steady(1.0 + spread * random.standard_normal(PARTS), 2.262 * spread / np.sqrt(PARTS)) for _ in range(400)]
    assert 0.4 < np.mean(known) < 0.7, "half of the spreads are smaller than the true one, and one in twenty seems to drift"
    assert is_steady(np.ones(PARTS), 0.01)
    rising = 1.0 + 0.02 * np.arange(PARTS)
    assert not is_steady(rising, 0.05) and is_steady(rising[[0, 9, 2, 7, 4, 5, 6, 3, 8, 1]], 0.05)
    assert not is_steady(np.zeros(PARTS) + [0.0, 1.0] * (PARTS // 2), 0.3)


def test_a_run_ends_when_its_mean_load_is_known(tmp_path, monkeypatch):
    monkeypatch.setattr("dilatedem.run.ending.BLOCK", 0.05)
    changes = ["time.until.steady=0.9", "time.duration=30", "time.step_fraction=0.4", "domain.x_boundary=periodic"]
    out = loop.run(load(CASES / "crowded.toml", changes), tmp_path / "run", quiet=True)
    told = results(out)
    assert told.summary["until"]["met"] == ["steady"] and 2.0 <= told.summary["simulated_s"] < 30.0
    forces = told.forces
    end = int(told.summary["simulated_s"] // 0.05)
    each = end // (2 * PARTS)
    along = forces.along_N.to_numpy() if "along_N" in forces else forces.fx_N.to_numpy()
    parts = along[end - PARTS * each : end].reshape(PARTS, each).mean(axis=1)
    assert is_steady(parts, 0.9)


@pytest.mark.parametrize(("changes", "sentence"), [
    (["time.until.ice_gone=true", "water.velocity=[0,0]"], "time.until.ice_gone = true: needs a current that carries the ice away"),
    (["time.until.ice_gone=true", "domain.x_boundary=inflow"], "must be false where ice enters without an end"),
    (["time.until.steady=0.1", "structure=[]"], "time.until.steady = 0.1: needs a structure that is no plane"),
    (["time.until.stedy=0.1"], 'time.until.stedy: unknown key; did you mean "steady"?'),
    (["time.until.load_above=-1"], "time.until.load_above = -1: must be greater than 0"),
])  # fmt: skip
def test_conditions_that_cannot_be_met_are_refused(changes, sentence):
    with pytest.raises(CaseError) as fault:
        load(CASES / "crowded.toml", ["water.velocity=[0.8,0.0]", *changes])
    assert sentence in str(fault.value)

"""A body of the list that is held fast bears loads like a structure, and they are recorded like one's."""

import json

import numpy as np
import pytest

from dilatedem.case.load import Source, build
from dilatedem.case.schema import Case
from dilatedem.errors import CaseError
from dilatedem.results.load import load as results
from dilatedem.run import loop

CUBE = [[x, y, z] for x in (-0.3, 0.3) for y in (-0.3, 0.3) for z in (-0.3, 0.3)]
HELD = {"vertices": CUBE, "dilated_radius": 0.05, "position": [0.0, 0.0, 0.0], "fixed": True}
BALL = {"vertices": [[0.0, 0.0, 0.0]], "dilated_radius": 0.3}


def case_of(*bodies: dict, **more) -> Case:
    return Case.model_validate({
        "field": {"source": "bodies"}, "water": {"enabled": False}, "gravity": {"acceleration": 0.0}, "body": list(bodies),
        "time": {"duration": 0.3}, "output": {"snapshot_interval": 0.1}, **more,
    })  # fmt: skip


@pytest.mark.parametrize("first", [True, False], ids=["held first", "held last"])
def test_the_impulse_on_it_is_the_momentum_of_the_ball_that_hit_it(first, tmp_path):
    ball = BALL | {"position": [-1.0, 0.1, 0.02], "velocity": [2.0, 0.0, 0.0]}
    case = case_of(*((HELD, ball) if first else (ball, HELD)))
    out = loop.run(case, tmp_path / "run", quiet=True)
    name = "body_0" if first else "body_1"
    told = results(out)
    forces = told.forces[told.forces.structure == name]
    window = np.diff(np.concatenate([[0.0], forces.time_s]))
    impulse = np.array([(forces[f"f{axis}_N"] * window).sum() for axis in "xyz"])
    mass, end = told.floes.mass_kg.iloc[1 if first else 0], told.snapshot(0.3)
    velocity = end.velocity[list(end.body).index(1 if first else 0)]
    start = np.array([2.0, 0.0, 0.0])
    late = told.summary["simulated_s"]
    assert late == pytest.approx(0.3)
    np.testing.assert_allclose(impulse, mass * (start - velocity), rtol=5e-3, atol=0.5)
    assert told.summary["loads"][name]["fh_max_N"] > 1e3


def test_two_held_bodies_do_not_meet_and_a_structure_stands_beside_them(tmp_path):
    pile = {"kind": "pile", "center": [5.0, 0.0], "radius": 0.5}
    ball = BALL | {"position": [-1.0, 0.1, 0.02], "velocity": [2.0, 0.0, 0.0]}
    other = HELD | {"position": [0.0, 3.0, 0.0]}
    out = loop.run(case_of(HELD, other, ball, structure=[pile]), tmp_path / "run", quiet=True)
    loads = json.loads((out / "summary.json").read_text())["loads"]
    assert list(loads) == ["pile", "body_0", "body_1"]
    assert loads["body_0"]["fh_max_N"] > 1e3 and loads["pile"]["fh_max_N"] == loads["body_1"]["fh_max_N"] == 0.0


def test_its_name_is_kept_for_it():
    text = '[[structure]]\nkind = "pile"\nname = "body_0"\n[[body]]\nvertices = [[0, 0, 0]]\nfixed = true\n'
    with pytest.raises(CaseError, match=r'structure.0.name = "body_0": is kept for a fixed \[\[body\]\]; choose another'):
        build(Source("case.toml", text))

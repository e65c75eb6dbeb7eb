"""A box structure is met as a body of its shape that is held, and its record says where and how hard."""

import json
from pathlib import Path

import h5py
import numpy as np
import pytest

from dilatedem.case.load import load
from dilatedem.case.schema import Case
from dilatedem.results.load import load as results
from dilatedem.run import loop
from dilatedem.run.simulation import Simulation
from dilatedem.state.clock import Status
from dilatedem.structures.box import Box

CROWDED = Path(__file__).parents[2] / "cases" / "crowded.toml"
TURN = 20.0  # deg
BOX = {"kind": "box", "center": [1.0, 0.2], "size": [2.0, 1.2], "rotation": TURN, "bottom": -1.0, "top": 1.0, "dilated_radius": 0.1}


def thrown(model: str, **more) -> Simulation:
    """A block that flies at what stands there, without water and weight."""
    return Simulation.of_case(Case.model_validate({
        "field": {"source": "bodies"}, "water": {"enabled": False}, "gravity": {"acceleration": 0.0},
        "contact": {"model": model}, "time": {"step": 2e-5},
        "body": [{
            "vertices": [[x, y, z] for x in (-0.3, 0.3) for y in (-0.4, 0.4) for z in (-0.2, 0.2)], "dilated_radius": 0.05,
            "position": [-0.6, 0.1, 0.05], "velocity": [2.0, 0.3, 0.0],
        }, *more.pop("bodies", [])], **more,
    }))  # fmt: skip


@pytest.mark.parametrize("model", ["liu2015", "consistent"])
def test_a_hit_is_that_on_a_held_body_of_the_same_shape(model):
    core = [[x, y, z] for x in (-0.9, 0.9) for y in (-0.5, 0.5) for z in (-0.9, 0.9)]
    held = {
        "vertices": core, "dilated_radius": 0.1, "position": [1.0, 0.2, 0.0], "rotation": [0.0, 0.0, np.radians(TURN)],
        "fixed": True, "elastic_modulus": 210e9, "poisson_ratio": 0.3,
    }  # fmt: skip
    structure, body = thrown(model, structure=[BOX]), thrown(model, bodies=[held])
    for simulation in (structure, body):
        assert simulation.advance(20_000) == Status.DONE
    np.testing.assert_allclose(structure.state.bodies.velocity[0], body.state.bodies.velocity[0], rtol=1e-6, atol=1e-12)
    np.testing.assert_allclose(structure.state.bodies.position[0], body.state.bodies.position[0], rtol=1e-6, atol=1e-12)
    assert structure.state.bodies.velocity[0, 0] < 1.0, "it was hit"


def test_the_record_holds_the_momentum_that_the_block_lost_and_says_where():
    simulation = thrown("consistent", structure=[BOX])
    mass, before = simulation.model.solids.mass[0], simulation.state.bodies.velocity[0].copy()
    impulse, moment = np.zeros(3), 0.0
    for _ in range(20_000):
        assert simulation.advance(1) == Status.DONE
        impulse += simulation.state.loads.step_load[0, :3] * simulation.dt
        moment += simulation.state.loads.step_load[0, 5] * simulation.dt
    np.testing.assert_allclose(impulse, mass * (before - simulation.state.bodies.velocity[0]), rtol=1e-3, atol=1e-3)
    impulse_map = simulation.state.loads.impulse_map[0]
    normal = np.hypot(*impulse[:2])
    assert impulse_map.sum() == pytest.approx(normal, rel=0.02)  # friction aside
    # all of it on the side that looks to -x of the box's own axes: between its second and its third corner
    edges = simulation.scene.structures[0].chart.edges(impulse_map.shape[0])
    middles = 0.5 * (edges[1:] + edges[:-1])
    touched = middles[impulse_map.sum(axis=1) > 0.0]
    assert touched.min() > 2.0 and touched.max() < 2.0 + 1.2
    assert abs(moment) < normal * 0.6 + 1.0


def test_no_floe_starts_in_it_and_its_files_are_complete(tmp_path):
    """Nor in a body that is held beside it, whose load has a figure as well once a ball has hit it."""
    structure = {"kind": "box", "name": "pier", "center": [3.5, 0.0], "size": [3.0, 2.0], "rotation": 30.0}
    held = {"outline": [[-4.0, -1.0], [-2.0, -1.0], [-2.0, 1.0], [-4.0, 1.0]], "fixed": True}
    ball = {"vertices": [[0.0, 0.0, 0.0]], "dilated_radius": 0.2, "position": [-4.5, 0.0, 0.0], "velocity": [2.0, 0.0, 0.0]}
    bodies = f"body=[{toml(held)}, {toml(ball)}]"
    case = load(CROWDED, ["time.duration=1.0", f"structure=[{toml(structure)}]", bodies])
    out = loop.run(case, tmp_path / "run", quiet=True)
    summary = json.loads((out / "summary.json").read_text())
    assert summary["loads"]["pier"]["fh_max_N"] > 1e3 and summary["loads"]["body_0"]["fh_max_N"] > 1e3
    with h5py.File(out / "run.h5") as file:
        assert file["structures/pier/outline_m"].shape == (4, 2) and file["load_map/pier/impulse_Ns"][()].sum() > 0.0
        assert file["load_map/pier"].attrs["axis_label"].startswith("Distance around the box")
    told = results(out).load_map("pier")
    assert told.impulse_Ns.dims == ("distance", "height") and float(told.distance_edges_m[-1]) == pytest.approx(10.0)
    from dilatedem.post import post

    post([out])
    drawn = {path.name for path in (out / "figures").iterdir()}
    assert {"force_pier.png", "load_map_pier.png", "force_body_0.png", "plan.png"} <= drawn


def toml(table: dict) -> str:
    return "{" + ", ".join(f"{name} = {json.dumps(value)}" for name, value in table.items()) + "}"


def test_impossible_boxes_are_refused():
    with pytest.raises(ValueError, match=r"must be above bottom, -3 m"):
        Box(kind="box", top=-3.5)
    with pytest.raises(ValueError, match=r"must be less than half of the shortest side, 0.2 m"):
        Box(kind="box", size=(0.4, 3.0), dilated_radius=0.2)

"""The load on several structures together: the sum of theirs at every step, about one point."""

import numpy as np
import pytest

import dilatedem
from dilatedem.case.load import case_from
from dilatedem.case.schema import Case
from dilatedem.errors import CaseError
from dilatedem.run.simulation import Simulation
from dilatedem.scene.records import records_of
from dilatedem.state.clock import Status
from dilatedem.state.loads import EXTREMES

LEVEL = -1.5  # m
CURRENT = (2.0, 0.5)  # m/s
CASE = {
    "domain": {"size": [12.0, 12.0], "x_boundary": "periodic", "y_boundary": "periodic"},
    "field": {"floe_count": 20, "concentration": 0.8, "seed": 5},
    "ice": {"initial_velocity": [3.0, 0.8, 0.0], "dilated_radius": 0.06}, "water": {"velocity": list(CURRENT)},
    "structure": [
        {"kind": "pile", "name": "one", "center": [1.0, -1.0], "radius": 0.4},
        {"kind": "pile", "name": "two", "center": [0.0, 2.5], "radius": 0.5},
    ],
    "time": {"duration": 1.1, "step_fraction": 0.4},
    "output": {"force_interval": 0.05, "snapshot_interval": 0.0, "moment_level": LEVEL},
}  # fmt: skip


def about(center: np.ndarray, load: np.ndarray) -> np.ndarray:
    """Loads (n, 6) about a structure's center as loads about the middle of the domain at the level."""
    lever = center - np.array([0.0, 0.0, LEVEL])
    return np.concatenate([load[:, :3], load[:, 3:] + np.cross(lever, load[:, :3])], axis=1)


def test_extremes_are_those_of_the_sum_at_every_step():
    simulation = Simulation.of_case(Case.model_validate(CASE))
    assert [record.name for record in simulation.scene.records] == ["one", "two", "total"]
    simulation.evaluate()
    steps, loads = [], simulation.state.loads
    for _ in range(round(1.0 / simulation.dt)):
        assert simulation.advance(1) == Status.DONE
        steps.append(loads.step_load.copy())
    one, two, total = np.moveaxis(np.array(steps), 1, 0)
    center = simulation.model.charts.center
    np.testing.assert_allclose(center[:, 2], LEVEL)
    scale = np.abs(total).max()
    np.testing.assert_allclose(total, about(center[0], one) + about(center[1], two), atol=1e-12 * scale)
    assert np.abs(one).max() > 0.0 < np.abs(two).max(), "both were hit"
    fx, fy, mx, my, mz = total[:, [0, 1, 3, 4, 5]].T
    u, v = np.array(CURRENT) / np.hypot(*CURRENT)
    found = dict(zip(EXTREMES, loads.window_extreme[2], strict=True))
    for name, values in {"fx": fx, "fy": fy, "along": u * fx + v * fy, "across": u * fy - v * fx}.items():
        assert (found[f"{name}_min_N"], found[f"{name}_max_N"]) == pytest.approx((values.min(), values.max()), rel=1e-12)
    for name, values in {"mx": mx, "my": my, "mz": mz}.items():
        assert (found[f"{name}_min_Nm"], found[f"{name}_max_Nm"]) == pytest.approx((values.min(), values.max()), rel=1e-12)
    assert found["fh_max_N"] == pytest.approx(np.hypot(fx, fy).max(), rel=1e-12)
    assert found["mh_max_Nm"] == pytest.approx(np.hypot(mx, my).max(), rel=1e-12)
    of_parts = loads.window_extreme[:2, EXTREMES.index("fh_max_N")]
    assert found["fh_max_N"] < of_parts.sum(), "their peaks come at different times"


def test_every_window_of_the_total_is_the_sum(tmp_path):
    run = dilatedem.run(CASE, tmp_path / "run")
    parts = {name: rows.reset_index(drop=True) for name, rows in run.forces.groupby("structure")}
    one, two, total = parts["one"], parts["two"], parts["total"]
    assert len(total) == len(one) == 22
    for name in ("fx_N", "fy_N", "fz_N", "along_N", "across_N", "contacts"):
        np.testing.assert_allclose(total[name], one[name] + two[name], atol=1e-7 * abs(total[name]).max())
    for name in ("fx", "fy", "along", "across"):
        span = 1e-7 * abs(total[f"{name}_max_N"]).max()
        assert (total[f"{name}_max_N"] <= one[f"{name}_max_N"] + two[f"{name}_max_N"] + span).all()
        assert (total[f"{name}_min_N"] >= one[f"{name}_min_N"] + two[f"{name}_min_N"] - span).all()
        assert (total[f"{name}_N"] <= total[f"{name}_max_N"] + span).all()
        assert (total[f"{name}_min_N"] <= total[f"{name}_N"] + span).all()
    told = run.summary["loads"]["total"]
    assert told["fh_max_N"] == pytest.approx(total.fh_max_N.max(), rel=1e-8)
    assert told["mh_max_Nm"] == pytest.approx(total.mh_max_Nm.max(), rel=1e-8)
    assert told["along_mean_N"] == pytest.approx(total.along_N.mean(), rel=1e-6)


def test_walls_and_held_bodies_are_no_part_of_the_total_and_one_structure_has_none():
    case = CASE | {"domain": {"size": [12.0, 12.0], "x_boundary": "wall"}}
    names = [record.name for record in Simulation.of_case(Case.model_validate(case)).scene.records]
    assert names == ["one", "two", "wall_x_min", "wall_x_max", "total"]
    alone = Simulation.of_case(Case.model_validate(case | {"structure": CASE["structure"][:1]}))
    assert [record.name for record in alone.scene.records] == ["one", "wall_x_min", "wall_x_max"]
    assert records_of(alone.case, []) == [] and len(alone.model.records.total) == 0


def test_the_name_of_the_total_is_kept():
    with pytest.raises(CaseError, match="is kept for all structures together"):
        case_from(CASE | {"structure": [CASE["structure"][0] | {"name": "total"}]}, {})

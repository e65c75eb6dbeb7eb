"""Idle bodies take long steps beside the busy ones: nothing is missed, nothing is lost, and span = 1 is the plain scheme."""

from pathlib import Path

import numpy as np
import pytest

from dilatedem.case.load import load
from dilatedem.case.schema import Case
from dilatedem.run.simulation import Simulation
from dilatedem.state.clock import Status

CROWDED = Path(__file__).parents[2] / "cases" / "crowded.toml"
BALL = {"vertices": [[0.0, 0.0, 0.0]], "dilated_radius": 0.1}


def balls(*bodies: dict, step: float, **tables) -> Simulation:
    """Balls without water and gravity."""
    made = Simulation.of_case(Case.model_validate({
        "field": {"source": "bodies"}, "water": {"enabled": False}, "gravity": {"acceleration": 0.0},
        "contact": {"damping": 0.0, "friction": 0.0}, "time": {"duration": 10.0, "step": step},
        "body": [BALL | body for body in bodies], **tables,
    }))  # fmt: skip
    assert made.evaluate() == Status.DONE
    return made


def moved(simulation: Simulation, span: int, time: float) -> Simulation:
    simulation.span = span
    assert simulation.advance(round(time / simulation.dt)) == Status.DONE
    return simulation


def evaluated(simulation: Simulation) -> dict[str, float]:
    assert simulation.evaluate() == Status.DONE
    return simulation.energies()


def residual(simulation: Simulation, start: dict[str, float]) -> float:
    """What the ledger cannot tell [J]."""
    now = simulation.energies()
    stored = sum(now[name] - start[name] for name in ("kinetic", "gravity", "buoyancy", "elastic"))
    return stored + now["loss_damping"] + now["loss_friction"] - now["work_drag"] - now["gain_law"]


def test_only_bodies_that_may_touch_take_short_steps():
    simulation = balls({}, {"position": [0.5, 0.0, 0.0], "velocity": [-0.1, 0.0, 0.0]}, {"position": [3.0, 3.0, 0.0]}, step=5e-5)
    simulation.span = 16
    seen = []
    for _ in range(400):
        assert simulation.advance(160) == Status.DONE
        seen.append(tuple(np.flatnonzero(simulation.workspace.is_busy)))
    assert set(seen) == {(), (0, 1)}
    first = seen.index((0, 1)) * 160 * 5e-5
    assert first == pytest.approx(3.0, abs=0.1)  # they meet after 3 s
    assert 0 < seen.count((0, 1)) < 20


@pytest.mark.parametrize("model", ["liu2015", "consistent"])
def test_a_crowd_goes_the_way_of_the_plain_scheme(model):
    case = load(CROWDED)
    tables = case.model_dump()
    tables["contact"]["model"] = model
    plain, paced = (Simulation.of_case(Case.model_validate(tables)) for _ in range(2))
    assert paced.span >= 20
    paced.strides = False  # which test_strides looks at
    plain.span, steps = 1, -(-100 // paced.span) * paced.span
    before = [evaluated(simulation) for simulation in (plain, paced)]
    hits = 0
    for _ in range(80):
        assert plain.advance(steps) == Status.DONE == paced.advance(steps)
        hits += plain.contacts > 0
    assert hits > 3 and plain.state.loads.mode_steps.sum() > 100
    for name, scale in (("position", 1e-6), ("velocity", 1e-4)):
        a, b = (getattr(simulation.state.bodies, name) for simulation in (plain, paced))
        np.testing.assert_allclose(b, a, atol=scale, err_msg=name)
    assert plain.state.clock.evaluations <= paced.state.clock.evaluations <= 1.02 * plain.state.clock.evaluations
    residuals = [residual(simulation, start) for simulation, start in zip((plain, paced), before, strict=True)]
    assert residuals[1] == pytest.approx(residuals[0], abs=1e-6 * plain.energies()["loss_damping"])


def test_a_body_that_is_hit_out_of_rest_meets_the_next_in_time():
    """Newton's cradle: the ball in the middle gets its speed within a span, its neighbour stands a hair away."""
    gap = 1e-6
    row = [{"position": [0.2 * i + gap * i, 0.0, 0.0]} for i in range(3)]
    row[0] |= {"position": [-0.01, 0.0, 0.0], "velocity": [2.0, 0.0, 0.0]}
    plain, paced = (moved(balls(*row, step=2e-6), span, 0.02) for span in (1, 16))
    np.testing.assert_allclose(paced.state.bodies.velocity, plain.state.bodies.velocity, atol=1e-9)
    assert paced.state.bodies.velocity[2, 0] > 1.5


def test_a_span_ends_where_a_body_gets_farther_than_foreseen():
    """A light ball between a heavy one and a far wall flies off faster than any room it was given."""
    light = {"position": [0.201, 0.0, 0.0], "density": 1.0}
    heavy = {"velocity": [8.0, 0.0, 0.0], "density": 9e5}
    case = {"structure": [{"kind": "plane", "point": [0.33, 0.0, 0.0], "normal": [-1.0, 0.0, 0.0]}]}
    plain, paced = (moved(balls(heavy, light, step=1e-6, **case), span, 0.004) for span in (1, 16))
    np.testing.assert_allclose(paced.state.bodies.velocity, plain.state.bodies.velocity, rtol=1e-9, atol=1e-9)
    assert abs(plain.state.bodies.velocity[1, 0]) > 8.0


def test_bodies_too_fast_for_a_span_take_shorter_ones():
    simulation = moved(balls({"velocity": [50.0, 0.0, 0.0]}, {"position": [5.0, 0.0, 0.0]}, step=5e-6), 16, 0.01)
    assert simulation.state.bodies.position[0, 0] == pytest.approx(0.5, rel=1e-12)


def test_a_body_too_fast_for_any_step_is_named():
    simulation = balls({}, {"position": [5.0, 0.0, 0.0]}, {"position": [0.0, 5.0, 0.0]}, step=1e-6)
    simulation.state.bodies.velocity[1, 0] = 2e3  # which no step that a case may have would have been too long for
    simulation.span = 16
    assert simulation.advance(16) == Status.TOO_FAST
    assert simulation.state.clock.culprit.tolist() == [1, -1]
    assert simulation.state.clock.measure[0] == pytest.approx(2e-3)

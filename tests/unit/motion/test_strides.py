"""Busy bodies take several steps in one where their contacts are soft: nothing new is missed, and what is lost is small."""

import math
from pathlib import Path

import numpy as np
import pytest

from dilatedem.case.load import load
from dilatedem.case.schema import Case
from dilatedem.run.simulation import Simulation
from dilatedem.state.clock import Status

CROWDED = Path(__file__).parents[2] / "cases" / "crowded.toml"
SPAN = 25


def ball(x: float, speed: float = 0.0, y: float = 0.0) -> dict:
    return {"vertices": [[0.0, 0.0, 0.0]], "dilated_radius": 0.1, "position": [x, y, 0.0], "velocity": [speed, 0.0, 0.0]}


def balls(*bodies: dict, strides: bool, **tables) -> Simulation:
    """Balls without water and gravity, before a wall at x = 1 where `tables` has one, in spans of SPAN steps."""
    made = Simulation.of_case(Case.model_validate({
        "field": {"source": "bodies"}, "water": {"enabled": False}, "gravity": {"acceleration": 0.0},
        "contact": {"damping": 0.0, "friction": 0.0}, "time": {"duration": 10.0, "step": 1e-6}, "body": list(bodies), **tables,
    }))  # fmt: skip
    made.span, made.strides = SPAN, strides
    return made


def wall(kind: str = "plane") -> dict:
    return {"structure": [{"kind": kind, "name": "wall", "point": [1.0, 0.0, 0.0], "normal": [-1.0, 0.0, 0.0]}]}


def evaluations(simulation: Simulation) -> int:
    return int(simulation.state.clock.evaluations[0])


@pytest.mark.parametrize("model", ["liu2015", "consistent"])
def test_a_soft_hit_takes_fewer_steps_and_comes_to_the_same(model):
    """A slow ball against another, far from a fast one: the same speeds afterwards, the same energy, far fewer evaluations."""
    tables = {"contact": {"model": model, "damping": 0.0, "friction": 0.0}}
    plain, strided = (balls(ball(0.0, 0.02), ball(0.20001), ball(0.0, 1.0, 5.0), strides=on, **tables) for on in (False, True))
    for simulation in (plain, strided):
        assert simulation.advance(SPAN * 400) == Status.DONE
        assert simulation.contacts == 0
    assert strided.state.clock.step == plain.state.clock.step
    assert evaluations(strided) < 0.5 * evaluations(plain)
    a, b = (simulation.state.bodies.velocity[:, 0] for simulation in (plain, strided))
    np.testing.assert_allclose(b[:2], a[:2], atol=1e-5)
    assert b[:2].sum() == pytest.approx(0.02, rel=1e-12)
    assert (b[:2] ** 2).sum() == pytest.approx(0.02**2, rel=1e-3)


def test_the_impulse_that_is_recorded_is_what_the_bodies_lost():
    """Sums over steps weigh loads as the kicks do, however long strides are."""
    simulation = balls(ball(0.8, 1.0), strides=True, **wall())
    mass = simulation.model.solids.mass[0]
    steps = 0
    while simulation.state.bodies.velocity[0, 0] > 0.0 or simulation.contacts > 0:
        assert simulation.advance(SPAN) == Status.DONE
        steps += SPAN
    assert evaluations(simulation) < 0.7 * steps
    impulse = simulation.state.loads.window_sum[0, 0] * simulation.dt
    assert impulse == pytest.approx(mass * (1.0 - simulation.state.bodies.velocity[0, 0]), rel=1e-10)


def test_every_contact_begins_with_a_single_step():
    """Two blocks meet face on face, as stiff as contacts get: a stride into that would throw them apart."""
    corners = [[x, y, z] for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-0.25, 0.25)]
    block = {"vertices": corners, "dilated_radius": 0.04}
    bodies = [block | {"position": [-1.05, 0.0, 0.0], "velocity": [0.3, 0.0, 0.0]}, block | {"position": [1.05, 0.0, 0.0]}]
    plain, strided = (balls(*bodies, strides=on, time={"duration": 10.0, "step_fraction": 0.4}) for on in (False, True))
    for simulation in (plain, strided):
        assert simulation.advance(-(-round(0.1 / simulation.dt) // SPAN) * SPAN) == Status.DONE
        assert simulation.contacts == 0 and simulation.state.loads.mode_steps.sum() > 3
    a, b = (simulation.state.bodies.velocity for simulation in (plain, strided))
    np.testing.assert_allclose(b, a, atol=1e-6)
    assert strided.state.clock.moves < 0.5 * plain.state.clock.moves


BLOCK = {
    "vertices": [[x, y, z] for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-0.25, 0.25)], "dilated_radius": 0.04,
}  # fmt: skip


def stub_of_an_edge() -> dict:
    """Its upright edge is on the face of a block at x = 0, by a length that shrinks: soon a corner, seventy times as stiff."""
    return BLOCK | {
        "position": [1.07 + math.sqrt(2.0), 0.0, 0.4795], "rotation": [0.0, 0.0, math.pi / 4.0], "velocity": [0.0, 0.0, 0.3],
    }  # fmt: skip


def closing_face() -> dict:
    """Its face leans against that of a block at x = 0 and closes on it, at first about a place that deepens no more."""
    tilt, spin, overlap = 1e-4, -0.2, 1e-6
    x, y = -math.cos(tilt) - math.sin(tilt), math.cos(tilt) - math.sin(tilt)
    still = overlap / (6.0 * tilt)  # share of the face from its edge to the middle of the overlap
    x, y = x + 2.0 * math.sin(tilt) * still, y - 2.0 * math.cos(tilt) * still
    return BLOCK | {
        "position": [1.08 - overlap + math.cos(tilt) + math.sin(tilt), 0.0, 0.0], "rotation": [0.0, 0.0, tilt],
        "velocity": [spin * y, -spin * x, 0.0], "angular_velocity": [0.0, 0.0, spin],
    }  # fmt: skip


@pytest.mark.parametrize(("model", "moving", "most"), [("liu2015", stub_of_an_edge(), 0.1), ("consistent", closing_face(), 1.0)])
def test_a_contact_that_becomes_stiff_at_once_is_not_met_by_a_long_stride(model, moving, most):
    """What is won beside single steps was -3.9 and 1.9 J where nobody looked ahead, and the speed was off by 0.16 and 0.014."""
    bodies = [BLOCK | {"fixed": True}, moving, ball(0.0, 1.0, 50.0)]
    tables = {"contact": {"model": model, "damping": 0.0, "friction": 0.0}, "time": {"duration": 10.0, "step_fraction": 0.4}}
    plain, strided = (balls(*bodies, strides=on, **tables) for on in (False, True))
    won = []
    for simulation in (plain, strided):
        assert simulation.evaluate() == Status.DONE
        start = simulation.energies()
        assert simulation.advance(8 * SPAN) == Status.DONE
        now = simulation.energies()
        won.append(now["kinetic"] + now["elastic"] - now["gain_law"] - start["kinetic"] - start["elastic"])
    assert abs(won[1] - won[0]) < most
    assert strided.state.bodies.velocity[1, 0] == pytest.approx(plain.state.bodies.velocity[1, 0], rel=0.01)
    assert evaluations(strided) < 0.9 * evaluations(plain)


@pytest.mark.parametrize("model", ["liu2015", "consistent"])
def test_a_crowd_loses_no_more_energy(model):
    """Twenty-seven floes for half a second: what the ledger cannot tell stays small, and the steps are fewer."""
    tables = load(CROWDED).model_dump()
    tables["contact"]["model"] = model
    simulations = [Simulation.of_case(Case.model_validate(tables)) for _ in range(2)]
    simulations[0].strides = False
    residuals = []
    for simulation in simulations:
        assert simulation.evaluate() == Status.DONE
        start = simulation.energies()
        assert simulation.advance(-(-8000 // simulation.span) * simulation.span) == Status.DONE
        now = simulation.energies()
        stored = sum(now[name] - start[name] for name in ("kinetic", "gravity", "buoyancy", "elastic"))
        residuals.append(stored + now["loss_damping"] + now["loss_friction"] - now["work_drag"] - now["gain_law"])
    assert evaluations(simulations[1]) < evaluations(simulations[0])
    assert abs(residuals[1]) < 1e-4 * simulations[0].energies()["loss_damping"] + abs(residuals[0])

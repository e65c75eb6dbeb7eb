"""A structure has a coefficient of friction of its own, or that of the contacts."""

import numpy as np
import pytest

from dilatedem.case.schema import Case
from dilatedem.run.simulation import Simulation

PLANE = {"kind": "plane", "point": [0.0, 0.0, 0.0], "normal": [0.0, 0.0, 1.0]}
FLOOR, SPEED = 0.06, 0.5


def sliding(model: str, *structures: dict, friction: float) -> Simulation:
    """A low block that slides along x over a level plane."""
    block = {
        "vertices": [[x, y, z] for x in (-0.3, 0.3) for y in (-0.4, 0.4) for z in (-0.01, 0.01)], "dilated_radius": 0.05,
        "position": [0.0, 0.0, FLOOR], "velocity": [SPEED, 0.0, 0.0],
    }  # fmt: skip
    return Simulation.of_case(Case.model_validate({
        "field": {"source": "bodies"}, "water": {"enabled": False}, "contact": {"model": model, "friction": friction},
        "time": {"step": 5e-5}, "structure": list(structures), "body": [block],
    }))  # fmt: skip


def slowing(simulation: Simulation) -> float:
    """Mean deceleration [m/s2] along x between 0.04 s and 0.08 s."""
    simulation.run(until=0.04)
    speed, since = simulation.floes.velocity[0, 0], simulation.time
    simulation.run(until=0.08)
    return (speed - simulation.floes.velocity[0, 0]) / (simulation.time - since)


@pytest.mark.parametrize("model", ["liu2015", "consistent"])
def test_a_block_is_slowed_by_the_coefficient_of_what_it_slides_on(model):
    assert slowing(sliding(model, PLANE | {"friction": 0.3}, friction=0.05)) == pytest.approx(0.3 * 9.81, rel=0.01)
    assert slowing(sliding(model, PLANE | {"friction": 0.0}, friction=0.4)) == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("model", ["liu2015", "consistent"])
def test_the_same_coefficient_given_or_not_is_the_same_to_the_last_bit(model):
    usual, own = sliding(model, PLANE, friction=0.3), sliding(model, PLANE | {"friction": 0.3}, friction=0.3)
    for simulation in (usual, own):
        simulation.step(500)
    np.testing.assert_array_equal(own.state.bodies.velocity, usual.state.bodies.velocity)

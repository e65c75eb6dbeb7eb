"""A collision of any two bodies conserves sum m v and sum (x cross m v + L), whatever the contact law, mode, damping and step: to
round-off, at most one unit in the last place for every step."""

import numpy as np
import pytest

from tests.verification.comparison import MODELS, Comparison, advance_to, by_model, check, start

CASE = "collision"
PAIRS = {"floe on floe": (0, 1), "capsule on plate": (2, 3), "tetrahedron on sphere": (4, 5)}


def momenta(simulation, bodies: tuple[int, int]) -> tuple[np.ndarray, np.ndarray]:
    """Linear (3,) [kg m/s] and angular (3,) momentum about the origin [kg m2/s] of two bodies."""
    a = list(bodies)
    state, mass = simulation.state.bodies, simulation.model.solids.mass[a]
    linear = mass[:, None] * state.velocity[a]
    return linear.sum(axis=0), (np.cross(state.position[a], linear) + state.angular_momentum[a]).sum(axis=0)


def compare_model(model: str, *overrides: str) -> list[Comparison]:
    simulation = start(CASE, *overrides, model=model)
    state = simulation.state.bodies
    before = {name: momenta(simulation, pair) for name, pair in PAIRS.items()}
    moving = state.velocity.copy()
    advance_to(simulation, 1.0)
    round_off = np.finfo(float).eps * float(simulation.state.clock.step[0])
    rows = []
    for name, pair in PAIRS.items():
        a = list(pair)
        assert np.abs(state.velocity[a] - moving[a]).max() > 0.05, f"{name}: did not meet"
        assert simulation.contacts == 0
        after = momenta(simulation, pair)
        linear = (simulation.model.solids.mass[a, None] * np.abs(moving[a])).sum()
        scales = linear, linear * np.abs(state.position[a]).max()
        for what, old, new, scale in zip(("linear", "angular"), before[name], after, scales, strict=True):
            change = float(np.abs(new - old).max())
            rows.append(Comparison(CASE, f"{name}: change of {what} momentum", 0.0, change, round_off, scale=scale))
    return rows


def compare() -> list[Comparison]:
    return by_model(compare_model)


@pytest.mark.parametrize("model", MODELS)
def test_frictionless_collision(model):
    check(compare_model(model))


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("friction", [0.1, 1.0])
def test_collision_with_friction(model, friction):
    check(compare_model(model, f"contact.friction={friction}", "contact.damping=0.0"))

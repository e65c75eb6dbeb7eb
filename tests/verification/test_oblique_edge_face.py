"""Oblique impacts of edges and a face that slide throughout: the impulse of friction is mu times that of the normal force, exactly.

Elastic, without gravity: a level capsule and a cube on its edge that move across their axis, and a block that lies flat. Where the
contact force passes through the centroid, the normal impulse is P = 2 m V_n, hence V_t' = V_t - 2 mu V_n and w' = 2 mu V_n m h/I
about the axis (h: height of the centroid over the plate; friction along -x at the plate turns about +y). The cube turns a little
while it touches and the contact is half an overlap above the plate: both to the ratio of overlap and height, 1e-3 at 0.1 m/s.

The friction on the flat block pushes its leading edge down. Force and overlap shift within the face, so that no closed form gives
its spin. Its books have to close all the same, as those of the others: momentum and moment of momentum, about the origin, change
by the impulses of the force on the plate, sum of dt F and of dt x cross F (exact for the Verlet steps, so to round-off).
"""

from math import pi, sqrt

import numpy as np
import pytest

from dilatedem.state.clock import Status
from tests.verification.comparison import MODELS, Comparison, by_model, check, start

CASE, MU, TANGENT, NORMAL = "oblique_edge_face", 0.2, 0.04, 0.01
SHAPES = ("capsule", "cube on its edge", "flat block")


def _momenta(simulation) -> np.ndarray:
    """Momentum and moment of momentum about the origin of each body, (3, 6)."""
    bodies, mass = simulation.state.bodies, simulation.model.solids.mass[:3, None]
    linear = mass * bodies.velocity[:3]
    return np.hstack([linear, np.cross(bodies.position[:3], linear) + bodies.angular_momentum[:3]])


def compare_model(model: str) -> list[Comparison]:
    simulation = start(CASE, model=model)
    bodies, pairs, solids = simulation.state.bodies, simulation.state.pairs, simulation.model.solids
    first, before = bodies.velocity[:3].copy(), _momenta(simulation)
    impulse = np.zeros((3, 6))
    for _ in range(round(simulation.case.time.duration / simulation.dt)):
        assert simulation.advance(1) == Status.DONE
        for k in np.flatnonzero(pairs.overlap[: pairs.count[0]] > 0.0):
            a, force = pairs.a[k], -simulation.dt * pairs.force[k]
            impulse[a] += (*force, *np.cross(bodies.position[a] + pairs.point[k], force))
    assert simulation.contacts == 0, "still touching at the end"
    change = _momenta(simulation) - before
    round_off = np.finfo(float).eps * float(simulation.state.clock.step[0])
    rows = []
    for i, shape in enumerate(SHAPES):
        moved, mass = bodies.velocity[i] - first[i], solids.mass[i]
        rows.append(Comparison(CASE, f"{shape}: ratio of the impulses", MU, float(-moved[0] / moved[2]), 1e-9))
        scale = mass * TANGENT * np.array([1.0, 1.0, 1.0] + 3 * [np.abs(bodies.position[i]).max()])
        error = np.abs((change[i] - impulse[i]) / scale).max()
        rows.append(Comparison(CASE, f"{shape}: momentum and moment not from the plate", 0.0, float(error), round_off, 1.0))
    radius, length = 0.04, 0.5
    rod, ball = pi * radius**2 * length, 4 / 3 * pi * radius**3
    turning = radius**2 * (0.5 * rod + 0.4 * ball) / (rod + ball)  # I/m of a capsule about its axis
    # a cube turns alike about every axis
    levers = (radius / turning, (0.25 * sqrt(2) + radius) * solids.mass[1] / solids.inertia[1, 0, 0])
    for i, (shape, lever) in enumerate(zip(SHAPES[:2], levers, strict=True)):
        rows += [
            Comparison(CASE, f"{shape}: normal speed, m/s", NORMAL, float(bodies.velocity[i, 2])),
            Comparison(CASE, f"{shape}: tangential speed, m/s", TANGENT - 2 * MU * NORMAL, float(bodies.velocity[i, 0])),
            Comparison(CASE, f"{shape}: spin, rad/s", 2 * MU * NORMAL * lever, float(bodies.angular_velocity[i, 1])),
        ]
    return rows


def compare() -> list[Comparison]:
    return by_model(compare_model)


@pytest.mark.parametrize("model", MODELS)
def test_oblique_impacts_that_slide(model):
    check(compare_model(model))

"""Chung & Ooi (2011), tests 4-8: oblique and spinning impacts of elastic spheres that slide throughout (Coulomb on the whole
impulse).

The normal impulse on a sphere is P = m* (1 + e) V_n, e = 1, V_n: speed of approach; the tangential one mu P against the
surface's sliding. On a rigid plane (m* = m, I = 2 m R^2/5):
4: e_t = 1 - mu (1 + e)/tan(theta), w' = -(5/2) mu (1 + e) v cos(theta)/R, theta from the normal, v the speed
5: psi' = psi - 7, R w'/(mu V_n) = -5, psi = sliding speed of the surface/(mu V_n)
6: spin w without tangential speed: V_t' = mu (1 + e) V_n, w' = w - (5/2) mu (1 + e) V_n/R
Two spheres that spin the same way: 7, 8: m_i V_ti' = mu P to opposite sides, I_i w_i' = I_i w_i - mu R_i P; the pair's centre
does not move (also where the contact sticks). A closed form has its lever R, the contact R less half the overlap: up to 1e-3
of w' here.
"""

from math import pi

import numpy as np
import pytest

from tests.verification.comparison import MODELS, Comparison, by_model, check, start
from tests.verification.point_impact import impacts


def _collide(case: str, model: str):
    """The simulation at the end of a case; velocity and spin (n, 3) before."""
    simulation = start(case, model=model)
    bodies = simulation.state.bodies
    before = bodies.velocity.copy(), bodies.angular_velocity.copy()
    impacts(simulation)
    return simulation, *before


def compare_4(model: str) -> list[Comparison]:
    case, mu, radius = "chung_ooi_4", 0.092, 0.0025
    simulation, before, _ = _collide(case, model)
    after, spin = simulation.state.bodies.velocity, simulation.state.bodies.angular_velocity
    rows = []
    for i, degrees in enumerate((50, 60, 75)):
        tangent, normal = before[i, 0], -before[i, 2]
        ratio = 1 - 2 * mu * normal / tangent
        rows += [
            Comparison(case, f"{degrees} deg: e_t", ratio, after[i, 0] / tangent),
            # a sphere that moves along +x spins about +y after the impact: the paper's sign is that of the other hand
            Comparison(case, f"{degrees} deg: spin, rad/s", -5 * mu * normal / radius, -spin[i, 1]),
        ]
    return rows


def compare_5(model: str) -> list[Comparison]:
    case, mu, radius = "chung_ooi_5", 0.3, 0.01
    simulation, before, _ = _collide(case, model)
    after, spin = simulation.state.bodies.velocity, simulation.state.bodies.angular_velocity
    rows = []
    for i, psi in enumerate((8, 10, 14)):
        unit = -mu * before[i, 2]
        rows += [
            # a difference of large numbers is measured by what it was taken from
            Comparison(case, f"psi = {psi}: psi'", psi - 7, (after[i, 0] - radius * spin[i, 1]) / unit, scale=psi),
            Comparison(case, f"psi = {psi}: R w'/(mu V_n)", -5, -radius * spin[i, 1] / unit),
        ]
    return rows


def compare_6(model: str) -> list[Comparison]:
    case, mu, radius = "chung_ooi_6", 0.4, 0.1
    simulation, before, turning = _collide(case, model)
    after, spin = simulation.state.bodies.velocity, simulation.state.bodies.angular_velocity
    rows = []
    for i, psi in enumerate((8, 10, 14)):
        kick = -2 * mu * before[i, 2]
        # the lowest point of a sphere that spins about +y moves along -x: friction pushes it along +x
        rows += [
            Comparison(case, f"psi = {psi}: tangential speed, m/s", kick, after[i, 0]),
            Comparison(case, f"psi = {psi}: spin, rad/s", turning[i, 1] - 2.5 * kick / radius, spin[i, 1]),
        ]
    return rows


def _spinning_pairs(case: str, second: float, model: str) -> list[Comparison]:
    """Rows of tests 7 and 8: spheres of 0.1 m and `second`, psi = 2 (bodies 0, 1) and psi = 10 (bodies 2, 3)."""
    mu, approach, radii = 0.4, 0.4, np.array([0.1, second])
    mass = 2699.0 * 4 / 3 * pi * radii**3
    simulation, _, turning = _collide(case, model)
    after, spin = simulation.state.bodies.velocity, simulation.state.bodies.angular_velocity
    rows = []
    for first, psi in ((0, 2), (2, 10)):
        drift = mass @ after[first : first + 2, 1] / mass.sum()
        rows.append(Comparison(case, f"psi = {psi}: drift of the centre, m/s", 0.0, drift, 1e-9, scale=approach))
    kick = mu * 2 * approach / (1 / mass).sum()
    for i, side in ((0, -1), (1, 1)):
        rows += [
            # the left sphere's right side moves along +y: friction pushes it along -y
            Comparison(case, f"psi = 10, R = {radii[i]:g} m: tangential speed, m/s", side * kick / mass[i], after[2 + i, 1]),
            Comparison(
                case,
                f"psi = 10, R = {radii[i]:g} m: spin, rad/s",
                turning[2 + i, 2] - 2.5 * kick / (mass[i] * radii[i]),
                spin[2 + i, 2],
                scale=turning[2 + i, 2],
            ),
        ]
    return rows


def compare_7(model: str) -> list[Comparison]:
    return _spinning_pairs("chung_ooi_7", 0.1, model)


def compare_8(model: str) -> list[Comparison]:
    return _spinning_pairs("chung_ooi_8", 0.05, model)


PARTS = (compare_4, compare_5, compare_6, compare_7, compare_8)


def compare() -> list[Comparison]:
    return by_model(lambda model: [row for part in PARTS for row in part(model)])


@pytest.mark.parametrize("model", MODELS)
def test_4_constant_speed(model):
    check(compare_4(model))


@pytest.mark.parametrize("model", MODELS)
def test_5_constant_normal_speed(model):
    check(compare_5(model))


@pytest.mark.parametrize("model", MODELS)
def test_6_spinning_sphere(model):
    check(compare_6(model))


@pytest.mark.parametrize("model", MODELS)
def test_7_equal_spinning_spheres(model):
    check(compare_7(model))


@pytest.mark.parametrize("model", MODELS)
def test_8_unequal_spinning_spheres(model):
    check(compare_8(model))

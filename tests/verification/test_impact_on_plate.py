"""Central impacts of a corner (sphere), edges (a level capsule, a cube on its edge) and a face (flat block) on a plate, at 0.01,
0.3 and 2 m/s.

Elastic, at 0.3 m/s: largest overlap, force and duration of m d'' = -F(d) (`normal_impact`). `liu2015`: F = K d^(3/2), K = 4/3 E*
sqrt(r) for the sphere (Eq. (11)) and 4/3 E* L sqrt(r) for an edge (Eq. (19)), to 1e-3; F = 2 E* 1.02 sqrt(A/pi) d for the face
(Eq. (24)). `consistent`: Hertz for the sphere, the line law F = pi E* L d/Lam for the edges and 2 E* 1.018 sqrt(A/pi) d for the
face, edges and faces to 5 %, as far as the energies of ends and borders leave them their own. No impact may turn or shift the
body, and an elastic one gives back its speed.

Damped: restitution. `liu2015`: of its own equation of motion, which depends on speed. `consistent`: one number for all, in closed
form in `normal_impact`, to 1 %.
"""

from math import pi, sqrt

import numpy as np
import pytest

from tests.verification.comparison import MODELS, Comparison, advance_to, by_model, check, start
from tests.verification.normal_impact import (
    ICE_STEEL,
    impact_in_theory,
    line_law,
    power_law,
    restitution_of_oscillator,
    viscous_law,
)
from tests.verification.point_impact import impacts

CASE, ICE, DAMPING = "impact_on_plate", 915.0, 0.36
SHAPES = ("sphere", "capsule", "cube on its edge", "flat block")
SPEEDS = (0.01, 0.3, 2.0)
#: restitution of `consistent` as specified
SPECIFIED = {0.05: 0.8588, 0.1: 0.7441, 0.2: 0.5717, 0.3: 0.4510, 0.36: 0.3953, 0.5: 0.2984, 0.7: 0.2103, 1.0: 0.1353}


def box_mass(a: float, b: float, c: float, r: float) -> float:
    """kg of ice: a box with sides a, b, c dilated by r [m]."""
    surface, edges = 2 * (a * b + b * c + c * a), a + b + c
    return ICE * (a * b * c + surface * r + pi * edges * r**2 + 4 / 3 * pi * r**3)


def capsule_mass(length: float, r: float) -> float:
    return ICE * (pi * r**2 * length + 4 / 3 * pi * r**3)


MASSES = (ICE * 4 / 3 * pi * 0.1**3, capsule_mass(0.5, 0.04), box_mass(0.5, 0.5, 0.5, 0.04), box_mass(0.92, 0.92, 0.22, 0.04))


def liu_laws() -> list[tuple[float, float]]:
    """K and kappa of the four shapes."""
    edge = 4 / 3 * ICE_STEEL * 0.5 * sqrt(0.04)
    face = 2 * ICE_STEEL * 1.02 * sqrt(0.92**2 / pi)
    return [(4 / 3 * ICE_STEEL * sqrt(0.1), 1.5), (edge, 1.5), (edge, 1.5), (face, 1.0)]


def elastic_forces(model: str) -> list:
    """Force [N] of the overlap [m] for the four shapes."""
    if model == "liu2015":
        return [power_law(*law) for law in liu_laws()]
    line = line_law(ICE_STEEL, 0.5, 0.04)
    face = power_law(2 * ICE_STEEL * 1.018 * sqrt(0.92**2 / pi), 1.0)
    return [power_law(4 / 3 * ICE_STEEL * sqrt(0.1), 1.5), line, line, face]


def compare_elastic(model: str) -> list[Comparison]:
    simulation = start(CASE, "contact.damping=0.0", model=model)
    bodies = simulation.state.bodies
    found = impacts(simulation, every=10)
    rows = []
    for i, (shape, mass, force) in enumerate(zip(SHAPES, MASSES, elastic_forces(model), strict=True)):
        theory, _ = impact_in_theory(force, mass, 0.3)
        allowed = 1e-3 if model == "liu2015" or shape == "sphere" else 0.05
        impact = found[len(SHAPES) + i, 12]
        rows += [
            Comparison(CASE, f"{shape}, elastic: overlap, m", theory.overlap, impact.overlap, allowed),
            Comparison(CASE, f"{shape}, elastic: force, N", theory.force, impact.force, allowed),
            Comparison(CASE, f"{shape}, elastic: duration, s", theory.duration, impact.duration, allowed),
        ]
    speeds = np.repeat(SPEEDS, len(SHAPES))
    aside = np.abs(bodies.velocity[:12, :2]).max(axis=1) / speeds
    turning = np.abs(bodies.angular_velocity[:12]).max(axis=1) * 0.1 / speeds
    error = np.abs(bodies.velocity[:12, 2] / speeds - 1.0).max()
    return rows + [
        Comparison(CASE, "elastic, worst of 12: restitution", 1.0, 1.0 - float(error)),
        Comparison(
            CASE, "elastic, worst of 12: speed aside, 0.1 m x spin, of the impact's", 0.0, float(max(*aside, *turning)), 1e-9, 1.0
        ),
    ]


def restitutions(model: str, xi: float, *overrides: str) -> np.ndarray:
    """Speed after over speed before, (3, 4): by speed and shape."""
    simulation = start(CASE, f"contact.damping={xi}", *overrides, model=model)
    advance_to(simulation, simulation.case.time.duration)
    assert simulation.contacts == 0, "still touching at the end"
    after = simulation.state.bodies.velocity[:12, 2].reshape(len(SPEEDS), len(SHAPES))
    return after / np.array(SPEEDS)[:, None]


def restitution_in_theory(model: str, shape: int, speed: float, xi: float) -> float:
    if model != "liu2015":
        return restitution_of_oscillator(xi)
    law, mass = liu_laws()[shape], MASSES[shape]
    return impact_in_theory(power_law(*law), mass, speed, viscous_law(model, *law, mass, xi))[1]


def compare_damped(model: str) -> list[Comparison]:
    found = restitutions(model, DAMPING)
    allowed = 1e-3 if model == "liu2015" else 0.01
    return [
        Comparison(
            CASE, f"{shape}, {speed:g} m/s: restitution", restitution_in_theory(model, i, speed, DAMPING), found[j, i], allowed
        )
        for i, shape in enumerate(SHAPES)
        for j, speed in enumerate(SPEEDS)
    ]


def compare_table(model: str) -> list[Comparison]:
    """One restitution for one xi, whatever the shape and speed: asked of `consistent` alone."""
    if model == "liu2015":
        return []
    rows = []
    for xi, target in SPECIFIED.items():
        found = restitutions(model, xi, "time.step=1e-6").ravel()
        worst = found[np.abs(found / target - 1.0).argmax()]
        rows.append(Comparison(CASE, f"xi = {xi:g}, worst of 12: restitution", target, float(worst), 0.01))
    return rows


def compare() -> list[Comparison]:
    return by_model(lambda model: compare_elastic(model) + compare_damped(model) + compare_table(model))


@pytest.mark.parametrize("model", MODELS)
def test_elastic_impacts(model):
    check(compare_elastic(model))


@pytest.mark.parametrize("model", MODELS)
def test_restitution_by_speed_and_shape(model):
    check(compare_damped(model))


@pytest.mark.parametrize("model", [model for model in MODELS if model != "liu2015"])
def test_restitution_by_damping(model):
    check(compare_table(model))


def test_restitution_as_specified():
    for xi, printed in SPECIFIED.items():
        assert restitution_of_oscillator(xi) == pytest.approx(printed, abs=6e-5)


@pytest.mark.parametrize("exponent", [1.0, 1.25, 1.5])
@pytest.mark.parametrize("speed", [0.01, 2.0])
def test_restitution_in_closed_form_is_that_of_the_equation(exponent, speed):
    law, mass = (1e8, exponent), 30.0
    _, found = impact_in_theory(power_law(*law), mass, speed, viscous_law("consistent", *law, mass, 0.36))
    assert found == pytest.approx(restitution_of_oscillator(0.36), rel=1e-5)


def test_face_of_the_paper_is_an_oscillator():
    assert restitution_in_theory("liu2015", 3, 0.3, DAMPING) == pytest.approx(
        restitution_of_oscillator(DAMPING / sqrt(2)), rel=1e-5
    )

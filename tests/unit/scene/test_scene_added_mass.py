"""What floes take along: between a thin disc and a sphere; what is no floe counts as a sphere, what is held takes nothing."""

from math import pi

import numpy as np
import pytest

from dilatedem.case.schema import Case
from dilatedem.motion.timestep import critical_step
from dilatedem.run.simulation import Simulation
from dilatedem.scene.added_mass import spheroid_share

SQUARE = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
BALL = {"vertices": [[0.0, 0.0, 0.0]], "dilated_radius": 0.3, "position": [5.0, 0.0, 0.0]}
HEAVY = BALL | {"position": [8.0, 0.0, 0.0], "density": 3000.0}


def simulation_of(added: bool = True, **water) -> Simulation:
    return Simulation.of_case(Case.model_validate({
        "field": {"source": "bodies"}, "water": {"added_mass": added, **water},
        "body": [{"outline": SQUARE}, BALL, HEAVY, {"outline": SQUARE, "position": [-5.0, 0.0], "fixed": True}],
    }))  # fmt: skip


def test_edgewise_a_floe_takes_along_what_a_spheroid_does():
    flat = np.array([1e-4, 0.01, 0.2, 0.9, 0.9989, 1.0, 5.0])
    found = spheroid_share(flat)
    assert found[:2] == pytest.approx(pi / 4 * flat[:2], rel=0.02)  # thin
    assert (np.diff(found) >= 0.0).all() and found[-3:] == pytest.approx([0.5] * 3, rel=1e-3)  # a sphere
    # of a spheroid half as high as wide: Lamb's integral by quadrature
    s = np.geomspace(1e-9, 1e9, 400_001)
    alpha = 0.5 * np.trapezoid(1.0 / ((1.0 + s) ** 2 * np.sqrt(0.25 + s)), s)
    assert spheroid_share(np.array([0.5]))[0] == pytest.approx(alpha / (2.0 - alpha), rel=1e-5)


def test_what_each_body_takes_along():
    solids = simulation_of().model.solids
    radius = 2.0 / np.sqrt(pi)
    assert solids.added_mass[0, 1] == pytest.approx(4 / 3 * 1025.0 * radius**3, rel=0.01)  # outline rounded
    assert solids.added_inertia[0] == pytest.approx(8 / 45 * 1025.0 * radius**5, rel=0.01)
    assert 0.1 < solids.added_mass[0, 0] / solids.mass[0] < 0.5
    assert solids.added_mass[1] == pytest.approx(0.5 * solids.mass[1])
    assert solids.added_mass[2] == pytest.approx(0.5 * 1025.0 / 3000.0 * solids.mass[2], rel=1e-3)
    assert (solids.added_mass[3] == 0.0).all() and solids.inverse_mass[3] == solids.inverse_heave_mass[3] == 0.0
    assert 1.0 / solids.inverse_heave_mass[0] == pytest.approx(solids.mass[0] + solids.added_mass[0, 1])
    np.testing.assert_allclose(solids.inertia[0] @ solids.inverse_inertia[0], np.eye(3), atol=1e-12)


def test_without_it_bodies_weigh_what_they_are():
    for other in (simulation_of(False, drag="skin_form"), simulation_of(True, enabled=False)):
        solids, alone = other.model.solids, simulation_of(False).model.solids
        assert not solids.added_mass.any() and not solids.added_inertia.any()
        for name in alone._fields:
            np.testing.assert_array_equal(getattr(solids, name), getattr(alone, name))
        np.testing.assert_array_equal(solids.inverse_heave_mass, alone.inverse_mass)


def test_the_critical_step_only_grows():
    with_water, alone = (critical_step(s.model, s.state.bodies) for s in (simulation_of(), simulation_of(False)))
    assert with_water >= alone

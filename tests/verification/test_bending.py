"""Bodies that bend at rest: by their free modes, and by mode acceleration.

A beam on two end supports under its weight: the weight excites no mode, the supports load each by phi(ends) . R. Beam theory has a
middle deflection 5 q L^4/(384 E I), with shear q L^2/(8 kappa G A) more, and the stress q L^2 h/(16 I); by n symmetric modes of
Euler-Bernoulli the deflection is short by 1.33, 0.72, 0.13, 0.10 and 0.013 % for n = 1, 2, 3, 4 and 8.

A rigid floe on water with a load P on its end: the water bears it by P/L (4 - 6 x/L), the moment is P x (1 - x/L)^2, at most
4/27 P L, at L/3.
"""

import numpy as np
import pytest

from dilatedem.deformation.statics import Flexibility, accelerated_stress, static_coordinates
from dilatedem.deformation.stress import corner_stress
from tests.verification.comparison import Comparison, check
from validation.bao2004 import reference
from validation.bao2004.bending import floating, recovered_moment, sagging
from validation.bao2004.bodies import Meshed, beam

FOLDER = "bao2004"
#: size of the elements [m]; modes, enough for eight that are symmetric
SIZE, COUNT = 0.5, 60
#: of the floe [N]
LOAD = 1000.0


def of_sagging(body: Meshed) -> list[Comparison]:
    bent = sagging(body)
    deflection, stress = sum(reference.sagging()), reference.sagging_stress()
    rows = [
        Comparison(FOLDER, "beam on its ends: middle deflection, m", deflection, bent.whole, 5e-3),
        Comparison(FOLDER, "beam on its ends: stress of the middle by mode acceleration, Pa", stress, bent.stress, 2e-2),
    ]
    for count, error in reference.SERIES.items():
        found = bent.by_modes[count] / bent.whole - 1.0
        quantity = f"beam on its ends: error of its deflection by {count} symmetric modes"
        rows.append(Comparison(FOLDER, quantity, error, found, 5e-4, 1.0))
    return rows


def of_floating(body: Meshed) -> list[Comparison]:
    moment = recovered_moment(body, floating(body, LOAD), reference.LENGTH / 3.0)
    target = 4.0 / 27.0 * LOAD * reference.LENGTH
    return [Comparison(FOLDER, "rigid floe on water, loaded at its end: moment at L/3 from its stress, N m", target, moment, 3e-2)]


def compare() -> list[Comparison]:
    body = beam(SIZE, COUNT)
    return of_sagging(body) + of_floating(body)


@pytest.fixture(scope="module")
def body() -> Meshed:
    pytest.importorskip("skfem")
    return beam(SIZE, COUNT)


def test_a_beam_on_its_ends_sags_as_theory_has_it(body):
    check(of_sagging(body))


def test_a_floe_that_is_loaded_at_its_end_bends_as_the_water_bears_it(body):
    check(of_floating(body))
    for place in (0.15, 0.5, 0.7):
        moment = recovered_moment(body, floating(body, LOAD), place * reference.LENGTH)
        assert moment == pytest.approx(reference.floating_moment(place * reference.LENGTH, LOAD), rel=3e-2)


def test_loads_that_move_a_body_as_a_whole_do_not_bend_it(body):
    """Its weight, and forces as they are in a body that is turned ever faster."""
    elements = body.elements
    spun = (elements.mass @ np.cross([0.1, -0.2, 0.3], elements.nodes).ravel()).reshape(-1, 3)
    for force in (spun, (elements.mass @ np.tile([1.0, 2.0, 3.0], len(elements.nodes))).reshape(-1, 3)):
        assert np.abs(Flexibility.of(elements).balanced(force)).max() < 1e-9 * np.abs(force).max()
        assert np.abs(static_coordinates(body.modes, force)).max() < 1e-9


def test_what_bends_is_the_stiffness_s_own_answer(body):
    """K u = F, of a load in balance, and by modes the same in the limit: their share of the energy is close to all of it."""
    force = floating(body, LOAD)
    flexibility = Flexibility.of(body.elements)
    moved = flexibility.displacement(force)
    np.testing.assert_allclose(body.elements.stiffness @ moved.ravel(), flexibility.balanced(force).ravel(), atol=1e-6 * LOAD)
    by_modes = (static_coordinates(body.modes, force) ** 2 * body.modes.frequency**2).sum()
    assert 0.99 < by_modes / (force * moved).sum() < 1.0


def test_mode_acceleration_leaves_out_what_accelerating_modes_do_not_bear(body):
    """A body that is let go under loads has not bent yet: its modes accelerate by phi . F, and bear nothing."""
    force, modes = floating(body, LOAD), body.modes
    flexibility = Flexibility.of(body.elements)
    at_rest = corner_stress(body.elements, flexibility.displacement(force))
    let_go = accelerated_stress(flexibility, modes, force, np.einsum("inc,nc->i", modes.shape, force))
    held = accelerated_stress(flexibility, modes, force, np.zeros(modes.count))
    np.testing.assert_array_equal(held, at_rest)
    middle = np.abs(body.mesh.points[:, 0]) < 3.0  # away from the load itself, which bends the floe in all modes
    assert np.abs(let_go[middle]).max() < 0.05 * np.abs(at_rest[middle]).max()

"""Free vibration of a beam and of a plate of ice, by quadratic tetrahedra.

A free beam of Euler and Bernoulli has the frequencies (x_k/L)^2 sqrt(E I/(rho A))/(2 pi), cos x_k cosh x_k = 1: 5.373, 14.811 and
29.035 Hz for 10 m x 1 m x 0.5 m; Timoshenko's equations, with shear and the inertia of sections, lower them by 0.9, 2.5 and 4.7 %.
A free square plate, nu = 0.3, has a^2 w sqrt(rho h/D) = 13.49, 19.79, 24.43 (Leissa 1973), D = E h^3/(12 (1 - nu^2)).
"""

import numpy as np
import pytest

from dilatedem.deformation.modes import Modes, rigid_motions
from tests.verification.comparison import Comparison, check
from validation.bao2004 import reference
from validation.bao2004.bodies import SIDE, THIN, Meshed, beam, block, deformable, plate, upright

FOLDER = "bao2004"
#: size of the elements of the beam and of the plate [m]
SIZE, PLATE_SIZE = 0.5, 0.1


def plate_numbers(modes: Modes) -> np.ndarray:
    """a^2 w sqrt(rho h/D) of each mode."""
    ice = reference.ICE
    stiffness = ice.elastic_modulus * THIN**3 / (12.0 * (1.0 - ice.poisson_ratio**2))
    return SIDE**2 * modes.frequency * np.sqrt(ice.density * THIN / stiffness)


def of_beam(body: Meshed) -> list[Comparison]:
    found = body.modes.frequency[upright(body.modes)[:3]] / (2.0 * np.pi)
    corrected = found * reference.euler_bernoulli() / reference.timoshenko()
    return [
        Comparison(FOLDER, f"mode {k + 1} of a free beam, less Timoshenko's correction, Hz", target, corrected[k], 2e-2)
        for k, target in enumerate(reference.euler_bernoulli())
    ]


def of_plate(body: Meshed) -> list[Comparison]:
    found = plate_numbers(body.modes)
    return [
        Comparison(FOLDER, f"mode {k + 1} of a free square plate, a² ω √(ρh/D)", target, found[k], 2e-2)
        for k, target in enumerate(reference.PLATE)
    ]


def momenta(body: Meshed) -> list[Comparison]:
    """What no mode may have: momentum, and angular momentum about the centroid; and the mass that each must have."""
    flat = body.modes.shape.reshape(body.modes.count, -1)
    moved = np.abs(flat @ (body.elements.mass @ rigid_motions(body.elements))).max()
    products = np.abs(flat @ (body.elements.mass @ flat.T) - np.eye(body.modes.count)).max()
    return [
        Comparison(FOLDER, "momenta of the modes of a free beam, √kg/s at a rate of 1", 0.0, moved, 1e-11, 1.0),
        Comparison(FOLDER, "products of these modes in its mass, less 0 and 1", 0.0, products, 1e-11, 1.0),
    ]


def compare() -> list[Comparison]:
    body = beam(SIZE, 12)
    return of_beam(body) + momenta(body) + of_plate(plate(PLATE_SIZE, 5))


@pytest.fixture(scope="module")
def body() -> Meshed:
    pytest.importorskip("skfem")
    return beam(SIZE, 12)


def test_frequencies_of_a_beam(body):
    check(of_beam(body))


def test_modes_have_no_momenta_and_a_mass_of_their_own(body):
    check(momenta(body))


def test_frequencies_of_a_plate():
    pytest.importorskip("skfem")
    check(of_plate(plate(PLATE_SIZE, 5)))


def test_frequencies_fall_towards_their_limit_as_elements_get_smaller():
    """Displacements that are chosen from fewer make a stiffer body; halved elements leave less than a quarter of the error."""
    pytest.importorskip("skfem")
    found = np.array([deformable(block(1.0, 1.0, 0.5), size, 3).modes.frequency for size in (0.5, 0.25, 0.125)])
    change = found[:-1] - found[1:]
    assert (change > 0.0).all()
    assert (change[1] < 0.25 * change[0]).all()


def test_a_mode_changes_the_inertia_as_the_bent_shape_has_it(body):
    """I of the displaced nodes, by their own mass, against I + dI/dxi xi; the rest is of the square of xi."""
    modes, elements = body.modes, body.elements

    def inertia(nodes: np.ndarray) -> np.ndarray:
        product = nodes.T @ (elements.scalar_mass @ nodes)
        return np.trace(product) * np.eye(3) - product

    for shape, gradient in zip(modes.shape, modes.inertia_gradient, strict=True):
        step = 1e-3
        central = (inertia(modes.nodes + step * shape) - inertia(modes.nodes - step * shape)) / (2.0 * step)
        np.testing.assert_allclose(central, gradient, atol=1e-8 * np.abs(inertia(modes.nodes)).max())


def test_what_tisserands_condition_leaves_out(body):
    """The angular momentum of two modes at work, in their own frame, by the velocities of the displaced nodes."""
    modes, elements = body.modes, body.elements
    coordinate, rate = np.linspace(0.3, -0.2, modes.count), np.cos(np.arange(modes.count))
    place = modes.nodes + np.einsum("i,inc->nc", coordinate, modes.shape)
    moved = elements.scalar_mass @ np.einsum("i,inc->nc", rate, modes.shape)
    np.testing.assert_allclose(modes.neglected_momentum(coordinate, rate), np.cross(place, moved).sum(axis=0), atol=1e-9)
    assert np.abs(modes.twist + modes.twist.transpose(1, 0, 2)).max() < 1e-9

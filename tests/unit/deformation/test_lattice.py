"""Modes as smooth fields over a lattice: what the elements say, within a share of a percent."""

import numpy as np
import pytest

from dilatedem.deformation.elements import Material, assembled, interpolation
from dilatedem.deformation.lattice import lattice_of
from dilatedem.deformation.mesh import meshed
from dilatedem.deformation.modes import Modes, free_modes
from dilatedem.geometry.polyhedron import prism

ICE = Material(1e9, 0.3, 915.0)
FLOE = prism([[-1.4, -1.2], [1.3, -1.3], [1.5, 1.1], [-1.2, 1.4]], -0.25, 0.25)


@pytest.fixture(scope="module")
def modes() -> Modes:
    pytest.importorskip("skfem")
    return free_modes(assembled(meshed(FLOE, 0.25), ICE), 6)


def test_fields_are_those_of_the_elements(modes):
    points = np.random.default_rng(5).uniform([-1.1, -1.1, -0.25], [1.1, 1.1, 0.25], (200, 3))
    between = interpolation(modes.nodes, modes.elements, points)
    expected = np.stack([between @ shape for shape in modes.shape])
    found = lattice_of(modes, 0.125).at(points)
    assert np.abs(found - expected).max() < 1e-2 * np.abs(expected).max()
    assert np.sqrt(((found - expected) ** 2).mean()) < 2e-3 * np.sqrt((expected**2).mean())


def test_fields_that_are_quadratic_are_met_exactly(modes):
    x, y, z = modes.nodes.T
    field = np.stack((x * x - y, y * z, 1.0 + z * z - x * y), axis=-1)
    rest = np.zeros((1, 0, 6)), np.zeros((1, 3, 3)), np.zeros((1, 1, 3))
    quadratic = Modes(modes.nodes, modes.elements, np.ones(1), field[None], *rest)
    lattice = lattice_of(quadratic, 0.5)
    points = np.array([[0.1, -0.2, 0.05], [-1.0, 0.9, -0.2], [1.2, 1.0, 0.25]])
    x, y, z = points.T
    np.testing.assert_allclose(lattice.at(points)[0], np.stack((x * x - y, y * z, 1.0 + z * z - x * y), axis=-1), atol=1e-6)

"""Surfaces of bodies that bend: their integrals, and the rigid motion that fits a bent face best."""

import numpy as np
import pytest

from dilatedem.deformation.elements import EDGES
from dilatedem.deformation.lattice import Lattice, lattice_of
from dilatedem.deformation.mesh import meshed
from dilatedem.deformation.modes import Modes
from dilatedem.deformation.skin import face_motion, skin_of, surface_stress
from dilatedem.deformation.stress import in_plane, tension, von_mises
from dilatedem.geometry.polyhedron import prism

BOX = prism([[-2.0, -1.0], [2.0, -1.0], [2.0, 1.0], [-2.0, 1.0]], -0.25, 0.25)
TALL = prism([[-2.0, -1.0], [2.0, -1.0], [2.0, 1.0], [-2.0, 1.0]], -0.35, 0.35)
DOWN = int(np.argmin(BOX.normals[:, 2]))


def modes_of(*functions, body=BOX) -> Modes:
    """Fields over the elements of the box, each a function of x, y, z to three components."""
    mesh = meshed(body, 0.5)
    nodes, elements = quadratic(mesh)
    shape = np.stack([np.stack(np.broadcast_arrays(*function(*nodes.T)), axis=-1) for function in functions])
    rest = np.zeros((1, 0, 6)), np.zeros((1, 3, 3)), np.zeros((1, 1, 3))
    return Modes(nodes, elements, np.ones(len(functions)), shape, *rest)


def fields(*functions) -> Lattice:
    """The same, quadratic at most, over a lattice."""
    return lattice_of(modes_of(*functions), 0.25)


def quadratic(mesh) -> tuple[np.ndarray, np.ndarray]:
    """Nodes and elements of quadratic tetrahedra, without scikit-fem."""
    ends = np.sort(mesh.tetrahedra[:, np.array(EDGES)], axis=2)
    edges, number = np.unique(ends.reshape(-1, 2), axis=0, return_inverse=True)
    nodes = np.concatenate((mesh.points, mesh.points[edges].mean(axis=1)))
    return nodes, np.concatenate((mesh.tetrahedra, len(mesh.points) + number.reshape(-1, 6)), axis=1)


def test_integrals_over_a_face_are_those_of_its_fields():
    skin = skin_of(TALL, modes_of(lambda x, y, z: (0.0 * x, 0.0, x), lambda x, y, z: (0.0 * x, y, 1.0), body=TALL))
    np.testing.assert_allclose(skin.area, np.abs(TALL.normals) @ [1.4, 2.8, 8.0], atol=1e-12)
    np.testing.assert_allclose(skin.first[DOWN], [[0.0, 0.0, 0.0], [0.0, 0.0, 8.0]], atol=1e-6)
    # outward is down: int x x = 2 (4^3/12), int z = -0.35 x 8
    np.testing.assert_allclose(skin.outward[DOWN], [0.0, -8.0], atol=1e-6)
    np.testing.assert_allclose(skin.moment[DOWN], [[-(4**3) / 6, 0.0, 0.0], [0.0, 0.0, 2.8]], atol=1e-5)
    np.testing.assert_allclose(skin.second[DOWN, [0, 1], [0, 1]], [4**3 / 6, 8.0], atol=1e-5)
    np.testing.assert_allclose(skin.second[DOWN, 0, 1], skin.second[DOWN, 1, 0], atol=1e-12)
    assert len(skin_of(BOX, modes_of(lambda x, y, z: (0.0 * x, 0.0, x))).area) == 2, "sides of a plate are left out"
    for face in range(6):
        rows = slice(skin.start[face], skin.start[face + 1])
        assert np.abs((skin.point[rows] - skin.centre[face]) @ skin.normal[face]).max() < 1e-12


def test_a_face_moves_as_the_rigid_motion_that_fits_it_best():
    loop = BOX.vertices[BOX.faces[DOWN]]
    turn, moved = np.array([0.3, -0.2, 0.5]), np.array([1.0, 2.0, 3.0])

    def rigid(x, y, z):
        return tuple(moved[:, None] + np.cross(turn, np.stack((x, y, z + 0.25), axis=-1)).T)

    centre, found = face_motion(loop, fields(rigid, lambda x, y, z: (0.0 * x, 0.0, x * x)))
    np.testing.assert_allclose(centre, [0.0, 0.0, -0.25], atol=1e-12)
    np.testing.assert_allclose(found[0], [*moved, *turn], atol=1e-5)
    np.testing.assert_allclose(found[1], [0.0, 0.0, 4.0 / 3.0, 0.0, 0.0, 0.0], atol=1e-5)


def test_stress_in_a_plane_is_that_of_the_plane():
    stress, normal = np.array([2.0, -1.0, 5.0, 0.3, 0.2, 1.5]), np.array([0.0, 0.0, -1.0])
    along, across, shear = in_plane(stress, normal)
    half = 0.5 * (along - across)
    principal = 0.5 * (along + across) + np.hypot(half, shear)
    flat = np.array([2.0, -1.0, 0.0, 0.0, 0.0, 1.5])
    assert principal == pytest.approx(float(tension(flat)))
    assert np.sqrt(along**2 - along * across + across**2 + 3.0 * shear**2) == pytest.approx(float(von_mises(flat)))


def test_stress_is_looked_at_on_every_face():
    nodes = np.concatenate((BOX.vertices, [[0.0, 0.0, 0.0]]))
    stress = np.zeros((1, len(nodes), 6))
    stress[0, :, 0] = 1.0
    rest = np.zeros((1, 3, 3)), np.zeros((1, 1, 3))
    modes = Modes(nodes, np.zeros((0, 10), int), np.ones(1), np.zeros((1, len(nodes), 3)), stress, *rest)
    points, found = surface_stress(modes, BOX)
    assert points.shape == (24, 3) and found.shape == (24, 1, 3)
    ends = np.abs(found[:, 0]).max(axis=1) == 0.0
    assert ends.sum() == 8 and np.allclose(np.abs(points[ends, 0]), 2.0), "the ends have none in their own planes"

"""Meshes fill their bodies, with elements of fair shape."""

import numpy as np
import pytest

from dilatedem.deformation.mesh import POOR, Mesh, meshed
from dilatedem.deformation.plan import triangulated
from dilatedem.geometry.polyhedron import convex_hull, prism, volume

SQUARE = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])


def closed(mesh: Mesh, solid) -> None:
    """The triangles that belong to one tetrahedron alone are the surface of the body: all its area, and its volume."""
    a, b, c = (mesh.points[mesh.surface()[:, k]] for k in range(3))
    area = 0.5 * np.cross(b - a, c - a)
    np.testing.assert_allclose(area.sum(axis=0), 0.0, atol=1e-12)
    assert (area * a).sum() / 3.0 == pytest.approx(volume(solid))
    outside = [((a - solid.vertices[face[0]]) @ normal).max() for face, normal in zip(solid.faces, solid.normals, strict=True)]
    assert max(outside) < 1e-12


@pytest.mark.parametrize("size", [0.1, 0.25, 2.0])
def test_triangles_fill_a_polygon(size):
    points, triangles = triangulated(SQUARE, size)
    a, b, c = (points[triangles[:, k]] for k in range(3))
    area = 0.5 * ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])
    assert (area > 0.0).all() and area.sum() == pytest.approx(1.0)
    sides = np.sqrt(((points[triangles] - points[np.roll(triangles, 1, axis=1)]) ** 2).sum(axis=-1))
    assert sides.max() < 1.6 * max(size, 1.0 if size > 1.0 else size)
    assert (area / sides.max(axis=1) ** 2).min() > 0.15  # 0.433 of an equilateral one


def test_a_prism_is_meshed_in_layers_however_it_lies():
    floe = prism([[0.0, 0.0], [2.0, 0.3], [2.5, 1.5], [1.0, 2.4], [-0.4, 1.2]], -0.25, 0.25)
    mesh = meshed(floe, 0.25)
    closed(mesh, floe)
    assert mesh.quality > 0.2 and set(np.round(mesh.points[:, 2], 9)) == {-0.25, 0.0, 0.25}
    turn = np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))[0]
    turned = convex_hull(floe.vertices @ (turn * np.linalg.det(turn)).T)
    closed(meshed(turned, 0.25), turned)


@pytest.mark.parametrize("seed", range(6))
def test_any_other_body_is_meshed_too(seed):
    solid = convex_hull(np.random.default_rng(seed).normal(size=(10, 3)) * [1.0, 1.0, 0.5])
    mesh = meshed(solid, 0.3)
    closed(mesh, solid)
    assert mesh.quality > POOR and len(mesh.tetrahedra) > 100


def test_it_is_the_same_every_time():
    solid = convex_hull(np.random.default_rng(7).normal(size=(10, 3)))
    for body in (solid, prism(SQUARE, 0.0, 1.0)):
        one, other = meshed(body, 0.4), meshed(body, 0.4)
        np.testing.assert_array_equal(one.points, other.points)
        np.testing.assert_array_equal(one.tetrahedra, other.tetrahedra)


def test_what_is_no_solid_has_no_mesh():
    with pytest.raises(ValueError, match="only a solid can deform"):
        meshed(prism(SQUARE, 0.0, 0.0), 0.1)

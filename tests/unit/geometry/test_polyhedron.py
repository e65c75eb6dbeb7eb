"""Convex hulls of every dimension, prisms, and the order of vertices, edges and faces."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from dilatedem.geometry.polyhedron import assemble, centroid, convex_hull, edge_faces, prism, volume

SQUARE = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]])


def is_convex(body):
    """Every vertex lies under every face, on it when it belongs to the loop; loops run counter-clockwise."""
    size = np.ptp(body.vertices, axis=0).max()
    for loop, normal in zip(body.faces, body.normals, strict=True):
        height = (body.vertices - body.vertices[loop[0]]) @ normal
        corner = body.vertices[loop]
        turn = np.cross(corner - np.roll(corner, 1, axis=0), np.roll(corner, -1, axis=0) - corner) @ normal
        if height.max() > 1e-7 * size or np.abs(height[loop]).max() > 1e-7 * size or turn.min() <= 0.0:
            return False
    return True


def test_point():
    point = convex_hull([[1.0, 2.0, 3.0], [1.0, 2.0, 3.0]])
    assert (point.dimension, len(point.vertices), len(point.edges), len(point.faces)) == (0, 1, 0, 0)
    assert point.normals.shape == (0, 3)


def test_segment_keeps_its_ends():
    segment = convex_hull([[0.5, 0.5, 0.5], [0.0, 0.0, 0.0], [1.0, 1.0, 1.0], [0.2, 0.2, 0.2]])
    assert (segment.dimension, segment.edges.tolist(), segment.faces) == (1, [[0, 1]], ())
    assert segment.vertices.tolist() == [[0.0, 0.0, 0.0], [1.0, 1.0, 1.0]]


def test_flat_polygon_has_two_faces():
    turn = Rotation.from_rotvec([0.4, 0.9, -0.3]).as_matrix()
    points = (
        np.array([[0, 0, 0], [1, 0, 0], [2, 0, 0], [2, 2, 0], [1, 1, 0], [0, 2, 0], [0, 1, 0]], float)
        @ turn.T
    )
    plate = convex_hull(points)
    assert (plate.dimension, len(plate.vertices), len(plate.edges), len(plate.faces)) == (2, 4, 4, 2)
    assert plate.faces[0].tolist() == plate.faces[1][::-1].tolist()
    assert plate.normals[0] == pytest.approx(-plate.normals[1])
    assert volume(plate) == 0.0
    assert is_convex(plate)


def test_points_on_faces_and_edges_are_dropped():
    turn = Rotation.from_rotvec([-1.0, 0.2, 0.5]).as_matrix()
    grid = np.stack(np.meshgrid(*3 * [np.linspace(0.0, 2.0, 5)]), axis=-1).reshape(-1, 3)
    cube = convex_hull(grid @ turn.T + 30.0)
    assert (cube.dimension, len(cube.vertices), len(cube.edges), len(cube.faces)) == (3, 8, 12, 6)
    assert volume(cube) == pytest.approx(8.0, rel=1e-12)
    assert centroid(cube) == pytest.approx(turn @ np.ones(3) + 30.0)
    assert is_convex(cube)


@pytest.mark.parametrize("count", [4, 7, 30, 200])
def test_random_hulls_are_closed_and_convex(count):
    hull = convex_hull(np.random.default_rng(count).normal(size=(count, 3)) * [3.0, 1.0, 0.1])
    assert len(hull.vertices) - len(hull.edges) + len(hull.faces) == 2
    assert is_convex(hull)
    assert (hull.edges[:, 0] < hull.edges[:, 1]).all()


def test_slivers_and_near_flat_sets():
    needle = convex_hull([[0, 0, 0], [3, 0, 0], [3, 1e-5, 0], [1.5, 0, 1e-5]])
    assert needle.dimension == 3
    assert is_convex(needle)
    noise = 1e-10 * np.random.default_rng(0).normal(size=(40, 3))
    ring = np.linspace(0.0, 2.0 * np.pi, 40, endpoint=False)
    plate = convex_hull(np.column_stack((np.cos(ring), np.sin(ring), 0 * ring)) + noise)
    assert plate.dimension == 2
    assert len(plate.vertices) == 40
    block = np.vstack([np.column_stack((SQUARE, np.full(4, z))) for z in (0.0, 1.0)])
    assert len(convex_hull(np.vstack([block, block + 1e-10])).faces) == 6


def test_prism_order():
    block = prism(SQUARE, -1.0, 0.5)
    assert block.vertices[:4, :2].tolist() == block.vertices[4:, :2].tolist() == SQUARE.tolist()
    assert (block.vertices[:4, 2] == -1.0).all() and (block.vertices[4:, 2] == 0.5).all()
    expected = [[0, 0, -1], [0, 0, 1], [0, -1, 0], [1, 0, 0], [0, 1, 0], [-1, 0, 0]]
    assert block.normals.tolist() == expected
    assert volume(block) == pytest.approx(6.0)
    assert is_convex(block)


def test_prism_without_height_is_a_plate():
    for top in (0.21, 0.21 + 1e-17, 0.21 - 1e-12):
        assert prism(SQUARE, 0.21, top).dimension == 2
    with pytest.raises(ValueError, match="below its bottom"):
        prism(SQUARE, 0.21, 0.2)


def test_edge_faces_run_both_ways():
    body = convex_hull(np.random.default_rng(1).normal(size=(12, 3)))
    for (start, end), beside in zip(body.edges, edge_faces(body), strict=True):
        for face, (first, second) in zip(beside, ((start, end), (end, start)), strict=True):
            loop = body.faces[face].tolist()
            assert loop[(loop.index(first) + 1) % len(loop)] == second
    assert edge_faces(convex_hull([[0, 0, 0], [1, 0, 0]])).tolist() == [[-1, -1]]


def test_moved_and_scaled():
    block = prism(SQUARE, 0.0, 1.0).translated([1.0, 2.0, 3.0])
    assert centroid(block) == pytest.approx([2.0, 3.0, 3.5])
    assert volume(block.scaled(0.5)) == pytest.approx(0.5)


@pytest.mark.parametrize(
    ("points", "message"),
    [
        ([], "shape"),
        ([[1.0, 2.0]], "shape"),
        ([[0.0, 0.0, np.nan]], "not finite"),
        ([[0.0, 0.0, np.inf]], "not finite"),
    ],
)
def test_unusable_points_are_refused(points, message):
    with pytest.raises(ValueError, match=message):
        convex_hull(points)


def test_open_surface_is_refused():
    block = prism(SQUARE, 0.0, 1.0)
    with pytest.raises(ValueError, match="do not close"):
        assemble(block.vertices, block.faces[:-1])

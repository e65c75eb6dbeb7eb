"""The contact patch: mode, point of application and size, against plane geometry by `shapely`.

A face reaches RIM times the reach of the smaller body beyond its sides, so that a patch is exact to a rim of that width.
"""

import numpy as np
import pytest
import shapely
from scipy.spatial.transform import Rotation

from dilatedem.contact.liu2015.patch import RIM
from dilatedem.contact.support import PARALLEL
from dilatedem.geometry.polyhedron import convex_hull, prism
from dilatedem.state.modes import Mode
from tests.pair_in_place import PairInPlace
from tests.reference.cores import box, cores, polygon

CORES = cores()
RADIUS = 0.04
#: rotation vector that stands a cube on its corner, and one that stands it on an edge along x
ON_CORNER = Rotation.from_rotvec([0.675510858856181, -0.675510858856181, 0.0])
ON_EDGE = Rotation.from_rotvec([np.pi / 4, 0.0, 0.0])


def penetrating_polygon(pair: PairInPlace, normal: np.ndarray, across: np.ndarray, face_a, face_b):
    """Part of two near-parallel faces that overlaps once both are dilated, in the plane of `across` (2, 3), as a shapely
    polygon, and the height of both dilated surfaces over that plane as functions of the place."""

    def plan(body, face):
        return pair.vertices(body)[face] @ across.T

    def height(body, face, rise):
        corners = pair.vertices(body)[face]
        inside = np.column_stack((corners @ across.T, np.ones(len(corners))))
        return np.linalg.lstsq(inside, corners @ normal + rise, rcond=None)[0]

    low, high = height(0, face_a, pair.shapes.radius[0]), height(1, face_b, -pair.shapes.radius[1])
    common = shapely.Polygon(plan(0, face_a)).intersection(shapely.Polygon(plan(1, face_b)))
    # half plane where the lower surface reaches above the upper one
    slope, level = (low - high)[:2], (low - high)[2]
    steepness = np.linalg.norm(slope)
    if steepness > 1e-9:  # else the gap is the same all over
        away, side = slope / steepness, np.array([-slope[1], slope[0]]) / steepness
        foot, far = -level / steepness * away, 100.0 + 2.0 * abs(level) / steepness
        ends = [foot - far * side, foot + far * side]
        half = shapely.Polygon([*ends, ends[1] + far * away, ends[0] + far * away])
        common = common.intersection(half)
    return common, lambda point: float((low - high) @ [*point, 1.0])


@pytest.mark.parametrize("seed", range(40))
def test_face_on_face(seed):
    # a floe on another, turned, shifted and tilted by less than what counts as parallel
    rng = np.random.default_rng(seed)
    cores_here = [prism(polygon(rng.integers(3, 9), 2.5, 10 * seed + i), -0.21, 0.21) for i in range(2)]
    pair = PairInPlace(*cores_here, radii=(0.04, 0.06))
    frame = Rotation.random(random_state=rng)
    tilt = rng.normal(size=2)
    tilt *= rng.uniform(0.0, 0.45 * PARALLEL) / np.linalg.norm(tilt) if seed % 4 else 0.0
    turn = frame * Rotation.from_rotvec([*tilt, 0.0]) * Rotation.from_rotvec([0.0, 0.0, rng.uniform(-3, 3)])
    sink = rng.uniform(0.001, 0.02)
    pair.place(0, [3.0, -4.0, 0.5], frame)
    shift = np.array([*rng.uniform(-0.6, 0.6, 2), 0.0])
    # the lowest corner of the upper face as deep as `sink`
    drop = (turn.apply(pair.cores[1].vertices) @ frame.apply([0, 0, 1])).min()
    pair.place(1, pair.bodies.position[0] + frame.apply(shift + [0.0, 0.0, 0.21 + 0.10 - sink - drop]), turn)
    found = pair.patch()
    if found is None:
        pytest.skip("the lowest corner hangs beside the other floe")
    normal = pair.pairs.normal[0].copy()
    across = np.linalg.svd(normal[None])[2][1:]
    expected, overlap_at = penetrating_polygon(pair, normal, across, pair.cores[0].faces[1], pair.cores[1].faces[0])
    if found.mode != Mode.FACE_FACE:
        assert expected.area < 0.1 * np.sqrt(expected.area)
        return
    rim = 1.5 * RIM * pair.shapes.reach.min() * expected.length  # a face's rim along both axes
    assert expected.area - 1e-9 <= found.size <= expected.area + rim
    centre = np.array(expected.centroid.coords[0])
    assert found.point @ across.T == pytest.approx(centre, abs=rim / np.sqrt(expected.area))
    # the overlap is that at the point, to round-off
    assert found.overlap == pytest.approx(overlap_at(found.point @ across.T), abs=1e-9)


def test_face_on_face_is_met_often_enough():
    def mode(tilt):
        pair = PairInPlace(CORES["box"], CORES["box"])
        pair.place(1, [0.3, 0.2, 0.42 + 0.06], Rotation.from_rotvec([tilt, 0.0, 0.2]))
        return pair.patch().mode

    assert mode(0.0) == mode(0.01) == Mode.FACE_FACE
    # the deepest edge then runs over the other's top and out of it
    assert mode(0.2) != Mode.FACE_FACE


@pytest.mark.parametrize("tilt", [0.0, 1e-9, 1e-4, 0.01, 0.015])
@pytest.mark.parametrize("shift", [0.0, 0.4, -0.4])
def test_edge_on_face(tilt, shift):
    # an edge of 0.5 m along x on the top of a cube of 0.5 m
    pair = PairInPlace(box(0.5, 0.5, 0.5), box(0.5, 0.5, 0.5))
    turn = Rotation.from_rotvec([0.0, tilt, 0.0]) * ON_EDGE
    drop = (turn.apply(pair.cores[1].vertices))[:, 2].min()
    pair.place(1, [shift, 0.0, 0.25 + 0.08 - 0.003 - drop], turn)
    found = pair.patch()
    # ends of the deepest edge; where it has sunk below the surface of the cube's dilated top, and is over the top
    ends = pair.vertices(1)[np.argsort(np.abs(pair.vertices(1)[:, 1]) + pair.vertices(1)[:, 2])[:2]]
    ends = ends[np.argsort(ends[:, 0])]
    along = np.linspace(0.0, 1.0, 200001)
    points = ends[0] + along[:, None] * (ends[1] - ends[0])
    # heights are measured along the contact's normal, square to the top but for `tilt`
    sunk = (points[:, 2] - 0.04 < 0.25 + 0.04) & (np.abs(points[:, 0]) <= 0.25)
    length = sunk.mean() * np.linalg.norm(ends[1] - ends[0])
    if not sunk.any():
        assert found is None
        return
    assert found.mode == Mode.EDGE_FACE
    assert found.size == pytest.approx(length, abs=2e-3 * tilt + 1e-4)
    assert found.point[0] == pytest.approx(points[sunk][:, 0].mean(), abs=1e-3 * (tilt > 0) + 1e-4)
    assert abs(found.point[1]) < 1e-9


@pytest.mark.parametrize("shift", [0.0, 0.2, -0.45])
def test_edge_along_edge(shift):
    pair = PairInPlace(box(0.5, 0.5, 0.5), box(0.5, 0.5, 0.5))
    pair.place(0, np.zeros(3), ON_EDGE)
    pair.place(1, [shift, 0.0, 2 * 0.25 * np.sqrt(2) + 0.08 - 1e-4], ON_EDGE)
    found = pair.patch()
    assert (found.mode, found.size) == (Mode.EDGE_PARALLEL, pytest.approx(0.5 - abs(shift), rel=1e-9))
    assert found.point == pytest.approx([0.5 * shift, 0.0, 0.25 * np.sqrt(2) + 0.04 - 5e-5], abs=1e-9)


@pytest.mark.parametrize(
    ("core_b", "height", "turn_a", "turn_b", "mode"),
    [
        (box(0.5, 0.5, 0.5), 2 * 0.25 * np.sqrt(3), ON_CORNER, ON_CORNER, Mode.VERTEX_VERTEX),
        (box(0.5, 0.5, 0.5), 0.25 + 0.25 * np.sqrt(3), None, ON_CORNER, Mode.VERTEX_FACE),
        (box(0.5, 0.5, 0.5), 0.25 * (np.sqrt(2) + np.sqrt(3)), ON_EDGE, ON_CORNER, Mode.VERTEX_EDGE),
        (box(0.5, 0.5, 0.5), 2 * 0.25 * np.sqrt(2), ON_EDGE, Rotation.from_rotvec([0, np.pi / 4, 0]), Mode.EDGE_CROSSING),
        (convex_hull([[0.0, 0.0, 0.0]]), 0.25, None, None, Mode.VERTEX_FACE),
        (convex_hull([[0.0, 0.0, 0.0]]), 0.25 * np.sqrt(2), ON_EDGE, None, Mode.VERTEX_EDGE),
        (convex_hull([[0.0, 0.0, 0.0]]), 0.25 * np.sqrt(3), ON_CORNER, None, Mode.VERTEX_VERTEX),
        (convex_hull([[-0.2, 0.0, 0.0], [0.2, 0.0, 0.0]]), 0.25, None, None, Mode.EDGE_FACE),
        (convex_hull([[-0.2, 0.0, 0.0], [0.2, 0.0, 0.0]]), 0.25 * np.sqrt(2), ON_EDGE, None, Mode.EDGE_PARALLEL),
        (convex_hull([[0.0, -0.2, 0.0], [0.0, 0.2, 0.0]]), 0.25 * np.sqrt(2), ON_EDGE, None, Mode.EDGE_CROSSING),
        (prism([[-0.2, -0.2], [0.2, -0.2], [0.0, 0.2]], 0.0, 0.0), 0.25, None, None, Mode.FACE_FACE),
    ],
)
def test_modes_of_what_stands_on_a_cube(core_b, height, turn_a, turn_b, mode):
    for swapped in (False, True):
        cube = box(0.5, 0.5, 0.5)
        pair = PairInPlace(core_b, cube) if swapped else PairInPlace(cube, core_b)
        below, above = (1, 0) if swapped else (0, 1)
        pair.place(below, np.zeros(3), turn_a)
        pair.place(above, [0.0, 0.0, height + 0.08 - 1e-4], turn_b)
        found = pair.patch()
        assert found.mode == mode
        assert found.overlap == pytest.approx(1e-4, rel=1e-6)
        assert pair.closest().normal == pytest.approx([0.0, 0.0, -1.0 if swapped else 1.0], abs=1e-9)


@pytest.mark.parametrize("angle", [2.0, 10.0, 45.0, 90.0])
def test_crossing_edges_meet_at_the_crossing(angle):
    pair = PairInPlace(CORES["capsule"], CORES["capsule"], radii=(0.1, 0.1))
    pair.place(1, [0.1, 0.0, 0.2 - 1e-4], Rotation.from_rotvec([0.0, 0.0, np.radians(angle)]))
    found = pair.patch()
    assert found.mode == Mode.EDGE_CROSSING
    assert found.point == pytest.approx([0.1, 0.0, 0.1 - 5e-5], abs=1e-9)


@pytest.mark.parametrize("shift", [(0.0, 0.0), (1.0, 0.0), (0.0, 0.03), (1.3, 0.1), (0.0, 0.42 - 0.05)])
def test_level_floes_side_by_side(shift):
    # the faces that meet are upright, their tops and bottoms level or nearly so
    pair = PairInPlace(CORES["box"], CORES["box"])
    pair.place(1, [2.72 + 0.08 - 1e-4, *shift])
    found, rim = pair.patch(), RIM * pair.shapes.reach.min()
    assert found.mode == Mode.FACE_FACE
    assert found.size == pytest.approx((2.72 - shift[0]) * (0.42 - shift[1]), abs=2 * rim * 2.72)
    assert found.point == pytest.approx([1.4 - 5e-5, 0.5 * shift[0], 0.5 * shift[1]], abs=rim)


def test_level_floes_corner_on_corner():
    # two upright edges of 0.42 m
    pair = PairInPlace(CORES["box"], CORES["box"])
    side = 2.72 + (0.08 - 1e-4) / np.sqrt(2)
    pair.place(1, [side, side, 0.0])
    found = pair.patch()
    assert found.mode == Mode.EDGE_PARALLEL
    assert found.size == pytest.approx(0.42, rel=1e-9)
    assert found.point == pytest.approx([1.36 + 0.5 * (side - 2.72), 1.36 + 0.5 * (side - 2.72), 0.0], abs=1e-9)


def test_sliver_of_a_face_is_an_edge():
    # level, but one floe raised until only 1 mm of both sides faces each other
    pair = PairInPlace(CORES["box"], CORES["box"])
    pair.place(1, [2.72 + 0.08 - 1e-4, 0.0, 0.419])
    found = pair.patch()
    assert found.mode in (Mode.EDGE_PARALLEL, Mode.EDGE_FACE)
    assert found.size == pytest.approx(2.72, rel=1e-3)


@pytest.mark.parametrize(
    ("kind", "start", "direction", "turn"),
    [
        ("box", [2.72, 0.3, 0.05], [-1.0, 0.0, 0.0], [0.0, 0.0, 0.0]),
        ("floe", [2.63, 0.3, 0.0], [-1.0, 0.0, 0.0], [0.02, -0.01, 0.6]),
        ("box", [0.3, 0.2, 0.48], [0.0, 0.0, -1.0], [0.02, -0.01, 0.6]),
        ("capsule", [0.1, 0.2, 0.25], [0.0, 0.0, -1.0], [0.02, -0.01, 0.6]),
    ],
)
def test_patch_goes_on_where_cores_meet(kind, start, direction, turn):
    # the distance of cores hands over to their penetration at 0: mode, overlap, place and size know nothing of it
    pair = PairInPlace(CORES["box"], CORES[kind])
    step, before, distances = 1e-4, None, []
    for i in range(1500):
        pair.place(1, np.array(start) + i * step * np.array(direction), Rotation.from_rotvec(turn))
        distances.append(pair.closest().distance)
        if abs(distances[-1]) > 0.02:
            continue
        found = pair.patch()
        if before is not None:
            assert found.mode == before.mode
            # at the centroid of a patch that still grows it rises more slowly than at the deepest point
            assert 0.0 < found.overlap - before.overlap < 1.1 * step
            assert found.point == pytest.approx(before.point, abs=20 * step)
            assert found.size == pytest.approx(before.size, rel=0.01)
        before = found
    assert max(distances) > -0.001 and min(distances) < -0.02 and before is not None

"""The cap of a core: the distance from it, what lies beyond its border, and which face it is."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from dilatedem.contact.consistent.cap import CORNER, INTERIOR, SIDE
from dilatedem.geometry.polyhedron import convex_hull, prism
from tests.kernels import around_cap, face_towards, workspace_of
from tests.pair_in_place import PairInPlace
from tests.reference.cores import box, polygon

UP = np.array([0.0, 0.0, 1.0])
SQUARE = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]])
WIDTH = 0.008


def distance_to(corners: np.ndarray, x: np.ndarray) -> float:
    """Distance of a point from a convex polygon (counter-clockwise in z = 0), a segment or a vertex: all sides, one by one."""
    if len(corners) == 1:
        return float(np.linalg.norm(x - corners[0]))
    ends = np.roll(corners, -1, axis=0)
    e, d = ends - corners, x - corners
    if len(corners) > 2 and (np.cross(e, d)[:, 2] >= 0.0).all():
        return float(abs(x[2]))
    t = np.clip((d * e).sum(axis=1) / (e * e).sum(axis=1), 0.0, 1.0)
    return float(np.linalg.norm(d - t[:, None] * e, axis=1).min())


def around(corners, x, turn=None, shift=0.0):
    """Region, its number, vector from the cap, overhangs and their gradients, in a frame that is turned and moved before."""
    turn = turn or Rotation.identity()
    placed, point = turn.apply(corners) + shift, turn.apply(x) + shift
    region, place, w, (side, out, side_gradient, out_gradient) = around_cap(
        workspace_of(placed), len(corners), tuple(turn.apply(UP)), tuple(point), WIDTH
    )
    back = turn.inv()
    return region, place, back.apply(w), side, out, back.apply(side_gradient), back.apply(out_gradient)


def somewhere(corners, rng) -> np.ndarray:
    """A point over a cap or beside it, every other one over it."""
    if rng.random() < 0.5:
        return np.append(rng.uniform(-1.5, 1.5, 2), rng.uniform(0.001, 0.1))
    return rng.dirichlet(np.full(len(corners), 0.5)) @ corners + [0.0, 0.0, rng.uniform(0.001, 0.1)]


def caps() -> dict[str, np.ndarray]:
    flat = {n: np.column_stack((polygon(n, 2.0, 10 + n), np.zeros(n))) for n in (3, 4, 7, 40)}
    needle = np.array([[-1.0, 0.0, 0.0], [1.0, -0.01, 0.0], [1.0, 0.01, 0.0]])
    return {f"{n} corners": c for n, c in flat.items()} | {
        "needle": needle, "segment": SQUARE[:2], "vertex": SQUARE[:1]
    }  # fmt: skip


@pytest.mark.parametrize("name", caps())
def test_nearest_is_the_distance_of_a_slow_search(name):
    corners, rng, met = caps()[name], np.random.default_rng(3), set()
    for _ in range(300):
        x = somewhere(corners, rng)
        region, place, w, side, out, *_ = around(corners, x, Rotation.random(rng=rng), rng.uniform(-9, 9, 3))
        met.add(region)
        assert np.linalg.norm(w) == pytest.approx(distance_to(corners, x), abs=1e-13)
        assert distance_to(corners, x - w) < 1e-12  # the foot is on the cap
        foot = x - w
        if region == CORNER:
            assert foot == pytest.approx(corners[place], abs=1e-12)
        elif region == SIDE:
            e = np.roll(corners, -1, axis=0)[place] - corners[place]
            assert np.cross(foot - corners[place], e) == pytest.approx(np.zeros(3), abs=1e-12)
            assert abs(w @ e) < 1e-12
        if len(corners) > 2:
            assert (side == 0.0) == (region == INTERIOR)
            assert (out > 0.0) == (region == CORNER)
            assert side == pytest.approx(distance_to(corners, x * [1.0, 1.0, 0.0]), abs=1e-12)
    assert met == ({CORNER} if len(corners) == 1 else {SIDE, CORNER} if len(corners) == 2 else {INTERIOR, SIDE, CORNER})


@pytest.mark.parametrize("name", caps())
def test_overhangs_have_the_gradients_they_say(name):
    corners, rng, step, checked = caps()[name], np.random.default_rng(4), 1e-7, 0
    for _ in range(200):
        x = somewhere(corners, rng)
        region, place, _, _, _, side_gradient, out_gradient = around(corners, x)
        ends = [[around(corners, x + s * step * axis) for s in (-1, 1)] for axis in np.eye(3)]
        if any(end[:2] != (region, place) for pair in ends for end in pair):
            continue  # a border between two regions in reach of the differences
        side = [(high[3] - low[3]) / (2 * step) for low, high in ends]
        out = [(high[4] - low[4]) / (2 * step) for low, high in ends]
        assert side == pytest.approx(side_gradient, abs=2e-6)
        assert out == pytest.approx(out_gradient, abs=2e-6)
        checked += 1
    assert checked > 150


@pytest.mark.parametrize("name", ["3 corners", "4 corners", "7 corners", "segment"])
def test_overhangs_do_not_jump_between_regions(name):
    # along lines through many regions; a jump of either measure would be a jump of the energy
    corners, rng = caps()[name], np.random.default_rng(5)
    crossed, jumps = 0, []
    for _ in range(40):
        a, b = np.append(rng.uniform(-1.5, 1.5, 2), 0.05), np.append(rng.uniform(-1.5, 1.5, 2), 0.08)
        seen = [around(corners, a + t * (b - a)) for t in np.linspace(0.0, 1.0, 101)]
        for i in range(100):
            low, high, one, two = i / 100, (i + 1) / 100, seen[i], seen[i + 1]
            if one[:2] == two[:2]:
                continue
            while high - low > 1e-12:
                middle = 0.5 * (low + high)
                here = around(corners, a + middle * (b - a))
                low, high, one, two = (middle, high, here, two) if here[:2] == one[:2] else (low, middle, one, here)
            crossed += 1
            jumps.append((abs(two[3] - one[3]), abs(two[4] - one[4]), np.linalg.norm(two[2] - one[2])))
    assert crossed > 20
    # beyond the end of a segment the measure along it begins at 0, across it stays what stands for far
    assert np.max(jumps, axis=0) == pytest.approx(np.zeros(3), abs=1e-9)


@pytest.mark.parametrize("height", [0.0, 0.05])
def test_ties_fall_to_the_lower_feature_of_the_pair(height):
    # on the border itself the face goes before the side, the side before the corner
    assert around(SQUARE, np.array([0.5, 0.0, height]))[0] == INTERIOR
    assert around(SQUARE, np.array([0.0, 0.0, height]))[0] == INTERIOR
    # level with the corner: beside the side there is nothing of the corner yet
    region, place, w, side, out, *_ = around(SQUARE, np.array([1.0, -0.02, height]))
    assert (region, place) in ((CORNER, 1), (SIDE, 0))
    assert w == pytest.approx([0.0, -0.02, height], abs=1e-15)
    assert (side, out) == (pytest.approx(0.02), 0.0)
    region, place, w, *_ = around(SQUARE, np.array([1.0 - 1e-9, -0.02, height]))
    assert (region, place) == (SIDE, 0)
    region, place, w, *_ = around(SQUARE, np.array([1.0 + 1e-5, -0.02, height]))
    assert (region, place) == (CORNER, 1)


def test_round_off_at_a_tie_moves_nothing():
    # the same point in many frames falls into either region: foot and measures agree
    rng = np.random.default_rng(6)
    for x in ([1.0, -0.02, 0.05], [0.5, 0.0, 0.05], [0.0, 0.0, 0.05]):
        regions = set()
        for _ in range(50):
            region, _, w, side, out, *_ = around(SQUARE, np.array(x), Rotation.random(rng=rng), rng.uniform(-9, 9, 3))
            regions.add(region)
            assert w == pytest.approx([0.0, min(x[1], 0.0), 0.05], abs=1e-13)
            assert side == pytest.approx(max(-x[1], 0.0), abs=1e-13)
            assert out < 1e-13
        assert len(regions) > 1


def facing_of(core, corner, direction, turn=None) -> int:
    """Number of the face that looks along `direction` at a corner, -1 for none; the corner by its place."""
    pair = PairInPlace(core, box(1.0, 1.0, 1.0))
    turn = turn or Rotation.identity()
    vertex, normal = turn.apply(pair.shapes.vertex), turn.apply(pair.shapes.face_normal)
    number = int(np.linalg.norm(core.vertices - corner, axis=1).argmin())
    return face_towards(
        pair.shapes, vertex, normal, 0, np.array([number]), tuple(turn.apply(np.array(direction) / np.linalg.norm(direction)))
    )


CUBE = box(1.0, 1.0, 1.0)


@pytest.mark.parametrize(
    ("direction", "normal"),
    [
        ([0.0, 0.0, 1.0], [0.0, 0.0, 1.0]),
        ([0.1, 0.1, 1.0], [0.0, 0.0, 1.0]),
        ([0.0, 1.0, 0.3], [0.0, 1.0, 0.0]),
        ([1.0, 0.6, 0.5], [1.0, 0.0, 0.0]),
    ],
)
def test_the_flattest_face_at_the_corner_is_the_cap(direction, normal):
    for seed in range(5):
        turn = Rotation.random(rng=np.random.default_rng(seed))
        found = facing_of(CUBE, [0.5, 0.5, 0.5], direction, turn)
        assert CUBE.normals[found] == pytest.approx(normal)


def test_the_flattest_side_belongs_to_the_cap():
    # a corner whose flattest side (along x) is shared by two faces, neither of them flush
    core = convex_hull([[0.0, 0.0, 0.0], [1.0, 0.0, -0.01], [0.2, 0.5, -0.6], [0.2, -0.5, -0.6]])
    found = facing_of(core, [0.0, 0.0, 0.0], [0.0, 0.0, 1.0])
    loop = core.vertices[core.faces[found]]
    assert any(corner == pytest.approx([1.0, 0.0, -0.01]) for corner in loop)


def test_a_sphere_and_a_capsule_have_no_face():
    assert facing_of(convex_hull([[0.0, 0.0, 0.0]]), [0.0, 0.0, 0.0], [0.3, 0.0, 1.0]) == -1
    assert facing_of(convex_hull([[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]]), [1.0, 0.0, 0.0], [0.3, 0.0, 1.0]) == -1


@pytest.mark.parametrize("tilt", [0.0, 1e-15, -1e-15, 1e-6, -1e-6])
def test_a_flat_polygon_met_edge_on_has_a_face(tilt):
    plate = prism(polygon(5, 2.0, 1), 0.0, 0.0)
    assert facing_of(plate, plate.vertices[0], [1.0, 0.2, tilt]) >= 0

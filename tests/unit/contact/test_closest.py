"""Distance and witness points of cores, apart and intersecting, against the programmes of tests/reference and against `coal`."""

import itertools

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tests.pair_in_place import PairInPlace
from tests.reference.closest_points_qp import closest_points, depth
from tests.reference.cores import box, cores

CORES = cores()
KINDS = list(itertools.combinations_with_replacement(CORES, 2))
#: kinds whose differences span no volume in general position: no depth to speak of
FLAT = {("sphere", "sphere"), ("capsule", "capsule"), ("capsule", "sphere"), ("capsule", "pile"), ("sphere", "pile")}
POSES = 12


def poses(pair: PairInPlace, seed: int, spread: float):
    """Put the pair's bodies at random, within `spread` x the size that keeps most apart; nearly flat every other time."""
    rng = np.random.default_rng(seed)
    reach = sum(min(np.linalg.norm(core.vertices, axis=1).max(), 2.0) for core in pair.cores) + 0.1
    for i in range(POSES):
        turns = [Rotation.random(random_state=rng) for _ in range(2)]
        if i % 2:
            # near-parallel features are the normal case on the water
            tilt = rng.normal(size=(2, 2)) * 10.0 ** rng.uniform(-9, -1)
            turns = [Rotation.from_rotvec([*t, s]) for t, s in zip(tilt, rng.uniform(-3, 3, 2), strict=True)]
        direction = rng.normal(size=3) * [1.0, 1.0, 0.2 if i % 2 else 1.0]
        direction /= np.linalg.norm(direction)
        pair.place(0, rng.uniform(-20, 20, 3), turns[0])
        pair.place(1, pair.bodies.position[0] + direction * reach * spread * rng.uniform(0.3, 1.2), turns[1])
        pair.forget()
        yield pair


def hold_optimal(pair: PairInPlace, tolerance: float = 1e-9) -> None:
    """The answer carries its own proof: points of both cores, so far apart, and a plane of each core square to their line."""
    found = pair.closest()
    assert np.linalg.norm(found.normal) == pytest.approx(1.0, abs=1e-12)
    if found.distance >= 0.0:
        assert found.on_b - found.on_a == pytest.approx(found.distance * found.normal, abs=tolerance)
    a, b = (pair.vertices(i) @ found.normal for i in range(2))
    # the normal is exact to 3e-7 rad: at a lever of some metres
    slack = 1e-6 * max(np.ptp(a), np.ptp(b), 1.0) if found.distance > 0.0 else tolerance
    assert b.min() - a.max() == pytest.approx(found.distance, abs=slack)


@pytest.mark.parametrize("kinds", KINDS, ids="-".join)
def test_apart(kinds):
    pair = PairInPlace(*(CORES[kind] for kind in kinds))
    met = 0
    for seen in poses(pair, 11, 1.3):
        expected, _, _ = closest_points(seen.vertices(0), seen.vertices(1))
        if expected < 1e-6:
            continue
        met += 1
        found = seen.closest()
        assert found.distance == pytest.approx(expected, rel=1e-9, abs=1e-9)
        hold_optimal(seen)
        for body, point in ((0, found.on_a), (1, found.on_b)):
            assert closest_points(seen.vertices(body), point[None])[0] < 1e-7
    assert met >= 3


@pytest.mark.parametrize("kinds", [kinds for kinds in KINDS if kinds not in FLAT and "pile" not in kinds], ids="-".join)
def test_intersecting(kinds):
    pair = PairInPlace(*(CORES[kind] for kind in kinds))
    met = 0
    for seen in poses(pair, 12, 0.3):
        if closest_points(seen.vertices(0), seen.vertices(1))[0] > 0.0:
            continue
        met += 1
        assert -seen.closest().distance == pytest.approx(depth(seen.vertices(0), seen.vertices(1)), abs=1e-9)
        hold_optimal(seen)
    assert met >= 1 or set(kinds) <= {"sphere", "capsule", "plate"}


@pytest.mark.parametrize("kinds", [kinds for kinds in KINDS if "pile" not in kinds], ids="-".join)
def test_coal_says_the_same(kinds):
    coal = pytest.importorskip("coal")
    pair = PairInPlace(*(CORES[kind] for kind in kinds))

    def solid(core):
        if len(core.vertices) == 1:
            return coal.Sphere(1e-12)
        if len(core.vertices) == 2:
            return coal.Capsule(1e-12, np.linalg.norm(core.vertices[1] - core.vertices[0]))
        if core.dimension == 2:
            return None
        points = coal.StdVec_Vec3s()
        for point in core.vertices:
            points.append(point)
        return coal.Convex.convexHull(points, False, "Qt")

    def pose(body):
        place = coal.Transform3s()
        turn = pair.rotation(body)
        if len(pair.cores[body].vertices) == 2:
            turn = turn * Rotation.from_rotvec([0.0, np.pi / 2, 0.0])  # coal's capsules stand along z
        place.setRotation(turn.as_matrix())
        place.setTranslation(pair.bodies.position[body])
        return place

    solids = [solid(core) for core in pair.cores]
    if None in solids:
        pytest.skip("coal has no flat polygon")
    request = coal.DistanceRequest()
    request.gjk_tolerance = request.epa_tolerance = 1e-9
    request.gjk_max_iterations = request.epa_max_iterations = 1000
    for spread in (0.4, 1.2):
        for seen in poses(pair, 13, spread):
            result = coal.DistanceResult()
            coal.distance(solids[0], pose(0), solids[1], pose(1), request, result)
            assert seen.closest().distance == pytest.approx(result.min_distance, abs=2e-6)


@pytest.mark.parametrize("gap", [1e-6, 0.079, 1.0])
@pytest.mark.parametrize("shift", [(0.0, 0.0), (1.0, 0.0), (2.72, 0.0), (0.0, 0.42), (2.72, 0.42), (1.0, 0.03)])
def test_aligned_boxes(gap, shift):
    # level with each other, sides exactly parallel: every vertex lies on the edge of some inclusion test
    pair = PairInPlace(CORES["box"], CORES["box"])
    pair.place(1, [2.72 + gap, *shift])
    found = pair.closest()
    assert found.distance == pytest.approx(gap, abs=1e-12)
    assert found.normal == pytest.approx([1.0, 0.0, 0.0], abs=1e-9)


@pytest.mark.parametrize("gap", [1e-6, 0.05, 1.0])
def test_boxes_corner_on_corner(gap):
    pair = PairInPlace(CORES["box"], CORES["box"])
    pair.place(1, [2.72 + gap, 2.72 + gap, 0.0])
    found = pair.closest()
    assert found.distance == pytest.approx(np.sqrt(2) * gap, abs=1e-12)
    assert found.normal == pytest.approx([np.sqrt(0.5), np.sqrt(0.5), 0.0], abs=1e-9)


@pytest.mark.parametrize("angle", [0.0, 1e-12, 1e-9, 1e-6, 1e-3])
def test_nearly_parallel_faces(angle):
    pair = PairInPlace(CORES["box"], CORES["box"])
    pair.place(0, np.zeros(3), Rotation.from_rotvec([0.1, 0.2, 0.3]))
    turn = pair.rotation(0)
    pair.place(1, turn.apply([0.3, 0.2, 0.5]), turn * Rotation.from_rotvec([0.7 * angle, angle, 0.1]))
    expected, _, _ = closest_points(pair.vertices(0), pair.vertices(1))
    assert pair.closest().distance == pytest.approx(expected, abs=1e-10)
    hold_optimal(pair)


def test_long_pile_and_a_floe():
    pair = PairInPlace(CORES["floe"], CORES["pile"], radii=(0.04, 2.0))
    rng = np.random.default_rng(3)
    for _ in range(50):
        pair.place(0, [0.0, 0.0, rng.uniform(-1, 1)], Rotation.from_rotvec([*rng.normal(size=2) * 0.02, rng.uniform(-3, 3)]))
        angle = rng.uniform(-np.pi, np.pi)
        pair.place(1, [3.4 * np.cos(angle), 3.4 * np.sin(angle), 0.0])
        pair.forget()
        plan = pair.vertices(0)[:, :2] - pair.bodies.position[1, :2]
        # a vertical line: the distance is that of the floe's plan from a point
        expected, _, _ = closest_points(np.column_stack((plan, np.zeros(len(plan)))), np.zeros((1, 3)))
        assert pair.closest().distance == pytest.approx(expected, abs=1e-9)
        assert abs(pair.closest().normal[2]) < 1e-9


@pytest.mark.parametrize(
    "kinds", [("box", "box"), ("floe", "box"), ("floe", "pile"), ("sliver", "floe"), ("hull", "capsule")], ids="-".join
)
def test_warm_start_is_cold_start(kinds):
    warm = PairInPlace(*(CORES[kind] for kind in kinds))
    cold = PairInPlace(*(CORES[kind] for kind in kinds))
    rng = np.random.default_rng(5)
    turn, spin = Rotation.from_rotvec([0.01, -0.02, 0.5]), Rotation.from_rotvec([0.002, 0.001, 0.02])
    for step in range(120):
        position = np.array([3.4 - 0.01 * step, 0.4 - 0.005 * step, 0.02]) + 1e-6 * rng.normal(size=3)
        turn = spin * turn
        for pair in (warm, cold):
            pair.place(1, position, turn if kinds[1] != "pile" else None)
        cold.forget()
        cold.pairs.normal[:] = warm.pairs.normal  # the memory of intersecting cores is part of the answer, not of the search
        w, c = warm.closest(), cold.closest()
        assert w.distance == pytest.approx(c.distance, abs=1e-11)
        assert w.normal == pytest.approx(c.normal, abs=2e-6)


def paths():
    """Slides of one body into another until the cores are deep in each other: bodies, start and direction of b, its rotation."""
    flat, tilted = Rotation.identity(), Rotation.from_rotvec([0.02, -0.01, 0.6])
    yield pytest.param("box", [2.9, 0.0, 0.0], [-1.0, 0.0, 0.0], flat, id="face on face")
    yield pytest.param("box", [2.9, 1.3, 0.1], [-1.0, 0.0, 0.0], flat, id="offset")
    yield pytest.param("box", [3.1, 0.2, 0.05], [-1.0, 0.1, 0.0], tilted, id="tilted")
    yield pytest.param("floe", [2.9, 0.3, 0.0], [-1.0, 0.0, 0.0], tilted, id="corner on face")
    yield pytest.param("box", [0.3, 0.2, 0.6], [0.0, 0.0, -1.0], tilted, id="from above")
    yield pytest.param("capsule", [0.1, 0.2, 0.6], [0.0, 0.0, -1.0], tilted, id="capsule")
    yield pytest.param("sphere", [1.6, 0.2, 0.05], [-1.0, 0.0, 0.0], flat, id="sphere")


@pytest.mark.parametrize(("kind", "start", "direction", "turn"), list(paths()))
def test_deep_overlap_is_continuous(kind, start, direction, turn):
    pair = PairInPlace(CORES["box"], CORES[kind])
    step, before = 1e-4, None
    deepest = 0.0
    for i in range(6000):
        pair.place(1, np.array(start) + i * step * np.array(direction), turn)
        found = pair.closest()
        if before is not None:
            # a depth never changes faster than the way that is gone
            assert abs(found.distance - before.distance) <= step * np.linalg.norm(direction) + 1e-9
            assert found.normal @ before.normal > 0.99
        before, deepest = found, min(deepest, found.distance)
        if deepest < -0.12:  # past 2 (r_a + r_b) less the dilations a run would have stopped
            break
    assert deepest < -0.08


def test_box_in_box():
    pair = PairInPlace(box(2.0, 2.0, 2.0), box(0.5, 0.5, 0.5))
    pair.place(1, [0.6, 0.1, 0.05])
    found = pair.closest()
    assert found.distance == pytest.approx(-(1.0 - 0.6 + 0.25))
    assert found.normal == pytest.approx([1.0, 0.0, 0.0])

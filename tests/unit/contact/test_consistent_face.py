"""A face that presses on a face: punches, the clipped patch, and its energy against sums over triangles."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from shapely import Polygon

from dilatedem.contact.consistent.face import BETA, MARGIN
from dilatedem.state.modes import Mode
from tests.kernels import face_on_cap, four_on_four, workspace_of
from tests.pair_in_place import PairInPlace
from tests.reference.cores import box, polygon

UP, REACH = np.array([0.0, 0.0, 1.0]), 0.08
#: by which face b reaches beyond its border, m
BORDER = MARGIN * REACH
#: beta of F = 2 E* beta sqrt(A/pi) overlap by aspect ratio, boundary elements (physics, 4.2)
PUNCHES = {1.0: 1.018, 2.0: 1.045, 5.6: 1.184, 10.0: 1.321}
#: Dunavant's rule of degree 4 on a triangle: barycentric coordinates, weights
_A, _B = 0.445948490915965, 0.091576213509771
POINTS = np.array([np.roll([1 - 2 * s, s, s], i) for s in (_A, _B) for i in range(3)])
WEIGHTS = np.repeat([0.223381589678011, 0.109951743655322], 3)


def rectangle(x: float, y: float) -> np.ndarray:
    return 0.5 * np.array([[-x, -y], [x, -y], [x, y], [-x, y]])


def press(upper, lower, tilt, height, turn=None):
    """Of a polygon (n, 2) seen from above, tilted and lifted by `height` over another: energy, force, moment, area, rims, spread.

    tilt: rotation vector. Force and moment (about the origin) are on the upper one's body.
    """
    turn = turn or Rotation.identity()
    up = Rotation.from_rotvec(tilt).apply(np.column_stack((upper, np.zeros(len(upper))))) + [0.0, 0.0, height]
    normal = Rotation.from_rotvec(tilt).apply(-UP)
    low, deepest = np.column_stack((lower, np.zeros(len(lower)))), REACH - up[:, 2].min()
    scratch = workspace_of(turn.apply(low), turn.apply(up[::-1]))
    found = face_on_cap(scratch, len(upper), tuple(turn.apply(normal)), len(lower), tuple(turn.apply(UP)), REACH, deepest, 1.0)
    back = turn.inv().apply
    rims, larger = np.array(found[5]), np.array(found[6])
    assert (larger >= rims * (1.0 - 1e-12)).all()
    return found[0], back(found[1]), back(found[2]), found[3], found[5], back(np.array(found[4]))


def slow_patch(upper, lower, tilt, height):
    """(energy, area, second moments (2, 2) of the overlap over its integral) from shapely's clipping and sums over triangles."""
    turn = Rotation.from_rotvec(tilt)
    up = turn.apply(np.column_stack((upper, np.zeros(len(upper))))) + [0.0, 0.0, height]
    normal = turn.apply(UP)
    if len(lower):
        lower = Polygon(lower).buffer(BORDER, join_style="mitre", mitre_limit=1e9)
        patch = Polygon(up[:, :2]).intersection(lower)
    else:
        patch = Polygon(up[:, :2])

    def overlap(xy):
        return REACH - (normal @ up[0] - xy @ normal[:2]) / normal[2]

    if np.linalg.norm(normal[:2]) > 1e-12:  # the half plane where the overlap is positive
        down = normal[:2] / np.linalg.norm(normal[:2])
        at = max(-overlap(np.zeros(2)) / (np.linalg.norm(normal[:2]) / normal[2]), -50.0)
        side = np.array([-down[1], down[0]])
        far = [at * down + s * 100.0 * side + t * 100.0 * down for s, t in ((-1, 0), (1, 0), (1, 1), (-1, 1))]
        patch = patch.intersection(Polygon(far))
    corners = np.array(patch.exterior.coords)[:-1]
    sums, places, weights = np.zeros(2), [], []
    for i in range(1, len(corners) - 1):
        triangle = corners[[0, i, i + 1]]
        area = abs(np.linalg.det(triangle[1:] - triangle[0])) / 2.0
        places.append(POINTS @ triangle)
        weights.append(area * WEIGHTS)
    places, weights = np.concatenate(places), np.concatenate(weights)
    d = overlap(places)
    sums = np.array([weights @ d, weights @ d**2])
    centre = (weights * d) @ places / sums[0]
    J = (weights * d * (places - centre).T) @ (places - centre)
    shape = ((0.5 * np.trace(J) / np.sqrt(np.linalg.det(J)) + 1.0) / 2.0) ** 0.25
    area = sums[0] ** 2 / sums[1]
    return BETA * np.sqrt(area / np.pi) * shape * sums[1] / area, area, J / sums[0]


@pytest.mark.parametrize("ratio", PUNCHES)
@pytest.mark.parametrize("overlap", [1e-5, 1e-3])
def test_flat_punch(ratio, overlap):
    x, y = 0.3 * np.sqrt(ratio), 0.3 / np.sqrt(ratio)
    energy, force, moment, area, rims, spread = press(rectangle(x, y), rectangle(2.0, 2.0), np.zeros(3), REACH - overlap)
    expected = 2.0 * PUNCHES[ratio] * np.sqrt(x * y / np.pi) * overlap
    assert force == pytest.approx([0.0, 0.0, expected], rel=0.05, abs=1e-9 * expected)
    assert energy == pytest.approx(0.5 * force[2] * overlap, rel=1e-9)
    assert moment == pytest.approx(np.zeros(3), abs=1e-12 * force[2])
    assert area == pytest.approx(x * y, rel=1e-12)
    # edges press along the longer side, and at both ends as far as the dilated plane is within their reach
    beyond = np.sqrt(2.0 * REACH * overlap)
    assert rims == pytest.approx((overlap**2 * (x + 2.0 * beyond), x + 2.0 * beyond), rel=1e-9)
    assert spread.T @ spread == pytest.approx(np.diag([x * x, y * y, 0.0]) / 12.0, abs=1e-12)


@pytest.mark.parametrize("shift", [(0.0, 0.0), (0.7, 0.1), (0.93, 0.0), (0.9, 0.8)])
def test_face_on_face_of_a_pair(shift):
    # cubes of 1 m: the patch is where both are, and a little beyond the lower one's border
    pair = PairInPlace(box(1.0, 1.0, 1.0), box(1.0, 1.0, 1.0))
    pair.place(1, [*shift, 1.0 + REACH - 1e-4])
    found, size = pair.press(), 1.0 - np.array(shift)
    assert found.mode == Mode.FACE_FACE
    assert found.size == pytest.approx(size.prod(), abs=1.1 * BORDER * size.sum())
    shape = ((size[0] / size[1] + size[1] / size[0] + 2.0) / 4.0) ** 0.25
    assert found.force[2] == pytest.approx(2.0 * BETA * shape * np.sqrt(found.size / np.pi) * 1e-4, rel=2e-3)
    foot = np.cross(found.force, found.moment) / np.dot(found.force, found.force)
    assert foot[:2] == pytest.approx(0.5 * np.array(shift), abs=2.0 * BORDER)


def cases():
    """Two polygons, a tilt and a height: some 60 patches cut in all ways."""
    rng = np.random.default_rng(11)
    while True:
        upper, lower = (polygon(int(rng.integers(3, 9)), rng.uniform(0.5, 2.0), int(rng.integers(1 << 30))) for _ in range(2))
        upper = upper + rng.normal(size=2) * 0.4
        tilt = np.append(rng.normal(size=2), 0.0) * 10.0 ** rng.uniform(-7.0, -1.5)
        low = Rotation.from_rotvec(tilt).apply(np.column_stack((upper, np.zeros(len(upper)))))[:, 2].min()
        yield upper, lower, tilt, REACH - low - 10.0 ** rng.uniform(-5.0, -2.3)


def test_patch_and_energy_are_those_of_sums_over_triangles():
    rng, found = np.random.default_rng(12), 0
    for upper, lower, tilt, height in cases():
        energy, _, _, area, rims, spread = press(upper, lower, tilt, height, Rotation.random(rng=rng))
        if energy == 0.0:
            continue
        expected, expected_area, moments = slow_patch(upper, lower, tilt, height)
        assert energy == pytest.approx(expected, rel=1e-6)
        assert area == pytest.approx(expected_area, rel=1e-6)
        assert (spread.T @ spread)[:2, :2] == pytest.approx(moments, rel=1e-4, abs=1e-9 * np.trace(moments))
        assert 0.0 < rims[0] < rims[1] * (REACH - height + 10.0 * np.linalg.norm(tilt)) ** 2
        found += 1
        if found == 60:
            break


def test_a_half_space_cuts_nothing():
    for (upper, _, tilt, height), _ in zip(cases(), range(20), strict=False):
        energy, force, _, area, *_ = press(upper, np.zeros((0, 2)), tilt, height)
        expected, expected_area, _ = slow_patch(upper, np.zeros((0, 2)), tilt, height)
        assert (energy, area) == (pytest.approx(expected, rel=1e-6), pytest.approx(expected_area, rel=1e-6))
        assert force[:2] == pytest.approx(np.zeros(2), abs=1e-12 * force[2])


def test_force_and_moment_are_minus_the_gradient():
    # of a rigid motion of the upper face, the border's push among them
    worst = []
    for (upper, lower, tilt, height), _ in zip(cases(), range(100), strict=False):
        energy, force, moment, *_ = press(upper, lower, tilt, height)
        if energy == 0.0:
            continue

        def moved(shift, turn, upper=upper, lower=lower, tilt=tilt, height=height):
            first = Rotation.from_rotvec(tilt)
            up = first.apply(np.column_stack((upper, np.zeros(len(upper))))) + [0.0, 0.0, height]
            second = Rotation.from_rotvec(turn)
            normal = second.apply(first.apply(-UP))
            scratch = workspace_of(np.column_stack((lower, np.zeros(len(lower)))), (second.apply(up) + shift)[::-1])
            return face_on_cap(scratch, len(upper), tuple(normal), len(lower), tuple(UP), REACH, 0.1, 1.0)[0]

        h, zero = 1e-8, np.zeros(3)
        pushed = [(moved(-h * x, zero) - moved(h * x, zero)) / (2 * h) for x in np.eye(3)]
        turned = [(moved(zero, -h * x) - moved(zero, h * x)) / (2 * h) for x in np.eye(3)]
        size = np.linalg.norm(force)
        worst.append(max(np.linalg.norm(pushed - force), np.linalg.norm(turned - moment)) / size)
    assert len(worst) > 50
    assert np.median(worst) < 1e-5
    assert max(worst) < 2e-3


def test_four_corners_on_four_are_the_same_without_loops():
    # rectangles and other quadrilaterals, level and tilted, across each other and cut by one, two and more borders; what the short
    # way cannot tell it leaves
    rng, told, cut, left = np.random.default_rng(14), 0, 0, 0
    for i in range(600):
        caps = [rectangle(*rng.uniform(0.3, 2.0, 2)) if i % 4 else polygon(4, 1.5, int(rng.integers(1 << 30))) for _ in range(2)]
        upper = caps[0] @ Rotation.from_euler("z", rng.choice([0.0, 1e-3, 1.0]) * rng.normal()).as_matrix()[:2, :2].T
        upper = upper + rng.normal(size=2) * rng.choice([0.0, 0.3])
        tilt = np.append(rng.normal(size=2), 0.0) * 10.0 ** rng.uniform(-7.0, -1.5)
        up, low = (np.column_stack((cap, np.zeros(4))) for cap in (upper, caps[1]))
        up = Rotation.from_rotvec(tilt).apply(up)
        overlap, turn = 10.0 ** rng.uniform(-4.0, -2.3), Rotation.random(rng=rng)
        up = up + [0.0, 0.0, REACH - up[:, 2].min() - overlap]
        normals = tuple(turn.apply(Rotation.from_rotvec(tilt).apply(-UP))), tuple(turn.apply(UP))
        scratch = workspace_of(turn.apply(low), turn.apply(up[::-1]))
        short, rims = four_on_four(scratch, *normals, REACH, overlap, 1.0)
        energy, force, moment, area, spread, slow_rims, bounds = face_on_cap(
            scratch, 4, normals[0], 4, normals[1], REACH, overlap, 1.0
        )
        if not short[0]:
            left += 1
            continue
        told += 1
        size = np.linalg.norm(force)
        cut += abs(np.dot(force, normals[1])) < size * (1.0 - 1e-12)
        assert short[1] == pytest.approx(energy, rel=1e-10)
        assert np.array(short[2]) == pytest.approx(np.array(force), abs=1e-10 * size)
        assert np.array(short[3]) == pytest.approx(np.array(moment), abs=1e-10 * size)
        assert (short[4], rims) == (pytest.approx(area, rel=1e-10), pytest.approx(slow_rims, rel=1e-7))
        assert short[6][3:] == pytest.approx(bounds, rel=1e-7)
        # two vectors whose squares are the moments do not depend on the corner that comes first
        assert np.array(short[5]) == pytest.approx(np.array(spread), abs=1e-8)
    assert told > 200 and cut > 100 and left > 50


def test_faces_that_lean_do_not_press():
    # 85 degrees between them, and faces that look the same way
    for angle in (np.radians(85.0), np.pi):
        assert press(rectangle(1.0, 1.0), rectangle(2.0, 2.0), np.array([angle, 0.0, 0.0]), REACH)[0] == 0.0


@pytest.mark.parametrize("height", [REACH, REACH + 1e-9, 1.0])
def test_faces_apart_do_not_press(height):
    assert press(rectangle(1.0, 1.0), rectangle(2.0, 2.0), np.zeros(3), height)[0] == 0.0


def test_the_patch_of_a_floe_ends_where_its_own_border_does():
    # equal faces exactly over each other: the upper one's border cuts, so that nothing pushes sideways in any frame
    rng = np.random.default_rng(13)
    for _ in range(20):
        upper = polygon(6, 2.0, int(rng.integers(1 << 30)))
        found = press(upper, upper, np.zeros(3), REACH - 1e-4, Rotation.random(rng=rng))
        assert found[3] == pytest.approx(Polygon(upper).area, rel=1e-9)
        assert found[1][:2] == pytest.approx(np.zeros(2), abs=1e-12 * found[1][2])


def test_the_margin_of_a_needle_is_no_longer_than_that_of_a_square():
    # a small square beside the tip of a needle of 1 degree, 3 mm beyond it
    needle = np.array([[0.0, 0.0], [-1.0, 0.5 * np.radians(1.0)], [-1.0, -0.5 * np.radians(1.0)]])
    square = rectangle(0.002, 0.002) + [0.004, 0.0]
    assert press(square, needle, np.zeros(3), REACH - 1e-4)[0] == 0.0

"""A vertex that presses on a cap: Hertz's formulas, the elliptic factor, and the energy's own gradient."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from scipy.special import ellipe, ellipk

from dilatedem.contact.consistent.cap import CORNER, INTERIOR, SIDE
from dilatedem.contact.consistent.join import SHARE
from dilatedem.contact.consistent.point import BLEND
from dilatedem.geometry.polyhedron import convex_hull
from tests.kernels import around_cap, hertz_factor, point_on_cap, workspace_of
from tests.pair_in_place import PairInPlace
from tests.reference.cores import box

SQUARE = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]])
UP = (0.0, 0.0, 1.0)
SPHERE, CAPSULE = convex_hull([[0.0, 0.0, 0.0]]), convex_hull([[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]])


def exact_factor(k1: float, k2: float) -> float:
    """F = 4/3 E* factor d^(3/2) of Hertz's elliptic contact, k1 and k2 the sums of the principal curvatures [1/m].

    Johnson (1985), section 4.2: with m = 1 - (b/a)^2, K and E complete elliptic integrals, the ratio of curvatures is
    ((a/b)^2 E - K)/(K - E), d = 3 F K/(2 pi a E*) and k/2 = 3 F (K - E)/(2 pi E* m a^3), k the smaller curvature.
    """
    low, high = sorted((k1, k2))
    if low == high:
        return low**-0.5
    left, right = 1e-14, 1.0 - 1e-14
    for _ in range(200):
        m = 0.5 * (left + right)
        K, E = ellipk(m), ellipe(m)
        if (E / (1.0 - m) - K) / (K - E) < high / low:
            left = m
        else:
            right = m
    return 0.5 * np.pi / K * np.sqrt((K - E) / (0.5 * low * m * K))


def test_the_reference_knows_the_round_contact():
    assert exact_factor(4.0, 4.0 * (1.0 + 1e-6)) == pytest.approx(0.5, rel=1e-5)


@pytest.mark.parametrize("ratio", [1.0, 1.01, 1.3, 2.0, 5.0, 10.0, 30.0, 100.0, 200.0, 300.0, 1000.0])
@pytest.mark.parametrize("curvature", [0.5, 25.0])
def test_elliptic_factor(ratio, curvature):
    k1, k2 = curvature, curvature * ratio
    assert hertz_factor(k1 + k2, k1 * k2)[0] == pytest.approx(exact_factor(k1, k2), rel=1e-4 if ratio <= 300.0 else 1e-3)


@pytest.mark.parametrize("ratio", [1.0, 1.5, 20.0, 300.0])
def test_elliptic_factor_has_the_derivatives_it_says(ratio):
    trace, determinant = 25.0 * (1.0 + ratio), 25.0**2 * ratio
    _, by_trace, by_determinant = hertz_factor(trace, determinant)
    h = 1e-6
    slope = (hertz_factor(trace * (1 + h), determinant)[0] - hertz_factor(trace * (1 - h), determinant)[0]) / (2 * h * trace)
    assert by_trace == pytest.approx(slope, rel=1e-7)
    slope = (hertz_factor(trace, determinant * (1 + h))[0] - hertz_factor(trace, determinant * (1 - h))[0]) / (2 * h * determinant)
    assert by_determinant == pytest.approx(slope, rel=1e-7)
    # a length to the power 1/2
    assert hertz_factor(trace / 4.0, determinant / 16.0)[0] == pytest.approx(2.0 * hertz_factor(trace, determinant)[0], rel=1e-12)


@pytest.mark.parametrize("overlap", [1e-6, 1e-4, 5e-3])
@pytest.mark.parametrize("radius", [0.02, 0.04, 2.0])
def test_vertex_over_a_face_is_hertz(overlap, radius):
    reach = radius + 0.04
    energy, force, across, beyond = point_on_cap((0.4, 0.5, reach - overlap), radius, workspace_of(SQUARE), 4, UP, 0.04, 3.0, SHARE)
    assert energy == pytest.approx(8.0 / 15.0 * 3.0 * np.sqrt(radius) * overlap**2.5, rel=1e-9)
    assert force == pytest.approx((0.0, 0.0, 4.0 / 3.0 * 3.0 * np.sqrt(radius) * overlap**1.5), rel=1e-9)
    assert (across, beyond) == (0.0, 0.0)
    assert point_on_cap((0.4, 0.5, reach + 1e-12), radius, workspace_of(SQUARE), 4, UP, 0.04, 3.0, SHARE)[0] == 0.0


@pytest.mark.parametrize("overlap", [1e-5, 1e-3])
@pytest.mark.parametrize(
    ("core", "radii"),
    [
        ("sphere", (0.04, 0.04)),
        ("sphere", (0.04, 2.0)),
        ("capsule", (0.04, 0.04)),
        ("capsule", (0.04, 0.1)),
        ("capsule", (2.0, 0.04)),
        ("capsule", (0.04, 0.5)),
        ("capsule", (0.04, 2.0)),
        ("face", (0.04, 0.04)),
        ("face", (0.04, 2.0)),
    ],
)
def test_a_sphere_meets_a_pure_point(core, radii, overlap):
    # on a sphere (each of the two vertices has half of the energy's 16th power), along a capsule, on the face of a cube
    ra, rb = radii
    other, place, curvatures = {
        "sphere": (SPHERE, [0.0, 0.0, 0.0], (1 / ra + 1 / rb, 1 / ra + 1 / rb)),
        "capsule": (CAPSULE, [0.2, 0.0, 0.0], (1 / ra, 1 / ra + 1 / rb)),
        "face": (box(1.0, 1.0, 1.0), [0.2, 0.1, 0.5], (1 / ra, 1 / ra)),
    }[core]
    pair = PairInPlace(SPHERE, other, radii=radii)
    pair.place(1, place + np.array([0.0, 0.0, ra + rb - overlap]))
    found = pair.press()
    force = 4.0 / 3.0 * exact_factor(*curvatures) * overlap**1.5
    assert found.force == pytest.approx([0.0, 0.0, force], rel=5e-3, abs=1e-3 * force)
    assert found.energy == pytest.approx(0.4 * force * overlap, rel=5e-3)
    assert found.moment == pytest.approx(np.zeros(3), abs=1e-3 * force * overlap + 1e-12 * force)


@pytest.mark.parametrize("tilt", [20.0, 35.0, 50.0])
def test_the_corner_of_a_floe_on_a_pile_is_hertz(tilt):
    # physics, 9 B: "vertex on the R = 2 pile"; the corner leads by more than its edges could reach
    pair = PairInPlace(box(2.72, 2.72, 0.42), convex_hull([[0.0, 0.0, -20.0], [0.0, 0.0, 20.0]]), radii=(0.04, 2.0))
    pair.place(0, np.zeros(3), Rotation.from_euler("zy", [45.0, tilt], degrees=True))
    pair.place(1, [pair.vertices(0)[:, 0].max() + 2.04 - 1e-4, 0.0, 0.0])
    force = 4.0 / 3.0 * exact_factor(25.0, 25.5) * 1e-6
    assert pair.press().force[0] == pytest.approx(force, rel=0.05)


def places():
    """Points around a square of side 1 within reach of it: (3,), of every region, near its borders too."""
    rng = np.random.default_rng(8)
    for _ in range(400):
        spread = 10.0 ** rng.uniform(-4.0, -0.8)
        foot = np.array([rng.choice([0.0, 1.0, 0.5]), rng.choice([0.0, 1.0, 0.5])]) + spread * rng.normal(size=2)
        yield np.append(foot, rng.uniform(0.0, 0.08))


def test_force_is_minus_the_gradient_of_the_energy():
    scratch, worst, met = workspace_of(SQUARE), [], []
    for x in places():
        region, place, w, _ = around_cap(scratch, 4, UP, tuple(x), BLEND * 0.08)
        overlap = 0.08 - np.linalg.norm(w)
        step = 1e-5 * max(overlap, 0.0)
        if overlap < 1e-5:
            continue
        near = [[tuple(x + s * step * axis) for s in (-1, 1)] for axis in np.eye(3)]
        if any(around_cap(scratch, 4, UP, p, 0.008)[:2] != (region, place) for pair in near for p in pair):
            continue
        energy = [[point_on_cap(p, 0.04, scratch, 4, UP, 0.04, 1.0, SHARE)[0] for p in pair] for pair in near]
        slope = [(low - high) / (2 * step) for low, high in energy]
        force = np.array(point_on_cap(tuple(x), 0.04, scratch, 4, UP, 0.04, 1.0, SHARE)[1])
        worst.append(np.linalg.norm(force - slope) / np.linalg.norm(force))
        met.append(region)
    assert {INTERIOR, SIDE, CORNER} == set(met) and len(met) > 200
    assert max(worst) < 1e-6


def test_energy_and_force_do_not_jump_at_the_border():
    # from over the face past a side and a corner, the vertex at one height
    scratch, step = workspace_of(SQUARE), 1e-9
    for normal, edge in (((1.0, 0.0), (1.0, 0.3)), ((1.0, 1.0), (1.0, 1.0)), ((1.0, -0.2), (1.0, 0.0))):
        way = np.array(normal) / np.linalg.norm(normal)
        for at in np.linspace(-0.02, 0.02, 41):
            low, high = (
                point_on_cap((edge[0] + s * way[0], edge[1] + s * way[1], 0.075), 0.04, scratch, 4, UP, 0.04, 1.0, SHARE)
                for s in (at - step, at + step)
            )
            assert high[0] == pytest.approx(low[0], rel=1e-5)
            assert high[1] == pytest.approx(low[1], rel=1e-5, abs=1e-5 * np.linalg.norm(low[1]))


def test_past_the_border_the_rim_is_as_sharp_as_it_is_round():
    # over a side by more than the blend: both radii curve across it; past a corner: both ways, and half of the 16th power
    scratch, k = workspace_of(SQUARE), 1.0 / 0.04
    over = BLEND * 0.08 * 1.01
    energy, _, across, beyond = point_on_cap((0.5, -over, 0.079), 0.04, scratch, 4, UP, 0.04, 1.0, SHARE)
    overlap = 0.08 - np.hypot(over, 0.079)
    assert (across, beyond) == (1.0, 0.0)
    assert energy == pytest.approx(8 / 15 * exact_factor(k, 2 * k) * overlap**2.5, rel=3e-3)
    # t1 t2/(t1 + t2) of the corner's measure is half of either
    over *= 2.0
    energy, _, across, beyond = point_on_cap((-over, -over, 0.075), 0.04, scratch, 4, UP, 0.04, 1.0, SHARE)
    overlap = 0.08 - np.hypot(np.hypot(over, over), 0.075)
    assert overlap > 0.0 and (across, beyond) == (1.0, 1.0)
    assert energy**16 == pytest.approx(0.5 * (8 / 15 * exact_factor(2 * k, 2 * k) * overlap**2.5) ** 16, rel=0.05)

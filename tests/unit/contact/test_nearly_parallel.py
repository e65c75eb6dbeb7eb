"""Distance of cores whose faces are nearly parallel, against whole numbers.

A side t rad from parallel and L wide comes t L nearer on one end. What a search gains by turning its plane there, some t^2 L, may
be hidden by round-off of the squared distance: it must go on nevertheless.
"""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from dilatedem.geometry.polyhedron import Polyhedron, prism
from tests.kernels import triangle_point
from tests.pair_in_place import PairInPlace
from tests.reference.closest_points_exact import exact_distance

#: error that is allowed, of the bodies' size
ALLOWED = 1e-12
#: error of the normal that is allowed, rad
TURNED = 3e-7
#: rounds that a search may take: one that cycles takes closest.MOST_ROUNDS
MOST = 20
RANGES = [(-9, -6), (-12, -6), (-17, -12)]
PAIRS = 120
STEPS = 2


def outline(corners: int, rng) -> np.ndarray:
    """A convex outline (n, 2) of some metres, regular every other time, whose first side has the outward normal +x."""
    angle = np.arange(corners) * 2 * np.pi / corners
    if rng.random() < 0.5:
        angle = angle + rng.uniform(-0.3, 0.3, corners) * 2 * np.pi / corners
    points = rng.uniform(0.5, 3.0) * np.column_stack((np.cos(angle), np.sin(angle)))
    side = points[1] - points[0]
    normal = np.array([side[1], -side[0]]) / np.linalg.norm(side)
    turned = points @ np.array([[normal[0], -normal[1]], [normal[1], normal[0]]])
    return turned - [turned[0, 0], 0.5 * (turned[0, 1] + turned[1, 1])]


def floes(rng) -> tuple[Polyhedron, Polyhedron]:
    """Two prisms of 3 to 8 sides; the middle of the first one's face x = 0 is the origin, that of the second one's, too."""
    twins = rng.random() < 0.4
    plans = [outline(4, rng)] * 2 if twins else [outline(rng.integers(3, 9), rng) for _ in range(2)]
    heights = [0.5 * rng.uniform(0.2, 1.5)] * 2 if twins else 0.5 * rng.uniform(0.2, 1.5, 2)
    return tuple(prism(plan, -height, height) for plan, height in zip(plans, heights, strict=True))


def some_tilt(rng, least: float, most: float) -> Rotation:
    """About each axis by 10^least to 10^most rad, or, every fourth time, not at all."""
    return Rotation.from_rotvec(10.0 ** rng.uniform(least, most, 3) * rng.choice([-1, 0, 1, 1], 3))


def hold(pair: PairInPlace) -> None:
    a, b = pair.vertices(0), pair.vertices(1)
    size = max(np.ptp(a, axis=0).max(), np.ptp(b, axis=0).max())
    found, (distance, normal) = pair.closest(), exact_distance(a, b)
    assert found.distance == pytest.approx(distance, rel=0.0, abs=ALLOWED * size)
    assert found.normal == pytest.approx(normal, abs=TURNED)
    assert pair.pairs.rounds[0] <= MOST


def hold_in_steps(pair: PairInPlace, rng, turned: Rotation, shift, spin: Rotation, least: float, most: float, along) -> None:
    """Body b is `shift` from a, spun and tilted, all turned; then b moves a little, and the last corners are the start."""
    tilt = Rotation.identity()
    for _ in range(STEPS):
        tilt = some_tilt(rng, least, most) * tilt
        pair.place(0, np.zeros(3), turned)
        pair.place(1, turned.apply(shift), turned * tilt * spin)
        hold(pair)
        shift = shift + 10.0 ** rng.uniform(least, most) * rng.normal(size=3) * along


@pytest.mark.parametrize(("least", "most"), RANGES)
def test_side_by_side(least, most):
    rng = np.random.default_rng(1)
    for _ in range(PAIRS):
        pair = PairInPlace(*floes(rng))
        widths = [np.abs(core.vertices[np.abs(core.vertices[:, 0]) < 1e-9]).max(axis=0) for core in pair.cores]
        # the middles of both sides opposite each other, or only parts of the sides
        shift = rng.choice([0.0, 1.0], 3, p=[0.3, 0.7]) * rng.uniform(-0.9, 0.9, 3) * (widths[0] + widths[1])
        shift[0] = 10.0 ** rng.uniform(-3, -0.5)
        turned = Rotation.random(rng=rng) if rng.random() < 0.7 else Rotation.identity()
        hold_in_steps(pair, rng, turned, shift, Rotation.from_rotvec([0.0, 0.0, np.pi]), least, most, [0.1, 1.0, 1.0])


@pytest.mark.parametrize(("least", "most"), RANGES)
def test_one_above_the_other(least, most):
    rng = np.random.default_rng(3)
    for _ in range(PAIRS):
        pair = PairInPlace(*floes(rng))
        # middle on middle, or somewhere above
        shift = np.array([*rng.choice([0.0, 1.0], 2) * rng.uniform(-1.0, 1.0, 2), 10.0 ** rng.uniform(-3, -0.5)])
        shift[2] += sum(core.vertices[:, 2].max() for core in pair.cores)
        turned = Rotation.random(rng=rng) if rng.random() < 0.7 else Rotation.identity()
        spin = Rotation.from_rotvec([0.0, 0.0, rng.choice([0.0, np.pi / 2, rng.uniform(-3, 3)])])
        hold_in_steps(pair, rng, turned, shift, spin, least, most, [1.0, 1.0, 0.1])


@pytest.mark.parametrize("height", [1e-2, 1e-4, 1e-6, 1e-8])
def test_slivers(height):
    # three corners nearly in line, far to the side of the origin's projection: a normal that is oblique by a hair costs distance
    rng = np.random.default_rng(4)
    for _ in range(200):
        ends = rng.uniform(0.5, 3.0, 2) * [1, -1]
        plan = np.array([[ends[0], 0.0], [ends[1], 0.0], [rng.uniform(-0.4, 0.4), height]]) - [0.0, 0.3 * height]
        corners = Rotation.random(rng=rng).apply(np.column_stack((plan, np.full(3, 10.0 ** rng.uniform(-3, -0.5)))))
        corners = rng.permutation(corners)
        point, *_ = triangle_point(*map(tuple, corners))
        expected, _ = exact_distance(np.zeros((1, 3)), corners)
        assert np.linalg.norm(point) == pytest.approx(expected, rel=0.0, abs=ALLOWED)

"""The nominal area of a contact against closed forms, its derivative by the depth against differences, and that it never jumps."""

from collections.abc import Callable
from math import cos, pi, radians, sin, sqrt, tan

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from dilatedem.geometry.polyhedron import Polyhedron, convex_hull
from tests.pair_in_place import PairInPlace
from tests.reference.cores import box

RADIUS, PILE, HEIGHT = 0.04, 2.0, 0.5
#: core of a floe of 2.8 m x 2.8 m x 0.5 m
FLOE = box(2.72, 2.72, 0.42)
#: its outer side from its centroid, m
SIDE = 1.4
COLUMN = convex_hull([[0.0, 0.0, -200.0], [0.0, 0.0, 200.0]])
CAPSULE = convex_hull([[0.0, 0.0, -1.0], [0.0, 0.0, 1.0]])
POINT = convex_hull([[0.0, 0.0, 0.0]])
#: far larger than what touches it
WALL = box(8.0, 40.0, 40.0)
OVERLAP = 1e-4
#: m: within and beyond the rounding of edges, 0.0117 m of a square corner
DEPTHS = (1e-4, 1.5e-3, 5.8e-3, 0.02)
NONE = Rotation.identity()


def turned(*degrees: float, axes: str = "z") -> Rotation:
    return Rotation.from_euler(axes, degrees, degrees=True)


class Meeting:
    """Body a at the origin, turned, and b beside it along x so that the dilated bodies overlap by OVERLAP."""

    def __init__(self, core_a: Polyhedron, core_b: Polyhedron, radii=(RADIUS, RADIUS), aside: float = 0.0):
        self.pair, self.reach, self.aside = PairInPlace(core_a, core_b, radii), sum(radii), aside

    def area(self, depth: float, turn_a: Rotation = NONE, turn_b: Rotation = NONE) -> tuple[float, float]:
        ahead = turn_a.apply(self.pair.cores[0].vertices)[:, 0].max() - turn_b.apply(self.pair.cores[1].vertices)[:, 0].min()
        self.pair.forget()
        self.pair.place(0, np.zeros(3), turn_a)
        self.pair.place(1, [ahead + self.reach - OVERLAP, self.aside, 0.0], turn_b)
        return self.pair.nominal(depth)[:2]


def wedge(depth: float, half: float) -> float:
    """Half width [m] of an edge rounded by RADIUS between two faces, each at `half` [rad] to the edge's axis of symmetry."""
    rounded = RADIUS * (1.0 - sin(half))
    return sqrt(depth * (2.0 * RADIUS - depth)) if depth < rounded else RADIUS * cos(half) + (depth - rounded) * tan(half)


def lens(depth: float, first: float, second: float) -> float:
    """The circle in which two spheres of these radii [m] cut each other [m2]."""
    apart = first + second - depth
    return pi * (first**2 - ((apart**2 + first**2 - second**2) / (2.0 * apart)) ** 2)


@pytest.mark.parametrize("depth", DEPTHS)
def test_a_flat_side_on_a_pile(depth):
    area, _ = Meeting(FLOE, COLUMN, (RADIUS, PILE)).area(depth)
    assert area == pytest.approx(HEIGHT * 2.0 * sqrt(depth * (2.0 * PILE - depth)), rel=1e-6)


@pytest.mark.parametrize("depth", DEPTHS)
def test_a_square_corner_on_a_wall(depth):
    area, _ = Meeting(FLOE, WALL).area(depth, turned(45.0))
    assert area == pytest.approx(HEIGHT * 2.0 * wedge(depth, radians(45.0)), rel=1e-6)


@pytest.mark.parametrize("depth", DEPTHS)
def test_a_blunt_corner_on_a_wall(depth):
    corner = np.array([[0.0, 0.0], [-tan(radians(30.0)), 1.0], [-tan(radians(30.0)), -1.0]])  # 120 degrees
    core = convex_hull([[x, y, z] for x, y in corner for z in (-0.21, 0.21)])
    area, _ = Meeting(core, WALL).area(depth)
    assert area == pytest.approx(HEIGHT * 2.0 * wedge(depth, radians(60.0)), rel=1e-6)


@pytest.mark.parametrize("depth", DEPTHS)
def test_spheres(depth):
    assert Meeting(POINT, WALL, (0.5, RADIUS)).area(depth)[0] == pytest.approx(pi * depth * (1.0 - depth), rel=1e-6)
    assert Meeting(POINT, POINT, (0.5, 0.3)).area(depth)[0] == pytest.approx(lens(depth, 0.5, 0.3), rel=1e-6)


@pytest.mark.parametrize("depth", [0.0, *DEPTHS])
def test_a_face_on_a_face_is_the_patch_they_share(depth):
    area, _ = Meeting(FLOE, WALL).area(depth)
    assert area == pytest.approx(2.0 * SIDE * HEIGHT, rel=1e-9)
    assert Meeting(FLOE, FLOE, aside=1.0).area(depth)[0] == pytest.approx((2.0 * SIDE - 1.0) * HEIGHT, rel=1e-9)


@pytest.mark.parametrize(("angle", "within"), [(90.0, 0.01), (45.0, 0.01), (20.0, 0.07)])
def test_capsules_that_cross(angle, within):
    # an ellipse of the half axes sqrt(2 R' d), sqrt(2 R'' d), sqrt(R' R'') = r/sin of the angle of two equal cylinders
    radius, depth = 0.3, 1e-3
    area, _ = Meeting(CAPSULE, CAPSULE, (radius, radius)).area(depth, turn_b=turned(angle, axes="x"))
    assert area == pytest.approx(2.0 * pi * radius * depth / sin(radians(angle)), rel=within)


@pytest.mark.parametrize("depth", [1e-4, 1.5e-3, 5.8e-3])
def test_the_tip_of_a_cube_is_round(depth):
    area, _ = Meeting(box(0.92, 0.92, 0.92), WALL).area(depth, turned(45.0, -np.degrees(np.arctan(sqrt(0.5))), axes="zy"))
    assert area == pytest.approx(pi * depth * (2.0 * RADIUS - depth), rel=1e-9)


POSES = {
    "side on pile": (Meeting(FLOE, COLUMN, (RADIUS, PILE)), NONE),
    "corner on pile": (Meeting(FLOE, COLUMN, (RADIUS, PILE)), turned(45.0)),
    "edge a little askew on pile": (Meeting(FLOE, COLUMN, (RADIUS, PILE)), turned(45.0, 0.4, axes="zy")),
    "corner on wall": (Meeting(FLOE, WALL), turned(45.0)),
    "vertex on wall": (Meeting(FLOE, WALL), turned(40.0, -30.0, axes="zy")),
    "corner on corner": (Meeting(FLOE, FLOE, aside=0.01), turned(45.0)),
    "side a little askew on a side": (Meeting(FLOE, FLOE, aside=0.3), turned(0.2)),
}


@pytest.mark.parametrize("depth", DEPTHS)
@pytest.mark.parametrize("pose", POSES)
def test_the_derivative_and_that_the_area_grows(pose, depth):
    meeting, turn = POSES[pose]
    turn_b = turned(45.0) if pose == "corner on corner" else NONE
    tiny = 1e-4 * depth
    (low, _), (area, rate), (high, _) = (meeting.area(depth + change, turn, turn_b) for change in (-tiny, 0.0, tiny))
    assert 0.0 < low <= area <= high
    # it steers the search for the depth: how the rounding of corners grows is left out of it
    assert rate == pytest.approx((high - low) / (2.0 * tiny), rel=0.01, abs=1e-6)


#: rad, to which the largest changes along a path are narrowed
FINEST = 1e-9


def largest_jump(value: Callable[[float], float], tilts: np.ndarray) -> float:
    """What is left at FINEST of the largest changes between neighbouring tilts (n,) [rad], over the larger of both values."""

    def change(low: float, high: float) -> float:
        first, second = value(low), value(high)
        return abs(second - first) / max(first, second)

    values = np.array([value(tilt) for tilt in tilts])
    changes = np.abs(np.diff(values)) / np.maximum(values[1:], values[:-1])
    worst = 0.0
    for i in np.argsort(changes)[-8:]:
        low, high = tilts[i], tilts[i + 1]
        while high - low > FINEST:
            middle = 0.5 * (low + high)
            low, high = (low, middle) if change(low, middle) >= change(middle, high) else (middle, high)
        worst = max(worst, change(low, high))
    return worst


PATHS = {
    "turns on a floe's side": (Meeting(FLOE, FLOE, aside=0.3), (0.0, 0.0, 1.0)),
    "rolls over a corner on a floe's side": (Meeting(FLOE, FLOE, aside=0.3), (0.0, 1.0, -0.8)),
    "turns on the pile": (Meeting(FLOE, COLUMN, (RADIUS, PILE)), (0.0, 0.0, 1.0)),
    "tilts on the pile": (Meeting(FLOE, COLUMN, (RADIUS, PILE)), (0.0, 1.0, 0.0)),
    "twists on the pile": (Meeting(FLOE, COLUMN, (RADIUS, PILE)), (1.0, 0.0, 0.0)),
    "rolls over a corner on the pile": (Meeting(FLOE, COLUMN, (RADIUS, PILE)), (0.0, 1.0, -0.8)),
}


@pytest.mark.parametrize("depth", [1e-3, 0.015])
@pytest.mark.parametrize("path", PATHS)
def test_no_jump_on_a_path_of_poses(path, depth):
    meeting, axis = PATHS[path]
    axis = np.array(axis) / np.linalg.norm(axis)
    tilts = np.r_[0.0, np.geomspace(1e-7, 1e-2, 300), np.linspace(1e-2, 0.5 * pi, 900)[1:]]
    assert largest_jump(lambda tilt: meeting.area(depth, Rotation.from_rotvec(tilt * axis))[0], tilts) < 1e-4


@pytest.mark.parametrize("partner", ["floe", "pile"])
def test_an_area_falls_by_no_more_than_its_losses_as_the_bodies_turn_and_slide(partner):
    """By (rate + 2 extent) extent a radian that the normal turns in either body or the bodies about it, and 2 extent a metre."""
    rng = np.random.default_rng(7)
    core, radius = (FLOE, RADIUS) if partner == "floe" else (COLUMN, PILE)
    pair, fell = PairInPlace(FLOE, core, (RADIUS, radius)), 0
    for _ in range(400):
        depth, tilt = 10.0 ** rng.uniform([-7.0, -7.0], [-2.3, -0.5])
        upright = turned(rng.choice([0.0, 0.0, 45.0, rng.uniform(0.0, 90.0)]))
        turn = Rotation.from_rotvec(rng.normal(size=3) * 10.0 ** rng.uniform(-7.0, -0.5))
        place = np.array([6.0, rng.uniform(-1.2, 1.2), rng.uniform(-0.2, 0.2)])
        pair.forget()
        pair.place(0, np.zeros(3), Rotation.from_rotvec(rng.normal(size=3) * tilt) * upright)
        for _ in range(20):
            pair.place(1, place, turn)
            found = pair.closest()
            place[0] -= (found.distance - RADIUS - radius + OVERLAP) / max(abs(found.normal[0]), 0.2)
        area, rate, extent = pair.nominal(depth)
        if area == 0.0 or found.distance < 0.0:
            continue
        normal, contact = found.normal, found.on_a + RADIUS * found.normal
        spin = rng.normal(size=3) * 10.0 ** rng.uniform(-6.0, -1.0) * depth / extent
        slide = np.cross(rng.normal(size=3), normal) * rng.choice([0.0, 10.0 ** rng.uniform(-6.0, -1.0)]) * area / extent
        pair.place(1, contact + Rotation.from_rotvec(spin).apply(place - contact) + slide, Rotation.from_rotvec(spin) * turn)
        swing = pair.closest().normal - normal
        angle = np.linalg.norm(swing) + np.linalg.norm(swing - np.cross(spin, normal)) + abs(spin @ normal)
        fall = area - pair.nominal(depth)[0]
        assert fall <= (rate + 2.0 * extent) * extent * angle + 2.0 * extent * np.linalg.norm(slide) + 1e-12 * area
        fell += fall > 1e-6 * area
    assert fell > 50

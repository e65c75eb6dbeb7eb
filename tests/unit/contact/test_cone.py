"""A cone as contacts see it: its distance and normal are those of a round frustum, its energy has the force for a gradient."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from dilatedem.geometry.polyhedron import Polyhedron, convex_hull, prism
from dilatedem.geometry.separation import cone_distance, core_distance
from dilatedem.state.modes import Mode
from dilatedem.structures.cone import Cone
from tests.kernels import hertz_factor, line_law
from tests.pair_in_place import PairInPlace

RADIUS, WATERLINE = 0.04, 4.0
FLOE = prism([[-1.36, -1.36], [1.36, -1.36], [1.36, 1.36], [-1.36, 1.36]], -0.21, 0.21)
BALL = convex_hull([[0.0, 0.0, 0.0]])
SLOPES = (60.0, -60.0, 30.0)


def cone_at(slope: float, core: Polyhedron = FLOE) -> tuple[PairInPlace, Cone]:
    """A body, and a cone about the z axis with 4 m of radius at z = 0."""
    ends = {"top": 2.0} if slope > 0.0 else {"bottom": -2.0}
    cone = Cone(kind="cone", center=(0.0, 0.0), waterline_radius=WATERLINE, slope=slope, **ends)
    (part,) = cone.parts()
    pair = PairInPlace(core, part.shape.core, (RADIUS, part.shape.radius), taper=part.taper)
    pair.place(1, part.position)
    return pair, cone


def leaning(slope: float) -> Rotation:
    """Turns a floe whose side looks to -x so that it lies against the side of a cone."""
    return Rotation.from_euler("y", np.copysign(90.0 - abs(slope), -slope), degrees=True)


def press_to(pair: PairInPlace, turn: Rotation, overlap: float, height: float = 0.0, towards: float = 0.0) -> np.ndarray:
    """Put body a at +x of the cone, turned, `overlap` [m] deep; returns its place (3,)."""
    way = np.array([np.cos(towards), np.sin(towards), 0.0])
    low, high = 1.0, 20.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        pair.place(0, middle * way + [0.0, 0.0, height], turn)
        low, high = (middle, high) if pair.gap() < -overlap else (low, middle)
    pair.place(0, low * way + [0.0, 0.0, height], turn)
    return low * way + [0.0, 0.0, height]


@pytest.mark.parametrize("slope", SLOPES)
def test_a_ball_is_as_far_as_the_closed_form_says(slope):
    pair, _ = cone_at(slope, BALL)
    a, random = np.radians(abs(slope)), np.random.default_rng(1)
    for _ in range(20):
        around, height, away = random.uniform(0.0, 2.0 * np.pi), random.uniform(-0.5, 0.5), random.uniform(0.001, 3.0)
        out = np.array([np.cos(around), np.sin(around), 0.0])
        normal = np.sin(a) * out + [0.0, 0.0, np.copysign(np.cos(a), slope)]
        on_side = (WATERLINE - height / np.tan(np.radians(slope))) * out + [0.0, 0.0, height]
        pair.place(0, on_side + (away + RADIUS) * normal)
        assert pair.gap() == pytest.approx(away, abs=1e-13)
        np.testing.assert_allclose(pair.closest().normal, -normal, atol=1e-14)


def ring(radius: float, height: float, sides: int) -> np.ndarray:
    angle = (np.arange(sides) + 0.5) * 2.0 * np.pi / sides
    return np.column_stack([radius * np.cos(angle), radius * np.sin(angle), np.full(sides, height)])


def frustum(cone: Cone, sides: int) -> Polyhedron:
    """A polygon's frustum within the cone's side, whose sides' middles are in the direction of +x."""
    narrow = 1.0 / np.tan(np.radians(cone.slope))
    corners = [ring(cone.waterline_radius - z * narrow, z, sides) for z in (cone.bottom, cone.top)]
    return Polyhedron(np.concatenate(corners), np.zeros((0, 2), int), (), np.zeros((0, 3)))


@pytest.mark.parametrize("slope", SLOPES)
def test_polygons_come_nearer_by_the_square_of_their_sides(slope):
    pair, cone = cone_at(slope)
    for turn in (Rotation.from_euler("z", 0.4), Rotation.from_rotvec([0.1, 0.2, 0.8]), Rotation.from_rotvec([0.2, -0.3, 0.5])):
        pair.place(0, [9.0, 0.3, 0.05], turn)
        floe = Polyhedron(pair.vertices(0), FLOE.edges, (), np.zeros((0, 3)))
        apart, sides = pair.gap() + RADIUS, np.array([250, 1000])
        too_far = np.array([core_distance(floe, frustum(cone, n)) for n in sides]) - apart
        # at the middle of a side R (1 - cos(pi/n)) sin(slope), at its ends nothing
        bound = 9.0 * (1.0 - np.cos(np.pi / sides)) * np.sin(np.radians(abs(slope)))
        assert (too_far > -1e-12).all() and (too_far < bound).all()


def test_a_ball_at_the_middle_of_a_polygons_side():
    pair, cone = cone_at(60.0, BALL)
    pair.place(0, [7.0, 0.0, 0.3])
    ball = Polyhedron(pair.vertices(0), np.zeros((0, 2), int), (), np.zeros((0, 3)))
    for sides in (64, 250, 1000):
        side = core_distance(ball, frustum(cone, sides)) - pair.gap() - RADIUS
        assert 0.0 < side < 5.0 * (np.pi / sides) ** 2
        if sides == 64:
            assert side > 3e-3, "more than an overlap"
    assert side < 3e-5


@pytest.mark.parametrize("slope", [*SLOPES, 80.0])
def test_it_is_as_far_as_without_kernels(slope):
    pair, cone = cone_at(slope)
    (part,), random = cone.parts(), np.random.default_rng(2)
    axis = part.shape.core.vertices + part.position
    half = 0.5 * np.linalg.norm(axis[1] - axis[0])
    radii = part.shape.radius + part.taper * half * np.array([-1.0, 1.0])
    for _ in range(40):
        turn, around = Rotation.from_rotvec(random.normal(size=3)), random.uniform(0.0, 2.0 * np.pi)
        pair.place(0, [8.0 * np.cos(around), 8.0 * np.sin(around), random.uniform(-6.0, 6.0)], turn)
        pair.forget()
        cold = pair.gap()
        expected = cone_distance(Polyhedron(pair.vertices(0), FLOE.edges, (), turn.apply(FLOE.normals)), axis, radii) - RADIUS
        assert cold == pytest.approx(expected, abs=1e-9)
        assert pair.gap() == pytest.approx(cold, abs=1e-12), "from the corners of the last look"


@pytest.mark.parametrize("slope", SLOPES)
def test_a_corner_presses_as_hertz_says_with_the_curvature_of_the_side(slope):
    pair, _ = cone_at(slope)
    turn = Rotation.from_euler("z", np.pi / 4)
    press_to(pair, turn, 1e-3)
    found = pair.press()
    # the radius under the normal, at the height of the contact
    at = pair.closest().on_b
    across = np.hypot(*(at + (pair.closest().on_a - at) * 0.999)[:2])
    own, their = 1.0 / RADIUS, np.sin(np.radians(abs(slope))) / across
    factor = hertz_factor(2.0 * own + their, own * (own + their))[0]
    assert found.mode == Mode.VERTEX_EDGE
    assert np.linalg.norm(found.force) == pytest.approx(4.0 / 3.0 * factor * 1e-3**1.5, rel=1e-3)


@pytest.mark.parametrize("slope", SLOPES)
def test_a_side_presses_along_the_generator(slope):
    pair, cone = cone_at(slope)
    press_to(pair, leaning(slope), 1e-3)
    found = pair.press()
    assert found.mode == Mode.EDGE_FACE and found.size > 0.42
    z = pair.closest().on_a[2]
    curvature = np.sin(np.radians(abs(slope))) / (WATERLINE - z / np.tan(np.radians(slope)))
    # as on a pile the line runs out a little over the borders
    assert found.energy == pytest.approx(line_law(1.0, 0.42 * 1e-3, 0.42 * 1e-6, curvature)[0], rel=0.3)
    assert pair.patch().mode == Mode.EDGE_FACE and pair.patch().size == pytest.approx(0.42, abs=1e-3)


def attitudes(slope: float) -> list[Rotation]:
    lean = leaning(slope)
    return [
        Rotation.identity(), Rotation.from_euler("z", np.pi / 4), lean, lean * Rotation.from_euler("z", np.pi / 4),
        Rotation.from_euler("y", 2e-4) * lean * Rotation.from_euler("z", 1e-2), Rotation.from_rotvec([0.3, -0.2, 0.5]),
    ]  # fmt: skip


@pytest.mark.parametrize("slope", SLOPES)
def test_the_force_is_the_gradient_of_the_energy(slope):
    pair, _ = cone_at(slope)
    step = 1e-6
    for turn in attitudes(slope):
        place = press_to(pair, turn, 7e-4, height=0.07, towards=0.3)
        found = pair.press()

        def energy(moved, turned, turn=turn, place=place):
            pair.place(0, place + moved, Rotation.from_rotvec(turned) * turn)
            return pair.press().energy

        axes = step * np.eye(3)
        force = [(energy(e, 0 * e) - energy(-e, 0 * e)) / (2.0 * step) for e in axes]
        moment = [(energy(0 * e, e) - energy(0 * e, -e)) / (2.0 * step) for e in axes]
        size = np.linalg.norm(found.force)
        np.testing.assert_allclose(found.force, force, atol=2e-5 * size)
        np.testing.assert_allclose(found.moment, moment, atol=5e-5 * size)


@pytest.mark.parametrize("slope", SLOPES)
def test_nothing_jumps_where_a_floe_turns_past_the_side(slope):
    pair, _ = cone_at(slope)
    for turn in (leaning(slope), leaning(slope) * Rotation.from_euler("z", np.pi / 4)):
        place = press_to(pair, turn, 1e-3)
        rises = []
        for steps in (20, 200):
            forces = []
            for tilt in np.linspace(-2e-3, 2e-3, steps + 1):
                pair.place(0, place, Rotation.from_euler("y", tilt) * turn)
                forces.append(np.concatenate([pair.press().force, pair.press().moment]))
            rises.append(np.linalg.norm(np.diff(forces, axis=0), axis=1).max())
        assert rises[1] < 0.12 * rises[0]


def test_an_almost_upright_cone_is_a_pile():
    upright, pile = (
        PairInPlace(FLOE, convex_hull([[0.0, 0.0, -3.0], [0.0, 0.0, 3.0]]), (RADIUS, 2.0), taper=taper) for taper in (1e-12, 0.0)
    )
    for turn in attitudes(85.0):
        place = press_to(upright, turn, 1e-3, towards=0.2)
        pile.place(0, place, turn)
        for which in (upright, pile):
            which.forget()
        one, other = upright.press(), pile.press()
        assert one.mode == other.mode and one.energy == pytest.approx(other.energy, rel=1e-5)
        np.testing.assert_allclose(one.force, other.force, atol=1e-5 * np.linalg.norm(other.force))
        assert upright.patch().mode == pile.patch().mode and upright.patch().size == pytest.approx(pile.patch().size, rel=1e-6)

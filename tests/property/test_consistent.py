"""What holds of the model `consistent` for any two bodies in any pose: the force is the gradient of one energy, which knows neither
the frame nor the order of the bodies, and changes without a jump; and what that means for collisions.
"""

from typing import NamedTuple

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from dilatedem.case.schema import Case
from dilatedem.contact.consistent.face import MARGIN
from dilatedem.geometry.polyhedron import Polyhedron, convex_hull, prism
from dilatedem.run.simulation import Simulation
from dilatedem.state.clock import Status
from dilatedem.state.modes import Mode
from tests.pair_in_place import PairInPlace, Press
from tests.reference.cores import polygon

RADII = (0.04, 0.04)
REACH = sum(RADII)
#: by which face b reaches beyond its border, m
BORDER = MARGIN * REACH


class Pose(NamedTuple):
    """Body b (position (3,), rotation) against body a at the origin; overlap [m], unit normal from a to b."""

    pair: PairInPlace
    turn_a: Rotation
    place: np.ndarray
    turn_b: Rotation
    overlap: float
    normal: np.ndarray

    def press(self, shift=(0.0, 0.0, 0.0), turn_b=(0.0, 0.0, 0.0), turn_a=(0.0, 0.0, 0.0)) -> Press | None:
        """After a shift of b and turns of both about their own centroids, with no memory of any pose before."""
        self.pair.forget()
        self.pair.place(0, np.zeros(3), Rotation.from_rotvec(turn_a) * self.turn_a)
        self.pair.place(1, self.place + shift, Rotation.from_rotvec(turn_b) * self.turn_b)
        return self.pair.press()


def floe(rng) -> Polyhedron:
    """An irregular floe, no two sides of which are almost one: see `test_rolling_over_a_blunt_ridge`."""
    while True:
        outline = polygon(int(rng.integers(3, 8)), rng.uniform(1.6, 3.0), int(rng.integers(1 << 30)))
        side = np.roll(outline, -1, axis=0) - outline
        angle = np.arctan2(side[:, 1], side[:, 0])
        if ((np.roll(angle, -1) - angle) % (2 * np.pi)).min() > np.radians(15.0):
            return prism(outline, -0.21, 0.21)


def hull(rng) -> Polyhedron:
    """A convex hull, no two faces of which are almost one."""
    while True:
        core = convex_hull(rng.normal(size=(int(rng.integers(4, 9)), 3)) * [1.0, 0.8, 0.6])
        cosine = core.normals @ core.normals.T - 2.0 * np.eye(len(core.normals))
        if cosine.max() < np.cos(np.radians(15.0)):
            return core


CORES = {
    "floe": floe,
    "hull": hull,
    "tetrahedron": lambda rng: convex_hull(np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]]) * rng.uniform(0.3, 0.9, 3)),
    "capsule": lambda rng: convex_hull([[-0.7, 0.0, 0.0], [0.7, 0.0, 0.0]]),
    "sphere": lambda rng: convex_hull([[0.0, 0.0, 0.0]]),
    "plate": lambda rng: prism(polygon(int(rng.integers(3, 8)), 2.0, int(rng.integers(1 << 30))), 0.0, 0.0),
}


def facing_turn(rng, core: Polyhedron, direction, kind: str) -> Rotation:
    """A rotation that turns a face, an edge or a vertex of the core towards a direction."""
    if kind == "face" and core.faces:
        out = core.normals[rng.integers(len(core.normals))]
    elif kind == "edge" and len(core.edges):
        ends = core.vertices[core.edges[rng.integers(len(core.edges))]]
        out = ends.mean(axis=0) - core.vertices.mean(axis=0)
        if np.linalg.norm(out) < 1e-9:  # a capsule lies across the direction
            out = np.cross(ends[1] - ends[0], rng.normal(size=3))
    elif kind == "vertex" and len(core.vertices) > 1:
        out = core.vertices[rng.integers(len(core.vertices))] - core.vertices.mean(axis=0)
    else:
        out = rng.normal(size=3)
    turn, _ = Rotation.align_vectors([direction], [out / np.linalg.norm(out)])
    return Rotation.from_rotvec(direction * rng.uniform(0.0, 2.0 * np.pi)) * turn


def pose(seed: int, kinds: tuple[str, str], features: tuple[str, str], *, tilt: float = 0.0, deepest=5e-3) -> Pose:
    """Two random cores that touch by given features; tilt: of b's, rad. `level`: both upright at one height, as floes afloat."""
    rng = np.random.default_rng(seed)
    cores = [CORES[kind](rng) for kind in kinds]
    if features[0] == "level":
        direction = np.append(rng.normal(size=2), 0.0)
        turns = [Rotation.from_rotvec([0.0, 0.0, rng.uniform(0.0, 2.0 * np.pi)]) for _ in cores]
        if features[1] == "side":  # of both, in one plane
            normals = [core.normals[2 + rng.integers(len(core.normals) - 2)] for core in cores]
            turns[1] = Rotation.from_rotvec([0.0, 0.0, np.pi + np.arctan2(*normals[0][1::-1]) - np.arctan2(*normals[1][1::-1])])
            direction, turns[0] = normals[0] + 0.2 * rng.normal() * np.cross(normals[0], [0.0, 0.0, 1.0]), Rotation.identity()
    else:
        direction = rng.normal(size=3)
        direction /= np.linalg.norm(direction)
        turns = [facing_turn(rng, core, sign * direction, kind) for core, sign, kind in zip(cores, (1, -1), features, strict=True)]
    direction /= np.linalg.norm(direction)
    turns[1] = Rotation.from_rotvec(tilt * rng.normal(size=3)) * turns[1]
    pair = PairInPlace(*cores, radii=RADII)
    pair.place(0, np.zeros(3), turns[0])
    start = 8.0 * direction
    pair.place(1, start, turns[1])
    closest, overlap = pair.closest(), 10.0 ** rng.uniform(-5.0, np.log10(deepest))
    place = start + (closest.on_b - closest.on_a) * ((REACH - overlap) / closest.distance - 1.0)
    return Pose(pair, turns[0], place, turns[1], overlap, closest.normal)


ANY = ("any", "any")
FACES, EDGES, CORNERS = ("face", "face"), ("edge", "edge"), ("vertex", "vertex")
FAMILIES = {
    "floes": (("floe", "floe"), ANY, 0.0),
    "floes, level": (("floe", "floe"), ("level", "any"), 0.0),
    "floes, level, sides in one plane": (("floe", "floe"), ("level", "side"), 0.0),
    "floes, nearly level": (("floe", "floe"), ("level", "side"), 3e-3),
    "faces, 1e-7": (("floe", "hull"), FACES, 1e-7),
    "faces, 1e-5": (("floe", "floe"), FACES, 1e-5),
    "faces, 1e-3": (("hull", "floe"), FACES, 1e-3),
    "faces, 1e-2": (("floe", "tetrahedron"), FACES, 1e-2),
    "edges": (("hull", "floe"), EDGES, 0.0),
    "edges, nearly": (("floe", "tetrahedron"), EDGES, 1e-2),
    "corners": (("tetrahedron", "hull"), CORNERS, 0.0),
    "corner and face": (("tetrahedron", "floe"), ("vertex", "face"), 0.0),
    "edge and face": (("hull", "floe"), ("edge", "face"), 1e-3),
    "hulls": (("hull", "hull"), ANY, 0.0),
    "capsule and floe": (("capsule", "floe"), ("edge", "face"), 1e-2),
    "capsules": (("capsule", "capsule"), ANY, 0.0),
    "sphere and hull": (("sphere", "hull"), ANY, 0.0),
    "plate and hull": (("plate", "hull"), ANY, 0.0),
    "plates": (("plate", "plate"), FACES, 1e-3),
}


#: families whose faces are not flush with anything
FACELESS = ("edges", "corners", "hulls", "capsules", "sphere and hull", "floes, level")


def poses(family: str, count: int, first: int = 0):
    kinds, features, tilt = FAMILIES[family]
    return [pose(first + i, kinds, features, tilt=tilt) for i in range(count)]


def differences(found: Pose) -> tuple[float, float, float]:
    """Error of the force and of the moments on both, over the force (and 1 m), by central differences of the energy."""
    pressed, step = found.press(), 2e-4 * found.overlap

    def slopes(name):
        energies = [[found.press(**{name: s * step * axis}) for s in (-1, 1)] for axis in np.eye(3)]
        low, high = np.array([[0.0 if e is None else e.energy for e in pair] for pair in energies]).T
        return (low - high) / (2.0 * step)

    on_b = pressed.moment - np.cross(found.place, pressed.force)
    expected = {"shift": pressed.force, "turn_b": on_b, "turn_a": -pressed.moment}
    size = np.linalg.norm(pressed.force)
    return tuple(np.linalg.norm(slopes(name) - value) / size for name, value in expected.items())


@pytest.mark.parametrize("family", FAMILIES)
def test_force_and_moments_are_minus_the_gradient_of_the_energy(family):
    errors = np.array([differences(found) for found in poses(family, 40)])
    assert np.median(errors, axis=0).max() < 2e-5
    assert errors.max() < 5e-4


@pytest.mark.parametrize("family", FAMILIES)
def test_the_frame_does_not_matter(family):
    rng = np.random.default_rng(1)
    for found in poses(family, 10):
        turn, shift, pressed = Rotation.random(rng=rng), rng.uniform(-30.0, 30.0, 3), found.press()
        other = PairInPlace(*found.pair.cores, radii=RADII)
        other.place(0, shift, turn * found.turn_a)
        other.place(1, turn.apply(found.place) + shift, turn * found.turn_b)
        again, size = other.press(), np.linalg.norm(pressed.force)
        assert again.energy == pytest.approx(pressed.energy, rel=1e-7)
        assert turn.inv().apply(again.force) == pytest.approx(pressed.force, abs=1e-7 * size)
        assert turn.inv().apply(again.moment) == pytest.approx(pressed.moment, abs=1e-7 * size)


def swapped(found: Pose) -> tuple[float, np.ndarray, np.ndarray]:
    """Energy, force on b and its moment about a's centroid with the bodies in the other order."""
    other = PairInPlace(*reversed(found.pair.cores), radii=RADII)
    other.place(1, np.zeros(3), found.turn_a)
    other.place(0, found.place, found.turn_b)
    pressed = other.press()
    return pressed.energy, -pressed.force, -pressed.moment - np.cross(found.place, pressed.force)


def angle_of_faces(found: Pose) -> float:
    """The angle between those faces of a and b that look at each other, rad."""
    normals = [turn.apply(core.normals) for turn, core in zip((found.turn_a, found.turn_b), found.pair.cores, strict=True)]
    return float(np.linalg.norm(normals[0][:, None] + normals[1][None], axis=2).min())


@pytest.mark.parametrize("family", FAMILIES)
def test_the_order_of_the_bodies_does_not_matter(family):
    """But for two things in the clipping of faces, shares of a patch's breadth sqrt(A), more of a sliver's: the border of b reaches
    BORDER beyond itself, and faces at an angle are projected along the normal of b, a step aside by the angle times the radii. 3e-4
    at the median of faces, 2e-3 where they lean by 0.02 rad, 1 % at most; 5 % was seen for a patch of 0.3 cm2, 2 % of an edge that
    shares its energy with such a sliver. Without faces nothing but round-off."""
    seen = []
    for found in poses(family, 25):
        pressed, (energy, force, moment) = found.press(), swapped(found)
        size = np.linalg.norm(pressed.force)
        if pressed.mode == Mode.FACE_FACE:
            allowed = 1e-5 + (10.0 * BORDER + 2.0 * REACH * angle_of_faces(found)) / np.sqrt(pressed.size)
        else:
            allowed = 1e-5 if family in FACELESS else 0.03
        differ = (
            abs(energy / pressed.energy - 1.0),
            *(np.linalg.norm(force - pressed.force), np.linalg.norm(moment - pressed.moment)),
        )
        seen.append(max(differ[0], differ[1] / size, differ[2] / size))
        assert seen[-1] < allowed
    assert np.median(seen) < (1e-9 if family in FACELESS else 3e-3)


class Jump(NamedTuple):
    """Change of the wrench over its size across an interval of the path that cannot be halved any more."""

    change: float
    at: float


def worst_jump(found: Pose, way, count: int) -> Jump:
    """Halve the interval of largest change in turn, where the wrench changes faster than before and after."""

    def wrench(s):
        pressed = found.press(*way(s))
        # the moment about b's centroid is as steady as the force
        return np.zeros(6) if pressed is None else np.concatenate((pressed.force, pressed.moment))

    def size(*wrenches):
        return max(np.linalg.norm(w[:3]) for w in wrenches)

    at = np.linspace(-1.0, 1.0, count)
    seen = [wrench(s) for s in at]
    largest = size(*seen)
    if largest == 0.0:
        return Jump(0.0, 0.0)
    change = np.array([np.linalg.norm(b - a) / max(size(a, b), 1e-2 * largest) for a, b in zip(seen, seen[1:], strict=False)])
    beside = np.maximum(np.append(change[1:], 0.0), np.insert(change[:-1], 0, 0.0))
    worst = Jump(0.0, 0.0)
    for i in {int(change.argmax()), *np.argsort(beside - change)[:2]}:
        low, high, a, b = at[i], at[i + 1], seen[i], seen[i + 1]
        for _ in range(36):
            middle = 0.5 * (low + high)
            c = wrench(middle)
            low, high, a, b = (middle, high, c, b) if np.linalg.norm(c - a) < np.linalg.norm(b - c) else (low, middle, a, c)
        if size(a, b) > 1e-2 * largest:
            worst = max(worst, Jump(np.linalg.norm(b - a) / size(a, b), low))
    return worst


@pytest.mark.parametrize("family", FAMILIES)
def test_force_and_moment_do_not_jump(family):
    for i, found in enumerate(poses(family, 6, 100)):
        rng = np.random.default_rng(i)
        slide = np.cross(found.normal, rng.normal(size=3)) * 10.0 ** rng.uniform(-3.5, -0.7)
        slide += found.normal * found.overlap * rng.uniform(-0.5, 0.5)
        turn = rng.normal(size=3) * 10.0 ** rng.uniform(-5.0, -1.7)
        jump = worst_jump(found, lambda s, slide=slide, turn=turn: (s * slide, s * turn), 100)
        assert jump.change < 3e-3, f"pose {100 + i} at {jump.at}"


def collision(seed: int) -> Simulation:
    """Two random bodies about to meet, with friction and damping."""
    rng = np.random.default_rng(seed)
    kinds = (("floe", "floe"), ("hull", "floe"), ("tetrahedron", "hull"), ("plate", "capsule"), ("floe", "tetrahedron"))
    cores = [CORES[kind](rng) for kind in kinds[seed % len(kinds)]]
    direction = rng.normal(size=3)
    direction /= np.linalg.norm(direction)
    bodies = []
    for sign, core in zip((-1.0, 1.0), cores, strict=True):
        reach = np.linalg.norm(core.vertices, axis=1).max() + 0.02
        bodies.append(
            {
                "vertices": core.vertices.tolist(),
                "dilated_radius": 0.04,
                "position": (sign * reach * direction).tolist(),
                "rotation": rng.normal(size=3).tolist(),
                "velocity": (-sign * rng.uniform(1.0, 3.0) * direction + 0.1 * rng.normal(size=3)).tolist(),
                "angular_velocity": (0.5 * rng.normal(size=3)).tolist(),
            }
        )
    case = {
        "field": {"source": "bodies"},
        "water": {"enabled": False},
        "gravity": {"acceleration": 0.0},
        "contact": {"model": "consistent", "friction": rng.choice([0.1, 0.6]), "damping": rng.choice([0.0, 0.36])},
        "body": bodies,
    }
    return Simulation.of_case(Case.model_validate(case))


def momenta(simulation: Simulation) -> tuple[np.ndarray, np.ndarray]:
    state, mass = simulation.state.bodies, simulation.model.solids.mass[:2]
    linear = mass[:, None] * state.velocity[:2]
    return linear.sum(axis=0), (np.cross(state.position[:2], linear) + state.angular_momentum[:2]).sum(axis=0)


@pytest.mark.parametrize("seed", range(10))
def test_collisions_conserve_momentum(seed):
    simulation = collision(seed)
    assert simulation.evaluate() == Status.DONE
    before, scale, touched = momenta(simulation), 0.0, False
    mass, start = simulation.model.solids.mass[:2], simulation.state.bodies.velocity[:2].copy()
    for _ in range(60):
        assert simulation.advance(500) == Status.DONE
        touched = touched or simulation.contacts > 0
        scale = max(scale, (mass[:, None] * np.abs(simulation.state.bodies.velocity[:2])).sum())
        if touched and simulation.contacts == 0:
            break
    assert np.abs(simulation.state.bodies.velocity[:2] - start).max() > 0.01, "did not meet"
    # one unit in the last place for every step, as in tests/verification/test_collision.py
    round_off = np.finfo(float).eps * float(simulation.state.clock.step[0])
    after = momenta(simulation)
    assert after[0] == pytest.approx(before[0], abs=round_off * scale)
    reach = np.abs(simulation.state.bodies.position[:2]).max()
    assert after[1] == pytest.approx(before[1], abs=round_off * scale * reach)

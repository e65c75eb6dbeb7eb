"""An edge that presses on a cap: the law of a line, edges that cross, and the integrals along the edge."""

from itertools import product

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from dilatedem.contact.consistent.join import SHARP
from dilatedem.contact.consistent.point import BLEND
from dilatedem.geometry.polyhedron import convex_hull, prism
from dilatedem.state.modes import Mode
from tests.kernels import around_cap, edge_on_cap, line_law, workspace_of
from tests.pair_in_place import PairInPlace
from tests.reference.cores import box, polygon
from tests.unit.contact.test_consistent_point import exact_factor

UP = (0.0, 0.0, 1.0)
RADIUS = 0.04
REACH = 2.0 * RADIUS


def law_of_a_line(length: float, radius: float, overlap: float) -> tuple[float, float]:
    """F/E* [m2] = pi L d/Lam, Lam = 0.2 + ln(pi L^3/(F R)) (physics, 4.2), and the half-width of the contact over its length."""
    force = length * overlap
    for _ in range(100):
        force = np.pi * length * overlap / (0.2 + np.log(np.pi * length**3 / (force * radius)))
    return force, np.sqrt(4.0 * force * radius / (np.pi * length)) / length


@pytest.mark.parametrize(
    ("length", "radius", "overlap"), list(product((0.1, 0.2, 0.5), (0.02, 0.04, 0.2, 1.0, 2.0), (1e-5, 1e-4, 1e-3)))
)
def test_uniform_line(length, radius, overlap):
    expected, slender = law_of_a_line(length, radius, overlap)
    _, by_first, by_second, _ = line_law(1.0, length * overlap, length * overlap**2, 1.0 / radius)
    force = by_first * length + by_second * 2.0 * length * overlap
    if slender < 0.08:
        assert force == pytest.approx(expected, rel=0.05)
    else:
        # as wide as long it is no line any more: half-space boundary elements are 1.07 to 1.3 times lower than the formula, too
        assert 0.5 * expected < force < expected


#: F/E* [m2] by (length, radius, overlap) [m] of validation/half_space/reference.csv, lines with sharp ends
STUBS = {
    (0.02, 2.0, 1e-4): 2.138e-6, (0.05, 2.0, 1e-3): 6.101e-5, (0.1, 2.0, 1e-3): 8.428e-5, (0.2, 2.0, 1e-3): 1.237e-4,
    (0.42, 2.0, 1e-3): 1.98e-4, (0.01, 0.04, 1e-3): 1.006e-5, (0.02, 0.04, 1e-3): 1.433e-5, (0.1, 0.04, 1e-3): 4.018e-5,
    (0.42, 0.04, 1e-4): 9.721e-6,
}  # fmt: skip


@pytest.mark.parametrize(("length", "radius", "overlap"), STUBS)
def test_short_line_is_that_of_the_half_space(length, radius, overlap):
    _, by_first, by_second, _ = line_law(1.0, length * overlap, length * overlap**2, 1.0 / radius)
    force = by_first * length + by_second * 2.0 * length * overlap
    assert force == pytest.approx(STUBS[length, radius, overlap], rel=0.035)


def test_line_law_has_the_derivatives_it_says():
    for length, radius, overlap in product((0.003, 0.1, 2.0), (0.02, 2.0), (1e-6, 1e-3)):
        at = np.array([length * overlap, length * overlap**2, 1.0 / radius])
        found = line_law(3.0, *at)
        for i in range(3):
            h = np.where(np.arange(3) == i, 1e-6, 0.0)
            slope = (line_law(3.0, *(at * (1 + h)))[0] - line_law(3.0, *(at * (1 - h)))[0]) / (2e-6 * at[i])
            assert found[1 + i] == pytest.approx(slope, rel=1e-6), (length, radius, overlap, i)


def test_energy_of_a_line_rises_with_its_length_and_falls_with_its_curvature():
    energy = [line_law(1.0, length * 1e-4, length * 1e-8, 25.0)[0] for length in np.geomspace(1e-4, 10.0, 200)]
    assert (np.diff(energy) > 0.0).all()
    energy = [line_law(1.0, 1e-5, 1e-9, curvature)[0] for curvature in np.geomspace(0.1, 1e4, 200)]
    assert (np.diff(energy) < 0.0).all()


@pytest.mark.parametrize("angle", [90.0, 60.0, 30.0, 10.0, 5.0, 2.0, 1.0])
@pytest.mark.parametrize("radii", [(0.04, 0.04), (0.04, 2.0), (0.1, 0.02)])
def test_crossing_edges_are_elliptic_hertz(angle, radii):
    core, t = convex_hull([[-4.0, 0.0, 0.0], [4.0, 0.0, 0.0]]), np.radians(angle)
    ra, rb = radii
    across = np.array([-np.sin(t), np.cos(t)])
    curvature = np.linalg.eigvalsh(np.diag([0.0, 1 / ra]) + np.outer(across, across) / rb)
    for overlap in (1e-5, 1e-3):
        pair = PairInPlace(core, core, radii=radii)
        pair.place(1, [0.3, 0.0, ra + rb - overlap], Rotation.from_rotvec([0.0, 0.0, t]))
        found, force = pair.press(), 4.0 / 3.0 * exact_factor(*curvature) * overlap**1.5
        assert found.force == pytest.approx([0.0, 0.0, force], rel=0.05, abs=1e-6 * force)
        assert found.energy == pytest.approx(0.4 * force * overlap, rel=0.05)
        # through the crossing
        assert np.cross(found.force, found.moment) / np.dot(found.force, found.force) == pytest.approx([0.3, 0.0, 0.0], abs=1e-6)


def test_crossing_edges_are_counted_as_such():
    core = convex_hull([[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]])
    pair = PairInPlace(core, core)
    pair.place(1, [0.3, 0.0, REACH - 1e-4], Rotation.from_rotvec([0.0, 0.0, 1.0]))
    assert pair.press().mode == Mode.EDGE_CROSSING


def caps() -> dict[str, np.ndarray]:
    square = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]])
    return {f"{n} corners": np.column_stack((0.5 * polygon(n, 2.0, 10 + n) + 0.5, np.zeros(n))) for n in (3, 7)} | {
        "square": square, "segment": square[:2], "vertex": square[:1]
    }  # fmt: skip


def slow_integrals(corners, p, e, length):
    """Integrals of the overlap and of its square, m2 and m3, least and largest way beyond the border where it presses, by sums."""
    count, scratch = 20001, workspace_of(corners)
    sums, ways = np.zeros(2), []
    for s in (np.arange(count) + 0.5) / count * length:
        _, _, w, (side, out, _, _) = around_cap(scratch, len(corners), UP, tuple(p + s * e), BLEND * REACH)
        overlap = (REACH**2 - np.dot(w, w)) / (2 * REACH)
        if overlap > 0.0:
            sums += [overlap, overlap**2]
            ways.append((side, out))
    return sums * length / count, np.min(ways, axis=0), np.max(ways, axis=0)


def edges(corners, seed, count):
    """Edges that press on a cap: p, unit vector, length."""
    rng = np.random.default_rng(seed)
    while count:
        aim = np.mean(corners, axis=0) + np.append(rng.normal(size=2) * rng.choice([0.02, 0.5]), 0.0)
        if rng.random() < 0.5:  # near a border
            aim = corners[rng.integers(len(corners))] + np.append(rng.normal(size=2) * 0.02, 0.0)
        e = np.append(rng.normal(size=2), rng.normal() * 10.0 ** rng.uniform(-6, -1))
        e /= np.linalg.norm(e)
        length = rng.uniform(0.05, 2.0)
        p = aim + [0.0, 0.0, REACH - 10.0 ** rng.uniform(-4, -2.3)] - rng.uniform(0.0, length) * e
        if edge_on_cap(tuple(p), tuple(e), length, RADIUS, workspace_of(corners), len(corners), UP, RADIUS, 1.0, SHARP)[0] > 0.0:
            yield p, e, length
            count -= 1


@pytest.mark.parametrize("name", [name for name in caps() if name != "vertex"])
def test_integrals_along_the_edge(name):
    corners, plain = caps()[name], 0
    for p, e, length in edges(corners, 3, 8):
        energy, _, _, size, across = edge_on_cap(
            tuple(p), tuple(e), length, RADIUS, workspace_of(corners), len(corners), UP, RADIUS, 1.0, SHARP
        )
        (first, second), least, most = slow_integrals(corners, p, e, length)
        assert size == pytest.approx(first**2 / second, rel=1e-4)
        over_a_face = line_law(1.0, first, second, 1.0 / RADIUS)[0]
        along_an_edge = 2.0 ** (-1.0 / 16.0) * line_law(1.0, first, second, 2.0 / RADIUS)[0]
        if most[0] == 0.0:
            assert (energy, across) == (pytest.approx(over_a_face, rel=1e-4), 0.0)
            plain += 1
        elif least[0] >= BLEND * REACH and most[1] == 0.0:
            assert (energy, across) == (pytest.approx(along_an_edge, rel=1e-4), pytest.approx(1.0))
            plain += 1
        else:
            assert energy < over_a_face * (1.0 + 1e-6)
            if most[1] == 0.0:
                assert energy > along_an_edge * (1.0 - 1e-6)
    assert plain > 0


def test_an_edge_does_not_press_a_lone_vertex():
    # that is the vertex's to press on the edge
    found = edge_on_cap(
        (-0.3, 0.0, REACH - 1e-3), (1.0, 0.0, 0.0), 1.0, RADIUS, workspace_of([[0.0, 0.0, 0.0]]), 1, UP, RADIUS, 1.0, SHARP
    )
    assert found[0] == 0.0


@pytest.mark.parametrize("turn", [0.0, 0.3, 1.0])
def test_an_edge_exactly_along_a_border(turn):
    # over the border of a square, level with it, in frames whose round-off puts it on either side, over all or part of its length
    square, frame = caps()["square"], Rotation.from_rotvec(turn * np.array([0.6, -0.2, 0.7]))
    corners, normal = frame.apply(square), tuple(frame.apply(UP))
    for start, length in ((0.0, 1.0), (-0.5, 2.0), (0.3, 0.5)):
        p, e = frame.apply([start, 0.0, REACH - 1e-4]), tuple(frame.apply([1.0, 0.0, 0.0]))
        scratch = workspace_of(corners)
        found = edge_on_cap(tuple(p), e, length, RADIUS, scratch, 4, normal, RADIUS, 1.0, SHARP)
        inside = edge_on_cap(
            tuple(frame.apply([start, 1e-9, REACH - 1e-4])), e, length, RADIUS, scratch, 4, normal, RADIUS, 1.0, SHARP
        )
        assert found[0] == pytest.approx(inside[0], rel=1e-6)
        assert found[3] == pytest.approx(min(length, 1.0), abs=0.02)


@pytest.mark.parametrize("name", [name for name in caps() if name != "vertex"])
def test_force_and_moment_are_minus_the_gradient(name):
    corners, worst = caps()[name], []
    scratch, count = workspace_of(corners), len(corners)

    def energy(p, e, length):
        return edge_on_cap(tuple(p), tuple(e), length, RADIUS, scratch, count, UP, RADIUS, 1.0, SHARP)[0]

    for p, e, length in edges(corners, 4, 40):
        _, force, moment, _, _ = edge_on_cap(tuple(p), tuple(e), length, RADIUS, scratch, count, UP, RADIUS, 1.0, SHARP)
        h, force, moment = 1e-7, np.array(force), np.array(moment)
        pushed = [(energy(p - h * x, e, length) - energy(p + h * x, e, length)) / (2 * h) for x in np.eye(3)]
        turns = [Rotation.from_rotvec(h * x) for x in np.eye(3)]
        # about the origin
        turned = [
            (energy(t.inv().apply(p), t.inv().apply(e), length) - energy(t.apply(p), t.apply(e), length)) / (2 * h) for t in turns
        ]
        size = np.linalg.norm(force)
        worst.append(max(np.linalg.norm(pushed - force), np.linalg.norm(turned - moment)) / size)
    assert np.median(worst) < 1e-5
    # what lies beyond a sharp corner is no polynomial along the edge: the Gauss points are not exact there, and move with the pose
    assert max(worst) < 0.01
    assert np.mean(np.array(worst) > 1e-3) < 0.06


@pytest.mark.parametrize("corners", [12, 20, 100, 120])
def test_an_edge_across_a_cap_of_many_corners(corners):
    # a bar on a round table, 20 mm inside its rim: the chord is 0.28 m long for any number of corners that makes it round
    t = 2.0 * np.pi * np.arange(corners) / corners
    table = prism(0.5 * np.column_stack((np.cos(t), np.sin(t))), -0.2, 0.2)
    pair = PairInPlace(table, convex_hull([[0.0, -1.4, 0.0], [0.0, 1.4, 0.0]]))
    pair.place(1, [0.48, 0.0, 0.2 + REACH - 1e-3], Rotation.from_rotvec([0.0, 0.0, 0.3 / corners]))
    assert pair.press().size == pytest.approx(2.0 * np.sqrt(0.5**2 - 0.48**2), abs=0.09)


@pytest.mark.parametrize("tilt", [0.0, 1e-12, 1e-9, 1e-6])
def test_edge_on_face_of_a_pair(tilt):
    # 0.5 m of the lower edge of a cube turned by 45 degrees
    pair = PairInPlace(box(1.0, 1.0, 1.0), box(0.5, 0.5, 0.5))
    turn = Rotation.from_rotvec([0.0, tilt, 0.0]) * Rotation.from_rotvec([np.pi / 4, 0.0, 0.0])
    pair.place(1, [0.1, 0.05, 0.5 + REACH - 1e-4 + 0.25 * np.sqrt(2)], turn)
    found, force = pair.press(), law_of_a_line(0.5, RADIUS, 1e-4)[0]
    assert found.mode == Mode.EDGE_FACE
    assert found.size == pytest.approx(0.5, rel=1e-2)
    assert found.force == pytest.approx([0.0, 0.0, force], rel=0.05, abs=0.01 * force)


@pytest.mark.parametrize(("overlap", "allowed"), [(1e-3, 0.05), (2e-3, 0.05), (3e-3, 0.05), (5e-3, 0.06)])
def test_rims_round_the_ends_of_a_line_are_no_curvature_across_it(overlap, allowed):
    # a floe's side on the pile, whose axis runs out over the side's upper and lower border
    pair = PairInPlace(box(2.72, 2.72, 0.42), convex_hull([[0.0, 0.0, -5.0], [0.0, 0.0, 5.0]]), radii=(RADIUS, 2.0))
    pair.place(1, [1.36 + RADIUS + 2.0 - overlap, 0.0, 0.0], Rotation.identity())
    assert np.linalg.norm(pair.press().force) == pytest.approx(law_of_a_line(0.42, 2.0, overlap)[0], rel=allowed)

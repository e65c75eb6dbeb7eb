"""All features of two caps as one energy: what leads, what is left out, and which cap it is taken of."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from dilatedem.contact.consistent.face import MARGIN
from dilatedem.geometry.polyhedron import convex_hull, prism
from dilatedem.state.modes import Mode
from tests.kernels import line_law
from tests.pair_in_place import PairInPlace
from tests.reference.cores import box

RADIUS, REACH = 0.04, 0.08
#: by which face b reaches beyond its border, m
BORDER = MARGIN * REACH
SQUARE = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
ON_EDGE = Rotation.from_rotvec([np.pi / 4, 0.0, 0.0])
ON_CORNER = Rotation.align_vectors([[0.0, 0.0, -1.0]], [[1.0, 1.0, 1.0]])[0]


def hertz(factor: float, overlap: float) -> float:
    """Energy of a point, for E* = 1 Pa."""
    return 8.0 / 15.0 * factor * overlap**2.5


@pytest.mark.parametrize("swapped", [False, True])
@pytest.mark.parametrize(
    ("core_b", "turn_a", "turn_b", "height", "mode"),
    [
        (box(0.5, 0.5, 0.5), ON_CORNER.inv(), ON_CORNER, 2 * 0.25 * np.sqrt(3), Mode.VERTEX_VERTEX),
        (box(0.5, 0.5, 0.5), None, ON_CORNER, 0.25 + 0.25 * np.sqrt(3), Mode.VERTEX_FACE),
        (box(0.5, 0.5, 0.5), None, ON_EDGE, 0.25 + 0.25 * np.sqrt(2), Mode.EDGE_FACE),
        (box(0.5, 0.5, 0.5), ON_EDGE, ON_EDGE, 2 * 0.25 * np.sqrt(2), Mode.EDGE_PARALLEL),
        (box(0.5, 0.5, 0.5), None, None, 0.5, Mode.FACE_FACE),
        (convex_hull([[0.0, 0.0, 0.0]]), None, None, 0.25, Mode.VERTEX_FACE),
        (convex_hull([[0.0, 0.0, 0.0]]), ON_EDGE, None, 0.25 * np.sqrt(2), Mode.VERTEX_EDGE),
        (convex_hull([[-0.2, 0.0, 0.0], [0.2, 0.0, 0.0]]), None, None, 0.25, Mode.EDGE_FACE),
        (convex_hull([[-0.2, 0.0, 0.0], [0.2, 0.0, 0.0]]), ON_EDGE, None, 0.25 * np.sqrt(2), Mode.EDGE_PARALLEL),
        (prism([[-0.2, -0.2], [0.2, -0.2], [0.0, 0.2]], 0.0, 0.0), None, None, 0.25, Mode.FACE_FACE),
    ],
)
def test_what_stands_on_a_cube(core_b, turn_a, turn_b, height, mode, swapped):
    cube, overlap = box(0.5, 0.5, 0.5), 1e-4
    pair = PairInPlace(core_b, cube) if swapped else PairInPlace(cube, core_b)
    below, above = (1, 0) if swapped else (0, 1)
    pair.place(below, np.zeros(3), turn_a)
    pair.place(above, [0.0, 0.0, height + REACH - overlap], turn_b)
    found = pair.press()
    assert found.mode == mode
    force = np.linalg.norm(found.force)
    assert found.force == pytest.approx([0.0, 0.0, -force if swapped else force], rel=1e-9, abs=1e-7 * force)
    # through the middle of whatever touches
    middle = core_b.vertices.mean(axis=0)[:2]
    assert np.cross(found.force, found.moment)[:2] / force**2 == pytest.approx(middle, abs=1e-3)


def test_one_energy_is_little_above_the_largest():
    # faces: area, sides and corners of a punch press together; the face leads
    energies = []
    for size in (0.2, 0.02, 0.002):
        pair = PairInPlace(box(size, size, size), box(1.0, 1.0, 1.0))  # its own border cuts the patch
        pair.place(1, [0.0, 0.0, -(0.5 + 0.5 * size + REACH - 1e-4)])
        found = pair.press()
        face = 1.018 / np.sqrt(np.pi) * size * 1e-8
        line = line_law(1.0, size * 1e-4, size * 1e-8, 1.0 / RADIUS)[0]
        pieces = np.array([face, *[line] * 4, *[hertz(np.sqrt(RADIUS), 1e-4)] * 4])
        energies.append((found.energy, (pieces**16).sum() ** (1 / 16), pieces.max()))
    energies = np.array(energies)
    assert energies[:, 0] == pytest.approx(energies[:, 1], rel=2e-3)
    assert (energies[:, 0] >= energies[:, 2] * (1.0 - 1e-9)).all()


def test_upright_edges_beside_each_other_both_count():
    # two floes corner on corner, 5 mm into each other and tilted by 2e-3: their patch is a sliver, and both upright edges press
    # over 0.3 m. Which of them are measured must not depend on a hair of overlap
    pair = PairInPlace(box(2.72, 2.72, 0.42), box(2.72, 2.72, 0.42))
    pair.place(0, np.zeros(3), Rotation.from_rotvec([-0.00027041, -0.00185209, 0.0]))
    turn = Rotation.from_rotvec([1.97282873e-03, 6.77922173e-04, 8.41287935e-01])
    forces = []
    for overlap in np.linspace(4.9e-3, 5.2e-3, 301):
        pair.forget()
        pair.place(1, np.array([1.29771353, 3.34031225, -0.14289361]) + (5.084e-3 - overlap) * np.array([0.596, 0.803, 0.0]), turn)
        forces.append(pair.press().force)
    rises = np.linalg.norm(np.diff(forces, axis=0), axis=1) / np.linalg.norm(forces[0])
    # some 2e-4 a micrometre
    assert rises.max() < 3.0 * np.median(rises)


def ridge(angle: float, beside: float) -> PairInPlace:
    """A prism whose side at x = 1 has a blunt corner at y = `beside`, before the flat side of another."""
    t = np.tan(0.5 * angle)
    body = prism(
        [[-1.0, -1.0], [1.0 - t * (1.0 + beside), -1.0], [1.0, beside], [1.0 - t * (1.0 - beside), 1.0], [-1.0, 1.0]], -0.2, 0.2
    )
    return PairInPlace(body, box(0.8, 4.0, 0.4))


@pytest.mark.parametrize(
    ("degrees", "overlap"),
    [
        (20.0, 1e-3),
        (10.0, 1e-3),
        (5.0, 1e-3),
        (10.0, 5e-3),
        *[
            pytest.param(*case, marks=pytest.mark.xfail(strict=True, reason="only one of the two faces at a blunt ridge is taken"))
            for case in ((1.0, 1e-3), (0.5, 1e-3), (3.0, 5e-3), (1.0, 5e-3))
        ],
    ],
)
@pytest.mark.parametrize("beside", [0.0, 0.8])
def test_rolling_over_a_blunt_ridge(degrees, overlap, beside):
    # from one side to the next: at the middle both faces lean by half the angle
    pair = ridge(np.radians(degrees), beside)
    pair.place(1, [1.4 + REACH - overlap, 0.03, 0.05])
    found = []
    for turn in (-1e-9, 1e-9):
        pair.forget()
        pair.place(0, np.zeros(3), Rotation.from_rotvec([0.0, 0.0, turn]))
        found.append(pair.press())
    force = np.linalg.norm(found[0].force)
    assert found[1].energy == pytest.approx(found[0].energy, rel=1e-5)
    assert found[1].force == pytest.approx(found[0].force, abs=1e-3 * force)
    assert found[1].moment == pytest.approx(found[0].moment, abs=1e-3 * force)


@pytest.mark.parametrize("height", [0.0, 1e-12, 1e-3, -0.01])
@pytest.mark.parametrize("shift", [0.3, 2.0])
def test_thin_floes_at_one_height(height, shift):
    # flat cores (a floe of two dilated radii), level: half-cylinders beside each other
    pair = PairInPlace(prism(SQUARE, 0.0, 0.0), prism(SQUARE, 0.0, 0.0))
    pair.place(1, [2.0 + REACH - 1e-3, shift, height])
    found = pair.press()
    overlap = REACH - np.hypot(REACH - 1e-3, height)
    if overlap <= 0.0:
        assert found is None
        return
    pair.place(1, [2.0 + REACH - 1e-3, shift, 1e-6])
    level = pair.press()
    if abs(height) < 1e-6:
        assert found.energy == pytest.approx(level.energy, rel=1e-4)
        assert found.force == pytest.approx(level.force, abs=1e-4 * level.force[0])
    # the measure along the edges is their common length, but for what the rounded ends add; corner beside corner is a point
    assert found.mode == (Mode.VERTEX_EDGE if shift == 2.0 else Mode.EDGE_PARALLEL)
    assert found.size == pytest.approx(1.0 if shift == 2.0 else 2.0 - shift, abs=0.03)
    assert found.force[2] / found.force[0] == pytest.approx(height / (REACH - 1e-3), rel=0.05, abs=1e-9)


def test_the_cap_holds_the_closest_edge():
    # a roof with a ridge along x over low hips: at the ridge's end a hip is flatter than the roof's sides
    roof = convex_hull(
        [[-0.5, 0.0, 0.0], [0.5, 0.0, 0.0], [0.0, 1.0, -0.1], [0.0, -1.0, -0.1], [1.5, 0.3, -0.02], [1.5, -0.3, -0.02],
         [-1.5, 0.3, -0.02], [-1.5, -0.3, -0.02], [0.0, 0.0, -1.0]]
    )  # fmt: skip
    ball = convex_hull([[0.0, 0.0, 0.0]])
    forces = []
    for x in (-0.2, -0.1, 0.0, 0.1, 0.2):
        pair = PairInPlace(roof, ball)
        pair.place(1, [x, 0.0, REACH - 1e-3])
        forces.append(pair.press().force[2])
    assert min(forces) == pytest.approx(max(forces), rel=1e-6) and min(forces) > 0.0


def test_swapping_costs_no_more_than_the_margin():
    # the patch is cut by b's border moved out, so that its area may differ by BORDER times the border that cuts
    for width in (0.4, 0.1, 0.02):
        forces = []
        for swapped in (False, True):
            pair = PairInPlace(box(1.0, 1.0, 1.0), box(1.0, 1.0, 1.0))
            shift = np.array([1.0 + REACH - 1e-4, 0.0, 1.0 - width])
            pair.place(1, -shift if swapped else shift)
            forces.append(-pair.press().force if swapped else pair.press().force)
        assert forces[0] == pytest.approx(forces[1], rel=1.05 * BORDER / width, abs=BORDER / width * np.linalg.norm(forces[0]))

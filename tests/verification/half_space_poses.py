"""The poses of validation/half_space/reference.csv for the contact kernels: `consistent` against the boundary-element half space.

Every row is laid out as two dilated cores (a large box whose top is z = 0, or an edge, below; an edge, corner or face above) and
pressed with a modulus of 1 Pa, so that force and energy are those of the file.
"""

import csv
from dataclasses import dataclass
from math import atan, hypot, inf, radians
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from dilatedem.geometry.polyhedron import Polyhedron, convex_hull
from tests.pair_in_place import PairInPlace

REFERENCE = Path(__file__).parents[2] / "validation" / "half_space" / "reference.csv"
ON_PLATE = ("tilted edge", "rolled face", "strip", "square")
FAMILIES = (*ON_PLATE, "crossing")
RADIUS, PILE_RADIUS = 0.04, 2.0  # m
ENDLESS = 40.0  # m, of an edge that the half space has without end
DEPTH = 0.7  # m, of the cores behind an edge or corner
#: a row whose plain law (point, line or face) is within this of the half space is a pure contact; all others are in between
PURE = 0.02


@dataclass(frozen=True)
class Row:
    """A pose of reference.csv and its solution [m2], [m3] per E*; plain: force of the plain law for it over the solution."""

    family: str
    length: float
    width: float
    tilt: float  # rad, slope
    angle: float  # degrees, of a crossing
    radius_other: float
    overlap: float
    force: float
    energy: float
    plain: float

    @property
    def pure(self) -> bool:
        return abs(self.plain - 1.0) <= PURE

    @property
    def tiny(self) -> bool:
        """A square smaller than the circle that a corner presses, of radius sqrt(r overlap): no floe's face."""
        return self.family == "square" and 0.0 < self.length < 2.0 * (RADIUS * self.overlap) ** 0.5

    @property
    def on_pile(self) -> bool:
        return self.family == "crossing" and self.radius_other > RADIUS

    def __str__(self) -> str:
        where = f"angle {self.angle:g}, other {self.radius_other:g} m" if self.family == "crossing" else f"tilt {self.tilt:g}"
        return f"{self.family}, {self.length:g} m x {self.width:g} m, {where}, {1e3 * self.overlap:g} mm"


def _value(text: str) -> float:
    return float(text) if text else 0.0


def rows(family: str) -> list[Row]:
    with REFERENCE.open(encoding="utf-8") as file:
        return [
            Row(
                family, *(_value(row[name]) for name in ("length", "width", "tilt", "angle", "radius_other", "overlap")),
                *(_value(row[name]) for name in ("force", "energy", "pieces_over_force")),
            )
            for row in csv.DictReader(file)
            if row["family"] == family
        ]  # fmt: skip


def _block(length: float, width: float) -> Polyhedron:
    """Face of these sides at z = 0, from x = 0 on, the rest above it."""
    return convex_hull([[x, y, z] for x in (0.0, length) for y in (-0.5 * width, 0.5 * width) for z in (0.0, 2.0 * DEPTH)])


def _prism(length: float, start: float = 0.0) -> Polyhedron:
    """A box on its edge, which lies at z = 0 along x."""
    across = ((0.0, 0.0), (DEPTH, DEPTH), (-DEPTH, DEPTH), (0.0, 2.0 * DEPTH))
    return convex_hull([[x, y, z] for x in (start, start + length) for y, z in across])


def _pile() -> Polyhedron:
    """The axis of a pile, along x."""
    return convex_hull([[-0.5 * ENDLESS, 0.0, 0.0], [0.5 * ENDLESS, 0.0, 0.0]])


def _core(row: Row) -> Polyhedron:
    if row.width > 0.0:
        return _block(row.length, row.width)
    if row.length > 0.0:
        return _prism(row.length)
    return convex_hull([[0.0, 0.0, 0.0], *([x, y, DEPTH] for x in (-DEPTH, DEPTH) for y in (-DEPTH, DEPTH))])


def pair(row: Row, *, pile: bool = False) -> PairInPlace:
    """Body a below, body b above, at the row's deepest overlap.

    pile: a tilted edge is pressed along a pile of PILE_RADIUS instead of the plate: the relative curvature across is 1/r + 1/2 m
    instead of 1/r, which changes line and point by less than 1 %.
    """
    if pile:
        placed = PairInPlace(_pile(), _core(row), radii=(PILE_RADIUS, RADIUS))
        placed.place(0, (0.0, 0.0, 0.0))
        placed.place(1, (0.0, 0.0, PILE_RADIUS + RADIUS - row.overlap), Rotation.from_rotvec([0.0, -atan(row.tilt), 0.0]))
        return placed
    if row.family != "crossing":
        plate = convex_hull([[x, y, z] for x in (-4.0, 4.0) for y in (-4.0, 4.0) for z in (-1.0, 0.0)])
        placed = PairInPlace(plate, _core(row), radii=(RADIUS, RADIUS))
        placed.place(0, (0.0, 0.0, 0.0))
        placed.place(1, (0.0, 0.0, 2.0 * RADIUS - row.overlap), Rotation.from_rotvec([0.0, -atan(row.tilt), 0.0]))
        return placed
    length = ENDLESS if row.length == inf else row.length
    if row.on_pile:
        below = _pile()
    else:
        below = convex_hull(_prism(length, -0.5 * length).vertices * [1.0, 1.0, -1.0])
    placed = PairInPlace(below, _prism(length, -0.5 * length), radii=(row.radius_other, RADIUS))
    placed.place(0, (0.0, 0.0, 0.0))
    turn = Rotation.from_rotvec([0.0, 0.0, radians(row.angle)])
    placed.place(1, (0.0, 0.0, row.radius_other + RADIUS - row.overlap), turn)
    return placed


def over_half_space(row: Row, *, pile: bool = False) -> float:
    """Force of `consistent` over that of the half space."""
    return float(hypot(*pair(row, pile=pile).press().force)) / row.force


def farthest(chosen: list[Row], *, pile: bool = False) -> float:
    """The ratio that is farthest from 1."""
    found = np.array([over_half_space(row, pile=pile) for row in chosen])
    return float(found[np.abs(found - 1.0).argmax()])

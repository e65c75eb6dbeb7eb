"""Outlines that are not convex, cut into convex parts: the triangles of a constrained Delaunay triangulation, joined again while
what they make is convex (Hertel & Mehlhorn 1983: at most four times as many parts as needed)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import shapely

from dilatedem.numerics.plain import norm

#: sine of the angle by which a corner may turn inwards and still count as straight: round-off
STRAIGHT = 1e-10

Corner = tuple[float, float]
Loop = list[Corner]


@dataclass(frozen=True, eq=False)
class Part:
    """A convex part: outline (k, 2) [m], counter-clockwise; cuts (c, 2, 2) [m]: ends of its sides that lie within the whole."""

    outline: np.ndarray
    cuts: np.ndarray

    @property
    def inner(self) -> np.ndarray:
        """(3,) length of the cuts [m], and its first moments about the origin [m2]."""
        length, middle = norm(self.cuts[:, 1] - self.cuts[:, 0]), self.cuts.mean(axis=1)
        return np.array([length.sum(), *(length[:, None] * middle).sum(axis=0)])


def convex_parts(polygon: shapely.Geometry) -> list[Part]:
    """The convex parts of a polygon without holes; it fills what they fill. Longest cuts are given up first."""
    triangles = shapely.get_parts(shapely.constrained_delaunay_triangles(polygon))
    loops: list[Loop] = [_counter_clockwise(triangle) for triangle in triangles]
    owner = list(range(len(loops)))
    left = []
    for p, q in sorted(_diagonals(loops), key=lambda ends: (-_length(*ends), ends)):
        a, b = (_owner_of(p, q, loops, owner), _owner_of(q, p, loops, owner))
        merged = _merged(loops[a], loops[b], p, q)
        if merged is None:
            left.append((p, q))
            continue
        loops[a] = merged
        loops[b] = []
    cuts = {side for p, q in left for side in ((p, q), (q, p))}
    return [_part(loop, cuts) for loop in loops if loop]


def _counter_clockwise(triangle: shapely.Geometry) -> Loop:
    corners = shapely.get_coordinates(shapely.orient_polygons(triangle).exterior)[:-1]
    return [(float(x), float(y)) for x, y in corners]


def _sides(loop: Loop) -> list[tuple[Corner, Corner]]:
    return list(zip(loop, [*loop[1:], *loop[:1]], strict=True))


def _diagonals(loops: list[Loop]) -> list[tuple[Corner, Corner]]:
    """Sides that two triangles share, once each."""
    sides = {side for loop in loops for side in _sides(loop)}
    return [(p, q) for p, q in sides if p < q and (q, p) in sides]


def _length(p: Corner, q: Corner) -> float:
    return float(norm(np.subtract(p, q)))


def _owner_of(p: Corner, q: Corner, loops: list[Loop], owner: list[int]) -> int:
    """The loop that has the side from p to q."""
    return next(number for number in owner if (p, q) in _sides(loops[number]))


def _merged(a: Loop, b: Loop, p: Corner, q: Corner) -> Loop | None:
    """Two loops, the first with the side from p to q, the second with that from q to p, as one; None where it is not convex."""
    around_a, around_b = _from(a, q), _from(b, p)
    loop = [*around_a, *around_b[1:-1]]  # q ... p, then from p to q by b
    for corner in (p, q):
        k = loop.index(corner)
        before, after = loop[k - 1], loop[(k + 1) % len(loop)]
        if _turn(before, corner, after) < -STRAIGHT * _length(before, corner) * _length(corner, after):
            return None
    return loop


def _from(loop: Loop, corner: Corner) -> Loop:
    """The same loop, begun at one of its corners."""
    k = loop.index(corner)
    return [*loop[k:], *loop[:k]]


def _turn(a: Corner, b: Corner, c: Corner) -> float:
    """Twice the area of the triangle a b c, positive to the left."""
    return (b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0])


def _part(loop: Loop, cuts: set[tuple[Corner, Corner]]) -> Part:
    own = [side for side in _sides(loop) if side in cuts]
    return Part(np.array(loop), np.array(own).reshape(-1, 2, 2))

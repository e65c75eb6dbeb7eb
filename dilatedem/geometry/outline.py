"""Convex outlines in plan: checking, moving inwards (to the core) and outwards (to the drawn floe).

Moving a convex outline inwards shortens its sides at constant rates until one vanishes; the neighbours of a
vanished side then meet, and the rest goes on. Sides vanish in an order that does not depend on the distance
asked for, so the result is exact. Many outlines of one number of sides are worked together as arrays.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import ArrayLike

from dilatedem.numerics.blocks import offsets, take
from dilatedem.numerics.plain import angle, dot, norm

# Relative to the size of the outline: corners nearer than this to each other, or to the line through their
# neighbours, are dropped, and so are sides that erosion leaves shorter; a corner that lies inwards by more
# than this makes the outline non-convex.
RESOLUTION = 1e-8
# A mitred corner that would reach further than this many offsets from its origin is bevelled there.
MITRE_LIMIT = 3.0


class Outlines(Sequence):
    """Many outlines in one array, read as a list of arrays (k, 2) [m].

    points  (p, 2) [m] corners of all outlines, one after the other
    start   (n + 1,) where the corners of each begin; the last entry is p
    """

    def __init__(self, points: np.ndarray, start: np.ndarray):
        self.points, self.start = points, start

    @classmethod
    def of(cls, outlines: Iterable[np.ndarray]) -> Outlines:
        """The same outlines in one array."""
        outlines = list(outlines)
        return cls(np.concatenate([np.zeros((0, 2)), *outlines]), offsets([len(outline) for outline in outlines]))

    def __len__(self) -> int:
        return len(self.start) - 1

    def __getitem__(self, i):
        if isinstance(i, slice):
            return [self[k] for k in range(*i.indices(len(self)))]
        if not -len(self) <= i < len(self):
            raise IndexError(i)
        i %= len(self)
        return self.points[self.start[i] : self.start[i + 1]]

    @property
    def sides(self) -> np.ndarray:
        """(n,) number of corners of each outline."""
        return np.diff(self.start)

    def where(self, wanted: np.ndarray) -> Outlines:
        """Those outlines that are `wanted` (n,), a mask."""
        return Outlines(self.points[np.repeat(wanted, self.sides)], offsets(self.sides[wanted]))

    def by_sides(self) -> list[tuple[np.ndarray, np.ndarray]]:
        """Outlines (m,) of k sides and their corners (m, k, 2), for each k, so that they can be worked as arrays."""
        sides = self.sides
        groups = []
        for k in np.unique(sides):
            index = np.flatnonzero(sides == k)
            groups.append((index, take(self.points, self.start[index], k)))
        return groups


def prepare(outline: ArrayLike) -> np.ndarray:
    """The outline as convex, counter-clockwise corners (n, 2) [m], none double, none within a side.

    Takes either sense of rotation, and a closing point equal to the first. Raises ValueError for an outline
    that is not convex, crosses itself, has no area, or holds a value that is not finite.
    """
    corners = np.asarray(outline, dtype=float)
    if corners.ndim != 2 or corners.shape[1] != 2 or len(corners) < 3:
        raise ValueError(f"the outline has shape {corners.shape}: must be (n, 2) with at least three points")
    if not np.isfinite(corners).all():
        raise ValueError("the outline holds a value that is not finite: every coordinate must be a number")
    size = float(np.ptp(corners, axis=0).max())
    if size == 0.0:
        raise ValueError("the outline has no area: its points coincide")
    distinct = norm(np.diff(corners, axis=0)) > RESOLUTION * size
    corners = corners[np.concatenate(([True], distinct))]
    if norm(corners[-1] - corners[0]) <= RESOLUTION * size:
        corners = corners[:-1]
    if len(corners) < 3 or abs(area(corners)) <= RESOLUTION * size**2:
        raise ValueError("the outline has no area, or crosses itself: give its corners in order around it")
    if area(corners) < 0.0:
        corners = np.roll(corners[::-1], 1, axis=0)
    while len(corners) >= 3:
        height = _height_over_neighbours(corners)
        if (height < -RESOLUTION * size).any():
            raise ValueError("the outline is not convex: give a convex one, or split the floe")
        if height.min() > RESOLUTION * size:
            break
        corners = np.delete(corners, height.argmin(), axis=0)
    side = np.roll(corners, -1, axis=0) - corners
    behind = np.roll(side, 1, axis=0)
    turn = angle(_cross(behind, side), dot(behind, side))
    if len(corners) < 3 or abs(turn.sum() - 2.0 * np.pi) > 1e-6:
        raise ValueError("the outline crosses itself: give its corners in order, once around")
    return np.ascontiguousarray(corners)


def thinned(outline: np.ndarray, tolerance: float) -> np.ndarray:
    """The convex counter-clockwise outline (n, 2) without corners that lie within `tolerance` [m] of what is left: (k, 2), k >= 3.

    No corner moves (Douglas & Peucker 1973), so that it stays convex and nothing of it lies outside of the outline given.
    """
    left = shapely.get_coordinates(shapely.simplify(shapely.Polygon(outline), tolerance, preserve_topology=True))[:-1]
    return np.ascontiguousarray(left if area(left) > 0.0 else left[::-1])


def area(outline: np.ndarray) -> float | np.ndarray:
    """Signed area [m2] of outlines (..., n, 2), positive when counter-clockwise."""
    local = outline - outline[..., :1, :]
    return 0.5 * _cross(local, np.roll(local, -1, axis=-2)).sum(axis=-1)


def perimeter(outline: np.ndarray) -> float | np.ndarray:
    """Length [m] around outlines (..., n, 2)."""
    return norm(np.roll(outline, -1, axis=-2) - outline).sum(axis=-1)


def centroid(outline: np.ndarray) -> np.ndarray:
    """Centroid (..., 2) [m] of the area inside outlines (..., n, 2)."""
    local = outline - outline[..., :1, :]
    ahead = np.roll(local, -1, axis=-2)
    weight = _cross(local, ahead)
    shift = (weight[..., None] * (local + ahead)).sum(axis=-2) / (3.0 * weight.sum(axis=-1)[..., None])
    return outline[..., 0, :] + shift


def erode(outline: np.ndarray, distance: float) -> np.ndarray:
    """The convex counter-clockwise outline (n, 2) moved inwards by `distance` [m]: (k, 2) with 3 <= k <= n.

    Raises ValueError when nothing is left.
    """
    for eroded in erode_together(np.asarray(outline, dtype=float)[None], distance):
        return eroded.corners[0]
    raise ValueError(f"the outline is too narrow: moved inwards by {distance:g} m, nothing is left of it")


@dataclass(frozen=True, eq=False)
class Eroded:
    """Outlines left with one and the same number of sides: which ones (m,), and their corners (m, k, 2)."""

    index: np.ndarray
    corners: np.ndarray


def erode_together(outlines: np.ndarray, distance: float) -> Iterator[Eroded]:
    """`erode` for many outlines (m, n, 2) at once, by number of sides left; vanished ones are left out."""
    index = np.arange(len(outlines))
    corners = np.array(outlines, dtype=float)
    side = np.roll(corners, -1, axis=1) - corners
    length = norm(side)
    direction = side / length[..., None]
    shortest = RESOLUTION * length.max(axis=1)
    while len(index):
        behind = np.roll(direction, 1, axis=1)
        sine, cosine = _cross(behind, direction), (behind * direction).sum(axis=2)
        closing = sine / (1.0 + cosine)  # tan(turn/2): how fast the sides beside a corner shorten
        shortening = closing + np.roll(closing, -1, axis=1)
        # What vanishes on the way goes first, in its order in time; then what would be left too short.
        vanishing, remaining = length / shortening, length - distance * shortening
        gone = vanishing.min(axis=1) <= distance
        lasting = ~gone & (remaining.min(axis=1) > shortest)
        if lasting.any():
            # corners run along the bisector of the inward normals (-t_y, t_x) of their two sides
            inward = np.stack((-direction[..., 1] - behind[..., 1], direction[..., 0] + behind[..., 0]), axis=-1)
            moved = corners + distance * inward / (1.0 + cosine)[..., None]
            yield Eroded(index[lasting], moved[lasting])
        going = ~lasting
        shed = np.where(gone, vanishing.argmin(axis=1), remaining.argmin(axis=1))[going]
        state = (corners[going], direction[going], length[going], sine[going], cosine[going])
        kept, corners, direction, length = _without_side(shed, *state)
        index, shortest = index[going][kept], shortest[going][kept]


def mitred(outline: np.ndarray, distance: float) -> np.ndarray:
    """The convex counter-clockwise outline (n, 2) moved outwards by `distance` [m] with sharp corners.

    Corners so acute that they would reach beyond MITRE_LIMIT * distance are bevelled there, so a needle of a
    floe keeps a sensible outline.
    """
    ((_, moved),) = mitred_together(np.asarray(outline)[None], distance)
    return moved[0]


def mitred_together(outlines: np.ndarray, distance: float) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """`mitred` for many outlines (m, n, 2) at once: which ones (l,), and their corners (l, k, 2), by the corners bevelled."""
    side = np.roll(outlines, -1, axis=1) - outlines
    after = side / norm(side)[..., None]
    before = np.roll(after, 1, axis=1)
    outward = np.stack((before[..., 1], -before[..., 0]), axis=-1), np.stack((after[..., 1], -after[..., 0]), axis=-1)
    cosine = dot(before, after)
    half = np.sqrt(np.maximum(0.5 * (1.0 + cosine), 0.0))  # cos(turn/2), the reach of a mitre being 1/half
    acute = half * MITRE_LIMIT < 1.0
    for pattern in np.unique(acute, axis=0):
        which = np.flatnonzero((acute == pattern).all(axis=1))
        moved = []
        for k, bevelled in enumerate(pattern):
            corner, ahead, behind = outlines[which, k], after[which, k], before[which, k]
            left, right = outward[0][which, k], outward[1][which, k]
            if not bevelled:
                moved.append(corner + distance * (left + right) / (1.0 + cosine[which, k])[:, None])
                continue
            reach = half[which, k]
            run = (distance * (MITRE_LIMIT - reach) / np.sqrt(1.0 - reach**2))[:, None]
            moved += [corner + distance * left + run * behind, corner + distance * right - run * ahead]
        yield which, np.stack(moved, axis=1)


def _without_side(
    shed: np.ndarray,
    corners: np.ndarray,
    direction: np.ndarray,
    length: np.ndarray,
    sine: np.ndarray,
    cosine: np.ndarray,
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Each outline with side `shed` (m,) taken out and its neighbours extended until they meet.

    Outlines whose neighbouring sides no longer meet on the outer side have vanished together with the side;
    the first result marks those that go on.
    """
    sides = length.shape[1]
    # The missing triangle over the side, by the law of sines: the apex is pi - (turn before + turn after)
    row = np.arange(len(shed))
    after = (shed + 1) % sides
    apex = sine[row, shed] * cosine[row, after] + cosine[row, shed] * sine[row, after]
    kept = (apex > RESOLUTION) & (sides > 3)

    shed, after, apex, row = shed[kept], after[kept], apex[kept], np.arange(kept.sum())
    corners, direction, length, sine = corners[kept], direction[kept], length[kept], sine[kept]
    before = (shed - 1) % sides
    run_before = length[row, shed] * sine[row, after] / apex
    run_after = length[row, shed] * sine[row, shed] / apex
    length[row, before] += run_before
    length[row, after] += run_after
    corners[row, after] = corners[row, shed] + run_before[:, None] * direction[row, before]
    remaining = np.arange(sides) != shed[:, None]
    shape = (len(row), sides - 1)
    return (
        kept,
        corners[remaining].reshape(*shape, 2),
        direction[remaining].reshape(*shape, 2),
        length[remaining].reshape(shape),
    )


def _cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def _height_over_neighbours(corners: np.ndarray) -> np.ndarray:
    """(n,) [m] how far each corner lies outside the line through its two neighbours."""
    before, after = np.roll(corners, 1, axis=0), np.roll(corners, -1, axis=0)
    chord = after - before
    length = norm(chord)
    return _cross(corners - before, chord) / np.where(length > 0.0, length, 1.0)

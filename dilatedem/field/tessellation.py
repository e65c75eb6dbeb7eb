"""Voronoi cells of points: of random ones, the pattern of cracks that floes are cut from (Liu 2015, section 3.1).

Both kinds of boundary come from copies of the points around the domain. Copies moved by a period make the
cells periodic: a cell may stick out across the seam and is kept whole. Mirrored copies make the domain's edge
itself a border of the cells: a point and its mirror image are equally far from the edge, and no other mirror
image can be nearer to a place inside. So neither kind needs clipping, and the cells tile the domain to
round-off.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from dilatedem.geometry.outline import Outlines, centroid
from dilatedem.geometry.qhull import Voronoi
from dilatedem.numerics.blocks import offsets
from dilatedem.numerics.plain import angle, norm

# Width of the belt of copies around the domain at the first try, in mean spacings of the points. Too narrow a
# belt is noticed and widened, so this only sets the cost.
BELT = 4.0
# Places along an edge of the grid whose squares Hilbert's curve goes through: a power of two.
PLACES = 2**16
# Corners of a cell nearer than this, relative to the mean spacing, are one corner: Voronoi vertices where
# more than three cells meet (every one on a mirrored edge) come out of the hull several times, round-off
# apart.
RESOLUTION = 1e-9


def order_in_space(points: np.ndarray) -> np.ndarray:
    """(n,) order in which Hilbert's curve meets points (n, 2) of no negative coordinate: what is near in it is near in space.

    The curve goes through all squares of a grid, quarter by quarter (Hilbert 1891); each quarter's is the whole one turned.
    """
    extent = float(points.max(initial=0.0)) or 1.0
    x, y = np.minimum(points * (PLACES / extent), PLACES - 1).astype(np.int64).T
    place, side = np.zeros(len(points), np.int64), PLACES // 2
    while side:
        right, upper = (x & side) > 0, (y & side) > 0
        place += side * side * ((3 * right) ^ upper)
        mirrored, turned = right & ~upper, ~upper
        x, y = np.where(mirrored, PLACES - 1 - x, x), np.where(mirrored, PLACES - 1 - y, y)
        x, y = np.where(turned, y, x), np.where(turned, x, y)
        side //= 2
    return np.argsort(place, kind="stable")


def cells_of_points(points: np.ndarray, size: np.ndarray, periodic: Sequence[bool]) -> Outlines:
    """Voronoi cells of `points` (n, 2) [m] in a domain, which they tile.

    size      (2,) [m], the domain, centred on the origin
    periodic  whether the x and the y boundaries are periodic; cells end at the others

    Returns convex counter-clockwise outlines (k, 2) [m], one a point.
    """
    spacing = float(np.sqrt(np.prod(size) / len(points)))
    belt = BELT * spacing
    while True:
        around = with_copies(points, size, periodic, belt)
        diagram = Voronoi(around)
        corner, start = _sorted_corners(diagram, len(points))
        if _belt_suffices(diagram, corner, start, points, size, belt):
            break
        belt *= 2.0

    return distinct_corners(on_sides(diagram.vertices[corner], size, periodic, spacing), start, spacing)


def on_sides(corners: np.ndarray, size: np.ndarray, periodic: Sequence[bool], spacing: float) -> np.ndarray:
    """Corners (c, 2) [m], those that round-off has moved off a side of the domain back on it."""
    position = corners.copy()
    for axis in range(2):
        if not periodic[axis]:
            half = 0.5 * size[axis]
            on_edge = np.abs(np.abs(position[:, axis]) - half) <= RESOLUTION * spacing
            position[on_edge, axis] = np.copysign(half, position[on_edge, axis])
    return position


def distinct_corners(corners: np.ndarray, start: np.ndarray, spacing: float) -> Outlines:
    """Cells as outlines, of corners (c, 2) [m] that may be there several times; start (n + 1,): where those of a cell begin."""
    cell = np.repeat(np.arange(len(start) - 1), np.diff(start))
    distinct = norm(corners[_next_in_cell(start)] - corners) > RESOLUTION * spacing
    return Outlines(corners[distinct], offsets(np.bincount(cell[distinct], minlength=len(start) - 1)))


def centroids(cells: Outlines, size: np.ndarray, periodic: Sequence[bool]) -> np.ndarray:
    """(n, 2) [m] centroids of cells, brought into a periodic domain."""
    middle = np.empty((len(cells), 2))
    for index, corners in cells.by_sides():
        middle[index] = centroid(corners)
    return middle - np.where(periodic, size * np.floor(middle / size + 0.5), 0.0)


def with_copies(points: np.ndarray, size: np.ndarray, periodic: Sequence[bool], belt: float) -> np.ndarray:
    """The points, then their periodic or mirror images within `belt` [m] of the domain.

    points (n, 2 or more): what stands behind x and y goes along.
    """
    for axis in range(2):
        half = 0.5 * size[axis]
        copies = [points]
        # image k lies k periods away; mirror images of mirror images alternate with plain shifts
        for k in range(1, int(np.ceil(belt / size[axis])) + 1):
            for sign in (-1.0, 1.0):
                image = points.copy()
                if not periodic[axis] and k % 2 == 1:
                    image[:, axis] *= -1.0
                image[:, axis] += sign * k * size[axis]
                copies.append(image[np.abs(image[:, axis]) <= half + belt])
        points = np.concatenate(copies)
    return points


def _sorted_corners(diagram: Voronoi, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Voronoi vertices (k,) around each of the first `count` points, counter-clockwise, and starts."""
    regions = [diagram.regions[r] for r in diagram.point_region[:count]]
    start = offsets([len(region) for region in regions])
    corner = np.fromiter((v for region in regions for v in region), dtype=np.int64, count=start[-1])
    cell = np.repeat(np.arange(count), np.diff(start))
    away = diagram.vertices[corner] - diagram.points[cell]
    return corner[np.lexsort((angle(away[:, 1], away[:, 0]), cell))], start


def _belt_suffices(
    diagram: Voronoi, corner: np.ndarray, start: np.ndarray, points: np.ndarray, size: np.ndarray, belt: float
) -> bool:
    """Whether no copy outside the belt could cut a cell.

    A Voronoi vertex stands if the circle about it through its points holds no other point; so that circle
    must lie where all copies are present.
    """
    if (corner < 0).any():
        return False
    cell = np.repeat(np.arange(len(points)), np.diff(start))
    position = diagram.vertices[corner]
    reach = norm(position - points[cell])[:, None]
    return bool((np.abs(position) + reach <= 0.5 * size + belt).all())


def _next_in_cell(start: np.ndarray) -> np.ndarray:
    """(k,) index of the corner that follows each corner around its own cell."""
    ahead = np.arange(1, start[-1] + 1)
    ahead[start[1:] - 1] = start[:-1]
    return ahead

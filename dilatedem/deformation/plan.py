"""A convex polygon cut into triangles of about one size, all of good shape."""

import numpy as np
from scipy.spatial import Delaunay

#: distance from the sides, in sizes of a triangle, within which no point is put
CLEAR = 0.6
#: how often points are moved to the mean of their neighbours
ROUNDS = 12
#: area of a triangle over the square of the size, below which it is a sliver along a side that round-off made
SLIVER = 1e-8


def triangulated(outline: np.ndarray, size: float) -> tuple[np.ndarray, np.ndarray]:
    """Points (n, 2) and triangles (t, 3), counter-clockwise, that fill a convex counter-clockwise `outline` (k, 2) [m].

    Sides are cut into equal pieces no longer than `size` [m]; their points come first, in the order of the outline. Within, the
    points of a lattice of equilateral triangles, each moved to the mean of its neighbours some times.
    """
    rim = subdivided(outline, size)
    inside = _lattice(outline, size)
    for _ in range(ROUNDS if len(inside) else 0):
        inside = _smoothed(np.concatenate((rim, inside)), len(rim), size)
    points = np.concatenate((rim, inside))
    return points, _triangles(points, size)


def subdivided(loop: np.ndarray, size: float) -> np.ndarray:
    """The corners (k, d) of a closed loop and points that cut its sides into equal pieces no longer than `size`."""
    pieces = [between(a, b, size)[:-1] for a, b in zip(loop, np.roll(loop, -1, axis=0), strict=True)]
    return np.concatenate(pieces)


def between(a: np.ndarray, b: np.ndarray, size: float) -> np.ndarray:
    """Points from a to b, both included, no further than `size` from each other; from b to a they are the same ones."""
    count = int(np.ceil(np.sqrt(((b - a) ** 2).sum()) / size * (1.0 - 1e-9)))
    share = np.arange(count + 1)[:, None] / count
    return (1.0 - share) * a + share * b


def depths(outline: np.ndarray, points: np.ndarray) -> np.ndarray:
    """(n,) distance [m] of points (n, 2) from the nearest side of a convex counter-clockwise outline, positive within."""
    along = np.roll(outline, -1, axis=0) - outline
    inward = np.column_stack((-along[:, 1], along[:, 0])) / np.sqrt((along**2).sum(axis=1))[:, None]
    return ((points[:, None, :] - outline) * inward).sum(axis=-1).min(axis=1)


def _lattice(outline: np.ndarray, size: float) -> np.ndarray:
    """Points of an equilateral lattice about the middle of the outline, those that are clear of its sides."""
    low, high = outline.min(axis=0), outline.max(axis=0)
    step = np.array([size, size * np.sqrt(0.75)])
    half = np.ceil(0.5 * (high - low) / step).astype(int) + 1
    column, row = np.meshgrid(np.arange(-half[0], half[0] + 1), np.arange(-half[1], half[1] + 1))
    cells = np.column_stack(((column + 0.5 * (row % 2)).ravel(), row.ravel()))
    points = 0.5 * (low + high) + cells * step
    return points[depths(outline, points) > CLEAR * size]


def _smoothed(points: np.ndarray, fixed: int, size: float) -> np.ndarray:
    """The points behind the first `fixed` ones, each at the mean of its neighbours."""
    triangles = _triangles(points, size)
    start, end = triangles[:, [0, 1, 2, 1, 2, 0]].ravel(), triangles[:, [1, 2, 0, 0, 1, 2]].ravel()
    total, count = np.zeros_like(points), np.bincount(start, minlength=len(points))
    np.add.at(total, start, points[end])
    return (total / count[:, None])[fixed:]


def _triangles(points: np.ndarray, size: float) -> np.ndarray:
    """The Delaunay triangles, counter-clockwise, in an order that their points alone give."""
    corners = Delaunay(points).simplices.astype(np.int64)
    a, b, c = (points[corners[:, k]] for k in range(3))
    area = 0.5 * ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])
    corners[area < 0.0] = corners[area < 0.0][:, ::-1]
    corners = corners[np.abs(area) > SLIVER * size * size]
    return corners[np.lexsort(np.sort(corners, axis=1).T[::-1])]

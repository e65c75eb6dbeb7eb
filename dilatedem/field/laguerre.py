"""Cells of prescribed areas: a power diagram, which is what Voronoi's becomes where each point has a weight.

A place belongs to the point p for which |x - p|^2 - w is least (Aurenhammer 1987). Cells are convex and tile the domain; the more
weight, the larger. There is one set of weights, up to a constant, for which the cells have areas given beforehand; Newton's method,
damped so that no cell vanishes on the way, finds it from any points (Kitagawa, Merigot & Thibert 2019). The diagram itself is the
lower hull of the points lifted to height |p|^2 - w. Copies around the domain make its boundaries, as in `field.tessellation`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from dilatedem.field.tessellation import BELT, centroids, distinct_corners, on_sides, with_copies
from dilatedem.geometry.outline import Outlines
from dilatedem.geometry.qhull import ConvexHull
from dilatedem.numerics.blocks import offsets
from dilatedem.numerics.plain import angle, dot, norm

#: each area is met to this part of it
EXACT = 1e-9
#: the same while points are still being moved
NEARLY = 0.2
#: steps of Newton's method, at most; from random points it takes 5 to 20
MOST_STEPS = 200
#: rounds of moving each point to the middle of its cell before cells are of use: large cells that were thrown among small ones push
#: them aside, which leaves needles
SETTLING = 8
#: residual at which a linear system counts as solved, relative to its right side; Newton's method mends the rest
SOLVED = 1e-8


@dataclass(frozen=True, eq=False)
class Diagram:
    """Cells (n) as corners (c, 2) [m] one cell after the other, each counter-clockwise, and where each begins (n + 1,).

    area (n,) [m2]; first, second (e,): cells that share a side, each both ways round; coupling (e,): how much area goes from the
    second to the first per unit of weight, the length of that side over twice the distance of the points (of images, as it lies).
    """

    corners: np.ndarray
    start: np.ndarray
    area: np.ndarray
    first: np.ndarray
    second: np.ndarray
    coupling: np.ndarray


def nuclei_of_areas(
    points: np.ndarray, areas: np.ndarray, size: np.ndarray, periodic: Sequence[bool], regularity: int
) -> tuple[np.ndarray, np.ndarray]:
    """Points (n, 2) [m] near those given and weights (n,) [m2], with which cells have `areas` (n,) [m2], which fill the domain.

    Points move to the middles of their cells SETTLING + `regularity` times before. Raises ValueError where that cannot be.
    """
    points, weights = settled(points, areas, size, periodic, regularity)
    return points, weights_of_areas(points, weights, areas, size, periodic)


def settled(
    points: np.ndarray, areas: np.ndarray, size: np.ndarray, periodic: Sequence[bool], regularity: int
) -> tuple[np.ndarray, np.ndarray]:
    """The same points after they have moved, and weights with which their cells have about those areas."""
    weights = np.zeros(len(points))
    for _ in range(SETTLING + regularity):
        weights, diagram = _fitted(points, weights, areas, size, periodic, NEARLY)
        points = centroids(Outlines(diagram.corners, diagram.start), size, periodic)
    return points, weights


def weights_of_areas(
    points: np.ndarray,
    weights: np.ndarray,
    areas: np.ndarray,
    size: np.ndarray,
    periodic: Sequence[bool],
    free: np.ndarray | None = None,
) -> np.ndarray:
    """(n,) [m2] the weights with which cells have `areas` (n,) [m2]; `weights`: a first guess.

    free (n,): whose weights are sought, and whose areas are met, the others held as they are given; None: of all.
    """
    return _fitted(points, weights, areas, size, periodic, EXACT, free)[0]


def cells_of_weights(
    points: np.ndarray, weights: np.ndarray, size: np.ndarray, periodic: Sequence[bool], first: int | None = None
) -> Outlines:
    """The cells of points (n, 2) [m] in the domain with `weights` (n,) [m2], as outlines; first: of so many points alone.

    Raises ValueError for an empty one.
    """
    diagram, count = power_diagram(points, weights, size, periodic), len(points) if first is None else first
    if empty := int(np.count_nonzero(diagram.area[:count] <= 0.0)):
        raise ValueError(f"{empty} of {count} cells are empty")
    spacing = float(np.sqrt(np.prod(size) / len(points)))
    start = diagram.start[: count + 1]
    return distinct_corners(on_sides(diagram.corners[: start[-1]], size, periodic, spacing), start, spacing)


def _fitted(
    points: np.ndarray,
    weights: np.ndarray,
    areas: np.ndarray,
    size: np.ndarray,
    periodic: Sequence[bool],
    tolerance: float,
    free: np.ndarray | None = None,
) -> tuple[np.ndarray, Diagram]:
    """Weights for which each cell that is `free` has its area, to `tolerance` of it, and the cells; `weights`: a first guess."""
    weights, diagram = _begun(points, weights, areas, size, periodic, free)
    asked = slice(None) if free is None else free
    least = 0.5 * min(diagram.area[asked].min(), areas.min())
    for _ in range(MOST_STEPS):
        lack = _lack(areas, diagram, free)
        if (np.abs(lack) <= tolerance * areas).all():
            break
        step, share = _solution(diagram, lack, free), 1.0
        while share > EXACT:
            tried = weights + share * step
            attempt = power_diagram(points, tried, size, periodic)
            if attempt.area[asked].min() >= least and norm(_lack(areas, attempt, free)) <= (1.0 - 0.5 * share) * norm(lack):
                break
            share *= 0.5
        else:  # round-off: it comes no nearer
            break
        weights, diagram = tried - tried.mean() if free is None else tried, attempt
    return weights, diagram


def _begun(
    points: np.ndarray, weights: np.ndarray, areas: np.ndarray, size: np.ndarray, periodic: Sequence[bool], free: np.ndarray | None
) -> tuple[np.ndarray, Diagram]:
    """A first guess of which no cell that is `free` is empty, and its cells."""
    diagram = power_diagram(points, weights, size, periodic)
    if free is None and diagram.area.min() <= 0.0:  # of Voronoi's diagram no cell is
        weights = np.zeros(len(points))
        return weights, power_diagram(points, weights, size, periodic)
    for _ in range(MOST_STEPS):
        empty = [] if free is None else np.flatnonzero(free & (diagram.area <= 0.0))
        if not len(empty):
            break
        weights = weights.copy()
        for i in empty:  # so much that its point, and some place around, is its own
            away = points - points[i]
            away -= np.where(periodic, size * np.round(away / size), 0.0)
            power = dot(away, away) - weights
            power[i] = np.inf
            weights[i] = areas[i] / (4.0 * np.pi) - power.min()
        diagram = power_diagram(points, weights, size, periodic)
    return weights, diagram


def _lack(areas: np.ndarray, diagram: Diagram, free: np.ndarray | None) -> np.ndarray:
    """(n,) [m2] what cells lack of their areas; of those that are held nothing is asked."""
    return areas - diagram.area if free is None else np.where(free, areas - diagram.area, 0.0)


def _solution(diagram: Diagram, lack: np.ndarray, free: np.ndarray | None) -> np.ndarray:
    """Changes of the weights [m2] that make up for areas `lack` (n,) [m2], to first order: by conjugate gradients.

    Of those that are `free` alone, where others are held: what a change takes from these is theirs to bear.
    """
    count = len(lack)
    diagonal = np.bincount(diagram.first, diagram.coupling, count)
    if free is not None:
        diagonal[~free] = 1.0  # where they lie in belts of others, they may even be empty

    def gained(weights: np.ndarray) -> np.ndarray:
        gain = diagonal * weights - np.bincount(diagram.first, diagram.coupling * weights[diagram.second], count)
        return gain if free is None else np.where(free, gain, 0.0)

    change, rest = np.zeros(count), lack - lack.mean() if free is None else lack
    eased = rest / diagonal
    direction, product = eased, float(dot(rest, eased))
    limit = SOLVED * float(norm(rest))
    for _ in range(10 * count):
        if float(norm(rest)) <= limit:
            break
        gain = gained(direction)
        share = product / float(dot(direction, gain))
        change, rest = change + share * direction, rest - share * gain
        eased = rest / diagonal
        before, product = product, float(dot(rest, eased))
        direction = eased + product / before * direction
    return change


def power_diagram(points: np.ndarray, weights: np.ndarray, size: np.ndarray, periodic: Sequence[bool]) -> Diagram:
    """The cells of points (n, 2) [m] in the domain with `weights` (n,) [m2]; those of too little weight have no corners."""
    count = len(points)
    belt = BELT * float(np.sqrt(np.prod(size) / count))
    weights = weights - weights.min()
    while True:
        around = with_copies(np.column_stack([points, weights, np.arange(count)]), size, periodic, belt)
        triangles, neighbours = _lower_hull(around[:, :2], around[:, 2])
        places = _centres(around[:, :2], around[:, 2], triangles)
        row, side = np.nonzero(triangles < count)
        cell = triangles[row, side]
        away = places[row] - points[cell]
        # a copy q cuts off a corner where |corner - q|^2 - w is less there than for the corner's own point
        reach = np.sqrt(np.maximum(dot(away, away) - weights[cell] + weights.max(), 0.0))
        if (np.abs(places[row]) + reach[:, None] <= 0.5 * size + belt).all():
            break
        belt *= 2.0
    start = offsets(np.bincount(cell, minlength=count))
    corners = _around(places[row], cell, start, points)
    first, second, coupling = _sides(around, triangles, neighbours, places, count)
    return Diagram(corners, start, _areas(corners, start), first, second, coupling)


def _lower_hull(points: np.ndarray, weights: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Triangles (t, 3) of points that see the same corner of cells, and the triangle opposite each of their points; -1 = none."""
    hull = ConvexHull(np.column_stack([points, dot(points, points) - weights]))
    lower = hull.equations[:, 2] < 0.0
    number = np.where(lower, np.cumsum(lower) - 1, -1)
    return hull.simplices[lower], number[hull.neighbors[lower]]


def _centres(points: np.ndarray, weights: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """(t, 2) [m] the places that are equally far, in |x - p|^2 - w, from the three points of each triangle."""
    origin, *others = (points[triangles[:, k]] for k in range(3))
    (ax, ay), (bx, by) = (2.0 * (other - origin).T for other in others)
    a, b = (
        dot(other - origin, other - origin) - weights[triangles[:, k]] + weights[triangles[:, 0]]
        for k, other in enumerate(others, start=1)
    )
    spanned = ax * by - ay * bx
    return origin + np.column_stack([by * a - ay * b, ax * b - bx * a]) / spanned[:, None]


def _around(corners: np.ndarray, cell: np.ndarray, start: np.ndarray, points: np.ndarray) -> np.ndarray:
    """The corners (c, 2), each of its `cell` (c,), one cell after the other and each counter-clockwise."""
    count = np.maximum(np.diff(start), 1)
    middle = np.column_stack([np.bincount(cell, corners[:, k], len(points)) / count for k in range(2)])
    away = corners - middle[cell]
    return corners[np.lexsort((angle(away[:, 1], away[:, 0]), cell))]


def _areas(corners: np.ndarray, start: np.ndarray) -> np.ndarray:
    """(n,) areas [m2] of cells that may have no corners."""
    cell = np.repeat(np.arange(len(start) - 1), np.diff(start))
    local = corners - corners[start[cell]]
    ahead = np.arange(1, len(corners) + 1)
    last = start[1:][np.diff(start) > 0] - 1
    ahead[last] = start[:-1][np.diff(start) > 0]
    cross = local[:, 0] * local[ahead, 1] - local[:, 1] * local[ahead, 0]
    return 0.5 * np.bincount(cell, cross, len(start) - 1)


def _sides(
    around: np.ndarray, triangles: np.ndarray, neighbours: np.ndarray, places: np.ndarray, count: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Cells on both sides of each side that a cell of the domain has, and how they are coupled; see `Diagram`."""
    owner = around[:, 3].astype(np.int64)
    found = []
    for k in range(3):
        here = np.flatnonzero(neighbours[:, k] > np.arange(len(triangles)))  # each side once
        a, b = triangles[here, (k + 1) % 3], triangles[here, (k + 2) % 3]
        length = norm(places[neighbours[here, k]] - places[here])
        coupling = length / (2.0 * norm(around[a, :2] - around[b, :2]))
        for one, other in ((a, b), (b, a)):
            inside = one < count
            found.append((one[inside], owner[other[inside]], coupling[inside]))
    first, second, coupling = (np.concatenate(column) for column in zip(*found, strict=True))
    return first, second, coupling

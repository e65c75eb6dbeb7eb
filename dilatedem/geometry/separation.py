"""Distance of two convex cores, or how deep they are in each other, in NumPy: for the few pairs that are looked at before a run.

What `contact.search` finds in compiled code, by another road and without compiling. Distance: the point of the Minkowski difference
nearest to the origin, by the corners that span it (Gilbert, Johnson & Keerthi 1988), each set of at most four looked at in full.
Depth: the shortest of all separating translations, along the normals of faces and of crossing edges.
"""

from itertools import combinations

import numpy as np

from dilatedem.geometry.polyhedron import Polyhedron

#: relative gain in squared distance below which the search ends
CONVERGED = 1e-13
#: distance over the extent of both cores below which they count as intersecting: far above round-off, far below any overlap
TOUCHING = 1e-10
#: searches that take longer cycle on round-off and have converged
MOST_ROUNDS = 64
#: squared sine of the angle of two edges below which they have no common normal
PARALLEL_EDGES = 1e-16
#: directions of edges that differ by less than this are one
SAME_DIRECTION = 1e-9
#: axes that are worked together at most
AT_ONCE = 4096


def core_distance(a: Polyhedron, b: Polyhedron) -> float:
    """Signed distance [m] of two cores in one frame; negative: the depth of their intersection."""
    extent = float(np.ptp(np.concatenate([a.vertices, b.vertices]), axis=0).max())
    distance = _distance(a.vertices, b.vertices)
    if distance > TOUCHING * extent:
        return distance
    return -_depth(a, b)


def cone_distance(core: Polyhedron, axis: np.ndarray, radii: np.ndarray) -> float:
    """Signed distance [m] of a core from the hull of two spheres about the ends `axis` (2, 3) [m], of the radii (2,) [m].

    Beside the side of that cone an edge of the core is closest, or a corner, as the gap has no least value within a face; past its
    ends the spheres are. Where the axis is in the core: less than nothing by the larger radius.
    """
    length = float(np.linalg.norm(axis[1] - axis[0]))
    if core_distance(core, Polyhedron(axis, np.array([[0, 1]]), (), np.zeros((0, 3)))) <= 0.0:
        return -float(radii.max())
    ends = [_distance(core.vertices, end[None]) - radius for end, radius in zip(axis, radii, strict=True)]
    taper = (radii[1] - radii[0]) / length
    return min(*ends, _distance_from_side(core, axis[0], (axis[1] - axis[0]) / length, length, radii[0], taper))


def _distance_from_side(core: Polyhedron, start: np.ndarray, unit: np.ndarray, length: float, radius: float, taper: float) -> float:
    """Distance [m] of a core's edges from the side of a cone: of spheres whose radius grows by `taper` along its axis."""
    lean = taper / np.sqrt(1.0 - taper * taper)
    first, edge = core.vertices[core.edges[:, 0]] - start, core.vertices[core.edges[:, 1]] - core.vertices[core.edges[:, 0]]
    rise = edge @ unit
    flat, level, tilt = first - np.outer(first @ unit, unit), edge - np.outer(rise, unit), lean * rise
    square = np.vecdot(level, level)
    # the gap cosine rho - taper z is least where rho' = lean z'; along steeper edges at an end
    steep = square <= tilt * tilt
    divisor = np.where(steep, 1.0, square)
    foot = -np.vecdot(flat, level) / divisor
    nearest = np.linalg.norm(flat + foot[:, None] * level, axis=1)
    place = foot + tilt * nearest / np.sqrt(np.where(steep, 1.0, square * (square - tilt * tilt)))
    place = np.clip(np.where(steep, (tilt > 0.0).astype(float), place), 0.0, 1.0)
    point = first + place[:, None] * edge
    height = point @ unit
    rho = np.linalg.norm(point - np.outer(height, unit), axis=1)
    centre = np.clip(height + lean * rho, 0.0, length)
    return float((np.hypot(rho, height - centre) - radius - taper * centre).min(initial=np.inf))


def _distance(a: np.ndarray, b: np.ndarray) -> float:
    """Distance [m] of the convex hulls of points (m, 3) and (n, 3) [m]; 0 where they meet."""
    corners = [b[0] - a[0]]
    nearest, last = corners[0], np.inf
    for _ in range(MOST_ROUNDS):
        square = float(nearest @ nearest)
        if square == 0.0 or square >= last:
            break
        last = square
        corner = b[np.argmin(b @ nearest)] - a[np.argmax(a @ nearest)]
        if square - float(nearest @ corner) <= CONVERGED * square:
            break
        nearest, corners = _nearest_of(np.array([*corners, corner]))
    return float(np.sqrt(min(nearest @ nearest, last)))


def _nearest_of(points: np.ndarray) -> tuple[np.ndarray, list[np.ndarray]]:
    """The point of the hull of 1 to 5 points (n, 3) nearest to the origin, and those of them that span it (4 at most)."""
    best, at, chosen = np.inf, points[0], [points[0]]
    for count in range(1, min(len(points), 4) + 1):
        for which in combinations(range(len(points)), count):
            some = points[list(which)]
            weight = _weights(some)
            if weight is None or weight.min() < 0.0:
                continue
            place = weight @ some
            square = float(place @ place)
            if square < best:
                best, at, chosen = square, place, list(some)
    return at, chosen


def _weights(points: np.ndarray) -> np.ndarray | None:
    """Weights (n,) of sum 1 of the point nearest to the origin in the affine hull of points (n, 3); None for dependent ones."""
    if len(points) == 1:
        return np.ones(1)
    edges = points[1:] - points[0]
    gram = edges @ edges.T
    try:
        rest = np.linalg.solve(gram, -edges @ points[0])
    except np.linalg.LinAlgError:
        return None
    return np.concatenate([[1.0 - rest.sum()], rest])


def _depth(a: Polyhedron, b: Polyhedron) -> float:
    """How far b must be moved at least to be clear of a [m]."""
    axes = np.concatenate([a.normals, -b.normals, *_crossings(_directions(a), _directions(b))])
    least = np.inf
    for first in range(0, len(axes), AT_ONCE):
        some = axes[first : first + AT_ONCE]
        least = min(least, float(((a.vertices @ some.T).max(axis=0) - (b.vertices @ some.T).min(axis=0)).min()))
    return max(least, 0.0) if len(axes) else 0.0


def _directions(core: Polyhedron) -> np.ndarray:
    """(k, 3) unit directions of a core's edges, each once whatever its sense."""
    along = core.vertices[core.edges[:, 1]] - core.vertices[core.edges[:, 0]]
    along = along / np.linalg.norm(along, axis=1, keepdims=True)
    strongest = np.take_along_axis(along, np.abs(along).argmax(axis=1)[:, None], axis=1)
    along = along * np.sign(strongest)
    _, first = np.unique(np.round(along / SAME_DIRECTION), axis=0, return_index=True)
    return along[first]


def _crossings(a: np.ndarray, b: np.ndarray) -> list[np.ndarray]:
    """Unit normals common to one of the directions a (m, 3) and one of b (n, 3), in both senses."""
    normal = np.cross(a[:, None], b[None]).reshape(-1, 3)
    square = np.vecdot(normal, normal)
    normal = normal[square > PARALLEL_EDGES] / np.sqrt(square[square > PARALLEL_EDGES])[:, None]
    return [normal, -normal]

"""Convex solids as what is common to half spaces: of given planes, moved inwards, cut to a range of heights."""

import numpy as np

from dilatedem.geometry.polyhedron import Polyhedron, convex_hull
from dilatedem.geometry.qhull import HalfspaceIntersection, QhullError
from dilatedem.numerics.plain import dot, norm

#: radius of the largest ball over the extent below which a solid is taken for empty
EMPTY = 1e-9


def of_half_spaces(normal: np.ndarray, offset: np.ndarray) -> Polyhedron:
    """All x with normal . x <= offset; normal (k, 3) unit vectors, offset (k,) [m]. Raises ValueError where there is no room."""
    middle, radius = largest_ball(normal, offset)
    depth = offset - dot(normal, middle)
    size = float(depth.max())
    if radius <= EMPTY * size:
        raise ValueError("nothing is left of the solid: its sides meet too soon")
    try:
        corners = HalfspaceIntersection(np.column_stack((normal, -depth / size)), np.zeros(3)).intersections
    except QhullError as fault:
        raise ValueError("the sides of the solid enclose nothing: they are too close to degenerate") from fault
    return convex_hull(middle + size * corners)


def moved_inwards(body: Polyhedron, distance: float) -> Polyhedron:
    """The convex solid with all its sides moved inwards by `distance` [m]: the core whose dilation rounds its edges and corners.

    Raises ValueError, which says what may be taken off, where nothing is left.
    """
    offset = np.array([dot(body.vertices[loop], normal).mean() for loop, normal in zip(body.faces, body.normals, strict=True)])
    _, most = largest_ball(body.normals, offset)
    if distance >= most:
        raise ValueError(f"dilated_radius = {distance:g}: must be less than {most:.3g} m, the radius of the largest ball in it")
    return of_half_spaces(body.normals, offset - distance)


def largest_ball(normal: np.ndarray, offset: np.ndarray) -> tuple[np.ndarray, float]:
    """Centre (3,) and radius [m] of the largest ball in the half spaces of `of_half_spaces`; negative where they hold none."""
    from scipy.optimize import linprog  # it takes a quarter of a second to load, and few cases need it

    reach = float(np.abs(offset).max()) or 1.0
    rows = np.column_stack((normal, norm(normal)))
    found = linprog([0.0, 0.0, 0.0, -1.0], A_ub=rows, b_ub=offset / reach, bounds=[(None, None)] * 4, method="highs")
    if found.status != 0:
        raise ValueError("the sides of the solid do not close around it")
    return reach * found.x[:3], float(reach * found.x[3])


def between(body: Polyhedron, low: float, high: float) -> np.ndarray:
    """(k, 3) [m] corners of what of a convex solid lies between two heights, which may be one; none where nothing does."""
    z = body.vertices[:, 2]
    found = [body.vertices[(z >= low) & (z <= high)]]
    start, end = body.vertices[body.edges[:, 0]], body.vertices[body.edges[:, 1]]
    for level in (low, high):
        crossing = (start[:, 2] - level) * (end[:, 2] - level) < 0.0
        a, b = start[crossing], end[crossing]
        found.append(a + ((level - a[:, 2]) / (b[:, 2] - a[:, 2]))[:, None] * (b - a))
    return np.concatenate(found)

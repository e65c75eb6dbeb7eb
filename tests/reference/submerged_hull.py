"""Submerged part of a convex polyhedron by slow and obvious means: the corners below water and the points where edges pass
it, hulled.
"""

import numpy as np
from scipy.spatial import ConvexHull

from dilatedem.geometry.polyhedron import Polyhedron


def submerged(outer: Polyhedron, turn: np.ndarray, height: float) -> tuple[float, np.ndarray, float]:
    """Volume [m3], its centroid (3,) in body coordinates [m] and the wetted area [m2] below z = 0 of a polyhedron turned by
    the matrix `turn`, its origin at z = `height`."""
    up = turn[2]
    level = outer.vertices @ up + height
    points = [outer.vertices[level <= 0.0]]
    for i, j in outer.edges:
        if (level[i] < 0.0) != (level[j] < 0.0):
            t = level[i] / (level[i] - level[j])
            points.append((outer.vertices[i] + t * (outer.vertices[j] - outer.vertices[i]))[None])
    points = np.concatenate(points)
    if len(points) < 4:
        return 0.0, np.zeros(3), 0.0
    hull = ConvexHull(points)
    inside = points.mean(axis=0)
    volume, moment, wetted = 0.0, np.zeros(3), 0.0
    for simplex, equation in zip(hull.simplices, hull.equations, strict=True):
        corners = points[simplex]
        part = abs(np.linalg.det(corners - inside)) / 6
        volume += part
        moment += part * (corners.sum(axis=0) + inside) / 4
        on_the_water = equation[:3] @ up > 1 - 1e-9 and np.abs(corners @ up + height).max() < 1e-9
        if not on_the_water:
            wetted += 0.5 * np.linalg.norm(np.cross(corners[1] - corners[0], corners[2] - corners[0]))
    return volume, moment / volume, wetted

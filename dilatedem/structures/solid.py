"""What kinds of structures share that are sharp convex solids with rounded edges."""

import numpy as np

from dilatedem.field.obstacles import Obstacle, Region
from dilatedem.geometry.half_spaces import between, moved_inwards
from dilatedem.geometry.outline import area
from dilatedem.geometry.polyhedron import Polyhedron, convex_hull
from dilatedem.geometry.shapes import BodyShape
from dilatedem.numerics.plain import norm
from dilatedem.structures.kind import UPRIGHT, Part


def rounded(solid: Polyhedron, radius: float) -> Part:
    """A solid in world coordinates with edges and corners rounded by `radius` [m]. Raises ValueError for too large a radius."""
    shape, middle = BodyShape.of_core(moved_inwards(solid, radius), radius)
    return Part(middle, UPRIGHT, shape, plan_reach=float(norm(shape.core.vertices[:, :2]).max()) + radius)


def obstacles(solid: Polyhedron, thickness: float) -> list[Obstacle]:
    """What of it lies between the heights that a floe of this thickness [m] can take up."""
    points = between(solid, -thickness, thickness)
    return [Region(points[:, :2])] if len(points) else []


def hull_in_plan(points: np.ndarray) -> np.ndarray:
    """Convex outline (k, 2) [m] of points (n, 2 or 3) [m] seen from above, counter-clockwise."""
    hull = convex_hull(np.column_stack([points[:, :2], np.zeros(len(points))])).vertices[:, :2]
    return hull if area(hull) > 0.0 else np.ascontiguousarray(hull[::-1])

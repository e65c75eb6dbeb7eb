"""What no floe may touch at the start, in plan."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Disk:
    """A disk, such as the plan of a pile: centre (2,) and outer radius [m]."""

    center: tuple[float, float]
    radius: float


@dataclass(frozen=True)
class HalfPlane:
    """A half-plane, such as the plan of a wall, through `point` (2,) [m]: solid on the side away from its `normal` (2,).

    It has no periodic images: with one, a solid half-plane would fill a periodic domain.
    """

    point: tuple[float, float]
    normal: tuple[float, float]


@dataclass(frozen=True, eq=False)
class Region:
    """Plan of any other body: everything within `reach` [m] of the convex hull of its points (n, 2) [m]."""

    outline: np.ndarray
    reach: float = 0.0


Obstacle = Disk | HalfPlane | Region

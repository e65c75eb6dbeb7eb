"""An unbounded plane: a wall, a slope, a sea bed."""

import math
from typing import ClassVar, Literal

import numpy as np

from dilatedem.field.obstacles import HalfPlane, Obstacle
from dilatedem.geometry.polyhedron import Polyhedron, convex_hull
from dilatedem.keys import Fault, Friction, Name, PoissonRatio, Positive, Vector3, key
from dilatedem.numerics.plain import norm
from dilatedem.state.charts import Along
from dilatedem.structures.kind import (
    DRAWN_BOTTOM,
    DRAWN_TOP,
    UPRIGHT,
    Chart,
    Part,
    Sketch,
    Structure,
    friction_key,
    modulus_key,
    name_key,
    ratio_key,
)
from dilatedem.structures.support import AnySupport, support_key

#: a normal shorter than this is taken for zero; its square must not vanish in round-off
SHORTEST_NORMAL = 1e-9
#: width of what is drawn, in diagonals of the domain
DRAWN_EXTENT = 1.2
#: m, of the plate that is drawn on the solid side
PLATE_THICKNESS = 0.05
#: steepness (horizontal part of the unit normal) below which a plane is level: it has no line at the water level
LEVEL = 1e-6
#: length and depth of the strip in plan, in diagonals of the domain: beyond any view
STRIP = (3.0, 0.025)


class Plane(Structure):
    """An unbounded plane, solid on the side that its normal points away from."""

    can_move: ClassVar[bool] = False  # it has no end
    has_an_end: ClassVar[bool] = False

    kind: Literal["plane"] = key(..., "", "An unbounded plane.")
    name: Name = name_key("plane")
    point: Vector3 = key(..., "m", "Any point of the plane.")
    normal: Vector3 = key(..., "", "Direction from the plane towards the ice; any length but zero.")
    elastic_modulus: Positive = modulus_key()
    poisson_ratio: PoissonRatio = ratio_key()
    friction: Friction | None = friction_key()
    support: AnySupport = support_key()

    def faults(self) -> list[Fault]:
        length = math.hypot(*self.normal)  # of lengths whose squares vanish, too
        if length < SHORTEST_NORMAL:
            shorter = f", nor shorter than {SHORTEST_NORMAL:g}" if length > 0.0 else ""
            return [(("normal",), f"must not be zero{shorter}: it points from the plane towards the ice")]
        if self.support.moves:
            return [(("support", "kind"), 'must be "held": a plane has no end, so that nothing can carry it; take a box')]
        return []

    @property
    def place(self) -> np.ndarray:
        return np.array([*self.point[:2], 0.0])

    def parts(self) -> list[Part]:
        normal = np.array(self.normal) / norm(self.normal)
        return [Part(np.array(self.point), UPRIGHT, normal=normal)]

    def obstacles(self, thickness: float) -> list[Obstacle]:
        level = float(norm(self.normal[:2]))
        if level == 0.0:  # a level plane bounds no floe in plan
            return []
        across, slope = np.array(self.normal[:2]) / level, self.normal[2] / level
        # where it stands out farthest towards the ice, over the heights that a floe can take up
        reach = slope * self.point[2] + abs(slope) * thickness
        return [HalfPlane(tuple(np.array(self.point[:2]) + across * reach), tuple(across))]

    def chart(self, extent: float) -> Chart:
        across = np.cross([0.0, 0.0, 1.0], self.normal)
        length = norm(across)
        axis = across / length if length > 0.0 else np.array([1.0, 0.0, 0.0])
        zero = "horizontal coordinate along the plane, from center_m in the direction of axis"
        return Chart(Along.LINE, "Distance along the plane", zero, origin=np.array(self.point), axis=axis, half=0.5 * extent)

    def drawing(self, extent: float) -> list[Polyhedron]:
        return [plate(self.point, self.normal, DRAWN_EXTENT * extent)]

    def sketch(self, extent: float) -> Sketch | None:
        normal, point = np.array(self.normal), np.array(self.point)
        steep = norm(normal[:2])
        if steep < LEVEL * norm(normal):
            return None
        across = normal[:2] / steep
        # on the plane at z = 0: from its point down the slope
        foot = point[:2] + across * (point[2] * normal[2] / steep)
        along = np.array([across[1], -across[0]]) * 0.5 * STRIP[0] * extent
        depth = across * STRIP[1] * extent
        return Sketch(np.array([foot + along, foot - along, foot - along - depth, foot + along - depth]), bounded=False)


def plate(point, normal, extent: float) -> Polyhedron:
    """A plane through `point` (3,) with outward `normal` (3,), as a thin plate `extent` [m] wide.

    Steep plates are cut at the heights between which structures are drawn.
    """
    point, normal = np.asarray(point, dtype=float), np.asarray(normal, dtype=float)
    normal = normal / norm(normal)
    along = np.cross([0.0, 0.0, 1.0], normal)
    if norm(along) < 1e-9:  # level plane: no direction along it is special
        along = np.array([1.0, 0.0, 0.0])
    along /= norm(along)
    upward = np.cross(normal, along)  # steepest ascent, for a plane that leans either way
    half = 0.5 * extent
    low = high = half
    if upward[2] > 1e-9:
        low = min(half, max(0.0, point[2] - DRAWN_BOTTOM) / upward[2])
        high = min(half, max(0.0, DRAWN_TOP - point[2]) / upward[2])
    return convex_hull(
        np.array([
            point + a * half * along + b * upward - depth * normal
            for a in (-1.0, 1.0)
            for b in (-low, high)
            for depth in (0.0, PLATE_THICKNESS)
        ])
    )  # fmt: skip

"""A straight circular member at any tilt: a leg or a brace of a jacket, a raked pile."""

import math
from typing import Literal

import numpy as np
from pydantic import create_model

from dilatedem.field.obstacles import Disk, Obstacle, Region
from dilatedem.geometry.polyhedron import Polyhedron, convex_hull
from dilatedem.geometry.shapes import BodyShape
from dilatedem.keys import Fault, Friction, Name, PoissonRatio, Positive, Vector3, key
from dilatedem.numerics.plain import norm
from dilatedem.state.charts import Along
from dilatedem.structures.kind import (
    UPRIGHT,
    Chart,
    Part,
    Sketch,
    Structure,
    circle,
    friction_key,
    modulus_key,
    name_key,
    ratio_key,
)
from dilatedem.structures.solid import hull_in_plan
from dilatedem.structures.support import AnySupport, support_key

#: m, between the ends of a brace, at least: its direction must not be round-off
SHORTEST = 1e-3
#: rise over length from which a brace is charted around its axis, as a pile is; flatter ones along it
STEEP = math.sqrt(0.5)
#: rise over length up to which a brace is level: all of it is as near to the water level
LEVEL = 1e-9
#: points of the axis where its outline in plan is looked at
OUTLINE_POINTS = 65


class _Ends(Structure):
    """What stands before the ends in a case file."""

    kind: Literal["brace"] = key(..., "", "A straight circular member, at any tilt.")
    name: Name = name_key("brace")


#: `from` is a word of Python's own, which no line of a class can give a value
_From = create_model("_From", __base__=_Ends, **{"from": (Vector3, key(..., "m", "One end of its axis."))})


class Brace(_From):
    """A straight circular member at any tilt: a leg, a brace, a raked pile. Its ends are round, a radius past those of its axis."""

    to: Vector3 = key(..., "m", "The other end of its axis.")
    radius: Positive = key(0.5, "m", "Radius of the member.")
    elastic_modulus: Positive = modulus_key()
    poisson_ratio: PoissonRatio = ratio_key()
    friction: Friction | None = friction_key()
    support: AnySupport = support_key()

    def faults(self) -> list[Fault]:
        if math.dist(*self._axis) < SHORTEST:
            return [(("to",), f"must be at least {SHORTEST:g} m from the other end")]
        return []

    @property
    def _axis(self) -> np.ndarray:
        """(2, 3) [m] its ends, the lower one first."""
        ends = np.array([getattr(self, "from"), self.to])
        return ends if ends[0, 2] <= ends[1, 2] else ends[::-1]

    @property
    def _direction(self) -> np.ndarray:
        """(3,) unit vector, upward."""
        low, high = self._axis
        return (high - low) / norm(high - low)

    @property
    def _is_steep(self) -> bool:
        return bool(self._direction[2] >= STEEP)

    @property
    def place(self) -> np.ndarray:
        """Where the axis, or what prolongs it, meets the water level; of a flat one its middle in plan."""
        low, high = self._axis
        if self._is_steep:
            at = low - low[2] / self._direction[2] * self._direction
        else:
            at = 0.5 * (low + high)
        return np.array([*at[:2], 0.0])

    def parts(self) -> list[Part]:
        """One capsule whose dilation is the radius."""
        low, high = self._axis
        shape, middle = BodyShape.of_core(convex_hull(self._axis), self.radius)
        return [Part(middle, UPRIGHT, shape, plan_reach=0.5 * float(norm((high - low)[:2])) + self.radius)]

    def obstacles(self, thickness: float) -> list[Obstacle]:
        """Of what lies between the heights that a floe can take up: all within a radius of a stretch of the axis in plan.

        A level plane cuts a cylinder that rises at the angle a in an ellipse of half axes r and r/sin(a). The disks of radius r
        about the points up to r/sin(a) - r from its middle hold it, and the last touches its tip.
        """
        (low, high), along, radius = self._axis, self._direction, self.radius
        flat = float(norm(along[:2]))
        if high[2] + radius <= -thickness or low[2] - radius >= thickness:
            return []
        ahead = radius * (1.0 / along[2] - 1.0) / flat if flat > 0.0 and along[2] > LEVEL else 0.0
        stretch = self._stretch(thickness, ahead)
        if flat == 0.0:
            return [Disk(tuple(stretch[0, :2].tolist()), radius)]
        return [Region(stretch[:, :2], reach=radius)]

    def _stretch(self, height: float, more: float = 0.0) -> np.ndarray:
        """(2, 3) [m] ends of that part of the axis which is nearer to the water level than `height`, and `more` on either side."""
        low, high = self._axis
        along, length = self._direction, float(norm(high - low))
        if along[2] <= LEVEL:
            return self._axis
        reached = (np.array([-height, height]) - low[2]) / along[2] + [-more, more]
        return low + np.clip(reached, 0.0, length)[:, None] * along

    def chart(self, extent: float) -> Chart:
        along = self._direction
        if self._is_steep:
            zero = "angle about the brace's axis at the height of the contact, counter-clockwise seen from above: 0 = +x"
            lean = (float(along[0] / along[2]), float(along[1] / along[2]))
            return Chart(Along.ANGLE, "Angle around the brace from +x", zero, radius=self.radius, lean=lean)
        low, high = self._axis
        axis, half = np.array([*along[:2], 0.0]) / norm(along[:2]), 0.5 * float(norm((high - low)[:2])) + self.radius
        zero = "horizontal coordinate along the brace, from center_m in the direction of axis, its higher end"
        return Chart(Along.LINE, "Distance along the brace in plan", zero, origin=self.place, axis=axis, half=half)

    def drawing(self, extent: float) -> list[Polyhedron]:
        part = self.parts()[0]
        return [part.shape.outer.translated(part.position)]

    def sketch(self, extent: float) -> Sketch | None:
        """What the water level cuts out of it: the hull of the disks that it cuts out of the balls along the axis."""
        first, last = self._stretch(self.radius)
        points = first + np.linspace(0.0, 1.0, OUTLINE_POINTS)[:, None] * (last - first)
        disks = [circle(point[:2], math.sqrt(self.radius**2 - point[2] ** 2)) for point in points if abs(point[2]) < self.radius]
        if not disks:
            return None
        return Sketch(hull_in_plan(np.concatenate(disks)))

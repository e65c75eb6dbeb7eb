"""A conical pier: a circular frustum, exactly round."""

import math
from typing import Literal

import numpy as np

from dilatedem.field.obstacles import Disk, Obstacle
from dilatedem.geometry.polyhedron import Polyhedron, convex_hull
from dilatedem.geometry.shapes import BodyShape
from dilatedem.keys import Fault, Friction, Name, PoissonRatio, Positive, Vector2, key
from dilatedem.numerics.plain import sine_cosine
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
from dilatedem.structures.support import AnySupport, support_key

#: sides of a cone as the figures in plan show it: round at any size
SKETCH_SIDES = 128
#: slope below which a cone is nearly flat, deg: the spheres that it is the hull of are 10 times wider than it is
FLATTEST = 5.0


class Cone(Structure):
    """An upright circular cone, cut at two heights, that narrows upwards or downwards."""

    kind: Literal["cone"] = key(..., "", "An upright circular cone that narrows upwards or downwards.")
    name: Name = name_key("cone")
    center: Vector2 = key((10.0, 0.0), "m", "Position of the axis, x and y.")
    waterline_radius: Positive = key(4.0, "m", "Radius at the water level.")
    slope: float = key(60.0, "deg", "Angle of its side from the horizontal, narrower above; negative: wider above.")
    bottom: float = key(-3.0, "m", "Height over the water of the circle at which its side ends below; a round cap closes it.")
    top: float = key(3.0, "m", "Height over the water of the circle at which its side ends above; a round cap closes it.")
    elastic_modulus: Positive = modulus_key()
    poisson_ratio: PoissonRatio = ratio_key()
    friction: Friction | None = friction_key()
    support: AnySupport = support_key()

    def faults(self) -> list[Fault]:
        if not FLATTEST <= abs(self.slope) <= 90.0:
            return [(("slope",), f"must be between {FLATTEST:g} and 90 degrees, or between -90 and -{FLATTEST:g}")]
        if self.top <= self.bottom:
            return [(("top",), f"must be above bottom, {self.bottom:g} m")]
        end, narrow = ("top", self.top) if self.slope > 0.0 else ("bottom", self.bottom)
        if self._radius(narrow) <= 0.0:
            tip = narrow + self._radius(narrow) / self._narrowing
            return [((end,), f"must be {'below' if end == 'top' else 'above'} the tip of the cone, {tip:.3g} m")]
        return []

    @property
    def _narrowing(self) -> float:
        """By how much the radius shrinks per metre of height."""
        return 0.0 if abs(self.slope) == 90.0 else 1.0 / math.tan(math.radians(self.slope))

    def _radius(self, height: float) -> float:
        """Radius of the circle at a height [m]."""
        return self.waterline_radius - self._narrowing * height

    @property
    def tapers(self) -> bool:
        return self._narrowing != 0.0

    @property
    def place(self) -> np.ndarray:
        return np.array([*self.center, 0.0])

    def parts(self) -> list[Part]:
        """The hull of the two spheres that touch the side from within along its two circles."""
        sine, _ = sine_cosine(math.radians(abs(self.slope)))
        low, high = (
            (height - self._radius(height) * self._narrowing, self._radius(height) / sine) for height in (self.bottom, self.top)
        )
        half, taper = 0.5 * (high[0] - low[0]), (high[1] - low[1]) / (high[0] - low[0])
        axis = convex_hull(np.array([[0.0, 0.0, -half], [0.0, 0.0, half]]))
        middle = np.array([*self.center, 0.5 * (low[0] + high[0])])
        shape, _ = BodyShape.of_core(axis, 0.5 * (low[1] + high[1]))
        return [Part(middle, UPRIGHT, shape, plan_reach=max(low[1], high[1]), taper=taper)]

    def obstacles(self, thickness: float) -> list[Obstacle]:
        widest = max(self.bottom, min(self.top, -math.copysign(thickness, self.slope)))
        return [Disk(self.center, self._radius(widest))]

    def chart(self, extent: float) -> Chart:
        zero = (
            "angle about the cone's axis, counter-clockwise seen from above: 0 = +x of the world, whatever the current; less "
            "upstream_deg it is the angle from the side that the current comes from, which figures take for zero"
        )
        return Chart(Along.ANGLE, "Angle around the cone from +x", zero, radius=self.waterline_radius)

    def drawing(self, extent: float) -> list[Polyhedron]:
        rings = [
            np.column_stack([corners, np.full(len(corners), height)])
            for height in (self.bottom, self.top)
            for corners in [circle(self.center, self._radius(height))]
        ]
        return [convex_hull(np.concatenate(rings))]

    def sketch(self, extent: float) -> Sketch | None:
        return Sketch(circle(self.center, self.waterline_radius, SKETCH_SIDES)) if self.bottom < 0.0 < self.top else None

"""A vertical circular pile: the cylinder of Liu, Long & Ji (2015), section 3."""

from typing import Literal

import numpy as np

from dilatedem.field.obstacles import Disk, Obstacle
from dilatedem.geometry.polyhedron import Polyhedron, convex_hull, prism
from dilatedem.geometry.shapes import BodyShape
from dilatedem.keys import Friction, Name, PoissonRatio, Positive, Vector2, key
from dilatedem.state.charts import Along
from dilatedem.structures.kind import (
    DRAWN_BOTTOM,
    DRAWN_TOP,
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

#: half the length of a pile's core, m: "reaching beyond any floe above and below"
HALF_LENGTH = 200.0
#: sides of a pile as the figures in plan show it: round at any size
SKETCH_SIDES = 128


class Pile(Structure):
    """A vertical circular pile, reaching beyond any floe above and below."""

    kind: Literal["pile"] = key(..., "", "A vertical circular pile.")
    name: Name = name_key("pile")
    center: Vector2 = key((10.0, 0.0), "m", "Position of the axis, x and y.")
    radius: Positive = key(2.0, "m", "Radius of the pile.")
    elastic_modulus: Positive = modulus_key()
    poisson_ratio: PoissonRatio = ratio_key()
    friction: Friction | None = friction_key()
    support: AnySupport = support_key()

    @property
    def place(self) -> np.ndarray:
        return np.array([*self.center, 0.0])

    def parts(self) -> list[Part]:
        """One capsule whose dilation is the pile's radius."""
        column = convex_hull(np.array([[0.0, 0.0, -HALF_LENGTH], [0.0, 0.0, HALF_LENGTH]]))
        return [Part(self.place, UPRIGHT, BodyShape.of_core(column, self.radius)[0], plan_reach=self.radius)]

    def obstacles(self, thickness: float) -> list[Obstacle]:
        return [Disk(self.center, self.radius)]

    def chart(self, extent: float) -> Chart:
        zero = (
            "angle about the pile's centre, counter-clockwise seen from above: 0 = +x of the world, whatever the current; less "
            "upstream_deg it is the angle from the side that the current comes from, which figures take for zero"
        )
        return Chart(Along.ANGLE, "Angle around the pile from +x", zero, radius=self.radius)

    def drawing(self, extent: float) -> list[Polyhedron]:
        return [prism(circle(self.center, self.radius), DRAWN_BOTTOM, DRAWN_TOP)]

    def sketch(self, extent: float) -> Sketch:
        return Sketch(circle(self.center, self.radius, SKETCH_SIDES))

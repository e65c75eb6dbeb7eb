"""A rectangular caisson or pier with rounded edges."""

import math
from typing import Literal

import numpy as np

from dilatedem.field.obstacles import Obstacle, Region
from dilatedem.geometry.polyhedron import Polyhedron, prism
from dilatedem.geometry.shapes import BodyShape
from dilatedem.keys import Fault, Friction, Name, PoissonRatio, Positive, Size2, Vector2, key
from dilatedem.numerics.frames import quaternion_from_rotation_vector
from dilatedem.numerics.plain import norm, sine_cosine
from dilatedem.state.charts import Along
from dilatedem.structures.kind import Chart, Part, Sketch, Structure, friction_key, modulus_key, name_key, ratio_key
from dilatedem.structures.support import AnySupport, support_key

#: corners in plan, in halves of the size: counter-clockwise, so that the side towards -x comes in the middle
CORNERS = np.array([[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]])


class Box(Structure):
    """A rectangular box with upright sides and rounded edges: a caisson, a bridge pier."""

    kind: Literal["box"] = key(..., "", "A rectangular box with upright sides and rounded edges.")
    name: Name = name_key("box")
    center: Vector2 = key((10.0, 0.0), "m", "Position of its middle, x and y.")
    size: Size2 = key((4.0, 4.0), "m", "Outer length along its own two axes.")
    rotation: float = key(0.0, "deg", "Angle by which its axes are turned from x and y, counter-clockwise.")
    bottom: float = key(-3.0, "m", "Height of its lower side over the water level.")
    top: float = key(3.0, "m", "Height of its upper side over the water level.")
    dilated_radius: Positive = key(0.1, "m", "Radius by which its edges and corners are rounded; less than half of every side.")
    elastic_modulus: Positive = modulus_key()
    poisson_ratio: PoissonRatio = ratio_key()
    friction: Friction | None = friction_key()
    support: AnySupport = support_key()

    def faults(self) -> list[Fault]:
        if self.top <= self.bottom:
            return [(("top",), f"must be above bottom, {self.bottom:g} m")]
        shortest = min(*self.size, self.top - self.bottom)
        if 2.0 * self.dilated_radius >= shortest:
            return [(("dilated_radius",), f"must be less than half of the shortest side, {shortest / 2:g} m")]
        return []

    @property
    def place(self) -> np.ndarray:
        return np.array([*self.center, 0.0])

    def _outline(self) -> np.ndarray:
        """(4, 2) [m] outer corners in plan, from its middle."""
        sine, cosine = sine_cosine(math.radians(self.rotation))
        x, y = (0.5 * np.array(self.size) * CORNERS).T
        return np.column_stack([cosine * x - sine * y, sine * x + cosine * y])

    def parts(self) -> list[Part]:
        """One dilated box."""
        half, radius = 0.5 * np.array([*self.size, self.top - self.bottom]), self.dilated_radius
        core = prism((half[:2] - radius) * CORNERS, radius - half[2], half[2] - radius)
        turn = quaternion_from_rotation_vector([0.0, 0.0, math.radians(self.rotation)])
        middle = np.array([*self.center, 0.5 * (self.bottom + self.top)])
        return [Part(middle, turn, BodyShape.of_core(core, radius)[0], plan_reach=float(norm(half[:2])))]

    def obstacles(self, thickness: float) -> list[Obstacle]:
        return [Region(self._outline() + self.center)]

    def chart(self, extent: float) -> Chart:
        zero = "distance around the box, counter-clockwise seen from above, from the corner at +x and +y of its own axes"
        return Chart(Along.OUTLINE, "Distance around the box, from its corner at +x, +y", zero, outline=self._outline())

    def drawing(self, extent: float) -> list[Polyhedron]:
        return [prism(self._outline() + self.center, self.bottom, self.top)]

    def sketch(self, extent: float) -> Sketch | None:
        return Sketch(self._outline() + self.center) if self.bottom < 0.0 < self.top else None

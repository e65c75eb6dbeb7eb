"""A pier of any convex outline, with upright or tapered sides and rounded edges."""

import math
from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from dilatedem.field.obstacles import Obstacle
from dilatedem.geometry import outline as plan
from dilatedem.geometry.half_spaces import of_half_spaces
from dilatedem.geometry.polyhedron import Polyhedron
from dilatedem.keys import Fault, Friction, Name, PoissonRatio, Positive, Vector2, key
from dilatedem.numerics.plain import norm, sine_cosine
from dilatedem.state.charts import Along
from dilatedem.structures import solid
from dilatedem.structures.kind import Chart, Part, Sketch, Structure, friction_key, modulus_key, name_key, ratio_key
from dilatedem.structures.support import AnySupport, support_key

#: deg, of the flattest side: flatter ones are no pier, and its sides would meet far away
FLATTEST = 5.0
#: corners that a pier may have, at most: its upper side is one face of them
MOST_CORNERS = 120


class Pier(Structure):
    """A pier whose plan is any convex polygon: a bridge pier, a caisson, a bow. Outline, at the water level, z = 0, and slope are
    those of its outer surface; edges and corners are rounded within it."""

    kind: Literal["pier"] = key(..., "", "A pier of a convex outline, straight or tapered.")
    name: Name = name_key("pier")
    outline: Annotated[list[Vector2], Field(min_length=3, max_length=MOST_CORNERS)] = key(
        ..., "m", "Corners at z = 0, in order around it; convex."
    )
    bottom: float = key(-3.0, "m", "Height of its lower side over the water level.")
    top: float = key(3.0, "m", "Height of its upper side over the water level.")
    slope: float = key(
        90.0, "deg",
        "Of its sides, from the horizontal: 90 is upright, less is narrower above, more or negative wider above (120 and -60 are "
        "the same); from 5 to 175, or from -90 to -5.",
    )
    dilated_radius: Positive = key(0.1, "m", "Radius by which its edges and corners are rounded.")
    elastic_modulus: Positive = modulus_key()
    poisson_ratio: PoissonRatio = ratio_key()
    friction: Friction | None = friction_key()
    support: AnySupport = support_key()

    def faults(self) -> list[Fault]:
        if self.top <= self.bottom:
            return [(("top",), f"must be above bottom, {self.bottom:g} m")]
        if not (FLATTEST <= self.slope <= 180.0 - FLATTEST or -90.0 <= self.slope <= -FLATTEST):
            return [(("slope",), f"must be from {FLATTEST:g} to {180.0 - FLATTEST:g}, or from -90 to {-FLATTEST:g}")]
        if 2.0 * self.dilated_radius >= self.top - self.bottom:
            return [(("dilated_radius",), f"must be less than half of the height, {0.5 * (self.top - self.bottom):g} m")]
        try:
            self._corners()
        except ValueError as fault:
            return [(("outline",), str(fault))]
        return self._taper_faults()

    def _taper_faults(self) -> list[Fault]:
        """Its narrow end must be there, as drawn and less the dilated radius all around."""
        (sine, cosine), radius = self._slope(), self.dilated_radius
        word, end, inwards = ("top", self.top, -radius) if cosine >= 0.0 else ("bottom", self.bottom, radius)
        if not self._has_room(end * cosine / sine):
            return [(("slope",), f"makes its sides meet before its {word}, {end:g} m")]
        if not self._has_room((end + inwards) * cosine / sine + radius / sine):
            return [(("dilated_radius",), f"leaves nothing of its narrowest level, at its {word}: take a smaller one")]
        return []

    def _has_room(self, distance: float) -> bool:
        """Whether something is left of the outline when its sides move inwards by `distance` [m]."""
        try:
            return distance <= 0.0 or len(plan.erode(self._corners(), distance)) > 2
        except ValueError:
            return False

    def _corners(self) -> np.ndarray:
        """(k, 2) [m] of the outline, counter-clockwise. Raises ValueError for one that is not convex."""
        return plan.prepare(self.outline)

    def _slope(self) -> tuple[float, float]:
        """Sine and cosine of the slope: the cosine is negative where it is wider above."""
        sine, cosine = sine_cosine(math.radians(self.slope % 180.0))
        return float(sine), 0.0 if abs(self.slope) == 90.0 else float(cosine)

    def _solid(self) -> Polyhedron:
        """As drawn, with sharp edges."""
        corners, (sine, cosine) = self._corners(), self._slope()
        side = np.roll(corners, -1, axis=0) - corners
        out = np.column_stack([side[:, 1], -side[:, 0]]) / norm(side)[:, None]
        normal = np.column_stack([sine * out, np.full(len(out), cosine)])
        offset = sine * (out[:, 0] * corners[:, 0] + out[:, 1] * corners[:, 1])
        ends = np.array([[0.0, 0.0, -1.0], [0.0, 0.0, 1.0]])
        return of_half_spaces(np.concatenate([normal, ends]), np.concatenate([offset, [-self.bottom, self.top]]))

    @property
    def place(self) -> np.ndarray:
        """The centroid of its outline."""
        return np.array([*plan.centroid(self._corners()), 0.0])

    def parts(self) -> list[Part]:
        return [solid.rounded(self._solid(), self.dilated_radius)]

    def obstacles(self, thickness: float) -> list[Obstacle]:
        return solid.obstacles(self._solid(), thickness)

    def chart(self, extent: float) -> Chart:
        zero = "distance around the pier's outline at the water level, counter-clockwise seen from above, from its first corner"
        outline = self._corners() - self.place[:2]
        return Chart(Along.OUTLINE, "Distance around the pier, from its first corner", zero, outline=outline)

    def drawing(self, extent: float) -> list[Polyhedron]:
        return [self._solid()]

    def sketch(self, extent: float) -> Sketch | None:
        return Sketch(self._corners()) if self.bottom < 0.0 < self.top else None

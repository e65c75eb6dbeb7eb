"""The bodies of a case file that are given one by one."""

from typing import Annotated

from pydantic import Field

from dilatedem.case.deformation import MOST_MODES
from dilatedem.keys import Fault, PoissonRatio, Positive, Table, Vector2, Vector3, key

#: points of an outline and vertices of a hull, at most: what can be looked at in a second
MOST_POINTS, MOST_VERTICES = 10_000, 2_000


class Body(Table):
    """An explicit body, numbered from 0 in the order given, before the generated floes.

    Exactly one of `vertices` (any convex shape) and `outline` (a floe, drawn in plan) is given.
    """

    vertices: Annotated[list[Vector3], Field(min_length=1, max_length=MOST_VERTICES)] | None = key(
        None, "m",
        "Core in body coordinates, to be dilated: one vertex is a sphere, two are a capsule, more are their "
        "convex hull.",
    )
    outline: Annotated[list[Vector2], Field(min_length=3, max_length=MOST_POINTS)] | None = key(
        None, "m", "Outer outline in plan, convex, in world coordinates, instead of `vertices`."
    )
    outline_tolerance: Positive | None = key(
        None, "m",
        "Distance from its outline within which corners are left out, for outlines with more of them than a face may have, 127. "
        "Those that stay do not move.",
    )
    dilated_radius: Positive | None = key(
        None, "m", "Dilated radius; that of `[ice]` unless given. At most half the thickness of an outline."
    )
    thickness: Positive | None = key(
        None, "m", "Outer thickness, of an outline only; that of `[ice]` unless given."
    )
    position: Vector2 | Vector3 | None = key(
        None, "m",
        "Of the centroid; `[0, 0, 0]` for `vertices`. An outline without it stays where it was drawn, one "
        "with it is shifted there; without z it floats at equilibrium (z = 0 where the water is off).",
        allowed="must be a list of 3 numbers, or of 2 for an outline that floats",
    )
    rotation: Vector3 = key(
        (0.0, 0.0, 0.0), "rad", "Rotation vector: its direction is the axis, its length the angle."
    )
    velocity: Vector3 = key((0.0, 0.0, 0.0), "m/s", "Velocity of the centroid.")
    angular_velocity: Vector3 = key((0.0, 0.0, 0.0), "rad/s", "Angular velocity about the world's axes.")
    density: Positive | None = key(None, "kg/m3", "Density; that of `[ice]` unless given.")
    elastic_modulus: Positive | None = key(None, "Pa", "Young's modulus; that of `[ice]` unless given.")
    poisson_ratio: PoissonRatio | None = key(None, "", "Poisson's ratio; that of `[ice]` unless given.")
    modes: Annotated[int, Field(ge=0, le=MOST_MODES)] | None = key(
        None, "", "Modes of vibration that it bends by; `deformation.modes` unless given."
    )
    fixed: bool = key(
        False, "",
        "`true` holds the body where it is, whatever pushes it; the load on it is recorded like that on a structure, as "
        "`body_N`, N its number.",
    )

    def faults(self) -> list[Fault]:
        found: list[Fault] = []
        if self.vertices is None and self.outline is None:
            found.append(((), "needs either vertices or outline"))
        elif self.vertices is not None:
            if self.outline is not None:
                found.append((("outline",), "give either vertices or outline, not both"))
            for name in ("thickness", "outline_tolerance"):
                if self.outline is None and getattr(self, name) is not None:
                    found.append(((name,), "belongs to an outline; vertices give the shape by themselves"))
            if self.position is not None and len(self.position) != 3:
                found.append((("position",), "must be a list of 3 numbers; only an outline finds its height"))
        for motion in ("velocity", "angular_velocity"):
            if self.fixed and any(getattr(self, motion)):
                found.append(((motion,), "must be zero for a fixed body; or set fixed = false"))
        return found

"""What a kind of structure answers, so that nobody else need know it: six questions.

1. its keys in a case file: the fields of its table;
2. its bodies: the convex parts that the ice meets (`parts`), each with
3. its plan reach: how far from its place ice may be and still not near it;
4. its plan obstacles: where no floe can start (`obstacles`);
5. the chart of its load map: how places on it are laid out flat (`chart`);
6. its drawing: what ParaView shows (`drawing`) and what the figures in plan show (`sketch`).

Besides, the point about which its moments are stated (`place`), and what carries it, whatever its shape (`structures.support`).
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from dilatedem.field.obstacles import Obstacle
from dilatedem.geometry.outline import perimeter
from dilatedem.geometry.polyhedron import Polyhedron
from dilatedem.geometry.shapes import BodyShape
from dilatedem.keys import Table, key
from dilatedem.numerics.frames import matrix_from_quaternion, quaternion_from_rotation_vector
from dilatedem.numerics.plain import sine_cosine, turned
from dilatedem.state.charts import Along

#: heights between which structures that reach farther than any floe are drawn, m
DRAWN_BOTTOM, DRAWN_TOP = -3.0, 2.0
#: sides of a circle where one is drawn
CIRCLE_SIDES = 64
#: orientation of a part that is not turned
UPRIGHT = quaternion_from_rotation_vector(np.zeros(3))


@dataclass(frozen=True, eq=False)
class Part:
    """A convex piece of a structure: a dilated core at a place, or a half space.

    position (3,) [m]: centroid, or a point of the half space's plane; orientation (4,): unit quaternion, body to world; shape: of
    the core, None for a half space; normal (3,): outward unit normal of a half space, None for a core; plan_reach [m]: radius of
    the upright cylinder about `position` that holds a core, or more; taper: what the radius of dilation grows by per metre from
    the first to the second corner of a core of two, whose radius is that in the middle; the part is a circular cone then, with a
    sphere at either end.
    """

    position: np.ndarray
    orientation: np.ndarray
    shape: BodyShape | None = None
    normal: np.ndarray | None = None
    plan_reach: float = 0.0
    taper: float = 0.0

    @property
    def is_half_space(self) -> bool:
        return self.normal is not None

    @property
    def heights(self) -> tuple[float, float]:
        """Of a core's lowest and of its highest point, dilation included [m]."""
        height = turned(matrix_from_quaternion(self.orientation), self.shape.core.vertices)[:, 2] + self.position[2]
        return float(height.min()) - self.shape.radius, float(height.max()) + self.shape.radius


@dataclass(frozen=True, eq=False)
class Chart:
    """How places on a structure are laid out flat: one coordinate around or along it, and the height over the water.

    along: what the first coordinate runs along; label: what that coordinate is, for an axis; zero: where its zero lies, in words.
    ANGLE: radius [m] of the surface that it runs around, for loads per metre of it; lean (2,): what the axis gains in x and y per
    metre of height, none if it is upright.
    LINE: origin (3,) [m], axis (3,) its unit vector, half [m]: it runs from -half to half.
    OUTLINE: outline (k, 2) [m], counter-clockwise, relative to the structure's centre; it runs from 0 to its length.
    """

    along: Along
    label: str
    zero: str
    radius: float | None = None
    origin: np.ndarray | None = None
    axis: np.ndarray | None = None
    lean: tuple[float, float] = (0.0, 0.0)
    half: float = 0.0
    outline: np.ndarray | None = None

    @property
    def place(self) -> str:
        """Name of the first coordinate in run.h5."""
        return "angle" if self.along == Along.ANGLE else "distance"

    def edges(self, bins: int) -> np.ndarray:
        """(bins + 1,) bounds of the first coordinate: degrees for an angle, else m."""
        if self.along == Along.ANGLE:
            return np.linspace(-180.0, 180.0, bins + 1)
        if self.along == Along.LINE:
            return np.linspace(-self.half, self.half, bins + 1)
        return np.linspace(0.0, perimeter(self.outline), bins + 1)


@dataclass(frozen=True, eq=False)
class Sketch:
    """A structure in plan, at the water level: outline (k, 2) [m], counter-clockwise.

    Of one that is not `bounded` the first side is its face, and the rest lies in the solid behind it.
    """

    outline: np.ndarray
    bounded: bool = True


class Structure(Table):
    """A table [[structure]] of a case file, and the six answers; each kind has a key `support` as well."""

    #: whether something can carry it that moves
    can_move: ClassVar[bool] = True
    #: whether ice can drift past it
    has_an_end: ClassVar[bool] = True

    @property
    def members(self) -> Sequence[Structure]:
        """The structures that it is made of, each with answers and a record of its own; none where it is one by itself."""
        return ()

    @property
    def tapers(self) -> bool:
        """Whether a part of it is exactly conical: the search then knows bodies whose dilation changes along them."""
        return any(member.tapers for member in self.members)

    def names(self) -> list[str]:
        """Under which its loads are recorded: its own, then those of its members."""
        return [self.name, *(member_name(self.name, member.name) for member in self.members)]

    @property
    @abstractmethod
    def place(self) -> np.ndarray:
        """(3,) [m] the centre at z = 0 about which moments are stated."""

    def remarks(self) -> list[str]:
        """What `dilatedem check` says of it, a sentence each."""
        return []

    @abstractmethod
    def parts(self) -> list[Part]:
        """Its bodies, each convex. Raises ValueError where it has no shape."""

    @abstractmethod
    def obstacles(self, thickness: float) -> list[Obstacle]:
        """Where in plan no floe of this thickness [m] can start."""

    @abstractmethod
    def chart(self, extent: float) -> Chart | None:
        """How its load map is laid out, in a domain of this diagonal [m]; None where its members have the maps."""

    @abstractmethod
    def drawing(self, extent: float) -> list[Polyhedron]:
        """Its pieces in world coordinates, cut to what is worth seeing in a domain of this diagonal [m]."""

    @abstractmethod
    def sketch(self, extent: float) -> Sketch | None:
        """It in plan, in a domain of this diagonal [m]; None where it has no outline at the water level."""


def member_name(whole: str, member: str) -> str:
    """What a structure is called in all output that is a member of another."""
    return f"{whole}/{member}"


def name_key(default: str) -> Any:
    """The key `name` of a kind of structure."""
    text = "Its name in all output: a letter, then letters, digits, `_` and `-`. No two structures share one."
    return key(default, "", text)


def modulus_key() -> Any:
    """The key `elastic_modulus`: that of steel unless given."""
    return key(210e9, "Pa", "Young's modulus in contact.")


def ratio_key() -> Any:
    """The key `poisson_ratio`."""
    return key(0.3, "", "Poisson's ratio.")


def friction_key() -> Any:
    """The key `friction`."""
    return key(None, "", "Coefficient of friction with it; `contact.friction` unless given.")


def circle(center, radius: float, sides: int = CIRCLE_SIDES) -> np.ndarray:
    """(sides, 2) [m] corners on a circle, counter-clockwise."""
    sine, cosine = sine_cosine(np.arange(sides) * (2.0 * np.pi / sides))
    return np.asarray(center, dtype=float) + radius * np.column_stack([cosine, sine])

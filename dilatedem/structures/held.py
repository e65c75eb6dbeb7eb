"""A body of the case's list that is held fast: what it bears is recorded like the load on a structure."""

from dataclasses import dataclass

import numpy as np

from dilatedem.field.obstacles import Obstacle
from dilatedem.geometry.polyhedron import Polyhedron
from dilatedem.structures.kind import Part, Sketch
from dilatedem.structures.support import HELD, Support


def name_of(number: int) -> str:
    """What a held body is called among the structures; number: of the body."""
    return f"body_{number}"


@dataclass(frozen=True, eq=False)
class HeldBody:
    """Answers for body `number`, whose centroid is at `position` (3,) [m], as `structures.kind.Structure` does.

    It is a body already, in place and drawn with the floes, and it has no load map: there may be hundreds of such bodies.
    """

    number: int
    position: np.ndarray
    kind: str = "body"
    support: Support = HELD

    @property
    def name(self) -> str:
        return name_of(self.number)

    @property
    def place(self) -> np.ndarray:
        return np.array([*self.position[:2], 0.0])

    def remarks(self) -> list[str]:
        return []

    def parts(self) -> list[Part]:
        return []

    def obstacles(self, thickness: float) -> list[Obstacle]:
        return []

    def chart(self, extent: float) -> None:
        return None

    def drawing(self, extent: float) -> list[Polyhedron]:
        return []

    def sketch(self, extent: float) -> Sketch | None:
        return None

"""A structure of several, each of a kind of its own: a jacket of legs and braces, a cone under a shaft."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, Literal

import numpy as np
from pydantic import Field, model_validator

from dilatedem.field.obstacles import Obstacle
from dilatedem.geometry.polyhedron import Polyhedron
from dilatedem.keys import Fault, Friction, Name, PoissonRatio, Positive, complete, key
from dilatedem.structures.kind import Part, Sketch, Structure, friction_key, modulus_key, name_key, ratio_key
from dilatedem.structures.support import AnySupport, support_key

#: what a part has from its structure unless it has its own
SHARED = ("elastic_modulus", "poisson_ratio", "friction")


class Parts(Structure):
    """One structure of several parts, each a `[[structure.part]]` table with the keys of its kind. Its load is the sum of theirs;
    that on each is recorded, too, as `name/part`. All moments are about the middle of the parts in plan. Elasticity and friction
    given here are those of every part that has none of its own; what carries it carries all of them."""

    kind: Literal["parts"] = key(..., "", "A structure of several parts.")
    name: Name = name_key("parts")
    elastic_modulus: Positive = modulus_key()
    poisson_ratio: PoissonRatio = ratio_key()
    friction: Friction | None = friction_key()
    support: AnySupport = support_key()
    part: Annotated[list[Single], Field(min_length=1)] = key(  # noqa: F821 (`structures.kinds` knows what it is)
        ..., "", "Its parts, each under a header `[[structure.part]]`: tables of any other kind; their names differ."
    )

    def faults(self) -> list[Fault]:
        first: dict[str, int] = {}
        found: list[Fault] = []
        for i, part in enumerate(self.part):
            if first.setdefault(part.name, i) != i:
                found.append((("part", i, "name"), f"is the name of part.{first[part.name]} too; give each part one of its own"))
            if part.support.moves:
                text = 'must be "held": parts move with their structure; give the support to that'
                found.append((("part", i, "support", "kind"), text))
            if self.support.moves and not part.can_move:
                found.append((("part", i, "kind"), f'must not be "{part.kind}" in a structure that moves: nothing can carry it'))
        return found

    @model_validator(mode="after")
    def _fill_parts(self):
        """Parts take from the whole what they leave out."""
        own = {name: getattr(self, name) for name in SHARED}
        left_out = [{name: own[name] for name in SHARED if name not in part.model_fields_set} for part in self.part]
        complete(self, "part", [part.model_copy(update=some) for part, some in zip(self.part, left_out, strict=True)])
        return self

    @property
    def members(self) -> Sequence[Structure]:
        return self.part

    @property
    def place(self) -> np.ndarray:
        """The middle of its parts in plan: halfway between the outermost of their places."""
        places = np.array([part.place for part in self.part])
        return 0.5 * (places.min(axis=0) + places.max(axis=0))

    def parts(self) -> list[Part]:
        """None but those of its members."""
        return []

    def obstacles(self, thickness: float) -> list[Obstacle]:
        return [obstacle for part in self.part for obstacle in part.obstacles(thickness)]

    def chart(self, extent: float) -> None:
        return None

    def drawing(self, extent: float) -> list[Polyhedron]:
        """None but those of its members."""
        return []

    def sketch(self, extent: float) -> Sketch | None:
        return None

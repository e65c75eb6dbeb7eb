"""The field of a case file: how its floes come about."""

from typing import Annotated, Literal, Union

from pydantic import Field, model_validator

from dilatedem.field import distribution
from dilatedem.keys import LARGEST_INTEGER, Fault, Positive, Table, complete, key

AnyDistribution = Annotated[Union[distribution.DISTRIBUTIONS], Field(discriminator="kind")]  # noqa: UP007 (a union of a tuple)


class IceField(Table):
    """The floes at the start: cells that fill the domain, shrunk to the concentration asked for."""

    source: Literal["voronoi", "bodies"] = key(
        "voronoi", "", "`voronoi` generates floes; `bodies` takes the `[[body]]` entries and nothing else."
    )
    floe_size: Positive | None = key(None, "m", "Square root of the mean floe area; 2.8 unless `floe_count` is given.")
    floe_count: Annotated[int, Field(ge=1)] | None = key(
        None, "", "Number of floes before those that touch a structure are left out; instead of `floe_size`."
    )
    concentration: Annotated[float, Field(gt=0, lt=1)] = key(0.64, "", "Share of the domain's area that is covered by ice.")
    seed: Annotated[int, Field(ge=0, le=LARGEST_INTEGER)] = key(
        1, "", "Seed of the random points; the same seed gives the same field."
    )
    shape: Literal["voronoi", "square", "hexagon"] = key(
        "voronoi",
        "",
        "`voronoi`: cells of random points; `square`, `hexagon`: cells of a lattice, stretched so that whole ones fit in.",
    )
    regularity: Annotated[int, Field(ge=0, le=1000)] = key(
        0,
        "",
        "How often each random point is moved to the middle of its cell (Lloyd): the more, the rounder and the more alike.",
    )
    size_distribution: AnyDistribution | None = key(
        None, "", "How floe sizes, square roots of plan areas, are distributed; unless given as random points have it."
    )
    front: Literal["straight", "ragged"] = key(
        "straight",
        "",
        "Where ice ends at open sides: `straight` cuts cells there; `ragged` leaves each cell whole whose middle is in the domain.",
    )

    def faults(self) -> list[Fault]:
        if self.floe_size is not None and self.floe_count is not None:
            return [(("floe_count",), "give either floe_size or floe_count, not both")]
        return [*self._shape_faults(), *self._size_faults()]

    def _shape_faults(self) -> list[Fault]:
        """Keys that speak of random points."""
        if self.shape == "voronoi":
            return []
        given = {"regularity": self.regularity > 0, "size_distribution": self.size_distribution is not None}
        alike = f'belongs to shape = "voronoi"; cells of shape = "{self.shape}" are all alike'
        return [((name,), alike) for name, is_given in given.items() if is_given]

    def _size_faults(self) -> list[Fault]:
        """Sizes that a distribution says by itself."""
        implied = self.size_distribution and self.size_distribution.floe_size
        given = [name for name in ("floe_size", "floe_count") if getattr(self, name) is not None]
        if not implied or not given:
            return []
        why = f'size_distribution of kind "{self.size_distribution.kind}" says it by itself, floe_size = {implied:.4g} m'
        return [((given[0],), f"must be left out: {why}")]

    @model_validator(mode="after")
    def _default_size(self):
        implied = self.size_distribution and self.size_distribution.floe_size
        if self.floe_size is None and self.floe_count is None and not implied:
            complete(self, "floe_size", 2.8)
        return self

    @property
    def asked_size(self) -> float | None:
        """Root of the mean floe area [m] that the case asks for; None where it asks for a number of floes."""
        return self.floe_size or (self.size_distribution and self.size_distribution.floe_size)

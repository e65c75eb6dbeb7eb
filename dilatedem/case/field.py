"""The field of a case file: how its floes come about."""

from pathlib import Path
from typing import Annotated, Literal, Union

from pydantic import Field, model_validator

from dilatedem.field import distribution, drawing
from dilatedem.keys import (
    LARGEST_INTEGER,
    Digest,
    Fault,
    File,
    NonNegative,
    Positive,
    Table,
    Vector2,
    complete,
    content_faults,
    content_of,
    digest_key,
    key,
)

AnyDistribution = Annotated[Union[distribution.DISTRIBUTIONS], Field(discriminator="kind")]  # noqa: UP007 (a union of a tuple)


#: keys that say how floes are made
MADE = ("floe_size", "floe_count", "concentration", "shape", "regularity", "size_distribution", "front")


class IceField(Table):
    """The floes at the start: cells that fill the domain, shrunk to the concentration asked for, or outlines of a file."""

    source: Literal["voronoi", "file", "bodies"] = key(
        "voronoi",
        "",
        "`voronoi` generates floes; `file` takes the outlines of `file`; `bodies` takes the `[[body]]` entries and nothing else.",
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

    file: File | None = key(
        None,
        "",
        "GeoJSON, WKT (a geometry a line) or CSV (columns `floe, x, y`, a row a point) file of outlines, in one plane; a relative "
        "path starts at the folder of the case file. `thickness`, `density`, `elastic_modulus`, `poisson_ratio` and `velocity` of "
        "an outline are taken where they are given.",
    )
    sha256: Digest | None = digest_key()
    scale: Positive = key(1.0, "", "Metres per unit of the file.")
    origin: Literal["centred"] | Vector2 = key(
        (0.0, 0.0),
        "m",
        "Where the origin of the file's coordinates comes to; `centred`: the middle of all outlines comes to that of the domain.",
        allowed='must be "centred" or a list of 2 numbers',
    )
    tolerance: NonNegative = key(
        0.02, "m", "Distance from an outline of the file within which points of it are left out; those that stay do not move."
    )
    not_convex: Literal["parts", "hull"] = key(
        "parts",
        "",
        "Outlines of the file that are not convex: `parts` cuts them into convex parts that move as one rigid floe, `hull` takes "
        "their hulls.",
    )
    smallest: NonNegative = key(
        0.0,
        "m",
        "Size, root of the plan area, below which outlines of the file are left out; those narrower than round edges always are.",
    )

    def faults(self) -> list[Fault]:
        if self.floe_size is not None and self.floe_count is not None:
            return [(("floe_count",), "give either floe_size or floe_count, not both")]
        return [*self._file_faults(), *self._shape_faults(), *self._size_faults()]

    def _file_faults(self) -> list[Fault]:
        if self.source != "file":
            return [] if self.file is None else [(("file",), 'belongs to source = "file"')]
        if self.file is None:
            return [(("source",), "needs a file of outlines")]
        if Path(self.file).suffix.lower() not in drawing.SUFFIXES:
            return [(("file",), f"must be a GeoJSON, WKT or CSV file, by its name, too: {', '.join(drawing.SUFFIXES)}")]
        given = [name for name in MADE if getattr(self, name) != type(self).model_fields[name].default]
        if given:
            return [((name,), 'belongs to source = "voronoi"; floes of a file are as they are drawn') for name in given]
        return content_faults(self.file, self.sha256)

    @model_validator(mode="after")
    def _note_content(self):
        if self.file is not None and self.sha256 is None:
            complete(self, "sha256", content_of(self.file))
        return self

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
        if self.floe_size is None and self.floe_count is None and not implied and self.source != "file":
            complete(self, "floe_size", 2.8)
        return self

    @property
    def asked_size(self) -> float | None:
        """Root of the mean floe area [m] that the case asks for; None where it asks for a number of floes."""
        return self.floe_size or (self.size_distribution and self.size_distribution.floe_size)

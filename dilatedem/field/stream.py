"""Ice without an end, for a side where it enters: strips across the drift, each a pure function of the case and of its number.

In the frame of the ice, strip k lies `width` upstream of strip k - 1; strip 0 begins at the downstream side of the domain at t = 0.
A cell belongs to the strip of its nucleus: it sticks out into the strips beside it as cells do, so that a field has no seam, and it
is the same whichever strips have been asked for before.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from dilatedem.field.endless import KEPT, Blocks, Course
from dilatedem.field.placement import VANISHING, dilated_areas, shrink_factor, shrunk
from dilatedem.field.recipe import PLAIN, Nuclei, Recipe, together
from dilatedem.field.tessellation import order_in_space
from dilatedem.geometry.outline import Outlines, area
from dilatedem.numerics.blocks import offsets
from dilatedem.numerics.plain import dot, norm

#: how wide a strip is, about: so many mean spacings of nuclei, and as many sizes of the largest cells; long beside the reach of a
#: cell, so that what lies farther downstream begins before, short beside a domain
WIDTH, LARGEST = 2.5, 1.5


@dataclass(frozen=True)
class Strip:
    """The floes of a strip.

    outlines   outer outlines (k, 2) [m] in world coordinates, where the ice stood or would have stood at t = 0
    plan_area  (floes,) plan area of each dilated floe [m2]
    which      (floes,) number of each among all cells of the stream, from strip 0 on
    narrow     cells that are too narrow for the dilated radius: open water instead
    """

    outlines: Outlines
    plan_area: np.ndarray
    which: np.ndarray
    narrow: int


class Cells:
    """The cells of all strips, `strips` to a block of nuclei. They tile the plane, or the channel, once."""

    def __init__(self, blocks: Blocks, course: Course, strips: int):
        self._blocks, self._course, self._strips = blocks, course, strips
        self._width = course.length / strips
        self._block = lru_cache(KEPT)(self._split)

    def first(self, number: int) -> int:
        """Number of a strip's first cell, when the cells of all strips are counted from those of strip 0 on."""
        block, strip = divmod(number, self._strips)
        return block * self._blocks.count + sum(len(nuclei.points) for nuclei in self._block(block)[:strip])

    def of(self, number: int) -> Outlines:
        """Convex cells of a strip [m], in its own frame: origin in its middle, x and y those of the domain."""
        own = self._nuclei(number)
        beside = 1
        while len(own.points):
            around = [own]
            for k in range(1, beside + 1):
                around += [self._nuclei(number + side * k).moved(self._course.along(side * k * self._width)) for side in (-1, 1)]
            nuclei, size = together(around), self._course.rectangle((2 * beside + 1) * self._width)
            cells = nuclei.cells(size, self._course.periodic(along=False), len(own.points))
            if self._are_whole(cells, own, range(number - beside - 1, number + beside + 2), 0.5 * size[self._course.axis]):
                return cells
            beside += 1
        return Outlines.of([])

    def _nuclei(self, number: int) -> Nuclei:
        """Those of a strip, in its own frame; neighbours have numbers that are near."""
        block, strip = divmod(number, self._strips)
        return self._block(block)[strip]

    def _split(self, number: int) -> list[Nuclei]:
        """The nuclei of a block's strips."""
        nuclei, axis = self._blocks.nuclei(number), self._course.axis
        places, along = nuclei.points.copy(), nuclei.points[:, axis] * self._strips
        strip = np.clip(np.floor(along), 0, self._strips - 1)  # a nucleus may have moved beyond the ends of its block
        places[:, axis] = along - strip  # within its strip
        places = (self._course.turned(places) - 0.5) * self._course.rectangle(self._width)
        found = []
        for k in range(self._strips):
            own = np.flatnonzero(strip == k)
            own = own[order_in_space(places[own] - places[own].min(axis=0, initial=0.0))]
            found.append(Nuclei(places[own], None if nuclei.weights is None else nuclei.weights[own]))
        return found

    def _are_whole(self, cells: Outlines, nuclei: Nuclei, strips: Sequence[int], half: float) -> bool:
        """Whether nothing beyond the strips that were laid out, `half` [m] from the middle, can cut these cells.

        A corner stands if no nucleus is nearer to it than its own, so that the circle of that radius must lie where all are known.
        strips: numbers of those, and of one more at either end.
        """
        blocks = [self._blocks.nuclei(block) for block in sorted({number // self._strips for number in strips})]
        own = np.repeat(np.arange(len(nuclei.points)), cells.sides)
        if nuclei.weights is None:
            reach = norm(cells.points - nuclei.points[own])
        else:  # the power distance, to the most that the weight of another takes off
            most, away = max(block.weights.max() for block in blocks), cells.points - nuclei.points[own]
            reach = np.sqrt(np.maximum(dot(away, away) - nuclei.weights[own] + most, 0.0))
        along = np.concatenate([block.points[:, self._course.axis] for block in blocks])
        beyond = self._course.length * max(0.0, -along.min(), along.max() - 1.0)  # of its block: there it is not looked for
        return bool((np.abs(cells.points[:, self._course.axis]) + reach < half - beyond).all())


class Stream:
    """The floes of all strips: cells shrunk by one factor, by which those of the strips of the domain have the concentration."""

    def __init__(
        self, course: Course, count: int, concentration: float, *, seed: int, radius: float, recipe: Recipe = PLAIN
    ):
        """count: cells to the area of a domain, about; radius: dilated radius [m].

        Raises ValueError where the concentration cannot be reached.
        """
        blocks = Blocks(course, recipe, count, seed)
        strips = max(1, round(course.length / max(WIDTH * blocks.spacing, LARGEST * blocks.largest)))
        self.course, self.width, self._radius = course, course.length / strips, radius
        #: cells in as many strips as the domain is long
        self.count, self._strips = blocks.count, strips
        self._cells = Cells(blocks, course, strips)
        #: strips that are kept in memory once they are made: those of the domain and of its margins, twice
        self.kept = 2 * strips + KEPT
        self.strip = lru_cache(self.kept)(self._strip)
        cells = Outlines.of([cell for number in range(strips) for cell in self._cells.of(number)])
        groups = cells.by_sides()
        ground = float(sum(area(corners).sum() for _, corners in groups))
        self.factor = shrink_factor(groups, concentration * ground, ground, radius)
        self.concentration = float(dilated_areas(groups, len(cells), self.factor, radius)[0].sum()) / ground

    def _strip(self, number: int) -> Strip:
        cells = self._cells.of(number)
        groups, first = cells.by_sides(), self.first(number)
        areas, _ = dilated_areas(groups, len(cells), self.factor, self._radius)
        _, narrow = dilated_areas(groups, len(cells), self.factor * (1.0 - VANISHING), self._radius)
        period = np.where(self.course.periodic(along=False), self.course.size, 0.0)
        place = self.course.along((number + 0.5) * self.width - 0.5 * self.course.length)
        outlines = shrunk(cells, self.factor, period)
        outlines = Outlines(outlines.points + place, outlines.start).where(~narrow)
        return Strip(outlines, areas[~narrow], first + np.flatnonzero(~narrow), int(narrow.sum()))

    def begins(self, number: int) -> float:
        """How far the first corner of a strip's floes lies upstream of the downstream side at t = 0 [m]."""
        return float(self.course.ahead(self.strip(number).outlines.points).min(initial=(number + 1) * self.width))

    def first(self, number: int) -> int:
        """Number of a strip's first cell."""
        return self._cells.first(number)

    def strip_of(self, cell: int) -> int:
        """Number of the strip that a cell belongs to."""
        number = cell * self._strips // self.count
        while self.first(number) > cell:
            number -= 1
        while self.first(number + 1) <= cell:
            number += 1
        return number

    def until(self, way: float) -> Sequence[int]:
        """Numbers of the strips of which some floe lies downstream of `way` [m] at t = 0, and reaches into the domain."""
        last = int(np.ceil(way / self.width)) + 1
        while self.begins(last) <= way:
            last += 1
        while self.begins(last - 1) > way:
            last -= 1
        first = -1
        while self.course.ahead(self.strip(first).outlines.points).max(initial=0.0) > 0.0:
            first -= 1
        return range(first + 1, last)

    def floes(self, numbers: Sequence[int]) -> Strip:
        """The floes of several strips together."""
        strips = [self.strip(number) for number in numbers]
        return Strip(
            Outlines(np.concatenate([each.outlines.points for each in strips]),
                     offsets(np.concatenate([each.outlines.sides for each in strips]))),
            np.concatenate([each.plan_area for each in strips]),
            np.concatenate([each.which for each in strips]),
            sum(each.narrow for each in strips),
        )  # fmt: skip


"""Ice without an end, for a side where it enters: strips across the drift, each a pure function of the case and of its number.

In the frame of the ice, strip k lies `width` upstream of strip k - 1; strip 0 begins at the downstream side of the domain at t = 0.
Nuclei are drawn strip by strip, and a cell belongs to the strip of its nucleus: it sticks out into the strips beside it as cells
do, so that a field has no seam, and it is the same whichever strips have been asked for before.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from dilatedem.field.placement import VANISHING, dilated_areas, shrink_factor, shrunk
from dilatedem.field.tessellation import cells_of_points, order_in_space
from dilatedem.geometry.outline import Outlines, area
from dilatedem.numerics.blocks import offsets
from dilatedem.numerics.plain import norm

#: mean spacings of nuclei that a strip is wide, about: long beside the reach of a cell, short beside a domain
WIDTH = 2.5
#: blocks of nuclei that are kept in memory once they are drawn
KEPT = 8


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


@dataclass(frozen=True)
class Course:
    """Which way the ice of a stream comes.

    size (2,) [m] of the domain; axis: that which it comes along; upstream: the sign of that direction, against the drift; across:
    whether the other axis is periodic.
    """

    size: tuple[float, float]
    axis: int
    upstream: int
    across: bool

    @property
    def length(self) -> float:
        """Extent of the domain along it [m]."""
        return self.size[self.axis]

    def rectangle(self, length: float) -> np.ndarray:
        """(2,) [m] extent of a part of the stream that is so long and as broad as the domain."""
        extent = np.array(self.size)
        extent[self.axis] = length
        return extent

    def ahead(self, points: np.ndarray) -> np.ndarray:
        """How far points (..., 2) [m] lie upstream of the downstream side."""
        return self.upstream * points[..., self.axis] + 0.5 * self.length

    def along(self, way: float) -> np.ndarray:
        """(2,) [m] a way against the drift."""
        step = np.zeros(2)
        step[self.axis] = self.upstream * way
        return step


class PoissonVoronoi:
    """Voronoi cells of points that are drawn uniformly, so many to every block of as many strips as the domain is long.

    So a block has the statistics of a field that ends: exactly as many cells, and its strips as many as chance gives them.
    """

    def __init__(self, course: Course, count: int, strips: int, seed: int):
        self._course, self._count, self._strips, self._seed = course, count, strips, seed
        self._width = course.length / strips
        self._block = lru_cache(KEPT)(self._draw)

    def first(self, number: int) -> int:
        """Number of a strip's first cell, when the cells of all strips are counted from those of strip 0 on."""
        block, strip = divmod(number, self._strips)
        return block * self._count + sum(len(nuclei) for nuclei in self._block(block)[:strip])

    def cells(self, number: int) -> Outlines:
        """Convex cells of a strip [m], in its own frame: origin in its middle, x and y those of the domain.

        Those of all strips together tile the plane, or the channel, once.
        """
        own = self._nuclei(number)
        beside = 1
        while len(own):
            around = [own]
            for k in range(1, beside + 1):
                around += [self._nuclei(number + side * k) + self._course.along(side * k * self._width) for side in (-1, 1)]
            points, size = np.concatenate(around), self._course.rectangle((2 * beside + 1) * self._width)
            periodic = [self._course.across and axis != self._course.axis for axis in range(2)]
            cells = cells_of_points(points, size, periodic).where(np.arange(len(points)) < len(own))
            if self._are_whole(cells, own, 0.5 * size[self._course.axis]):
                return cells
            beside += 1
        return Outlines.of([])

    def _nuclei(self, number: int) -> np.ndarray:
        """Those of a strip (n, 2) [m], in its own frame; neighbours have numbers that are near."""
        block, strip = divmod(number, self._strips)
        return self._block(block)[strip]

    def _draw(self, block: int) -> list[np.ndarray]:
        """The nuclei of a block's strips."""
        drawn = np.random.default_rng([self._seed, _natural(block)]).random((self._count, 2))
        along = drawn[:, self._course.axis] * self._strips
        strip = along.astype(np.int64)
        drawn[:, self._course.axis] = along - strip  # within its strip
        if self._course.upstream < 0:
            drawn[:, self._course.axis] = 1.0 - drawn[:, self._course.axis]
        places = [(drawn[strip == k] - 0.5) * self._course.rectangle(self._width) for k in range(self._strips)]
        return [points[order_in_space(points - points.min(axis=0, initial=0.0))] for points in places]

    def _are_whole(self, cells: Outlines, nuclei: np.ndarray, half: float) -> bool:
        """Whether nothing beyond the strips that were drawn, `half` [m] from the middle, can cut these cells.

        A corner stands if the circle about it through its nuclei holds no other, so that it must lie where all are drawn.
        """
        reach = norm(cells.points - np.repeat(nuclei, cells.sides, axis=0))
        return bool((np.abs(cells.points[:, self._course.axis]) + reach < half).all())


class Stream:
    """The floes of all strips: cells shrunk by one factor, by which those of the strips of the domain have the concentration."""

    def __init__(self, course: Course, count: int, concentration: float, *, seed: int, radius: float):
        """count: cells to the area of a domain; radius: dilated radius [m].

        Raises ValueError where the concentration cannot be reached.
        """
        strips = max(1, round(course.length / (WIDTH * np.sqrt(np.prod(course.size) / count))))
        self.course, self.width, self._radius = course, course.length / strips, radius
        self._count, self._strips = count, strips
        self._recipe = PoissonVoronoi(course, count, strips, seed)
        #: strips that are kept in memory once they are made: those of the domain and of its margins, twice
        self.kept = 2 * strips + KEPT
        self.strip = lru_cache(self.kept)(self._strip)
        cells = Outlines.of([cell for number in range(strips) for cell in self._recipe.cells(number)])
        groups = cells.by_sides()
        ground = float(sum(area(corners).sum() for _, corners in groups))
        self.factor = shrink_factor(groups, concentration * ground, ground, radius)
        self.concentration = float(dilated_areas(groups, len(cells), self.factor, radius)[0].sum()) / ground

    def _strip(self, number: int) -> Strip:
        cells = self._recipe.cells(number)
        groups, first = cells.by_sides(), self.first(number)
        areas, _ = dilated_areas(groups, len(cells), self.factor, self._radius)
        _, narrow = dilated_areas(groups, len(cells), self.factor * (1.0 - VANISHING), self._radius)
        period = np.where([self.course.across and axis != self.course.axis for axis in range(2)], self.course.size, 0.0)
        place = self.course.along((number + 0.5) * self.width - 0.5 * self.course.length)
        outlines = shrunk(cells, self.factor, period)
        outlines = Outlines(outlines.points + place, outlines.start).where(~narrow)
        return Strip(outlines, areas[~narrow], first + np.flatnonzero(~narrow), int(narrow.sum()))

    def begins(self, number: int) -> float:
        """How far the first corner of a strip's floes lies upstream of the downstream side at t = 0 [m]."""
        return float(self.course.ahead(self.strip(number).outlines.points).min(initial=(number + 1) * self.width))

    def first(self, number: int) -> int:
        """Number of a strip's first cell."""
        return self._recipe.first(number)

    def strip_of(self, cell: int) -> int:
        """Number of the strip that a cell belongs to."""
        number = cell * self._strips // self._count
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


def _natural(number: int) -> int:
    """A whole number as one that is not negative, one to one: seeds are."""
    return 2 * number if number >= 0 else -2 * number - 1

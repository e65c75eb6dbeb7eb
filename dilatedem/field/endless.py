"""Nuclei of ice without an end: blocks across the drift, as long as the domain, each a pure function of a recipe and of its number.

Each is drawn by itself, like a field that ends, and has the same number of nuclei and the same set of areas, if any is asked for.
Where nuclei move to the middles of their cells, those of the blocks beside move along, as on a belt that is closed far away: what
is done there fades on the way. So it does with weights, but for a constant that all those of a belt may have besides. That is why
every other block has the weights of its own belt, and the others those that fit between: their cells have exactly the areas asked
for, and only those of their neighbours differ a little, where two belts meet.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from dilatedem.field.laguerre import SETTLING, settled, weights_of_areas
from dilatedem.field.recipe import Nuclei, Recipe

#: blocks that are kept in memory once they are made, at each stage
KEPT = 8
#: how far away a belt is closed: so many sizes of the largest cells, and so many spacings more per root of the number of moves, as
#: what is done at an end spreads like heat. It moves a nucleus there by some 1 % of a spacing, at most
SHELTER, SPREAD = 4.0, 1.25


@dataclass(frozen=True)
class Course:
    """Which way the ice of a stream comes.

    size (2,) [m] of the domain; axis: that which it comes along; upstream: the sign of that direction, against the drift; whole:
    whether cells at the sides of the other axis are whole, as if it were periodic.
    """

    size: tuple[float, float]
    axis: int
    upstream: int
    whole: bool

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

    def periodic(self, along: bool) -> tuple[bool, bool]:
        """Which axes count as periodic where cells are made; along: whether that of the drift does."""
        x, y = (along if axis == self.axis else self.whole for axis in range(2))
        return x, y

    def turned(self, places: np.ndarray) -> np.ndarray:
        """Places (n, 2) in parts of a rectangle, told from its downstream side, from its lower left corner; and the other way."""
        told = places.copy()
        if self.upstream < 0:
            told[:, self.axis] = 1.0 - told[:, self.axis]
        return told


class Blocks:
    """The nuclei of all blocks: number 0 lies in the domain at t = 0, 1 upstream of it."""

    def __init__(self, course: Course, recipe: Recipe, count: int, seed: int):
        """count: how many nuclei to the area of the domain are asked for; every block has `self.count`."""
        self._course, self._recipe, self._asked, self._seed = course, recipe, count, seed
        self._size = np.array(course.size)
        self.count = recipe.count(self._size, count, course.periodic(along=True))
        #: m, root of the mean area of cells, and of that of the largest asked for
        self.spacing = self.largest = float(np.sqrt(np.prod(self._size) / self.count))
        if recipe.sizes is not None:
            self.largest *= float(np.sqrt(recipe.sizes.shares(self.count).max()))
        self._beside = self._blocks_beside()
        kept = KEPT + 2 * self._beside
        self.nuclei, self._drawn = lru_cache(KEPT)(self._nuclei), lru_cache(kept)(self._draw)
        self._settled, self._weighed = lru_cache(kept)(self._settle), lru_cache(KEPT)(self._weigh)

    def _nuclei(self, number: int) -> Nuclei:
        """Those of a block: places (n, 2) in parts of its extent, from its downstream side, and weights [m2]."""
        if not self._beside:
            return Nuclei(self._drawn(number)[0])
        places = self._course.turned(self._settled(number)[0] / self._size + 0.5)
        return Nuclei(places, None if self._recipe.sizes is None else self._weights(number))

    def _blocks_beside(self) -> int:
        """How many blocks on either side move along with one."""
        moves = self._recipe.regularity + (SETTLING if self._recipe.sizes is not None else 0)
        away = SHELTER * self.largest + SPREAD * math.sqrt(moves) * self.spacing
        return math.ceil(away / self._course.length) if moves else 0

    def _draw(self, number: int) -> tuple[np.ndarray, np.ndarray | None]:
        """Places (n, 2) of a block's nuclei, as in `_nuclei`, before they move, and the areas that their cells are to have [m2]."""
        generator = np.random.default_rng([self._seed, natural(number)])
        places = self._recipe.places(self._size, self._asked, self._course.periodic(along=True), generator)
        return places, None if self._recipe.sizes is None else self._recipe.areas(self._size, self.count, generator)

    def _settle(self, number: int) -> tuple[np.ndarray, np.ndarray | None]:
        """Points (n, 2) [m] of a block's nuclei once they have moved, in its frame, and weights of its belt, about."""
        belt, moved = self._belt(number, lambda k: (self._course.turned(self._drawn(k)[0]) - 0.5) * self._size), None
        if self._recipe.sizes is None:
            points = self._recipe.settled(*belt)
        else:
            points, moved = settled(belt[0], self._areas(number), *belt[1:], self._recipe.regularity)
        return self._own(points), moved

    def _weigh(self, number: int) -> np.ndarray:
        """(blocks, n) [m2] weights with which the cells of a belt, closed in itself, have their areas."""
        points, *belt = self._belt(number, lambda k: self._settled(k)[0])
        weights = weights_of_areas(points, self._settled(number)[1], self._areas(number), *belt)
        return weights.reshape(-1, self.count)

    def _weights(self, number: int) -> np.ndarray:
        """(n,) [m2] weights of a block: those of its belt, or those that fit in between the belts beside."""
        own, weights = self._beside, self._weighed(number)
        if number % 2 == 0:
            return weights[own]
        points, *belt = self._belt(number, lambda k: self._settled(k)[0])
        along, half = self._course.upstream * points[:, self._course.axis].reshape(weights.shape), 0.5 * self._course.length
        beside = {own + side: self._weighed(number + side)[own] for side in (-1, 1)}
        steps = [  # between two belts, near where they meet; a slope of weights moves cells, a step would squeeze them
            float((held - weights[k])[np.abs(np.abs(along[k]) - half) < self.largest].mean()) for k, held in beside.items()
        ]
        weights = weights + np.interp(along, [-half, half], steps)
        free = np.zeros(weights.shape, np.bool_)
        free[own] = True
        for k, held in beside.items():
            weights[k] = held
        return self._own(weights_of_areas(points, weights.ravel(), self._areas(number), *belt, free.ravel()))

    def _belt(self, number: int, points: Callable[[int], np.ndarray]) -> tuple[np.ndarray, np.ndarray, tuple[bool, bool]]:
        """Points (m, 2) [m] of a block and those beside it, in its frame, the size of that belt, and which of its axes are closed.

        points(k): those of block k in its own frame.
        """
        length, blocks = self._course.length, range(-self._beside, self._beside + 1)
        found = np.concatenate([points(number + k) + self._course.along(k * length) for k in blocks])
        return found, self._course.rectangle(len(blocks) * length), self._course.periodic(along=True)

    def _areas(self, number: int) -> np.ndarray:
        """(m,) [m2] areas of the cells of a belt."""
        return np.concatenate([self._drawn(number + k)[1] for k in range(-self._beside, self._beside + 1)])

    def _own(self, values: np.ndarray) -> np.ndarray:
        """Of values (m, ...) of the nuclei of a belt those of the block in its middle."""
        return values[self._beside * self.count : (self._beside + 1) * self.count]


def natural(number: int) -> int:
    """A whole number as one that is not negative, one to one: seeds are."""
    return 2 * number if number >= 0 else -2 * number - 1

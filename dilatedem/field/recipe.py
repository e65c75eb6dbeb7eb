"""What a field is cut from: nuclei, and the cells around them. A recipe makes the nuclei of any rectangle of the plane.

Nuclei of several rectangles, laid side by side, have cells without a seam: cells depend on the nuclei near them alone.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from dilatedem.field.distribution import SizeDistribution
from dilatedem.field.laguerre import cells_of_weights, nuclei_of_areas
from dilatedem.field.lattice import hexagons, squares
from dilatedem.field.tessellation import cells_of_points, centroids, order_in_space
from dilatedem.geometry.outline import Outlines

LATTICES = {"square": squares, "hexagon": hexagons}


@dataclass(frozen=True, eq=False)
class Nuclei:
    """Points (n, 2) [m], near ones with numbers that are near, and their weights (n,) [m2] where cells have areas of their own."""

    points: np.ndarray
    weights: np.ndarray | None = None

    def cells(self, size: np.ndarray, periodic: Sequence[bool], first: int | None = None) -> Outlines:
        """Their cells, which fill a domain of `size` (2,) [m] about the origin; first: of so many nuclei alone."""
        if self.weights is not None:
            return cells_of_weights(self.points, self.weights, size, periodic, first)
        cells = cells_of_points(self.points, size, periodic)
        return cells if first is None else cells.where(np.arange(len(cells)) < first)

    def moved(self, way: np.ndarray) -> Nuclei:
        """The same a `way` (2,) [m] away."""
        return Nuclei(self.points + way, self.weights)


def together(several: Sequence[Nuclei]) -> Nuclei:
    """The nuclei of several rectangles, one after the other."""
    weights = None if several[0].weights is None else np.concatenate([nuclei.weights for nuclei in several])
    return Nuclei(np.concatenate([nuclei.points for nuclei in several]), weights)


@dataclass(frozen=True)
class Recipe:
    """How the cells of a field come about.

    shape       "voronoi": around random points; "square", "hexagon": around those of a lattice
    regularity  how often each random point is moved to the middle of its cell (Lloyd 1982): cells become alike, and round
    sizes       the distribution of floe sizes; None: what comes about by itself
    """

    shape: str = "voronoi"
    regularity: int = 0
    sizes: SizeDistribution | None = None

    def count(self, size: Sequence[float], count: int, periodic: Sequence[bool]) -> int:
        """How many nuclei a rectangle of `size` (2,) [m] has where about `count` are asked for."""
        if self.shape in LATTICES:
            return len(LATTICES[self.shape](size, count, periodic))
        return count

    def nuclei(self, size: np.ndarray, count: int, periodic: Sequence[bool], generator: np.random.Generator) -> Nuclei:
        """Those of a rectangle of `size` (2,) [m] about the origin, whose boundaries count as `periodic` or as mirrors.

        count: as `count` says. The same state of the generator gives the same nuclei. Raises ValueError for none at all.
        """
        if count < 1:
            raise ValueError(f"floe count = {count}: must be at least 1")
        places = self.places(size, count, periodic, generator)
        points = (places - 0.5) * size
        if self.shape in LATTICES:
            return Nuclei(points[order_in_space(points + 0.5 * size)])
        points = points[order_in_space(places * size)]
        if self.sizes is None:
            return Nuclei(self.settled(points, size, periodic))
        return Nuclei(*nuclei_of_areas(points, self.areas(size, count, generator), size, periodic, self.regularity))

    def places(self, size: np.ndarray, count: int, periodic: Sequence[bool], generator: np.random.Generator) -> np.ndarray:
        """(n, 2) where nuclei are drawn in a rectangle of `size` (2,) [m], in parts of it from its lower left corner."""
        if self.shape in LATTICES:
            return LATTICES[self.shape](size, count, periodic)
        return generator.random((count, 2))

    def areas(self, size: np.ndarray, count: int, generator: np.random.Generator) -> np.ndarray:
        """(count,) [m2] areas that cells are to have by the distribution of sizes, in random order; they fill the rectangle."""
        shares = generator.permutation(self.sizes.shares(count))
        return shares * (float(np.prod(size)) / shares.sum())

    def settled(self, points: np.ndarray, size: np.ndarray, periodic: Sequence[bool]) -> np.ndarray:
        """Points (n, 2) [m] that say the sizes of their cells by themselves, after they have moved to the middles of these."""
        for _ in range(self.regularity):
            points = centroids(cells_of_points(points, size, periodic), size, periodic)
        return points


#: cells of random points
PLAIN = Recipe()

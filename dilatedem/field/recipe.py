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

    def cells(self, size: np.ndarray, periodic: Sequence[bool]) -> Outlines:
        """Their cells, which fill a domain of `size` (2,) [m] about the origin."""
        if self.weights is None:
            return cells_of_points(self.points, size, periodic)
        return cells_of_weights(self.points, self.weights, size, periodic)


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
            return len(LATTICES[self.shape](np.asarray(size, float), count, periodic))
        return count

    def nuclei(self, size: np.ndarray, count: int, periodic: Sequence[bool], generator: np.random.Generator) -> Nuclei:
        """Those of a rectangle of `size` (2,) [m] about the origin, whose boundaries count as `periodic` or as mirrors.

        count: as `count` says. The same state of the generator gives the same nuclei. Raises ValueError for none at all.
        """
        if count < 1:
            raise ValueError(f"floe count = {count}: must be at least 1")
        if self.shape in LATTICES:
            points = LATTICES[self.shape](size, count, periodic)
            return Nuclei(points[order_in_space(points + 0.5 * size)])
        drawn = generator.random((count, 2))
        points = (drawn[order_in_space(drawn * size)] - 0.5) * size
        if self.sizes is None:
            for _ in range(self.regularity):
                points = centroids(cells_of_points(points, size, periodic), size, periodic)
            return Nuclei(points)
        shares = generator.permutation(self.sizes.shares(count))
        return Nuclei(*nuclei_of_areas(points, shares * (float(np.prod(size)) / shares.sum()), size, periodic, self.regularity))

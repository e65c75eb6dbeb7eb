"""Points of a lattice, whose cells are squares or hexagons: as nearly as whole numbers of them fit into a domain.

Where they lie is told in parts of the domain's `size`, from its lower left corner.
"""

from collections.abc import Sequence

import numpy as np

#: distance of two columns of hexagons over that of two in a column
HEXAGON = 0.5 * 3.0**0.5


def squares(size: np.ndarray, count: int, periodic: Sequence[bool]) -> np.ndarray:
    """(n, 2) middles of some `count` cells of a domain of `size` (2,) [m], in rows and columns."""
    pitch = float(np.sqrt(np.prod(size) / count))
    columns, rows = (max(1, round(float(length) / pitch)) for length in size)
    return _places(columns, rows, 0.0)


def hexagons(size: np.ndarray, count: int, periodic: Sequence[bool]) -> np.ndarray:
    """The same, every other column half a cell further along y; along x a periodic domain takes an even number of columns.

    Cells at sides that are not periodic are cut straight there.
    """
    pitch = float(np.sqrt(np.prod(size) / count / HEXAGON))  # along y
    even = 2 if periodic[0] else 1
    columns = even * max(1, round(float(size[0]) / (even * HEXAGON * pitch)))
    rows = max(1, round(count / columns))
    return _places(columns, rows, 0.25)


def _places(columns: int, rows: int, shift: float) -> np.ndarray:
    """Middles of a grid, its columns shifted by `shift` cells up and down in turn."""
    column, row = (axis.ravel() for axis in np.meshgrid(np.arange(columns), np.arange(rows), indexing="ij"))
    along = row + 0.5 + shift * np.where(column % 2 == 0, 1.0, -1.0)
    return np.column_stack([(column + 0.5) / columns, along / rows])

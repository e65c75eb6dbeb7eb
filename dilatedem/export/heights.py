"""How a load spreads over height, from a load map: shares for the nodes of a beam."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from dilatedem.results.archive import LoadMap


@dataclass(frozen=True)
class Spread:
    """Shares of the normal impulse by height; rows from below."""

    edges: np.ndarray  # (n + 1,) [m] over the water level
    impulse: np.ndarray  # (n,) [N s], normal to the surface, over the run
    duration: float  # s

    @property
    def share(self) -> np.ndarray:
        """(n,) of the whole; zero where there was no load at all."""
        whole = float(self.impulse.sum())
        return self.impulse / whole if whole > 0.0 else np.zeros(len(self.impulse))

    @property
    def middle(self) -> np.ndarray:
        return 0.5 * (self.edges[1:] + self.edges[:-1])

    @property
    def height(self) -> float:
        """Of the load's resultant [m]: shares of it at `middle` have it there."""
        return float(self.share @ self.middle)


def spread_over_height(load_map: LoadMap) -> Spread:
    """The impulses of a map summed over places."""
    return Spread(load_map.height_edges, load_map.impulse.sum(axis=0), load_map.duration)

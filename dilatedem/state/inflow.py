"""How far the ice that enters has come: beside the case, all that its next strip depends on."""

from typing import NamedTuple

import numpy as np


class Inflow(NamedTuple):
    """The next strip, and what has entered and left so far."""

    strip: np.ndarray  # (1,) number of the strip that enters next
    lag: np.ndarray  # (1,) m, by which it is behind the drift since t = 0: it had to wait for room
    waited: np.ndarray  # (1,) s that strips have waited
    since: np.ndarray  # (1,) s, time at which one had to wait first; infinite: never
    entered: np.ndarray  # (1,) floes
    left: np.ndarray  # (1,) bodies, through any side
    omitted: np.ndarray  # (1,) floes of those strips that were open water instead: too small, or in the way of a structure
    carried_in: np.ndarray  # (1,) J, energy that floes had when they entered


def inflow_at_start(strip: int) -> Inflow:
    """Nothing has entered; strip: the one that enters first."""
    real = {name: np.zeros(1) for name in ("lag", "waited", "carried_in")}
    counts = {name: np.zeros(1, np.int64) for name in ("entered", "left", "omitted")}
    return Inflow(strip=np.array([strip]), since=np.full(1, np.inf), **real, **counts)

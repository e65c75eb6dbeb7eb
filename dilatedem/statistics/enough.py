"""How many runs are enough: how a band narrows with their number."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np

from dilatedem.statistics.bands import FEWEST, TAIL, Band, mean, sample, student

#: more values than anybody will have are not told
MOST = 100_000


def growth(values: Sequence[float], estimate: Callable[[Sequence[float]], Band] = mean) -> list[Band]:
    """The estimate of the first 1, 2, ... n values, in the order in which they came."""
    found = [value for value in values if math.isfinite(value)]
    return [estimate(found[:count]) for count in range(1, len(found) + 1)]


def needed(values: Sequence[float], share: float) -> int | None:
    """How many values it takes until Student's band of their mean reaches no farther from it than so large a share of it.

    From the spread of those that are there; None where they are too few to tell.
    """
    x = sample(values)
    if len(x) < FEWEST or x.mean() == 0.0:
        return None
    allowed = share * abs(float(x.mean())) / float(x.std(ddof=1)) if x[0] < x[-1] else math.inf
    counts = np.arange(FEWEST, MOST)
    close = student(1.0 - TAIL, counts - 1) <= allowed * np.sqrt(counts)
    return int(counts[np.argmax(close)]) if close.any() else None

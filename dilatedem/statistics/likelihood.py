"""Bands by profile likelihood: what a quantity may be before the data become too unlikely, all else chosen for the best."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from dilatedem.statistics.bands import TAIL, student

#: what stands for a likelihood of 0; times more than 1, the farther from what is possible, so that searches find their way back
IMPOSSIBLE = 1e12
#: of the best quantity's scale: first step outwards, and how closely an end is found
STEP, PRECISION = 0.2, 2e-3
#: first steps of a search in each parameter, and what of a parameter, and of the log-likelihood, is close enough
SEARCH, CLOSE = 0.1, {"xatol": 1e-3, "fatol": 1e-5}
#: steps outwards, each half as long again, before an end counts as open
OUTWARDS = 30
#: shapes looked at: lighter or heavier tails than any load has
SHAPES = (-0.9, 2.0)


def minimum(cost: Callable[[np.ndarray], float], start: list[float]) -> tuple[float, np.ndarray]:
    """Least cost and where it is, from a start nearby."""
    from scipy import optimize  # only where a law is fitted: it takes a quarter of a second to load

    corners = np.vstack([start, np.asarray(start) + SEARCH * np.eye(len(start))])
    found = optimize.minimize(cost, start, method="Nelder-Mead", options={"initial_simplex": corners, "maxiter": 800, **CLOSE})
    return float(found.fun), found.x


def critical(n: int, parameters: int) -> float:
    """What twice the log-likelihood may lack at the ends of a band: chi-square of one degree, by Student's law for few values."""
    return float(student(1.0 - TAIL, max(n - parameters, 1))) ** 2


def profile_ends(lacking: Callable[[float], float], best: float, scale: float, limit: float) -> tuple[float, float]:
    """Where twice the lacking log-likelihood of a quantity reaches `limit`, below and above its best value; infinite if nowhere."""
    return _end(lacking, best, -scale, limit), _end(lacking, best, scale, limit)


def _end(lacking: Callable[[float], float], best: float, scale: float, limit: float) -> float:
    inside, step = best, STEP * scale
    for _ in range(OUTWARDS):
        outside = inside + step
        if lacking(outside) > limit:
            return _between(lacking, inside, outside, limit, PRECISION * abs(scale))
        inside, step = outside, 1.5 * step
    return math.copysign(math.inf, scale)


def _between(lacking: Callable[[float], float], inside: float, outside: float, limit: float, precision: float) -> float:
    """By halving: at the edge of what is possible a search may end short of the best, where quicker ways would lose the root."""
    while abs(outside - inside) > precision:
        middle = 0.5 * (inside + outside)
        if lacking(middle) > limit:
            outside = middle
        else:
            inside = middle
    return 0.5 * (inside + outside)

"""Highest loads of independent runs by the generalized extreme value law, scipy.stats.genextreme with c = -shape."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace

import numpy as np
from scipy.special import gamma

from dilatedem.statistics.bands import Band, sample
from dilatedem.statistics.likelihood import IMPOSSIBLE, SHAPES, critical, minimum, profile_ends

#: with fewer values the shape says nothing, and bands of it hold too seldom (validation/statistics)
FEWEST = 20
#: shapes nearer to 0 are Gumbel's law to double precision
STRAIGHT = 1e-7
#: exponents beyond this make a likelihood of 0, before they overflow
LARGEST = 300.0

Cost = Callable[[np.ndarray], float]


@dataclass(frozen=True)
class GEV:
    """The law that fits (n,) highest loads: P(highest < x) = exp(-(1 + shape (x - location)/scale)^(-1/shape)).

    shape > 0: a heavy tail without an end; 0: Gumbel's; < 0: no load above location - scale/shape.
    """

    maxima: np.ndarray
    location: float
    scale: float
    shape: Band

    def value(self, runs: float) -> float:
        """The load that one of so many runs exceeds."""
        return float(self.location + self.scale * _reduced(self.shape.value, runs))

    def level(self, runs: float) -> Band:
        """The same with its band by profile likelihood."""
        start, best = [math.log(self.scale), self.shape.value], self.value(runs)

        def cost(value: float) -> Cost:
            def of(rest: np.ndarray) -> float:
                scale = math.exp(rest[0])
                return _unlikelihood(self.maxima, value - scale * _reduced(rest[1], runs), scale, rest[1])

            return of

        ends = profile_ends(_lacking(self, cost, start), best, max(self.scale, 0.1 * abs(best)), critical(len(self.maxima), 3))
        return Band(len(self.maxima), best, *ends)


def fit_gev(values: Iterable[float]) -> GEV | None:
    """The law of most likelihood; None for fewer than FEWEST values, or where a third of them are the same.

    So many, as of runs that no ice met, are a step that no law of this kind has: with k of n at its lower end the likelihood goes
    with scale^((n - k)/shape - k) for a small scale, which is without bounds at the heaviest tail that is looked at.
    """
    x = sample(values)
    if len(x) < FEWEST or np.unique(x, return_counts=True)[1].max() * (1.0 + SHAPES[1]) >= len(x):
        return None
    location, scale, shape = by_moments(x)
    spread = float(x.std())
    _, best = minimum(
        lambda p: _unlikelihood(x, location + spread * p[0], math.exp(p[1]), p[2]), [0.0, math.log(scale), shape]
    )  # fmt: skip
    fitted = GEV(x, location + spread * float(best[0]), math.exp(best[1]), Band(len(x), float(best[2])))

    def cost(value: float) -> Cost:
        return lambda rest: _unlikelihood(x, location + spread * rest[0], math.exp(rest[1]), value)

    ends = profile_ends(_lacking(fitted, cost, list(best[:2])), float(best[2]), 0.2, critical(len(x), 3))
    return replace(fitted, shape=Band(len(x), float(best[2]), *ends))


def _lacking(law: GEV, cost: Callable[[float], Cost], start: list[float]) -> Callable[[float], float]:
    """Twice what the log-likelihood lacks for a value of one quantity, the two others, from `start`, chosen for the best."""
    least = _unlikelihood(law.maxima, law.location, law.scale, law.shape.value)
    nearby = [np.asarray(start)]

    def lacking(value: float) -> float:
        found, nearby[0] = minimum(cost(value), list(nearby[0]))
        return 2.0 * (found - least)

    return lacking


def _reduced(shape: float, runs: float) -> float:
    """Level of the law with location 0 and scale 1."""
    rare = -math.log1p(-1.0 / runs)
    return -math.log(rare) if abs(shape) < STRAIGHT else (rare**-shape - 1.0) / shape


def _unlikelihood(x: np.ndarray, location: float, scale: float, shape: float) -> float:
    """Minus the log-likelihood of values (n,), ascending."""
    if not SHAPES[0] < shape < SHAPES[1]:
        return IMPOSSIBLE * (1.0 + abs(shape))
    reach = (x - location) / scale
    if abs(shape) >= STRAIGHT:
        least = 1.0 + shape * float(reach[0] if shape > 0.0 else reach[-1])
        if least <= 0.0:
            return IMPOSSIBLE * (1.0 - least)
        reach = np.log1p(shape * reach) / shape
    if -reach[0] > LARGEST:
        return IMPOSSIBLE
    return len(x) * math.log(scale) + (1.0 + shape) * float(reach.sum()) + float(np.exp(-reach).sum())


def by_moments(x: np.ndarray) -> tuple[float, float, float]:
    """Location, scale and shape from probability-weighted moments of values (n,), ascending (Hosking, Wallis & Wood 1985)."""
    n, rank = len(x), np.arange(len(x))
    first = float(x.mean())
    second, third = float((x * rank).mean()) / (n - 1), float((x * rank * (rank - 1)).mean()) / ((n - 1) * (n - 2))
    ratio = (2.0 * second - first) / (3.0 * third - first) - math.log(2.0) / math.log(3.0)
    bend = 7.8590 * ratio + 2.9554 * ratio**2
    bend = math.copysign(min(max(abs(bend), 1e-6), 0.8), bend)
    scale = (2.0 * second - first) * bend / (gamma(1.0 + bend) * (1.0 - 2.0**-bend))
    return float(first + scale * (gamma(1.0 + bend) - 1.0) / bend), float(scale), -bend

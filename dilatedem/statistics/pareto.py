"""Hits above a threshold by the generalized Pareto law (scipy.stats.genpareto), and the loads that runs exceed by it."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from dilatedem.statistics.bands import TAIL, Band, chi_square, sample
from dilatedem.statistics.likelihood import IMPOSSIBLE, SHAPES, critical, minimum, profile_ends

#: with fewer hits above the threshold no law is fitted
FEWEST = 20
#: shapes nearer to 0 are the exponential law to double precision
STRAIGHT = 1e-7
#: samples that the chance of a fit is judged by, always the same ones
RESAMPLES = 200


@dataclass(frozen=True)
class Pareto:
    """The law that fits (n,) peaks over a threshold [N], ascending: P(peak > x) = (1 + shape (x - threshold)/scale)^(-1/shape).

    rate: hits in a run, which come as Poisson's law says. Bands take hits for independent.
    """

    peaks: np.ndarray
    threshold: float
    runs: int
    rate: Band
    scale: float
    shape: Band
    chance: float  # that hits of this law lie as badly on it (Anderson and Darling's distance)

    def value(self, runs: float) -> float:
        """The load that one of so many runs exceeds; nan where it is no higher than the threshold."""
        rarity = self._rarity(runs, self.rate.value)
        return self.threshold + self.scale * _reach(self.shape.value, rarity) if rarity > 0.0 else math.nan

    def level(self, runs: float) -> Band:
        """The same with its band by profile likelihood of rate, scale and shape together."""
        count, value = len(self.peaks), self.value(runs)
        if not math.isfinite(value):
            return Band(count, math.nan)
        over = self.peaks - self.threshold
        least = _unlikelihood(over, self.scale, self.shape.value)
        nearby = [np.array([0.0, self.shape.value])]

        def cost(level: float, rest: np.ndarray) -> float:
            rarity = self._rarity(runs, self.rate.value * math.exp(rest[0]))
            if rarity <= 0.0 or level <= self.threshold:
                return IMPOSSIBLE
            scale = (level - self.threshold) / _reach(rest[1], rarity)
            return _unlikelihood(over, scale, rest[1]) + count * (math.expm1(rest[0]) - rest[0])

        def lacking(level: float) -> float:
            found, nearby[0] = minimum(lambda rest: cost(level, rest), list(nearby[0]))
            return 2.0 * (found - least)

        low, high = profile_ends(lacking, value, 0.3 * (value - self.threshold), critical(count, 2))
        return Band(count, value, max(low, self.threshold), high)

    @staticmethod
    def _rarity(runs: float, rate: float) -> float:
        """-ln P(peak > level) of a level that a run exceeds with a chance of 1/runs: P(highest < x) = exp(-rate P(peak > x))."""
        return math.log(rate) - math.log(-math.log1p(-1.0 / runs))


def fit_pareto(peaks: Iterable[float], threshold: float, runs: int) -> Pareto | None:
    """The law of most likelihood of the peaks [N] over the threshold that so many runs had; None where these are too few."""
    x = sample(peaks)
    x = x[x > threshold]
    count = len(x)
    if count < FEWEST or x[0] == x[-1]:
        return None
    over = x - threshold
    scale, shape = (float(part[0]) for part in moments_of_rows(over[None, :]))
    least, (log_scale, shape) = minimum(lambda p: _unlikelihood(over, math.exp(p[0]), p[1]), [math.log(scale), shape])
    nearby = [log_scale]

    def lacking(value: float) -> float:
        found, best = minimum(lambda p: _unlikelihood(over, math.exp(p[0]), value), nearby)
        nearby[0] = float(best[0])
        return 2.0 * (found - least)

    ends = profile_ends(lacking, float(shape), 0.2, critical(count, 2))
    low, high = (chi_square(share, freedom) / 2.0 for share, freedom in ((TAIL, 2 * count), (1.0 - TAIL, 2 * count + 2)))
    return Pareto(
        peaks=x, threshold=threshold, runs=runs, rate=Band(runs, count / runs, low / runs, high / runs), scale=math.exp(log_scale),
        shape=Band(count, float(shape), *ends), chance=fit_chance(over),
    )  # fmt: skip


def _reach(shape: float, rarity: float) -> float:
    """(P^(-shape) - 1)/shape of a peak that is exceeded with the chance P = exp(-rarity), of the law with scale 1."""
    return rarity if abs(shape) < STRAIGHT else math.expm1(shape * rarity) / shape


def _unlikelihood(over: np.ndarray, scale: float, shape: float) -> float:
    """Minus the log-likelihood of peaks less the threshold (n,)."""
    if not SHAPES[0] < shape < SHAPES[1]:
        return IMPOSSIBLE * (1.0 + abs(shape))
    if abs(shape) < STRAIGHT:
        return len(over) * math.log(scale) + float(over.sum()) / scale
    if (inside := 1.0 + shape * over[-1] / scale) <= 0.0:
        return IMPOSSIBLE * (1.0 - inside)
    return len(over) * math.log(scale) + (1.0 + 1.0 / shape) * float(np.log1p(shape / scale * over).sum())


def fit_chance(over: np.ndarray) -> float:
    """Chance that peaks of this law lie as far from the one that is fitted to them: by samples of that law."""
    from scipy import stats  # only where a law is fitted: it takes half a second to load

    rows = np.random.default_rng(1).uniform(size=(RESAMPLES, len(over)))
    rows.sort(axis=1)
    _, shape = (float(part[0]) for part in moments_of_rows(over[None, :]))
    made = stats.genpareto.ppf(rows, shape)
    return float(np.mean(_distance(made) >= _distance(over[None, :])[0]))


def moments_of_rows(rows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Scale and shape (rows,) by probability-weighted moments of rows (rows, n), ascending (Hosking & Wallis 1987)."""
    n = rows.shape[1]
    first = rows.mean(axis=1)
    second = (rows * (n - 1 - np.arange(n))).mean(axis=1) / (n - 1)
    shape = np.clip(2.0 - first / (first - 2.0 * second), 0.9 * SHAPES[0], 0.9)
    return first * (1.0 - shape), shape


def _distance(rows: np.ndarray) -> np.ndarray:
    """Anderson and Darling's distance (rows,) of every row (rows, n), ascending, from the law fitted to it."""
    from scipy import stats

    n = rows.shape[1]
    scale, shape = (part[:, None] for part in moments_of_rows(rows))
    below = np.clip(stats.genpareto.cdf(rows, shape, scale=scale), 1e-12, 1.0 - 1e-12)
    weight = (2.0 * np.arange(1, n + 1) - 1.0) / n
    return -n - (weight * (np.log(below) + np.log1p(-below[:, ::-1]))).sum(axis=1)

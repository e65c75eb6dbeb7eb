"""Highest loads of independent runs by Gumbel's law, P(highest < x) = exp(-exp(-(x - location)/scale)), with exact bands."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from dilatedem.statistics.bands import TAIL, Band, sample

#: samples of the standard law that bands are made of, always the same ones
RESAMPLES = 4000
#: steps to the scale; the last moves no digit that matters
STEPS = 12
#: with fewer values no law is fitted
FEWEST = 5
#: scale of values that are all the same, so that nothing is divided by none
NO_SCALE = 1e-100


@dataclass(frozen=True)
class Gumbel:
    """The law that fits (n,) highest loads, ascending. Bands take it for true."""

    maxima: np.ndarray
    location: Band
    scale: Band
    correlation: float  # of the loads with the law's, on Gumbel paper: 1 on a straight line
    chance: float  # that loads of this law correlate as badly

    def level(self, runs: float) -> Band:
        """The load that one of so many runs exceeds: a run does with a chance of 1/runs."""
        return _band(self.maxima, self.location.value, self.scale.value, reduced(runs))


def reduced(runs: float | np.ndarray) -> float | np.ndarray:
    """Gumbel's variate -ln(-ln(1 - 1/runs)): what is straight on Gumbel paper."""
    return -np.log(-np.log1p(-1.0 / np.asarray(runs, dtype=float)))


def plotting_places(count: int) -> np.ndarray:
    """(count,) shares that the sorted values stand for (Gringorten's, for this law)."""
    return (np.arange(1, count + 1) - 0.44) / (count + 0.12)


def fit_gumbel(values: Iterable[float]) -> Gumbel | None:
    """The law of most likelihood; None for too few values, or such that are all the same."""
    x = sample(values)
    if len(x) < FEWEST or x[0] == x[-1]:
        return None
    location, scale = (float(part[0]) for part in fit_rows(x[None, :]))
    _, scales, correlations = _standard(len(x))
    narrow, wide = np.quantile(scales, [TAIL, 1.0 - TAIL])
    correlation = float(_correlation(x[None, :])[0])
    return Gumbel(
        maxima=x,
        location=_band(x, location, scale, 0.0),
        scale=Band(len(x), scale, float(scale / wide), float(scale / narrow)),
        correlation=correlation,
        chance=float(np.mean(correlations <= correlation)),
    )


def _band(x: np.ndarray, location: float, scale: float, variate: float) -> Band:
    """location + variate scale. Its error over the fitted scale has the same law whatever the true ones are: no approximation."""
    locations, scales, _ = _standard(len(x))
    errors = (locations + variate * scales - variate) / scales
    below, above = np.quantile(errors, [TAIL, 1.0 - TAIL])
    value = location + variate * scale
    return Band(len(x), float(value), float(value - above * scale), float(value - below * scale))


@lru_cache(maxsize=64)
def _standard(count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Location, scale and correlation fitted to RESAMPLES samples of `count` values of the law with location 0 and scale 1."""
    samples = np.random.default_rng(1).gumbel(size=(RESAMPLES, count))
    samples.sort(axis=1)
    return *fit_rows(samples), _correlation(samples)


def _correlation(rows: np.ndarray) -> np.ndarray:
    """Of every row (rows, n), ascending, with the law's own quantiles."""
    straight = -np.log(-np.log(plotting_places(rows.shape[1])))
    straight = straight - straight.mean()
    apart = rows - rows.mean(axis=1, keepdims=True)
    return apart @ straight / np.sqrt((apart**2).sum(axis=1) * (straight**2).sum())


def fit_rows(rows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Location and scale (rows,) of most likelihood of every row (rows, n); scipy's gumbel_r.fit, for many at once.

    The scale b solves b = mean - sum(x exp(-x/b))/sum(exp(-x/b)), by Newton's steps from that of the variance.
    """
    least = rows.min(axis=1, keepdims=True)
    x = rows - least
    average = x.mean(axis=1, keepdims=True)
    scale = np.maximum(np.sqrt(6.0) / math.pi * x.std(axis=1, keepdims=True), NO_SCALE)
    for _ in range(STEPS):
        weight = np.exp(-x / scale)
        total = weight.sum(axis=1, keepdims=True)
        first, second = (x * weight).sum(axis=1, keepdims=True) / total, (x**2 * weight).sum(axis=1, keepdims=True) / total
        step = (scale - average + first) / (1.0 + (second - first**2) / scale**2)
        scale = np.maximum(scale - step, 0.1 * scale)
    location = least - scale * np.log(np.exp(-x / scale).mean(axis=1, keepdims=True))
    return location[:, 0], scale[:, 0]

"""What a handful of seeds can tell: bands of a mean and a median, paired tests, trends, exponents."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy import stats

CONFIDENCE = 0.95
RESAMPLES = 10_000  # of the bootstrap
#: with fewer values no band is given: of two, Student's is twelve times as wide as they are apart
FEWEST = 3


@dataclass(frozen=True)
class Band:
    """An estimate from n values, its standard deviation over them, and its 95 % confidence band; nan where n is too small."""

    n: int
    value: float
    deviation: float
    low: float
    high: float

    def above(self, threshold: float) -> bool:
        return self.low > threshold

    def below(self, threshold: float) -> bool:
        return self.high < threshold


@dataclass(frozen=True)
class Test:
    """A comparison of before and after. p: one-sided chance of such a rise or more without an effect."""

    n: int  # pairs: one a seed, or each value with each
    rises: int  # of them
    ratio: float  # median of after / before
    p: float


def finite(values) -> np.ndarray:
    array = np.asarray(list(values), dtype=float)
    return array[np.isfinite(array)]


def mean_band(values) -> Band:
    """Mean and its band by Student's t."""
    sample = finite(values)
    mean = float(sample.mean()) if len(sample) else math.nan
    deviation = float(sample.std(ddof=1)) if len(sample) > 1 else math.nan
    if len(sample) < FEWEST:
        return Band(len(sample), mean, deviation, math.nan, math.nan)
    half = float(stats.t.ppf(0.5 + CONFIDENCE / 2.0, len(sample) - 1)) * deviation / math.sqrt(len(sample))
    return Band(len(sample), mean, deviation, mean - half, mean + half)


def median_band(values) -> Band:
    """Median and its band by the bootstrap (percentiles); the same draws every time."""
    sample = finite(values)
    if len(sample) < FEWEST:
        return mean_band(sample)
    draws = np.random.default_rng(1).choice(sample, (RESAMPLES, len(sample)))
    low, high = np.percentile(np.median(draws, axis=1), [50.0 * (1.0 - CONFIDENCE), 50.0 * (1.0 + CONFIDENCE)])
    return Band(len(sample), float(np.median(sample)), float(sample.std(ddof=1)), float(low), float(high))


def paired(before: dict[int, float], after: dict[int, float]) -> Test:
    """Is `after` larger, seed by seed? Wilcoxon's signed ranks, exact, one-sided."""
    seeds = sorted(seed for seed in before if seed in after and math.isfinite(before[seed]) and math.isfinite(after[seed]))
    if not seeds:
        return Test(0, 0, math.nan, math.nan)
    a, b = np.array([before[seed] for seed in seeds]), np.array([after[seed] for seed in seeds])
    p = float(stats.wilcoxon(b, a, alternative="greater").pvalue) if np.any(a != b) else 1.0
    ratio = float(np.median(b / a)) if np.all(a != 0.0) else math.nan
    return Test(len(seeds), int(np.sum(b > a)), ratio, p)


def unpaired(lower, higher) -> Test:
    """Is `higher` larger, each value set against each? Mann & Whitney, exact for few values, one-sided."""
    a, b = finite(lower), finite(higher)
    if not len(a) or not len(b):
        return Test(0, 0, math.nan, math.nan)
    result = stats.mannwhitneyu(b, a, alternative="greater")
    ratio = float(np.median(b) / np.median(a)) if np.median(a) else math.nan
    return Test(len(a) * len(b), round(float(result.statistic)), ratio, float(result.pvalue))


def trend(table: np.ndarray) -> float:
    """p of Page's test that columns rise from left to right, row by row; table (seeds, speeds). nan where it is too small."""
    if table.shape[0] < 2 or table.shape[1] < 3:
        return math.nan
    return float(stats.page_trend_test(table).pvalue)


def complete_rows(columns: list[dict[int, float]]) -> np.ndarray:
    """(seeds, columns) of the seeds that all columns have."""
    seeds = [seed for seed in sorted(columns[0]) if all(math.isfinite(column.get(seed, math.nan)) for column in columns)]
    return np.array([[column[seed] for column in columns] for seed in seeds]).reshape(len(seeds), len(columns))


def exponents(speeds: np.ndarray, table: np.ndarray) -> np.ndarray:
    """n of F = c v^n by least squares of the logarithms, one per row of the table (seeds, speeds) that has no zero."""
    table = table[np.all(table > 0.0, axis=1)] if len(table) else table
    if len(speeds) < 2 or not len(table):
        return np.full(len(table), math.nan)
    return np.polyfit(np.log(speeds), np.log(table.T), 1)[0]


def slopes(speeds: np.ndarray, table: np.ndarray) -> np.ndarray:
    """dF/dv by least squares, one per row of the table (seeds, speeds)."""
    if len(speeds) < 2 or not len(table):
        return np.full(len(table), math.nan)
    return np.polyfit(speeds, table.T, 1)[0]

"""What a handful of seeds can tell: bands that stay in their range, Gumbel's law of highest loads, rank tests, exponents."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np
from scipy import stats

from dilatedem.statistics.gumbel import fit_rows, plotting_places

CONFIDENCE = 0.95
#: the chance, over all tests of the page together, of one effect that is none
LEVEL = 0.05
RESAMPLES = 10_000  # of the bootstrap; the same draws every time
#: with fewer values no band of a mean is given
FEWEST = 5
#: ... nor one of what scatter itself makes, as a scale or a correlation: too many resamples hold one or two values, and so none
FEWEST_SCATTER = 8
#: share of fields whose highest load stays below the quantile that is quoted: one of ten exceeds it
QUOTED = 0.9


@dataclass(frozen=True)
class Band:
    """An estimate from n values and its confidence band; nan where n is too small."""

    n: int
    value: float
    low: float
    high: float


@dataclass(frozen=True)
class Test:
    """A two-sided test. towards: on the side that was asked for? p: chance of lying so far off without an effect."""

    n: int
    count: int  # values, or pairs of values, on the side that was asked for
    towards: bool
    p: float


@dataclass(frozen=True)
class Gumbel:
    """P(highest load < x) = exp(-exp(-(x - location)/scale)), fitted to one highest load a field."""

    location: Band
    scale: Band
    quantile: Band  # that a share QUOTED of the fields stays below
    correlation: float  # of the sorted loads with the law's quantiles; 1: they lie on it


def finite(values: Iterable[float]) -> np.ndarray:
    array = np.asarray(list(values), dtype=float)
    return array[np.isfinite(array)]


def mean_of_rows(sample: np.ndarray) -> np.ndarray:
    return sample.mean(axis=-1)


def band(values: Iterable[float], estimate: Callable[[np.ndarray], np.ndarray] = mean_of_rows) -> Band:
    """An estimate, the mean unless said, and its band by the bootstrap."""
    sample = finite(values)
    if not len(sample):
        return Band(0, math.nan, math.nan, math.nan)
    value = float(estimate(sample[None, :])[0])
    if len(sample) < FEWEST:
        return Band(len(sample), value, math.nan, math.nan)
    return Band(len(sample), value, *percentiles(estimate(sample[drawn(len(sample))]), len(sample)))


@cache
def drawn(count: int, stream: int = 1) -> np.ndarray:
    """(RESAMPLES, count) numbers of the values that a resample takes."""
    return np.random.default_rng(stream).integers(0, count, (RESAMPLES, count))


def percentiles(estimates: np.ndarray, count: int) -> tuple[float, float]:
    """Ends of a band from the estimates of all resamples of so many values.

    Plain percentiles of few values are too narrow: a resample varies by sqrt(1 - 1/n) too little, and by a normal law, not
    Student's. Both are mended by going further out (Hesterberg 2015, expanded percentiles); the band still cannot leave the
    range of what it was drawn from.
    """
    student = float(stats.t.ppf(0.5 + CONFIDENCE / 2.0, count - 1))
    tail = 100.0 * float(stats.norm.cdf(-student * math.sqrt(count / (count - 1.0))))
    low, high = np.percentile(estimates[np.isfinite(estimates)], [tail, 100.0 - tail])
    return float(low), float(high)


def location_of_rows(samples: np.ndarray) -> np.ndarray:
    return fit_rows(samples)[0]


def gumbel(values: Iterable[float]) -> Gumbel:
    """Gumbel's law of the highest loads of independent fields."""
    sample = finite(values)
    if len(sample) < 3:
        return Gumbel(*[Band(len(sample), math.nan, math.nan, math.nan)] * 3, math.nan)
    estimates = [one[0] for one in quantities(sample[None, :])]
    if len(sample) < FEWEST_SCATTER:
        return Gumbel(*(Band(len(sample), float(value), math.nan, math.nan) for value in estimates), math.nan)
    resampled = quantities(sample[drawn(len(sample))])
    bands = [
        Band(len(sample), float(value), *percentiles(rows, len(sample))) for value, rows in zip(estimates, resampled, strict=True)
    ]
    places = plotting_places(len(sample))
    return Gumbel(*bands, float(np.corrcoef(np.sort(sample), stats.gumbel_r.ppf(places))[0, 1]))


def quantities(samples: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Location, scale and the quantile QUOTED of every row."""
    location, scale = fit_rows(samples)
    return location, scale, location - scale * math.log(-math.log(QUOTED))


def ratio_band(over: Iterable[float], under: Iterable[float], estimate: Callable[[np.ndarray], np.ndarray]) -> Band:
    """Ratio of an estimate from two independent samples."""
    a, b = finite(over), finite(under)
    count = min(len(a), len(b))
    if not count:
        return Band(0, math.nan, math.nan, math.nan)
    value = float(estimate(a[None, :])[0] / estimate(b[None, :])[0])
    if count < FEWEST_SCATTER:
        return Band(count, value, math.nan, math.nan)
    return Band(count, value, *percentiles(estimate(a[drawn(len(a), 1)]) / estimate(b[drawn(len(b), 2)]), count))


def paired_ratio(before: dict[int, float], after: dict[int, float]) -> Band:
    """Geometric mean over the seeds of after / before, of those where both are above 0."""
    logs = np.log([after[seed] / before[seed] for seed in sorted(before) if before[seed] > 0.0 and after.get(seed, 0.0) > 0.0])
    return band(logs, lambda rows: np.exp(rows.mean(axis=-1)))


def signed_ranks(values: Iterable[float], *, above: bool) -> Test:
    """Do values lie above 0 (or below)? Wilcoxon's signed ranks, exact for few values."""
    sample = finite(values) * (1.0 if above else -1.0)
    count = int(np.sum(sample > 0.0))
    if not np.any(sample):
        return Test(len(sample), count, False, 1.0)
    p = float(stats.wilcoxon(sample).pvalue)
    ranks = stats.rankdata(np.abs(sample))
    return Test(len(sample), count, bool(np.sum(ranks * np.sign(sample)) > 0.0), p)


def unpaired(lower: Iterable[float], higher: Iterable[float]) -> Test:
    """Is `higher` larger, each value set against each? Mann & Whitney, exact for few values."""
    a, b = finite(lower), finite(higher)
    if not len(a) or not len(b):
        return Test(0, 0, False, 1.0)
    result = stats.mannwhitneyu(b, a)
    pairs = len(a) * len(b)
    return Test(pairs, round(float(result.statistic)), bool(result.statistic > 0.5 * pairs), float(result.pvalue))


def together(tests: Sequence[Test]) -> Test:
    """Of statements that must all hold: the weakest of them; where some are on the other side, the clearest of those."""
    against = [test for test in tests if not test.towards]
    if against:
        clearest = min(against, key=lambda test: test.p)
        return Test(clearest.n, clearest.count, False, min(1.0, len(tests) * clearest.p))
    return max(tests, key=lambda test: test.p)


def holm(chances: Sequence[float]) -> list[float]:
    """p values, in the order given, corrected for their number: below LEVEL, none of the effects is one by chance, to LEVEL."""
    order = np.argsort(chances)
    corrected = np.zeros(len(chances))
    largest = 0.0
    for rank, place in enumerate(order):
        largest = max(largest, min(1.0, (len(chances) - rank) * chances[place]))
        corrected[place] = largest
    return [float(p) for p in corrected]


def complete_rows(columns: Sequence[dict[int, float]]) -> np.ndarray:
    """(seeds, columns) of the seeds that all columns have."""
    seeds = [seed for seed in sorted(columns[0]) if all(math.isfinite(column.get(seed, math.nan)) for column in columns)]
    return np.array([[column[seed] for column in columns] for seed in seeds]).reshape(len(seeds), len(columns))


def exponents(speeds: np.ndarray, table: np.ndarray) -> np.ndarray:
    """n of F = c v^n by least squares of the logarithms, one per row of the table (seeds, speeds) that has no zero."""
    table = table[np.all(table > 0.0, axis=1)] if len(table) else table
    if len(speeds) < 2 or not len(table):
        return np.full(len(table), math.nan)
    return np.polyfit(np.log(speeds), np.log(table.T), 1)[0]

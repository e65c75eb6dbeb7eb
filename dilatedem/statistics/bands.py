"""Mean, standard deviation and percentiles of independent values of an unknown law, each with a 95 % band in closed form."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from scipy import special  # scipy.stats takes half a second to load

CONFIDENCE = 0.95
#: chance that a band lies wholly above, and wholly below, what it is to hold
TAIL = (1.0 - CONFIDENCE) / 2.0
#: with fewer values there is no band of a mean or a standard deviation: their skewness is not known
FEWEST = 5
#: more skewness than this, of the bands of means, is that of one value far out; nor may it exceed UNFOLDED over what Student's band
#: reaches in standard deviations: at 1 the transformation folds over, and an end may be anywhere
MOST_SKEWNESS, UNFOLDED = 1.5, 0.8


@dataclass(frozen=True)
class Band:
    """An estimate from n values and its confidence band. An end that so few values cannot tell is infinite."""

    n: int
    value: float
    low: float = -math.inf
    high: float = math.inf

    @property
    def closed(self) -> bool:
        return math.isfinite(self.low) and math.isfinite(self.high)

    def is_apart(self, other: Band) -> bool:
        """Whether no value lies in both bands: stricter than that the difference of the two is not nothing."""
        return self.low > other.high or other.low > self.high

    def __truediv__(self, divisor: float) -> Band:
        """In another unit."""
        return Band(self.n, self.value / divisor, self.low / divisor, self.high / divisor)


def sample(values: Iterable[float]) -> np.ndarray:
    """(n,) values without those that are none (nan), ascending."""
    found = np.asarray(list(values), dtype=float)
    return np.sort(found[np.isfinite(found)])


def mean(values: Iterable[float]) -> Band:
    """Student's band, its skewness removed by a cubic transformation (Hall 1992, J. R. Stat. Soc. B 54, 221-228, Eq. (2.4)).

    With t = (mean - true mean)/s and skewness g, t + g t^2/3 + g^2 t^3/27 + g/(6 n) is nearly symmetric; the transformation
    can be turned round. Student's band alone lies too low for values with a long upper tail.
    """
    x = sample(values)
    n = len(x)
    centre = float(x.mean()) if n else math.nan
    if n < FEWEST:
        return Band(n, centre)
    spread = float(x.std(ddof=1))
    if spread == 0.0:
        return Band(n, centre, centre, centre)
    reach = student(1.0 - TAIL, n - 1) / math.sqrt(n)
    most = min(MOST_SKEWNESS, UNFOLDED / reach)
    third = min(max(skewness(x), -most), most) / 3.0
    ends = [centre - spread * _untransformed(side * reach, third, n) for side in (1.0, -1.0)]
    return Band(n, centre, min(ends), max(ends))


def _untransformed(reach: float, third: float, n: int) -> float:
    """The t that Hall's transformation takes to `reach`; third: a third of the skewness."""
    shifted = reach - third / (2.0 * n)
    if abs(third * shifted) < 1e-6:  # the limit of no skewness, before round-off takes it
        return shifted - third * shifted**2
    return (math.copysign(abs(1.0 + 3.0 * third * shifted) ** (1.0 / 3.0), 1.0 + 3.0 * third * shifted) - 1.0) / third


def student(share: float, freedom: float | np.ndarray) -> float | np.ndarray:
    """What a share of values of Student's law stays below."""
    return special.stdtrit(freedom, share)


def chi_square(share: float, freedom: float) -> float:
    """What a share of values of the chi-square law stays below."""
    return 2.0 * float(special.gammaincinv(0.5 * freedom, share))


def _moment(x: np.ndarray, order: int) -> float:
    return float(np.mean((x - x.mean()) ** order))


def skewness(x: np.ndarray) -> float:
    """Unbiased for a normal law (Fisher and Pearson's adjusted one); 0 where it cannot be told."""
    n, variance = len(x), _moment(x, 2) if len(x) > 2 else 0.0
    found = math.sqrt(n * (n - 1)) / (n - 2) * _moment(x, 3) / variance**1.5 if variance > 0.0 else 0.0
    return found if math.isfinite(found) else 0.0


def excess_kurtosis(x: np.ndarray) -> float:
    """Unbiased for a normal law, of four values or more that are not all alike."""
    n = len(x)
    biased = _moment(x, 4) / _moment(x, 2) ** 2 - 3.0
    return (n - 1) / ((n - 2) * (n - 3)) * ((n + 1) * biased + 6.0)


def difference(one: Iterable[float], other: Iterable[float]) -> Band:
    """Mean of `one` less that of `other`, whose variances need not be alike: Student's band with Welch's degrees of freedom (1947).

    n is that of the fewer. Skewness of both alike goes out of a difference, and Hall's transformation is left out.
    """
    a, b = sample(one), sample(other)
    n = min(len(a), len(b))
    between = float(a.mean() - b.mean()) if n else math.nan
    if n < FEWEST:
        return Band(n, between)
    shares = [float(np.var(x, ddof=1)) / len(x) for x in (a, b)]
    if sum(shares) == 0.0:
        return Band(n, between, between, between)
    freedom = sum(shares) ** 2 / sum(share**2 / (len(x) - 1) for share, x in zip(shares, (a, b), strict=True))
    reach = student(1.0 - TAIL, freedom) * math.sqrt(sum(shares))
    return Band(n, between, between - reach, between + reach)


def deviation(values: Iterable[float]) -> Band:
    """Standard deviation, and its band by chi-square of as many degrees of freedom as fit the kurtosis.

    The variance of s^2 is sigma^4 (2/(n - 1) + e/n), e the excess kurtosis; chi-square of f degrees has 2/f. From few values e
    comes out far too small, as what makes it is rare. Laws with one long tail have e near twice the square of their skewness
    (gamma 1.5, Gumbel 1.8, exponential 1.5), which fewer values tell: the larger of the two is taken.
    """
    x = sample(values)
    n = len(x)
    spread = float(x.std(ddof=1)) if n > 1 else math.nan
    if n < FEWEST:
        return Band(n, spread, 0.0)
    if spread == 0.0:
        return Band(n, spread, 0.0, 0.0)
    excess = max(2.0 * skewness(x) ** 2, excess_kurtosis(x))
    freedom = 2.0 / (2.0 / (n - 1) + max(excess, -1.5) / n)
    low, high = (spread * math.sqrt(freedom / chi_square(share, freedom)) for share in (1.0 - TAIL, TAIL))
    return Band(n, spread, low, high)


def quantile(values: Iterable[float], share: float) -> Band:
    """What a share of the values stays below, and its band from the binomial law of order statistics.

    Of any continuous law P(r-th smallest value < quantile) is known; between two of them the ends are interpolated, so that the
    band holds at 95 % and not at the next higher chance that ranks allow (Hettmansperger & Sheather 1986 for the median, Nyblom
    1992 for others). Where the extreme value is no end on one side (a 90 % quantile needs 36 values for that), that side is
    open, and the other end is that of a one-sided band. A quantile beyond the extreme values has no value (`enough_for`).
    """
    x = sample(values)
    if not len(x):
        return Band(0, math.nan)
    told = len(x) >= enough_for(share)
    value = float(np.quantile(x, share, method="median_unbiased")) if told else math.nan
    low, high = _low_end(x, share, TAIL), -_low_end(-x[::-1], 1.0 - share, TAIL)
    if math.isinf(high):
        low = _low_end(x, share, 2.0 * TAIL)
    elif math.isinf(low):
        high = -_low_end(-x[::-1], 1.0 - share, 2.0 * TAIL)
    return Band(len(x), value, low, high)


def enough_for(share: float) -> int:
    """From how many values on a quantile lies between the least and the largest: the median from 1, 90 % from 7, 95 % from 13.

    The k-th of n values stands for a share of (k - 1/3)/(n + 1/3) (Hyndman & Fan 1996, median-unbiased). Beyond the n-th any
    estimate would be the largest value, whatever share is asked for.
    """
    beyond = min(share, 1.0 - share)
    return max(math.ceil((2.0 - beyond) / (3.0 * beyond) - 1e-9), 1)


def _low_end(x: np.ndarray, share: float, tail: float) -> float:
    """Below which the quantile lies with a chance of `tail`; x (n,) ascending."""
    n = len(x)
    below = special.bdtrc(np.arange(n), n, share)  # chance that the 1st, 2nd, ... smallest lies below the quantile
    rank = int(np.sum(below >= 1.0 - tail))
    if rank == 0:
        return -math.inf
    if rank == n:
        return float(x[-1])
    beyond = (below[rank - 1] - (1.0 - tail)) / (below[rank - 1] - below[rank])
    if beyond == 0.0:
        return float(x[rank - 1])
    weight = 1.0 / (1.0 + rank * (1.0 - share) * (1.0 - beyond) / ((n - rank) * share * beyond))
    return float((1.0 - weight) * x[rank - 1] + weight * x[rank])

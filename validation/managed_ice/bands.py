"""What several runs say together: the mean over ice fields with its band, and whether two of them differ."""

import math
from typing import NamedTuple

import numpy as np
from scipy.special import stdtrit

#: of the bands, two-sided
CONFIDENCE = 0.95


class Band(NamedTuple):
    """A mean, and half the width of its band."""

    mean: float
    half: float

    @property
    def ends(self) -> tuple[float, float]:
        return self.mean - self.half, self.mean + self.half

    def is_apart(self, other: "Band") -> bool:
        """Whether no value lies in both bands: stricter than that the difference of the means is not nothing."""
        return abs(self.mean - other.mean) > self.half + other.half


def student(freedom: float) -> float:
    """How many standard errors half a band is with so many degrees of freedom."""
    return float(stdtrit(freedom, 0.5 + 0.5 * CONFIDENCE))


def band(values: np.ndarray) -> Band:
    """Of the mean of values (n,), n > 1, one from each field: Student's t."""
    error = float(np.std(values, ddof=1)) / math.sqrt(len(values))
    return Band(float(np.mean(values)), student(len(values) - 1) * error)


def difference(one: np.ndarray, other: np.ndarray) -> Band:
    """Of the mean of `one` (n,) less that of `other` (m,), whose variances need not be alike (Welch 1947)."""
    a, b = (float(np.var(values, ddof=1)) / len(values) for values in (one, other))
    half = 0.0
    if a + b > 0.0:
        freedom = (a + b) ** 2 / (a * a / (len(one) - 1) + b * b / (len(other) - 1))
        half = student(freedom) * math.sqrt(a + b)
    return Band(float(np.mean(one) - np.mean(other)), half)

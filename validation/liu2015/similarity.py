"""One field at several speeds: how far its runs are copies of each other, once counted by drift instead of time."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from validation.liu2015.measures import Ensemble
from validation.liu2015.plan import LARGE
from validation.liu2015.statistics import FEWEST_SCATTER, RESAMPLES, Band, band, complete_rows, drawn, exponents, percentiles

#: m/s above which the paper sees the force grow faster
BREAK = 0.7
#: m of drift; highest hits of two speeds no further apart than that are the same hit
SAME_HIT = 0.1
HIGHEST, HIGHEST_AT, MEAN = "fh_max_equal_drift_N", "fh_max_equal_drift_at_m", "fx_mean_equal_drift_N"


@dataclass(frozen=True)
class Likeness:
    """What the speeds of one model have in common, at equal drift."""

    speeds: np.ndarray  # (k,) [m/s]
    highest: np.ndarray  # (seeds, k) [N], of the fields that were run at all speeds
    mean: np.ndarray  # (seeds, k) [N], along x
    exponent: Band  # of the highest force over all speeds
    local: list[Band]  # of the highest force, between a speed and the next
    change: Band  # of the exponent, from below to above BREAK
    mean_exponent: Band  # of the mean force along x
    correlation: Band  # over the seeds, of the logarithms of the highest forces of the two speeds that are least alike
    least_alike: tuple[float, float]  # m/s
    median_correlation: float  # over all pairs of speeds
    between: float  # standard deviation of the logarithm from field to field
    left: float  # ... and of what neither the field nor v^n accounts for
    same: int  # fields whose highest hit is the same at all speeds

    @property
    def fields(self) -> int:
        return len(self.highest)


def likeness(ensemble: Ensemble, model: str) -> Likeness | None:
    """None while there are fewer than three speeds or three fields that were run at all of them."""
    speeds = np.array(ensemble.speeds(model, LARGE))
    if len(speeds) < 3:
        return None
    highest, mean, at = (
        complete_rows([ensemble.of(name, model, LARGE, speed) for speed in speeds]) for name in (HIGHEST, MEAN, HIGHEST_AT)
    )
    if len(highest) < 3 or np.any(highest <= 0.0):
        return None
    logs = np.log(highest)
    correlation, pair, median = least_correlation(speeds, logs)
    low, high = speeds <= BREAK + 1e-9, speeds >= BREAK - 1e-9
    centred = logs - logs.mean(axis=0)
    left = centred - centred.mean(axis=1, keepdims=True)
    freedom = (logs.shape[0] - 1) * (logs.shape[1] - 1)
    return Likeness(
        speeds=speeds,
        highest=highest,
        mean=mean,
        exponent=band(exponents(speeds, highest)),
        local=[band(exponents(speeds[i : i + 2], highest[:, i : i + 2])) for i in range(len(speeds) - 1)],
        change=band(exponents(speeds[high], highest[:, high]) - exponents(speeds[low], highest[:, low])),
        mean_exponent=band(exponents(speeds, mean)),
        correlation=correlation,
        least_alike=pair,
        median_correlation=median,
        between=float(centred.mean(axis=1).std(ddof=1)),
        left=math.sqrt(float(np.sum(left**2)) / freedom),
        same=int(np.sum(np.ptp(at, axis=1) <= SAME_HIT)),
    )


def least_correlation(speeds: np.ndarray, logs: np.ndarray) -> tuple[Band, tuple[float, float], float]:
    """The lowest of all pairs of speeds with its band, which pair that is, and the median of all pairs; logs (seeds, speeds)."""
    table = np.corrcoef(logs.T)
    pairs = list(combinations(range(len(speeds)), 2))
    a, b = min(pairs, key=lambda pair: table[pair])
    median = float(np.median([table[pair] for pair in pairs]))
    if len(logs) < FEWEST_SCATTER:
        return Band(len(logs), float(table[a, b]), math.nan, math.nan), (float(speeds[a]), float(speeds[b])), median
    draws = drawn(len(logs))
    x, y = logs[draws, a], logs[draws, b]
    x, y = x - x.mean(axis=1, keepdims=True), y - y.mean(axis=1, keepdims=True)
    size = np.sqrt((x**2).sum(axis=1) * (y**2).sum(axis=1))
    resampled = np.divide((x * y).sum(axis=1), size, out=np.full(RESAMPLES, math.nan), where=size > 0.0)
    low, high = percentiles(resampled, len(logs))
    return Band(len(logs), float(table[a, b]), low, high), (float(speeds[a]), float(speeds[b])), median

"""A load against time at a uniform step, from windows with means and extremes: what keeps its impulse and its peaks.

Programs of structures take samples and join them by straight lines. A sample is the mean of the load under a hat of one step to
either side: hats add up to one everywhere, so the lines hold the impulse of the windows, whatever the step, and its centroid in
time. Peaks, which that flattens, are raised to the extremes of the windows, and the samples beside them give the impulse for it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

#: what samples may keep of a load: both as far as they go together, impulse first; or one of them whatever becomes of the other
KEEP = ("both", "impulse", "peaks")
#: samples to either side of a peak that give impulse for it; of peaks closer to each other the highest is kept
REACH = 2
#: of the highest, what a peak is counted from
LEAST_PEAK = 0.05
#: of a step, by which the end of the last window may miss a sample
ROUND_OFF = 1e-6


@dataclass(frozen=True)
class Windows:
    """A load by windows that follow each other from t = 0: ends [s], means and extremes over each, all (n,)."""

    end: np.ndarray
    mean: np.ndarray
    low: np.ndarray
    high: np.ndarray

    @property
    def edges(self) -> np.ndarray:
        return np.concatenate([[0.0], self.end])

    @property
    def impulse(self) -> float:
        return math.fsum(self.mean * np.diff(self.edges))


@dataclass(frozen=True)
class Cost:
    """What samples have of the windows that they were made of; shares are of the sum of the impulses' sizes, or of the peak."""

    impulse_error: float  # share of the impulse
    running_error: float  # largest difference of the impulses up to any sample, as a share
    highest: tuple[float, float]  # reached, and of the windows
    lowest: tuple[float, float]
    peaks: int  # separate ones, of either sign, of at least LEAST_PEAK of the largest
    kept: int  # of them, those that are reached in full
    largest_loss: float  # of a peak, what is missing at most, as a share of it


@dataclass(frozen=True)
class History:
    """Samples (k,) at multiples of `step` [s] from 0 on, with straight lines between them."""

    step: float
    value: np.ndarray
    cost: Cost

    @property
    def time(self) -> np.ndarray:
        return self.step * np.arange(len(self.value))


def sampled(windows: Windows, step: float, keep: str = "both") -> History:
    """Samples every `step` [s], no shorter than a window, with the impulse of the windows and, as far as that allows, their peaks.

    keep: of KEEP. An isolated load of impulse J and peak P is kept in both where J >= P step; else its peak becomes J / step, which
    no samples of that step and impulse exceed that do not change sign.
    """
    value, weight = deposited(windows, step)
    low, high = _envelope(windows, step, value)
    summits, pits = _summits(high), _summits(-low)
    peaks, valleys = summits[high[summits] >= -low[summits]], pits[-low[pits] > high[pits]]  # a sample is one of them at most
    if keep == "both":
        held = np.zeros(len(value), bool)
        value = raised(value, weight, peaks, high, _nearby_least(low), held)
        value = -raised(-value, weight, valleys, -low, _nearby_least(-high), held)
    elif keep == "peaks":
        value[peaks] = np.maximum(value[peaks], high[peaks])
        value[valleys] = np.minimum(value[valleys], low[valleys])
    return History(step, value, _cost(windows, step, value, weight, (summits, high), (pits, low)))


def deposited(windows: Windows, step: float) -> tuple[np.ndarray, np.ndarray]:
    """Means under hats of one step to either side, (k,), and the time that each sample stands for, (k,) [s]."""
    edges = windows.edges
    count = max(math.ceil(edges[-1] / step - ROUND_OFF), 1)
    cuts = np.union1d(edges, step * np.arange(1, count))  # between two cuts there is one window, and one step
    cuts = cuts[cuts <= edges[-1]]
    middle, length = 0.5 * (cuts[1:] + cuts[:-1]), np.diff(cuts)
    window = np.clip(np.searchsorted(edges, middle) - 1, 0, len(windows.mean) - 1)
    cell = np.minimum((middle / step).astype(np.int64), count - 1)
    impulse, share = windows.mean[window] * length, middle / step - cell
    held = np.bincount(cell, impulse * (1.0 - share), count + 1) + np.bincount(cell + 1, impulse * share, count + 1)
    weight = np.full(count + 1, step)
    weight[[0, -1]] = 0.5 * step
    return held / weight, weight


def raised(
    value: np.ndarray, weight: np.ndarray, peaks: np.ndarray, high: np.ndarray, floor: np.ndarray, held: np.ndarray
) -> np.ndarray:
    """The samples with peaks, numbers in order of their height, raised to `high` by impulse from beside them.

    No sample falls below `floor`, none that is `held` gives anything; peaks are held from now on.
    """
    value = value.copy()
    for k in peaks:
        held[k] = True
        wanted = weight[k] * (high[k] - value[k])
        beside = [i for i in range(max(k - REACH, 0), min(k + REACH + 1, len(value))) if not held[i]]
        spare = weight[beside] * np.maximum(value[beside] - floor[beside], 0.0)
        if wanted <= 0.0 or not spare.sum() > 0.0:
            continue
        moved = min(wanted, float(spare.sum()))
        value[k] += moved / weight[k]
        value[beside] -= moved * spare / spare.sum() / weight[beside]
    return value


def _envelope(windows: Windows, step: float, value: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Extremes of the windows about each sample, half a step to either side; the sample itself where there is none."""
    middle = 0.5 * (windows.edges[1:] + windows.edges[:-1])
    nearest = np.minimum(np.rint(middle / step).astype(np.int64), len(value) - 1)
    low, high = np.full(len(value), np.inf), np.full(len(value), -np.inf)
    np.minimum.at(low, nearest, windows.low)
    np.maximum.at(high, nearest, windows.high)
    return np.where(np.isfinite(low), low, value), np.where(np.isfinite(high), high, value)


def _summits(high: np.ndarray) -> np.ndarray:
    """Numbers of the samples that are above 0 and above all within REACH, the first of equal ones; the highest first."""
    around = np.pad(high, REACH, constant_values=-np.inf)
    before = np.max([around[i : i + len(high)] for i in range(REACH)], axis=0)
    after = np.max([around[REACH + 1 + i : REACH + 1 + i + len(high)] for i in range(REACH)], axis=0)
    found = np.flatnonzero((high > 0.0) & (high > before) & (high >= after))
    return found[np.argsort(-high[found], kind="stable")]


def _nearby_least(low: np.ndarray) -> np.ndarray:
    """The least of each sample and the two beside it."""
    around = np.pad(low, 1, mode="edge")
    return np.minimum(np.minimum(around[:-2], around[2:]), low)


def _cost(windows: Windows, step: float, value: np.ndarray, weight: np.ndarray, peaks: tuple, valleys: tuple) -> Cost:
    turned_over = math.fsum(np.abs(windows.mean) * np.diff(windows.edges)) or 1.0
    running = np.concatenate([[0.0], np.cumsum(0.5 * step * (value[1:] + value[:-1]))])
    asked = np.concatenate([[0.0], np.cumsum(windows.mean * np.diff(windows.edges))])
    there = np.interp(step * np.arange(len(value)), windows.edges, asked)
    largest = max(float(windows.high.max(initial=0.0)), -float(windows.low.min(initial=0.0)))
    wanted = np.concatenate([peaks[1][peaks[0]], -valleys[1][valleys[0]]])
    reached = np.concatenate([value[peaks[0]], -value[valleys[0]]])
    counted = wanted >= LEAST_PEAK * largest
    loss = np.clip(1.0 - reached[counted] / wanted[counted], 0.0, 1.0)
    return Cost(
        impulse_error=abs(math.fsum(value * weight) - windows.impulse) / turned_over,
        running_error=float(np.abs(running - there).max()) / turned_over,
        highest=(float(value.max()), float(windows.high.max())),
        lowest=(float(value.min()), float(windows.low.min())),
        peaks=len(loss),
        kept=int((loss <= ROUND_OFF).sum()),
        largest_loss=float(loss.max(initial=0.0)),
    )

"""Separate hits above a threshold, and which threshold is high enough for the generalized Pareto law."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from dilatedem.statistics.bands import Band, mean, sample
from dilatedem.statistics.pareto import FEWEST, fit_chance

#: shares of the hits that thresholds are tried to leave out, and the chance of a fit that is good enough
TRIED, GOOD = np.arange(0.0, 0.95, 0.1), 0.1
#: a threshold that nobody asked for leaves so many hits above it, where there are as many
LEAST_ABOVE = 2 * FEWEST
#: thresholds that a mean excess is told for, and the least number of hits above one
DRAWN, LEAST_DRAWN = 40, 6

Told = Callable[[float], np.ndarray]  # hits above a threshold


def peaks_above(start: np.ndarray, end: np.ndarray, force: np.ndarray, threshold: float, gap: float) -> np.ndarray:
    """The highest force of each separate hit.

    start, end (n,) [s] of pieces of time, in their order, and the highest force (n,) in each. Pieces that reach the threshold
    belong to one hit unless at least `gap` [s] below it lie between them (runs declustering, Coles 2001, 5.3.2).
    """
    above = np.flatnonzero(force >= threshold)
    if not len(above):
        return np.zeros(0)
    apart = start[above[1:]] - end[above[:-1]] >= gap * (1.0 - 1e-9)
    return np.maximum.reduceat(force[above], np.concatenate([[0], np.flatnonzero(apart) + 1]))


def suitable_threshold(peaks: np.ndarray, again: Told | None = None) -> float | None:
    """The lowest threshold from which on the peaks (n,) fit a generalized Pareto law; None for too few of them.

    Thresholds are shares of the peaks themselves (Bader, Yan & Zhang 2018). Where none fits, the highest that leaves enough.
    again: tells the hits anew above a threshold, as above a higher one there are others; unless given, those of `peaks` above it.
    """
    x, told = sample(peaks), again or above(peaks)
    if len(x) <= FEWEST:
        return None
    tried = [float(x[int(share * len(x))]) for share in TRIED if len(x) - int(share * len(x)) > LEAST_ABOVE] or [float(x[0])]
    for threshold in tried:
        hits = sample(told(threshold))
        over = hits[hits > threshold] - threshold
        if len(over) >= FEWEST and over[0] < over[-1] and fit_chance(over) > GOOD:
            return threshold
    return tried[-1]


def mean_excess(peaks: np.ndarray, again: Told | None = None) -> list[tuple[float, Band]]:
    """By how much hits exceed each of some thresholds, on average, with bands: a straight line where the law holds.

    peaks (n,) of all hits; again: as for `suitable_threshold`.
    """
    x, told = sample(peaks), again or above(peaks)
    if len(x) < LEAST_DRAWN:
        return []
    found = []
    for threshold in np.unique(np.linspace(x[0], x[-1], DRAWN)):
        hits = told(float(threshold))
        over = hits[hits > threshold] - threshold
        if len(over) >= LEAST_DRAWN:
            found.append((float(threshold), mean(over)))
    return found


def above(peaks: np.ndarray) -> Told:
    return lambda threshold: peaks[peaks >= threshold]

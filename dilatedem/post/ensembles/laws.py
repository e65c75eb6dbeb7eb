"""The highest loads of an ensemble: laws of the runs' maxima and of the hits above a threshold, and what they say of rare loads."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy import stats

from dilatedem.post.ensembles.measures import HIGHEST
from dilatedem.post.ensembles.study import Ensemble, Study
from dilatedem.statistics import GEV, Band, Gumbel, Pareto, fit_gev, fit_gumbel, fit_pareto, mean_excess, suitable_threshold

#: loads are told that one of so many runs exceeds
LEVELS = (10, 100)
#: pairs of neighbouring blocks that a correlation takes, and standard errors of it that 95 of 100 of chance lie within
FEWEST_PAIRS, BEYOND = 8, 1.96


@dataclass(frozen=True)
class Extremes:
    """The laws, None each where there is too little to fit.

    maxima (runs,) [N], in the order of the sweep; excess: mean excess of the hits over thresholds [N]; threshold [N]: that of
    `pareto`; levels: by law and number of runs; neighbours: correlation of blocks with those that follow them, and how far from 0
    chance takes it in 95 of 100 cases.
    """

    maxima: np.ndarray
    excess: list[tuple[float, Band]]
    threshold: float | None
    gumbel: Gumbel | None
    gev: GEV | None
    pareto: Pareto | None
    levels: dict[tuple[str, int], Band]
    neighbours: tuple[float, float] | None = None

    @property
    def depend(self) -> bool:
        """Whether blocks are more alike to their neighbours than chance makes them, so that bands are too narrow."""
        return self.neighbours is not None and self.neighbours[0] > self.neighbours[1]


def extremes(study: Study, ensemble: Ensemble, structure: str) -> Extremes:
    """Of the horizontal load on one structure."""
    maxima = ensemble.sample(structure, HIGHEST)

    def hits(level: float) -> np.ndarray:
        return np.concatenate([np.zeros(0), *study.peaks(ensemble, structure, level)])

    peaks = hits(study.threshold)
    threshold = study.threshold if study.fixed else suitable_threshold(peaks, hits)
    laws = {
        "gumbel": fit_gumbel(maxima),
        "gev": fit_gev(maxima),
        "pareto": None if threshold is None else fit_pareto(hits(threshold), threshold, len(ensemble.on(structure))),
    }
    levels = {(name, runs): law.level(runs) for name, law in laws.items() if law for runs in LEVELS}
    return Extremes(maxima, mean_excess(peaks, hits), threshold, **laws, levels=levels, neighbours=_neighbours(ensemble, structure))


def _neighbours(ensemble: Ensemble, structure: str) -> tuple[float, float] | None:
    """By ranks, as one load far out would make the correlation; None for runs, and for few blocks."""
    first, second = ensemble.neighbours(structure, HIGHEST)
    count = len(first)
    if count < FEWEST_PAIRS or np.ptp(first) == 0.0 or np.ptp(second) == 0.0:
        return None
    return float(stats.spearmanr(first, second).statistic), BEYOND / math.sqrt(count)

"""The highest loads of an ensemble: laws of the runs' maxima and of the hits above a threshold, and what they say of rare loads."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from dilatedem.post.ensembles import Ensemble, Study
from dilatedem.post.measures import HIGHEST
from dilatedem.statistics import GEV, Band, Gumbel, Pareto, fit_gev, fit_gumbel, fit_pareto, suitable_threshold

#: loads are told that one of so many runs exceeds
LEVELS = (10, 100)


@dataclass(frozen=True)
class Extremes:
    """The laws, None each where there is too little to fit.

    peaks (hits,) [N] above the threshold that tells hits; threshold [N]: that of `pareto`; levels: by law and number of runs.
    """

    maxima: np.ndarray
    peaks: np.ndarray
    threshold: float | None
    gumbel: Gumbel | None
    gev: GEV | None
    pareto: Pareto | None
    levels: dict[tuple[str, int], Band]


def extremes(study: Study, ensemble: Ensemble, structure: str) -> Extremes:
    """Of the horizontal load on one structure."""
    maxima = ensemble.sample(structure, HIGHEST)
    by_run = study.peaks(ensemble, structure)
    peaks = np.concatenate(by_run) if by_run else np.zeros(0)
    threshold = study.threshold if study.fixed else suitable_threshold(peaks)
    if threshold is not None and not study.fixed:  # with fewer pieces of time above it, hits are others
        peaks_of_law = np.concatenate(study.peaks(ensemble, structure, threshold))
    else:
        peaks_of_law = peaks
    laws = {
        "gumbel": fit_gumbel(maxima),
        "gev": fit_gev(maxima),
        "pareto": None if threshold is None else fit_pareto(peaks_of_law, threshold, len(by_run)),
    }
    levels = {(name, runs): law.level(runs) for name, law in laws.items() if law for runs in LEVELS}
    return Extremes(maxima, peaks, threshold, **laws, levels=levels)

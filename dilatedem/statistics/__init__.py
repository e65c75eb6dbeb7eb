"""What a handful of runs can tell of a load: estimates with their 95 % bands, extremes, and how many runs are enough.

Numbers alone: no files, no figures, nothing of ice. How often the bands hold what they should: validation/statistics.
"""

from dilatedem.statistics.bands import Band, deviation, difference, enough_for, mean, quantile
from dilatedem.statistics.enough import growth, needed
from dilatedem.statistics.gev import GEV, fit_gev
from dilatedem.statistics.gumbel import Gumbel, fit_gumbel
from dilatedem.statistics.pareto import Pareto, fit_pareto
from dilatedem.statistics.thresholds import mean_excess, peaks_above, suitable_threshold

__all__ = [
    "GEV", "Band", "Gumbel", "Pareto", "deviation", "difference", "enough_for", "fit_gev", "fit_gumbel", "fit_pareto", "growth",
    "mean", "mean_excess", "needed", "peaks_above", "quantile", "suitable_threshold",
]  # fmt: skip

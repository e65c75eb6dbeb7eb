"""What one run says of the load on one structure, as few numbers: those that ensembles are made of."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from dilatedem.post.loads import along_and_across, window_lengths
from dilatedem.results.tables import Table
from dilatedem.statistics import peaks_above

#: what is taken of each run: its name in statistics.csv, in words
QUANTITIES = {
    "horizontal_highest_N": "highest horizontal force",
    "along_highest_N": "highest force along the current",
    "across_highest_N": "largest force across the current, to either side",
    "along_mean_N": "mean force along the current",
    "across_mean_N": "mean force across the current",
    "along_deviation_N": "standard deviation in time of the force along the current",
    "horizontal_99_percent_N": "horizontal force that 99 % of the windows stay below",
    "hits": "hits above the threshold",
}
HIGHEST, MEAN_ALONG = "horizontal_highest_N", "along_mean_N"
#: quantities of sweep.csv that are the same, for sweeps whose run folders are not there
OF_TABLE = {
    "horizontal_highest_N": ("fh_max",), "along_highest_N": ("along_max",), "along_mean_N": ("along_mean", "fx_mean"),
}  # fmt: skip


@dataclass(frozen=True)
class Loads:
    """Of a run on one structure: its measures; windows that reach the least threshold, from and to [s], highest force [N] (n,)."""

    measures: dict[str, float]
    start: np.ndarray
    end: np.ndarray
    force: np.ndarray


def loads_of(
    history: Table, current: tuple[float, float], times: tuple[float, float], least: float, gap: float
) -> Loads | None:  # fmt: skip
    """From the rows of forces.csv of a structure that lie within two times [s]; None where there are none.

    current: velocity of the water [m/s]; least: threshold [N] below which no hits are looked for, gap [s]: between two of them.
    """
    lengths = window_lengths(history["time_s"])
    slack = 1e-6 * max(1.0, times[1])
    inside = (history["time_s"] - lengths >= times[0] - slack) & (history["time_s"] <= times[1] + slack)
    if not inside.any():
        return None
    part, lengths = {name: column[inside] for name, column in history.items()}, lengths[inside]
    above = part["fh_max_N"] >= least
    start, end, force = (part["time_s"] - lengths)[above], part["time_s"][above], part["fh_max_N"][above]
    hits = {"hits": float(len(peaks_above(start, end, force, least, gap)))}
    return Loads(_measures(part, lengths, current) | hits, start, end, force)


def _measures(part: Table, lengths: np.ndarray, current: tuple[float, float]) -> dict[str, float]:
    along, across = along_and_across(part, current)
    mean_along = float(np.average(along, weights=lengths))
    has_extremes = "across_max_N" in part  # older runs have none
    return {
        "horizontal_highest_N": float(part["fh_max_N"].max()),
        "along_highest_N": float(part["along_max_N"].max()) if has_extremes else math.nan,
        "across_highest_N": float(max(part["across_max_N"].max(), -part["across_min_N"].min())) if has_extremes else math.nan,
        "along_mean_N": mean_along,
        "across_mean_N": float(np.average(across, weights=lengths)),
        "along_deviation_N": float(np.sqrt(np.average((along - mean_along) ** 2, weights=lengths))),
        "horizontal_99_percent_N": float(np.percentile(part["fh_max_N"], 99.0)),
    }


def loads_of_row(row: dict[str, float]) -> Loads:
    """The same from what sweep.csv says of a structure, which knows no hits."""
    found = {name: next((row[key] for key in keys if key in row), math.nan) for name, keys in OF_TABLE.items()}
    nothing = np.zeros(0)
    return Loads(found, nothing, nothing, nothing)

"""Statistics of the ice load on one structure."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from dilatedem.results.archive import LoadMap
from dilatedem.results.tables import Table, row_count

QUANTILES = (50.0, 90.0, 95.0, 99.0, 99.9)  # per cent of the windows
# Share of the highest peak that counts as a peak; a lower one counts the shivers between two hits too.
PEAK_THRESHOLD = 0.1


def window_lengths(time: np.ndarray) -> np.ndarray:
    """Length (n,) [s] of the windows that end at these times (n,) [s]."""
    if len(time) == 0:
        return np.zeros(0)
    typical = float(np.median(np.diff(time))) if len(time) > 1 else float(time[0])
    # A run's first window starts at 0; a history that begins later starts with an ordinary window.
    first = time[0] if 0.0 < time[0] < 1.5 * typical else typical
    return np.concatenate([[first], np.diff(time)])


def load_statistics(history: Table) -> dict[str, Any]:
    """Headline figures of one structure's rows of forces.csv, SI units, ready for JSON.

    history: columns of forces.csv, each (n,). Means, standard deviations and impulses are those of the window
        means; peaks and quantiles those of the windows' extremes, which a run records over every step.
    """
    if row_count(history) == 0:
        return {"windows": 0}
    time, lengths = history["time_s"], window_lengths(history["time_s"])
    highest = history["fh_max_N"]
    touching = (history["contacts"] > 0.0) | (highest > 0.0)
    statistics: dict[str, Any] = {
        "windows": len(time),
        "window_s": float(np.median(lengths)),
        "from_s": float(time[0] - lengths[0]),
        "to_s": float(time[-1]),
        "contact_time_fraction": float(np.sum(lengths[touching]) / np.sum(lengths)),
        "fh": {
            "peak_N": float(np.max(highest)),
            "peak_time_s": float(time[int(np.argmax(highest))]),
            "quantiles_of_window_maxima_N": quantiles(highest),
        },
    }
    for axis in ("x", "y"):
        mean = history[f"f{axis}_N"]
        average = float(np.average(mean, weights=lengths))
        statistics[f"f{axis}"] = {
            "max_N": float(np.max(history[f"f{axis}_max_N"])),
            "min_N": float(np.min(history[f"f{axis}_min_N"])),
            "mean_N": average,
            "std_of_window_means_N": float(np.sqrt(np.average((mean - average) ** 2, weights=lengths))),
            "impulse_Ns": float(np.sum(mean * lengths)),
        }
    statistics["fx"]["quantiles_of_window_maxima_N"] = quantiles(history["fx_max_N"])
    statistics["peaks"] = peak_statistics(highest, lengths)
    return statistics


def quantiles(values: np.ndarray) -> dict[str, float]:
    """Values not exceeded in this percentage of the windows."""
    return {f"{q:g}": float(value) for q, value in zip(QUANTILES, np.percentile(values, QUANTILES), strict=True)}


def peak_statistics(highest: np.ndarray, lengths: np.ndarray) -> dict[str, Any]:
    """Separate peaks: unbroken rows of windows whose maximum (n,) [N] reaches a share of the highest of all.

    lengths: (n,) [s]. A duration counts whole windows, so it is too long by up to a window at either end.
    """
    threshold = PEAK_THRESHOLD * float(np.max(highest))
    if threshold <= 0.0:
        return {"threshold_N": 0.0, "count": 0, "mean_duration_s": 0.0, "longest_duration_s": 0.0}
    above = np.concatenate([[False], highest >= threshold, [False]])
    change = np.flatnonzero(np.diff(above.astype(np.int8)))
    starts, ends = change[::2], change[1::2]
    elapsed = np.concatenate([[0.0], np.cumsum(lengths)])
    duration = elapsed[ends] - elapsed[starts]
    return {
        "threshold_N": threshold,
        "threshold_share_of_highest": PEAK_THRESHOLD,
        "count": len(duration),
        "mean_duration_s": float(np.mean(duration)),
        "longest_duration_s": float(np.max(duration)),
    }


def mean_force_by_place(load_map: LoadMap) -> np.ndarray:
    """Mean normal force (places,) [N] on each sector or strip of a structure, over all heights."""
    if not load_map.duration > 0.0:
        return np.zeros(load_map.impulse.shape[0])
    return load_map.impulse.sum(axis=1) / load_map.duration


def line_load(load_map: LoadMap) -> np.ndarray:
    """Mean normal force per length (places,) [N/m] around a structure or along it."""
    width = np.diff(load_map.place_edges)
    if load_map.place == "angle":
        width = np.radians(width) * load_map.radius
    return mean_force_by_place(load_map) / width


def angular_statistics(load_map: LoadMap, upstream: float | None) -> dict[str, Any]:
    """Where around a structure the load sits.

    upstream: direction the current comes from, degrees from +x; None leaves the shares about it out.
    """
    force = mean_force_by_place(load_map)
    total = float(force.sum())
    if total <= 0.0:
        return {}
    angle = np.radians(0.5 * (load_map.place_edges[1:] + load_map.place_edges[:-1]))
    x, y = float(np.sum(force * np.cos(angle))), float(np.sum(force * np.sin(angle)))
    result: dict[str, Any] = {"centre_of_load_deg": math.degrees(math.atan2(y, x))}
    if upstream is not None:
        away = np.abs((np.degrees(angle) - upstream + 180.0) % 360.0 - 180.0)
        for half in (45, 90):
            result[f"share_within_{half}_deg_of_upstream"] = float(force[away <= half].sum() / total)
    return result

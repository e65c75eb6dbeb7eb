"""Statistics of the ice load on one structure."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from dilatedem.post.labels import number
from dilatedem.results.archive import LoadMap
from dilatedem.results.tables import Table, row_count

QUANTILES = (50.0, 90.0, 95.0, 99.0, 99.9)  # per cent of the windows
#: m/s2 that the least force which counts as a hit gives the run's mean floe: far above drag and the shivers of a jam
HIT_ACCELERATION = 1.0
#: N, that force where the floes are not known
HIT_FORCE = 1000.0
#: s for which the force stays below the threshold between two hits, at least
HIT_GAP = 1.0
#: MPa of mean nominal pressure of which is told how many events exceed them: ice crushes at 1 to 3 MPa
PRESSURES = (1, 2, 5)
#: how angles run
SENSE = "counter-clockwise seen from above"


def window_lengths(time: np.ndarray) -> np.ndarray:
    """Length (n,) [s] of the windows that end at these times (n,) [s]."""
    if len(time) == 0:
        return np.zeros(0)
    typical = float(np.median(np.diff(time))) if len(time) > 1 else float(time[0])
    # A run's first window starts at 0; a history that begins later starts with an ordinary window.
    first = time[0] if 0.0 < time[0] < 1.5 * typical else typical
    return np.concatenate([[first], np.diff(time)])


def load_statistics(history: Table, current: tuple[float, float] = (0.0, 0.0)) -> dict[str, Any]:
    """Headline figures of one structure's rows of forces.csv, SI units, ready for JSON.

    history: columns of forces.csv, each (n,). Means, standard deviations and impulses are those of the window
        means; peaks and quantiles those of the windows' extremes, which a run records over every step.
    current: velocity of the water [m/s]; where there is any, means and impulses along it and across it are given, too.
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
    if any(current):
        for side, force in zip(("along_current", "across_current"), along_and_across(history, current), strict=True):
            statistics[side] = {"mean_N": float(np.average(force, weights=lengths)), "impulse_Ns": float(np.sum(force * lengths))}
            statistics[side] |= extremes(history, side.removesuffix("_current"), "N")
    if "mh_max_Nm" in history:
        overturning = history["mh_max_Nm"]
        statistics["moment"] = {"peak_Nm": float(overturning.max()), "peak_time_s": float(time[int(np.argmax(overturning))])}
        statistics["moment"] |= {axis: extremes(history, axis, "Nm") for axis in ("mx", "my", "mz")}
    statistics["fx"]["quantiles_of_window_maxima_N"] = quantiles(history["fx_max_N"])
    return statistics


def extremes(history: Table, quantity: str, unit: str) -> dict[str, float]:
    """Lowest and highest of any step; nothing where forces.csv does not hold them."""
    low, high = history.get(f"{quantity}_min_{unit}"), history.get(f"{quantity}_max_{unit}")
    return {} if low is None or high is None else {f"min_{unit}": float(low.min()), f"max_{unit}": float(high.max())}


def quantiles(values: np.ndarray) -> dict[str, float]:
    """Values not exceeded in this percentage of the windows."""
    return {f"{q:g}": float(value) for q, value in zip(QUANTILES, np.percentile(values, QUANTILES), strict=True)}


def hit_threshold(masses: np.ndarray | None) -> float:
    """Horizontal force [N] from which on a load counts as a hit: what would give the mean floe HIT_ACCELERATION.

    masses (n,) [kg] of the floes at the start; none: HIT_FORCE. It depends on the ice alone, neither on the run's own loads nor on
    the current, so that counts of runs can be compared.
    """
    return HIT_ACCELERATION * float(np.mean(masses)) if masses is not None and len(masses) else HIT_FORCE


def hit_statistics(history: Table, threshold: float, gap: float = HIT_GAP) -> dict[str, Any]:
    """Separate hits: times at which the highest horizontal force of the windows reaches a threshold [N].

    Two such times are one hit unless the force stays below the threshold for `gap` [s] or longer in between: a floe that grinds
    along a structure, or bounces, is one hit. A duration runs from the first to the last of a hit's windows that reach the
    threshold, the time above counts these windows alone; both count whole windows, too long by up to a window at either end.
    """
    highest, lengths = history["fh_max_N"], window_lengths(history["time_s"])
    above = np.concatenate([[False], highest >= threshold, [False]])
    change = np.flatnonzero(np.diff(above.astype(np.int8)))
    elapsed = np.concatenate([[0.0], np.cumsum(lengths)])
    starts, ends = change[::2], change[1::2]
    apart = elapsed[starts[1:]] - elapsed[ends[:-1]] >= gap * (1.0 - 1e-9)
    first, last = starts[np.append(True, apart)[: len(starts)]], ends[np.append(apart, True)[: len(ends)]]
    duration = elapsed[last] - elapsed[first]
    return {
        "threshold_N": threshold,
        "gap_s": gap,
        "count": len(duration),
        "mean_duration_s": float(np.mean(duration)) if len(duration) else 0.0,
        "longest_duration_s": float(np.max(duration, initial=0.0)),
        "mean_time_above_s": float(np.sum(elapsed[ends] - elapsed[starts]) / len(duration)) if len(duration) else 0.0,
    }


def event_statistics(hits: Table) -> dict[str, Any]:
    """What hits.csv says of the events on one structure, at every step, where `hit_statistics` counts windows.

    hits: columns of hits.csv, each (n,). Shares are of events whose leading contact has a mean nominal pressure above so many MPa.
    """
    count, pressure = row_count(hits), hits["pressure_Pa"]
    return {
        "count": count,
        "mean_duration_s": float(np.mean(hits["duration_s"])),
        "longest_duration_s": float(np.max(hits["duration_s"])),
        "median_rise_s": float(np.median(hits["rise_s"])),
        "median_pressure_Pa": float(np.median(pressure)),
        **{f"share_above_{limit}_MPa": float(np.mean(pressure > 1e6 * limit)) for limit in PRESSURES},
    }


def hit_words(hits: dict[str, Any] | None) -> str:
    """How many hits there were and what counted as one, as a sentence of a caption; nothing where that is not known."""
    if not hits:
        return ""
    count, threshold = hits["count"], number(hits["threshold_N"] / 1e3, 3)
    return (
        f" {count} separate {'hit' if count == 1 else 'hits'}: horizontal force of at least {threshold} kN, apart by "
        f"{number(hits['gap_s'])} s or more below it."
    )


def along_and_across(history: Table, current: tuple[float, float]) -> tuple[np.ndarray, np.ndarray]:
    """Mean force of every window along the current and across it, positive to its left, each (n,) [N].

    current: its velocity [m/s]; along x and y where it is zero.
    """
    speed = math.hypot(*current)
    x, y = (current[0] / speed, current[1] / speed) if speed > 0.0 else (1.0, 0.0)
    fx, fy = history["fx_N"], history["fy_N"]
    return x * fx + y * fy, x * fy - y * fx


def zero_words(upstream: float | None) -> str:
    """Where angles are zero; upstream: direction the current comes from, None in still water."""
    return "+x (still water)" if upstream is None else "upstream"


def from_zero(angle: np.ndarray, upstream: float | None) -> np.ndarray:
    """Angles [deg] from +x as angles from the zero of `zero_words`, -180 to below 180."""
    return (angle - (upstream or 0.0) + 180.0) % 360.0 - 180.0


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
    """Where around a structure the load sits: its centre as an angle from the zero, which is said, and shares of it.

    upstream: direction the current comes from, degrees from +x; None, in still water, takes +x for the zero and leaves the shares
    about upstream out.
    """
    force = mean_force_by_place(load_map)
    total = float(force.sum())
    if total <= 0.0:
        return {}
    angle = from_zero(0.5 * (load_map.place_edges[1:] + load_map.place_edges[:-1]), upstream)
    x, y = (float(np.sum(force * part)) for part in (np.cos(np.radians(angle)), np.sin(np.radians(angle))))
    result: dict[str, Any] = {
        "zero_of_angles": f"{zero_words(upstream)}; {SENSE}", "centre_of_load_from_zero_deg": math.degrees(math.atan2(y, x)),
    }  # fmt: skip
    if upstream is not None:
        for half in (45, 90):
            result[f"share_within_{half}_deg_of_upstream"] = float(force[np.abs(angle) <= half].sum() / total)
    return result

"""Windows of forces.csv: when they end, and what becomes of those that have ended, many at once."""

from typing import NamedTuple

import numpy as np

from dilatedem.output.schedule import Schedule
from dilatedem.output.tables import Table
from dilatedem.state.clock import NEVER
from dilatedem.state.loads import Loads, Windows


def schedule_windows(windows: Windows, schedule: Schedule, step: int) -> int:
    """Say when the windows after `step` end, while none waits; returns the step at which there is no room for more."""
    due = schedule.due_after(step, len(windows.steps))
    windows.due[:] = NEVER
    windows.due[: len(due)] = due
    return int(due[-1]) if len(due) else NEVER


def end_open_window(windows: Windows, loads: Loads, step: int) -> None:
    """The run is over at `step`: a window that is not full ends with it."""
    if loads.steps[0] > 0:
        k = int(windows.count[0])
        windows.due[k], windows.steps[k] = step, loads.steps[0]
        windows.sum[k], windows.extreme[k], windows.contacts[k] = loads.window_sum, loads.window_extreme, loads.contact_sum
        windows.count[0] += 1
        loads.steps[0] = 0


class Ended(NamedTuple):
    """What forces.csv says of n windows that have ended on s structures."""

    times: list[float]  # (n,) s
    numbers: np.ndarray  # (n, s, 12) columns of forces.csv, without time and structure


def work_up(windows: Windows, names: list[str], dt: float, peaks: dict[str, dict]) -> Ended | None:
    """Bring the windows that wait into the headline loads, structure -> figures; none waits afterwards.

    names: of the structures, in order; dt: time step [s]. Worked up among many a window takes 3 us, on its own 11: NumPy takes as
    long for a number as for a hundred. Returns what is left to be written, in copies.
    """
    count = int(windows.count[0])
    if count == 0:
        return None
    times, steps = [step * dt for step in windows.due[:count].tolist()], windows.steps[:count]
    mean, contacts = windows.sum[:count] / steps[:, None, None], windows.contacts[:count] / steps[:, None]
    numbers = np.concatenate([mean, windows.extreme[:count], contacts[:, :, None]], axis=2)
    for s, name in enumerate(names):
        peak = peaks.setdefault(name, {
            "fx_max_N": 0.0, "fx_min_N": 0.0, "fy_max_N": 0.0, "fy_min_N": 0.0, "fh_max_N": 0.0, "fh_max_time_s": 0.0,
            "fx_sum": 0.0, "fy_sum": 0.0, "steps": 0, "touched": False,
        })  # fmt: skip
        peak["touched"] = peak["touched"] or bool(windows.contacts[:count, s].any())
        _note(peak, times, windows.extreme[:count, s], windows.sum[:count, s], int(steps.sum()))
    windows.count[0] = 0
    return Ended(times, numbers)


def append(ended: Ended, names: list[str], table: Table) -> None:
    """Append the rows of windows on structures of these names to forces.csv."""
    table.append_columns([
        [time_s for time_s in ended.times for _ in names], names * len(ended.times),
        *np.moveaxis(ended.numbers, 2, 0).reshape(ended.numbers.shape[2], -1).tolist(),
    ])  # fmt: skip


def _note(peak: dict, times: list[float], extreme: np.ndarray, window_sum: np.ndarray, steps: int) -> None:
    """Bring windows of one structure into its headline loads."""
    fx_min, fx_max, fy_min, fy_max, fh_max = extreme.T.tolist()
    peak["fx_min_N"], peak["fx_max_N"] = min(peak["fx_min_N"], *fx_min), max(peak["fx_max_N"], *fx_max)
    peak["fy_min_N"], peak["fy_max_N"] = min(peak["fy_min_N"], *fy_min), max(peak["fy_max_N"], *fy_max)
    highest = max(fh_max)
    if highest > peak["fh_max_N"]:
        peak["fh_max_N"], peak["fh_max_time_s"] = highest, times[fh_max.index(highest)]
    for fx, fy in window_sum[:, :2].tolist():  # one after the other: a sum that is the same however many windows come at once
        peak["fx_sum"] += fx
        peak["fy_sum"] += fy
    peak["steps"] += steps


def headline_loads(peak: dict | None) -> dict:
    """What summary.json says of one structure; None = it has no window yet. A load that never was has no time."""
    names = ("fx_max_N", "fx_min_N", "fy_max_N", "fy_min_N", "fh_max_N", "fh_max_time_s")
    if peak is None:
        return dict.fromkeys((*names, "fx_mean_N", "fy_mean_N"), 0.0) | {"fh_max_time_s": None, "touched": False}
    steps, at = max(peak["steps"], 1), peak["fh_max_time_s"] if peak["fh_max_N"] > 0.0 else None
    means = {"fx_mean_N": peak["fx_sum"] / steps, "fy_mean_N": peak["fy_sum"] / steps}
    return {name: peak[name] for name in names} | means | {"fh_max_time_s": at, "touched": peak["touched"]}

"""Windows of forces.csv: when they end, and what becomes of those that have ended, many at once."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from dilatedem.output.schedule import Schedule
from dilatedem.output.tables import Table
from dilatedem.state.clock import NEVER
from dilatedem.state.loads import EXTREMES, Loads, Windows

#: extremes before this one stand before the number of contacts in forces.csv, the others behind it
ALONG = EXTREMES.index("along_min_N")
#: of a run, what means are taken of
SUMS = ("fx_sum", "fy_sum", "along_sum", "across_sum")
#: extremes whose times are told, and how those are called
RESULTANTS = {"fh_max_N": "fh_max_time_s", "mh_max_Nm": "mh_max_time_s"}


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
        loads.steps[0], loads.window_sum[:] = 0, 0.0


class Ended(NamedTuple):
    """What forces.csv says of n windows that have ended, of s records."""

    times: list[float]  # (n,) s
    numbers: np.ndarray  # (n, s, 25) columns of forces.csv, without time and structure


def work_up(windows: Windows, names: list[str], dt: float, peaks: dict[str, dict], flow: Sequence[float]) -> Ended | None:
    """Bring the windows that wait into the headline loads, structure -> figures; none waits afterwards.

    names: of the records, in order; dt: time step [s]; flow (2,): direction of the current. Worked up among many a window takes
    3 us, on its own 11: NumPy takes as long for a number as for a hundred. Returns what is left to be written, in copies.
    """
    count = int(windows.count[0])
    if count == 0:
        return None
    times, steps = [step * dt for step in windows.due[:count].tolist()], windows.steps[:count]
    mean, contacts = windows.sum[:count] / steps[:, None, None], windows.contacts[:count] / steps[:, None]
    extreme = windows.extreme[:count]
    numbers = np.concatenate([
        mean, extreme[:, :, :ALONG], contacts[:, :, None], sideways(mean, flow), extreme[:, :, ALONG:],
    ], axis=2)  # fmt: skip
    sums = np.concatenate([windows.sum[:count, :, :2], sideways(windows.sum[:count], flow)], axis=2)
    for s, name in enumerate(names):
        peak = peaks.setdefault(name, {
            **dict.fromkeys((*EXTREMES, "fh_max_time_s", "mh_max_time_s", *SUMS), 0.0), "steps": 0, "touched": False,
        })  # fmt: skip
        peak["touched"] = peak["touched"] or bool(windows.contacts[:count, s].any())
        _note(peak, times, extreme[:, s], sums[:, s], int(steps.sum()))
    windows.count[0] = 0
    return Ended(times, numbers)


def sideways(force: np.ndarray, flow: Sequence[float]) -> np.ndarray:
    """(n, s, 2) forces along the current and across it, positive to its left, of (n, s, 2 or more)."""
    fx, fy = force[:, :, 0], force[:, :, 1]
    return np.stack([flow[0] * fx + flow[1] * fy, flow[0] * fy - flow[1] * fx], axis=2)


def append(ended: Ended, names: list[str], table: Table) -> None:
    """Append the rows of windows of records of these names to forces.csv."""
    table.append_columns([
        [time_s for time_s in ended.times for _ in names], names * len(ended.times),
        *np.moveaxis(ended.numbers, 2, 0).reshape(ended.numbers.shape[2], -1).tolist(),
    ])  # fmt: skip


def _note(peak: dict, times: list[float], extreme: np.ndarray, sums: np.ndarray, steps: int) -> None:
    """Bring windows of one record into its headline loads."""
    for name, values in zip(EXTREMES, extreme.T.tolist(), strict=True):
        if "_min_" in name:
            peak[name] = min(peak[name], *values)
            continue
        highest = max(values)
        if highest > peak[name]:
            peak[name] = highest
            if name in RESULTANTS:
                peak[RESULTANTS[name]] = times[values.index(highest)]
    for window in sums.tolist():  # one after the other: a sum that is the same however many windows come at once
        for name, value in zip(SUMS, window, strict=True):
            peak[name] += value
    peak["steps"] += steps


def headline_loads(peak: dict | None) -> dict:
    """What summary.json says of one record; None = it has no window yet. A load that never was has no time."""
    if peak is None:
        peak = dict.fromkeys((*EXTREMES, *SUMS), 0.0) | {"steps": 0, "touched": False}
    steps = max(peak["steps"], 1)
    means = {f"{name.removesuffix('_sum')}_mean_N": peak[name] / steps for name in SUMS}
    times = {time: peak[time] if peak[name] > 0.0 else None for name, time in RESULTANTS.items()}
    return {name: peak[name] for name in EXTREMES} | means | times | {"touched": peak["touched"]}

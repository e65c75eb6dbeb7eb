"""Windows of forces.csv: kept as numbers while they come, worked up into rows and headline loads many at once."""

import numpy as np

from dilatedem.output.tables import Table
from dilatedem.state.record import Loads

#: windows that are kept at most
ROOM = 1000


class Windows:
    """The windows of one run since they were last worked up.

    A window of one structure costs 1.5 us to keep and 3 us to work up among many; on its own it would take 11 us, as NumPy takes
    the same time for a number as for a hundred.
    """

    def __init__(self, structures: list[str], dt: float):
        """structures: their names, in order; dt: time step [s]."""
        count = len(structures)
        self._names, self._dt = structures, dt
        self._ends: list[int] = []  # step at which each window ends
        self._steps = np.zeros(ROOM, np.int64)
        self._sum = np.zeros((ROOM, count, 6))
        self._extreme = np.zeros((ROOM, count, 5))
        self._contacts = np.zeros((ROOM, count), np.int64)

    @property
    def full(self) -> bool:
        return len(self._ends) == ROOM

    def keep(self, step: int, loads: Loads) -> None:
        """The window of `loads` ends at `step`; the next one begins."""
        k = len(self._ends)
        self._ends.append(step)
        self._steps[k] = loads.steps[0]
        self._sum[k] = loads.window_sum
        self._extreme[k] = loads.window_extreme
        self._contacts[k] = loads.contact_sum
        loads.steps[0] = 0

    def work_up(self, table: Table, peaks: dict[str, dict]) -> None:
        """Append the windows kept to forces.csv and to the headline loads, structure -> figures; none is kept afterwards."""
        count = len(self._ends)
        if count == 0:
            return
        times, steps = [step * self._dt for step in self._ends], self._steps[:count]
        mean, contacts = self._sum[:count] / steps[:, None, None], self._contacts[:count] / steps[:, None]
        numbers = np.concatenate([mean, self._extreme[:count], contacts[:, :, None]], axis=2)
        structures = len(self._names)
        table.append_columns([
            [time_s for time_s in times for _ in range(structures)], self._names * count,
            *np.moveaxis(numbers, 2, 0).reshape(numbers.shape[2], -1).tolist(),
        ])  # fmt: skip
        for s, name in enumerate(self._names):
            peak = peaks.setdefault(name, {
                "fx_max_N": 0.0, "fx_min_N": 0.0, "fy_max_N": 0.0, "fy_min_N": 0.0, "fh_max_N": 0.0, "fh_max_time_s": 0.0,
                "fx_sum": 0.0, "fy_sum": 0.0, "steps": 0,
            })  # fmt: skip
            _note(peak, times, self._extreme[:count, s], self._sum[:count, s], int(steps.sum()))
        self._ends.clear()


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

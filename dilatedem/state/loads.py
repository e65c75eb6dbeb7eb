"""Loads on structures: the open window, maps since the start, windows that wait to be written."""

from typing import NamedTuple

import numpy as np

from dilatedem.state.clock import NEVER
from dilatedem.state.modes import MODE_COUNT

PLACE_BINS = 72  # of a load map: around a pile 5 degrees each
HEIGHT_BINS = 20
#: windows of loads that wait to be written, at most; fewer where so many structures' loads in them come to more numbers
WINDOWS, MOST_WAITING = 1000, 200_000


#: extremes of a window, in order, as columns of forces.csv: of forces along x, y, the horizontal, along the current, across it,
#: and of moments about the case's level
EXTREMES = (
    "fx_min_N", "fx_max_N", "fy_min_N", "fy_max_N", "fh_max_N", "along_min_N", "along_max_N", "across_min_N", "across_max_N",
    "mx_min_Nm", "mx_max_Nm", "my_min_Nm", "my_max_Nm", "mz_min_Nm", "mz_max_Nm", "mh_max_Nm",
)  # fmt: skip

#: columns of `Loads.crushed`
VOLUME, DEPTH = 0, 1


class Loads(NamedTuple):
    """Loads of s records (`state.records`): sums and extremes of the open window, and maps since the start."""

    steps: np.ndarray  # (1,) steps in the open window
    window_sum: np.ndarray  # (s, 6) force N and moment N m, summed over steps; zero where a window begins
    window_extreme: np.ndarray  # (s, EXTREMES) N, N m
    contact_sum: np.ndarray  # (s,) contacts, summed over steps
    step_load: np.ndarray  # (s, 6) of this step
    step_contacts: np.ndarray  # (s,) of this step
    stride_load: np.ndarray  # (s, 6) what the strides that end at this step add to the sums
    impulse_map: np.ndarray  # (maps, PLACE_BINS, HEIGHT_BINS) normal impulse, N s, as `state.charts` lays it out
    crushed: np.ndarray  # (s, 2) m3 of ice that has crushed on it since the start, m of the deepest dent
    mode_steps: np.ndarray  # (2, MODE_COUNT) contact steps, ice on ice and ice on structure
    mode_impulse: np.ndarray  # (2, MODE_COUNT) N s
    mode_force: np.ndarray  # (2, MODE_COUNT) N, largest normal force
    mode_overlap: np.ndarray  # (2, MODE_COUNT) m, largest overlap


class Windows(NamedTuple):
    """Windows of the loads that have ended and wait to be written, and when the next ones end.

    So that a run need not come back from the kernels at each of them.
    """

    count: np.ndarray  # (1,) windows that wait
    due: np.ndarray  # (room + 1,) step at which each of them ended, then those at which the next will
    steps: np.ndarray  # (room,) steps in it
    sum: np.ndarray  # (room, s, 6) and so on as in `Loads`
    extreme: np.ndarray  # (room, s, EXTREMES)
    contacts: np.ndarray  # (room, s)


def empty_loads(records: int, maps: int) -> Loads:
    """Nothing recorded yet of so many records, and so many load maps."""
    s = records
    per_mode = (np.zeros((2, MODE_COUNT)) for _ in range(4))
    return Loads(
        np.zeros(1, np.int64), np.zeros((s, 6)), np.zeros((s, len(EXTREMES))), np.zeros(s, np.int64), np.zeros((s, 6)),
        np.zeros(s, np.int64), np.zeros((s, 6)), np.zeros((maps, PLACE_BINS, HEIGHT_BINS)), np.zeros((s, 2)), *per_mode,
    )  # fmt: skip


def no_windows(records: int) -> Windows:
    """None has ended, and none will."""
    room = max(2, min(WINDOWS, MOST_WAITING // max(1, records)))
    return Windows(
        np.zeros(1, np.int64), np.full(room + 1, NEVER), np.zeros(room, np.int64), np.zeros((room, records, 6)),
        np.zeros((room, records, len(EXTREMES))), np.zeros((room, records), np.int64),
    )  # fmt: skip

"""A clock that kernels can read, for benchmarks; where there is none, reading it is no instruction at all.

Python's clock cannot be read in compiled code; the C library's can.
"""

import time
from typing import NamedTuple

import numpy as np
from numba import types

from dilatedem.jit.decorators import by_type, item

#: POSIX clock that no one sets; its number differs between systems
_MONOTONIC = getattr(time, "CLOCK_MONOTONIC", 1)
_clock_gettime = types.ExternalFunction("clock_gettime", types.int32(types.int32, types.voidptr))


class NoTimer(NamedTuple):
    """Nothing is timed."""

    nothing: int = 0


class Timer(NamedTuple):
    """Time spent on each of some stages."""

    booked: np.ndarray  # (stages, 2) ns, readings of the clock
    since: np.ndarray  # (1,) ns, the last reading
    answer: np.ndarray  # (2,) room for the C library's


def timer_of(stages: int) -> Timer:
    """Nothing booked yet."""
    return Timer(np.zeros((stages, 2), np.int64), np.zeros(1, np.int64), np.zeros(2, np.int64))


@item
def _unread(timer, stage):
    pass


@item
def _read(timer, stage):
    _clock_gettime(_MONOTONIC, timer.answer.ctypes)
    now = 1_000_000_000 * timer.answer[0] + timer.answer[1]
    if stage >= 0:
        timer.booked[stage, 0] += now - timer.since[0]
        timer.booked[stage, 1] += 1
    timer.since[0] = now


#: lap(timer, stage): book the time since the last reading on a stage, by number; -1: on none
lap = by_type(_unread, {Timer: _read})

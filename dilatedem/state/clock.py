"""Where a run is, and why it had to stop."""

from enum import IntEnum
from typing import NamedTuple

import numpy as np

NEVER = 2**62  # a step number no run reaches: safe in min() beside real ones


class Status(IntEnum):
    """Why `advance` came back."""

    DONE = 0
    PAIRS_FULL = 1  # the list of pairs has no room: grow the arrays and go on
    TOO_FAST = 2  # a body moved too far in one step, or its motion is no number
    TOO_DEEP = 3  # an overlap beyond what the method can mean


class Clock(NamedTuple):
    """How far a run is, why it stopped, and the work it has done: counts that are the same on every machine."""

    step: np.ndarray  # (1,) steps done
    time: np.ndarray  # (1,) s: `since_time` and the steps since `since_step`, so that no sum of steps drifts
    dt: np.ndarray  # (1,) s, of the steps to come; 0 where loads alone are evaluated
    since_step: np.ndarray  # (1,) step at which dt took its present value
    since_time: np.ndarray  # (1,) s, the time then
    begun: np.ndarray  # (1,) whether the loads of t = 0 were evaluated
    culprit: np.ndarray  # (2,) bodies at fault, -1 = none
    measure: np.ndarray  # (1,) the move or the overlap at fault, m
    moves: np.ndarray  # (1,) bodies moved, each once in a step or, idle ones, in a span
    evaluations: np.ndarray  # (1,) pairs looked at closely
    rounds: np.ndarray  # (1,) rounds of their distance searches
    rebuilds: np.ndarray  # (1,) lists of pairs made
    frequency: np.ndarray  # (1,) rad/s, bound on that of the contacts that were open when `advance` came back


_REAL = ("time", "dt", "since_time", "measure", "frequency")


def clock_at_start() -> Clock:
    """At t = 0, nothing done yet."""
    counts = {name: np.zeros(1, np.float64 if name in _REAL else np.int64) for name in Clock._fields}
    return Clock(**counts | {"culprit": np.full(2, -1, np.int64)})


def clock_at(steps: int, dt: float) -> Clock:
    """In the middle of a run, after so many steps of dt [s], its steps counted from here.

    Times come out of the same numbers as in the run itself, to the last bit.
    """
    clock = clock_at_start()
    clock.time[0], clock.since_step[0] = steps * dt, -steps
    clock.begun[0] = 1
    return clock

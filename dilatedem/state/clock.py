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
    """How far a run is, who made it stop, and the work it has done: counts that are the same on every machine."""

    step: np.ndarray  # (1,) steps done
    culprit: np.ndarray  # (2,) bodies at fault, -1 = none
    measure: np.ndarray  # (1,) the move or the overlap at fault, m
    moves: np.ndarray  # (1,) bodies moved, each once in a step or, idle ones, in a span
    evaluations: np.ndarray  # (1,) pairs looked at closely
    rounds: np.ndarray  # (1,) rounds of their distance searches
    rebuilds: np.ndarray  # (1,) lists of pairs made
    frequency: np.ndarray  # (1,) rad/s, bound on that of the contacts that were open when `advance` came back


def clock_at_start() -> Clock:
    counts = {name: np.zeros(1, np.int64) for name in Clock._fields}
    return Clock(**counts | {"culprit": np.full(2, -1, np.int64), "measure": np.zeros(1), "frequency": np.zeros(1)})

"""The time step with a clock between its stages.

Python's clock cannot be read in compiled code; the C library's can. `timed_advance` repeats `dilatedem.motion.step.advance`
stage by stage; tests/performance/test_timed_step.py holds the two together, word by word and bit by bit.
"""

import time

import numpy as np
from numba import types

from dilatedem.contact.gather import gather_contacts, record_loads
from dilatedem.contact.neighbours import awake_pairs, find_pairs
from dilatedem.contact.turning import turn_awake
from dilatedem.jit import device, kernel
from dilatedem.motion.stages import collide_pairs, complete_spins, drift_bodies, load_and_kick, longest_path, too_deep
from dilatedem.motion.step import DONE, PAIRS_FULL

#: stages in the order of the step; `spent` of `timed_advance` has a row for each
STAGES = ("search", "drift", "wake", "turn", "collide", "gather", "float", "record", "check")
SEARCH, DRIFT, WAKE, TURN, COLLIDE, GATHER, FLOAT, RECORD, CHECK = range(len(STAGES))

#: POSIX clock that no one sets; its number differs between systems
_MONOTONIC = getattr(time, "CLOCK_MONOTONIC", 1)
_clock_gettime = types.ExternalFunction("clock_gettime", types.int32(types.int32, types.voidptr))


@device
def _now(timespec):
    """Nanoseconds on the C library's clock; timespec (2,) is room for its answer."""
    _clock_gettime(_MONOTONIC, timespec.ctypes)
    return 1_000_000_000 * timespec[0] + timespec[1]


@device
def _lap(spent, stage, timespec, since):
    """Book the time since `since` [ns] on a stage; returns the present."""
    now = _now(timespec)
    spent[stage] += now - since
    return now


@kernel
def _read_clock(readings, spent, timespec):
    began = since = _now(timespec)
    for _ in range(readings):
        since = _lap(spent, 0, timespec, since)
    return since - began


def clock_cost(readings: int = 200_000) -> float:
    """What one reading of the clock adds to a stage, ns: the best of five rounds."""
    spent, timespec = np.zeros(1, np.int64), np.zeros(2, np.int64)
    return min(_read_clock(readings, spent, timespec) for _ in range(5)) / readings


@kernel
def timed_advance(team, model, bodies, pairs, spare, cells, workspace, ledger, loads, clock, dt, steps, spent, timespec):
    """As `advance`, and adds up the time of each stage.

    spent (stages,) int64 [ns] is added to; timespec (2,) int64: room.
    """
    status = DONE
    for _ in range(steps):
        t = _now(timespec)
        if longest_path(bodies) >= pairs.limit[0] and not find_pairs(model, bodies, pairs, spare, cells, clock):
            status = PAIRS_FULL
            break
        t = _lap(spent, SEARCH, timespec, t)
        if not drift_bodies(dt, model, bodies, pairs, clock):
            status = clock.status[0]
            break
        clock.step[0] += 1
        t = _lap(spent, DRIFT, timespec, t)
        awake = awake_pairs(bodies, pairs, workspace.awake)
        t = _lap(spent, WAKE, timespec, t)
        turn_awake(clock.step[0], awake, model.shapes, bodies, pairs, workspace)
        t = _lap(spent, TURN, timespec, t)
        collide_pairs(team, awake, dt, model, bodies, pairs, workspace)
        t = _lap(spent, COLLIDE, timespec, t)
        gather_contacts(workspace.awake, awake, dt, model.floating, bodies, pairs, ledger, loads, clock)
        t = _lap(spent, GATHER, timespec, t)
        load_and_kick(team, dt, model, bodies, workspace)
        t = _lap(spent, FLOAT, timespec, t)
        record_loads(loads)
        t = _lap(spent, RECORD, timespec, t)
        if too_deep(awake, model.shapes, model.contact, pairs, workspace, clock):
            status = clock.status[0]
            break
        t = _lap(spent, CHECK, timespec, t)
    complete_spins(model, bodies)
    return status


def timed(simulation, steps: int) -> tuple[dict[str, float], float]:
    """Advance a simulation whose pairs have room; returns us a step by stage, less the clock's share, and awake pairs."""
    spent, timespec, evaluations = np.zeros(len(STAGES), np.int64), np.zeros(2, np.int64), simulation.state.clock.evaluations
    before = int(evaluations[0])
    status = simulation._call(timed_advance, simulation.dt, steps, spent, timespec)
    if status != DONE:
        raise RuntimeError(f"the timed run came back with {status.name}")
    cost = clock_cost()
    per_step = {stage: max(0.0, total / steps - cost) * 1e-3 for stage, total in zip(STAGES, spent.tolist(), strict=True)}
    return per_step, (int(evaluations[0]) - before) / steps

"""The time step with a clock between its stages.

Python's clock cannot be read in compiled code; the C library's can. `timed_advance` repeats `dilatedem.step.advance.advance`
stage by stage; tests/performance/test_timed_step.py holds the two together, word by word and bit by bit.
"""

import time

import numpy as np
from numba import types

from dilatedem.contact.search.neighbours import awake_pairs, find_pairs
from dilatedem.contact.tally import close_tally, too_deep
from dilatedem.jit import device, kernel
from dilatedem.motion.energy import book_energies
from dilatedem.motion.paces import foresee
from dilatedem.motion.timestep import assembled_frequency
from dilatedem.step.advance import DONE, PAIRS_FULL, TOO_DEEP, TOO_FAST
from dilatedem.step.blocks import collide_pairs, complete_spins, drift_bodies, load_and_kick, longest_path, surprised, tick
from dilatedem.structures.record import end_window, load_structures, record_loads

#: stages in the order of the step; `booked` of `timed_advance` has a row for each
STAGES = ("search", "foresee", "drift", "wake", "collide", "float", "record", "idle")
SEARCH, FORESEE, DRIFT, WAKE, COLLIDE, FLOAT, RECORD, IDLE = range(len(STAGES))

#: POSIX clock that no one sets; its number differs between systems
_MONOTONIC = getattr(time, "CLOCK_MONOTONIC", 1)
_clock_gettime = types.ExternalFunction("clock_gettime", types.int32(types.int32, types.voidptr))


@device
def _now(timespec):
    """Nanoseconds on the C library's clock; timespec (2,) is room for its answer."""
    _clock_gettime(_MONOTONIC, timespec.ctypes)
    return 1_000_000_000 * timespec[0] + timespec[1]


@device
def _lap(booked, stage, timespec, since):
    """Book the time since `since` [ns] on a stage, and the reading; returns the present."""
    now = _now(timespec)
    booked[stage, 0] += now - since
    booked[stage, 1] += 1
    return now


@kernel
def _read_clock(readings, booked, timespec):
    began = since = _now(timespec)
    for _ in range(readings):
        since = _lap(booked, 0, timespec, since)
    return since - began


def clock_cost(readings: int = 200_000) -> float:
    """What one reading of the clock adds to a stage, ns: the best of five rounds."""
    booked, timespec = np.zeros((1, 2), np.int64), np.zeros(2, np.int64)
    return min(_read_clock(readings, booked, timespec) for _ in range(5)) / readings


@kernel
def timed_advance(
    team, model, bodies, pairs, spare, cells, workspace, tally, ledger, loads, windows, clock, span, steps, booked, timespec
):
    """As `advance`, and adds up the time of each stage.

    booked (stages, 2) int64 [ns, readings of the clock] is added to; timespec (2,) int64: room.
    """
    status, goal, dt = DONE, clock.step[0] + steps, clock.dt[0]
    while status == DONE and clock.step[0] < goal:
        t = _now(timespec)
        if longest_path(bodies) >= pairs.limit[0] and not find_pairs(model, bodies, pairs, spare, cells, clock):
            status = PAIRS_FULL
            break
        t = _lap(booked, SEARCH, timespec, t)
        start = clock.step[0]
        ahead, near, busy, idle = foresee(dt, min(span - start % span, goal - start), model, bodies, pairs, workspace)
        clock.moves[0] += idle
        t = _lap(booked, FORESEE, timespec, t)
        while clock.step[0] < start + ahead:
            if not drift_bodies(team, workspace.busy, busy, dt, model, bodies, pairs, workspace, clock):
                status = TOO_FAST
                break
            t = _lap(booked, DRIFT, timespec, t)
            tick(clock)
            clock.moves[0] += busy
            awake, at_structure = awake_pairs(near, model.structure_of, bodies, pairs, workspace)
            t = _lap(booked, WAKE, timespec, t)
            collide_pairs(team, awake, dt, model, bodies, pairs, workspace, tally)
            t = _lap(booked, COLLIDE, timespec, t)
            load_and_kick(team, workspace.busy, busy, awake, dt, clock.time[0], model, bodies, pairs, workspace)
            t = _lap(booked, FLOAT, timespec, t)
            load_structures(at_structure, dt, model.structure_of, model.charts, bodies, pairs, workspace, loads)
            record_loads(loads)
            end_window(clock.step[0], loads, windows)
            if too_deep(tally, pairs, clock):
                status = TOO_DEEP
            if status != DONE or surprised(workspace):
                break
            t = _lap(booked, RECORD, timespec, t)
        spent = (clock.step[0] - start) * dt
        if not drift_bodies(team, workspace.idle, idle, spent, model, bodies, pairs, workspace, clock):
            status = TOO_FAST
        load_and_kick(team, workspace.idle, idle, 0, spent, clock.time[0], model, bodies, pairs, workspace)
        t = _lap(booked, IDLE, timespec, t)
    close_tally(tally, ledger, loads, clock)
    complete_spins(model, bodies)
    book_energies(model, bodies, pairs, workspace, ledger)
    clock.frequency[0] = assembled_frequency(model.solids, bodies, pairs, workspace)
    return status


def timed(simulation, steps: int, *, calls: int = 1) -> tuple[dict[str, float], float]:
    """Advance a simulation whose pairs have room, in so many calls; returns us a step by stage, less the clock's share, and awake
    pairs."""
    booked, timespec, evaluations = np.zeros((len(STAGES), 2), np.int64), np.zeros(2, np.int64), simulation.state.clock.evaluations
    before, taken = int(evaluations[0]), 0
    simulation.state.clock.dt[0] = simulation.dt
    for call in range(1, calls + 1):
        piece, taken = steps * call // calls - taken, steps * call // calls
        status = simulation.call(timed_advance, simulation.span, piece, booked, timespec)
        if status != DONE:
            raise RuntimeError(f"the timed run came back with {status.name}")
    cost = clock_cost()
    per_step = {
        stage: max(0.0, total - readings * cost) / steps * 1e-3
        for stage, (total, readings) in zip(STAGES, booked.tolist(), strict=True)
    }
    return per_step, (int(evaluations[0]) - before) / steps

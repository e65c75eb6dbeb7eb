"""What a case takes for a load event, in steps and newtons."""

import math

import numpy as np

from dilatedem.case.schema import Case
from dilatedem.run.ending import total_steps
from dilatedem.state.hits import HitLog, Hits, hit_threshold, no_hits, no_log, samples_kept
from dilatedem.state.model import Model

#: steps by which a gap may be missed, as quotients of decimal numbers are
ROUND_OFF = 1e-6


def _watched(case: Case) -> int:
    """Structures whose events are told: those that the case lists, and their parts, which are the first of all."""
    return sum(len(structure.names()) for structure in case.structure)


def hits_at_start(case: Case, dt: float) -> Hits:
    """No event yet on the structures that the case lists, which are the first of all; steps of dt [s]."""
    watched = _watched(case)
    kept = case.output.hits_in_full if watched else 0
    before, after = samples_kept(dt, watched, kept)
    return no_hits(watched, kept, before + after + 1 if kept else 0)


def hit_log(case: Case, model: Model, dt: float) -> HitLog:
    """What counts as an event, and none that is over; model: of the start."""
    watched, output, solids = _watched(case), case.output, model.solids
    starts = np.setdiff1d(np.arange(model.floating), [k for first, last in model.joined for k in range(first + 1, last)])
    free = solids.inverse_mass[starts] > 0.0
    before, after = samples_kept(dt, watched, output.hits_in_full if watched else 0)
    return no_log(
        hit_threshold(output.hit_threshold, np.add.reduceat(solids.mass[: model.floating], starts)[free]),
        max(2, math.ceil(output.hit_gap / dt - ROUND_OFF)), before, after, total_steps(case, dt), watched,
    )  # fmt: skip

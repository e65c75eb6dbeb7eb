"""Load events of structures: those that go on, the highest of those that are over, and what counts as one."""

from typing import NamedTuple

import numpy as np

from dilatedem.state.clock import NEVER

#: whole numbers of an event: structure (-1: a free place), steps of its start, of the last load that counted and of its peak; at
#: the peak the leading floe, the mode of its contact and how many floes pushed; first step and number of the samples, number of the
#: floes and of the contacts that are kept
COUNTS = ("structure", "start", "last", "peak_step", "body", "mode", "bodies", "first", "samples", "floes", "contacts")
STRUCTURE, START, LAST, PEAK_STEP, BODY, MODE, BODIES, FIRST, SAMPLES, FLOES, CONTACTS = range(len(COUNTS))
#: and its real numbers: highest horizontal force; impulse up to this step and up to the last load that counted; nominal area, mean
#: pressure and crushed depth of the leading contact at the peak
FIGURES = ("peak_N", "sum_Ns", "impulse_Ns", "area_m2", "pressure_Pa", "crushed_m")
PEAK, SUM, IMPULSE, AREA, PRESSURE, CRUSHED = range(len(FIGURES))

#: s before and after its peak for which the force of an event is kept at every step: hits last 20 to 60 ms
BEFORE, AFTER = 0.1, 0.15
#: samples of one event that are kept, at most, and numbers of all of them: shorter where steps are short or structures many
MOST_SAMPLES, MOST_NUMBERS = 2000, 1_000_000
#: floes of an event that are kept, and contacts between them, at most
MOST_FLOES, MOST_CONTACTS = 60, 120
#: events of one structure that can wait to be written
ROOM = 64
#: m/s2 that the least force which counts, unless the case names one, gives the mean floe; N, that force where no floe moves
ACCELERATION, NO_FLOES = 1.0, 1000.0


class Hits(NamedTuple):
    """Events of w structures that are watched, and the n highest that are over: place h < w is the event of structure h that goes
    on, or free; the others, in no order, are those that are kept."""

    counts: np.ndarray  # (w + n, COUNTS)
    figures: np.ndarray  # (w + n, FIGURES)
    history: np.ndarray  # (w + n, samples, 3) N, force at every step around the peak
    floe: np.ndarray  # (w + n, floes) numbers of the floes that pushed, from the structure outward
    pose: np.ndarray  # (w + n, floes, 7) position [m] and orientation of each at the peak
    touch: np.ndarray  # (w + n, contacts, 3) their contacts: numbers of both bodies (of a structure -1 less its number), mode
    arrow: np.ndarray  # (w + n, contacts, 6) point [m] and force on the second body [N]
    recent: np.ndarray  # (w, samples, 3) N, the last steps' forces: that of a step at its number modulo samples


class HitLog(NamedTuple):
    """What counts as an event, and those that are over and wait to be written."""

    threshold: float  # N, horizontal force from which on a load counts
    gap: int  # steps from one load that counts to the next from which on they are two events
    before: int  # samples kept before the peak
    after: int  # and after it
    end: int  # step with which the run ends, and every event
    waiting: np.ndarray  # (1,) how many wait
    counts: np.ndarray  # (room, COUNTS)
    figures: np.ndarray  # (room, FIGURES)


def hit_threshold(setting: str | float, mass: np.ndarray) -> float:
    """Horizontal force [N] from which on a load counts; setting: that of the case, or "auto"; mass (n,) [kg] of the free floes.

    On its own it is what would give the mean floe ACCELERATION: far above drag and the shivers of a jam, a few per cent of a hit.
    It depends on the ice alone, neither on the run's own loads nor on the current: an event can be told while the run goes on, and
    counts of runs can be compared.
    """
    if setting != "auto":
        return float(setting)
    return ACCELERATION * float(np.mean(mass)) if len(mass) else NO_FLOES


def samples_kept(dt: float, structures: int, kept: int) -> tuple[int, int]:
    """Steps before and after a peak of which the force is kept, for steps of dt [s]."""
    if kept == 0 or structures == 0:
        return 0, 0
    most = min(MOST_SAMPLES, MOST_NUMBERS // (3 * (2 * structures + kept)))
    before = min(round(BEFORE / dt), int(most * BEFORE / (BEFORE + AFTER)))
    return before, min(round(AFTER / dt), most - before - 1)


def no_hits(structures: int, kept: int = 0, samples: int = 0) -> Hits:
    """No event yet; kept: how many are to be kept in full, with so many samples."""
    places, floes, contacts = structures + kept, MOST_FLOES * (kept > 0), MOST_CONTACTS * (kept > 0)
    counts = np.zeros((places, len(COUNTS)), np.int64)
    counts[:, STRUCTURE] = -1
    return Hits(
        counts, np.zeros((places, len(FIGURES))), np.zeros((places, samples, 3)), np.zeros((places, floes), np.int64),
        np.zeros((places, floes, 7)), np.zeros((places, contacts, 3), np.int64), np.zeros((places, contacts, 6)),
        np.zeros((structures, samples, 3)),
    )  # fmt: skip


def no_log(
    threshold: float = np.inf, gap: int = 2, before: int = 0, after: int = 0, end: int = NEVER, structures: int = 0
) -> HitLog:
    """No event waits."""
    room = max(1, ROOM * structures)
    return HitLog(
        threshold, gap, before, after, end, np.zeros(1, np.int64), np.zeros((room, len(COUNTS)), np.int64),
        np.zeros((room, len(FIGURES))),
    )  # fmt: skip

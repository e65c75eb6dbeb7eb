"""How long the steps of a run are: that of the contacts, and how many of them idle bodies take in one."""

import math
from fractions import Fraction

from dilatedem.case.schema import Case
from dilatedem.errors import CaseError
from dilatedem.run.observers import intervals
from dilatedem.water.loads import shortest_time

#: share of the time in which loads change that a step of a body which nothing can touch may last
LONGEST_SPAN = 4e-3
#: s that it may last at most, however slowly they change
LONGEST_STEP = 4e-3
#: most steps in such a step
MOST_SPAN = 32
#: angular frequency of the contacts that a single step is made for, in units of 1/critical step: at most, softer ones take several
#: in one (`motion.strides`)
STRIDE_PHASE = 2.0
#: what a step of all idle bodies costs, in units of a step of the busy ones and their contacts; effect: the span that the automatic
#: step is made for
IDLE_COST = 2.0
#: steps that can be counted: up to here floating-point numbers are exact
MOST_STEPS = 2.0**53
#: steps in the time that all outputs have in common, at least, for the step to divide it; else it divides the force window alone
SHORTEST_WINDOW = 16


def time_step(case: Case, critical: float) -> float:
    """The step [s]: the case's own, or a share of the critical one that divides the force window, and all output where it can.

    Raises CaseError for a step above the critical one, and for one in which no step could be told from the next.
    """
    if not critical > 0.0:
        raise CaseError("no time step is short enough for these bodies: check their sizes, densities, moduli and velocities")
    step = _time_step(case, critical)
    longest = max(case.time.duration, *intervals(case))
    if longest / step > MOST_STEPS:
        raise CaseError(
            f"the longest of time.duration and the intervals of [output], {longest:g} s, takes {longest / step:.2g} steps of "
            f"{step:.2g} s; at most {MOST_STEPS:.2g} can be counted: shorten it, or check what makes the step so short"
        )
    return step


def _time_step(case: Case, critical: float) -> float:
    if case.time.step != "auto":
        if case.time.step > critical:
            raise CaseError(
                f"time.step = {case.time.step:g}: must be at most the critical step, {critical:.3g} s, of the stiffest contact or "
                f'the fastest body; set time.step = "auto" for {case.time.step_fraction:g} of it'
            )
        return case.time.step
    output = case.output
    window, longest = output.force_interval, min(case.time.step_fraction * critical, output.force_interval, case.time.duration)
    common = _common_part(intervals(case))
    if common >= SHORTEST_WINDOW * longest:
        window = common
    steps = math.ceil(window / longest - 1e-9)

    def cost(span: int) -> float:
        return _rounded_up(steps, span) * (1.0 + IDLE_COST / span)

    return window / _rounded_up(steps, min(range(1, longest_span(longest, shortest_time(case)) + 1), key=cost))


def _rounded_up(steps: int, span: int) -> int:
    return -(-steps // span) * span


def _common_part(times: list[float]) -> float:
    """The longest time [s] of which all these are multiples, taken as the decimal numbers they were written as."""
    exact = [Fraction(repr(interval)) for interval in times]
    scale = math.lcm(*(interval.denominator for interval in exact))
    return float(Fraction(math.gcd(*(int(interval * scale) for interval in exact)), scale))


def longest_span(dt: float, changing: float) -> int:
    """The most steps of dt [s] that idle bodies may take in one, under loads that change over a time [s]."""
    return max(1, min(MOST_SPAN, int(min(LONGEST_SPAN * changing, LONGEST_STEP) / dt * (1.0 + 1e-9))))


def free_span(case: Case, dt: float) -> int:
    """Steps that bodies which nothing can touch take in one: the most that divide the force window, where that is steps in full.

    What else falls due within a span is written at its end (`Schedule`); no span is longer than a sixteenth of such an interval.
    """
    window, *others = (interval / dt for interval in intervals(case))
    spans = [span for span in range(1, longest_span(dt, shortest_time(case)) + 1) if span == 1 or _divides(span, window)]
    return max(span for span in spans if all(_divides(span, other) or 16 * span <= other for other in others) or span == 1)


def _divides(span: int, steps: float) -> bool:
    whole = round(steps)
    return abs(steps - whole) <= 1e-9 * steps and whole % span == 0

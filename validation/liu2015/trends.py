"""The paper's trends, one after the other: what it says, what is asked of the runs, what they say, and whether the two agree."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from validation.liu2015.measures import FIRST_HITS, JAM, Ensemble
from validation.liu2015.plan import CASES, LARGE, SIZE_SPEED, SMALL
from validation.liu2015.similarity import BREAK, likeness
from validation.liu2015.statistics import (
    FEWEST,
    LEVEL,
    Band,
    Test,
    band,
    finite,
    gumbel,
    holm,
    location_of_rows,
    ratio_band,
    signed_ranks,
    together,
    unpaired,
)

#: highest force over mean force from which on a history is called pulses
PULSES = 10.0

AGREES, DISAGREES, OPEN, SETUP = "agrees", "**disagrees**", "cannot be told", "follows from the set-up"


@dataclass(frozen=True)
class Finding:
    """One trend with one model. test: None where the outcome follows from the set-up, so that there is nothing to test."""

    trend: str
    model: str
    asked: str
    words: str
    test: Test | None


@dataclass(frozen=True)
class Verdict:
    """p: corrected for all tests of the page; nan where none was made."""

    finding: Finding
    word: str
    p: float


def number(value: float, digits: int = 3) -> str:
    if not math.isfinite(value):
        return "–"
    text = f"{value:.{digits}g}"
    return f"{value:.0f}" if "e+" in text else text


def banded(band: Band, scale: float = 1.0) -> str:
    """An estimate and its band, as 113 (74 to 151). Where all fields have one value, resamples cannot tell of others."""
    if not math.isfinite(band.low):
        return number(scale * band.value)
    if band.low == band.high:
        return f"{number(scale * band.value)} (in all {band.n})"
    return f"{number(scale * band.value)} ({number(scale * band.low)} to {number(scale * band.high)})"


def chance(p: float) -> str:
    return "–" if not math.isfinite(p) else "< 0.001" if p < 0.001 else f"{p:.2g}"


def by_size(ensemble: Ensemble, name: str, model: str) -> dict[str, np.ndarray]:
    """A measure at SIZE_SPEED, of both floe sizes."""
    return {size: finite(ensemble.of(name, model, size, SIZE_SPEED).values()) for size in CASES}


def both_sizes(say: Callable[[str], str]) -> str:
    return "; ".join(f"{size} m: {say(size)}" for size in CASES)


def rises_with_speed(ensemble: Ensemble, model: str) -> Finding:
    found = likeness(ensemble, model)
    words = "too few runs"
    if found:
        words = (
            f"F ~ v^n with n = {banded(found.exponent)}; correlation of two speeds over the fields at least "
            f"{banded(found.correlation)}"
        )
    return Finding("The highest force rises with ice speed (Fig. 14)", model, "nothing: similarity", words, None)


def faster_above(ensemble: Ensemble, model: str) -> Finding:
    found = likeness(ensemble, model)
    words = f"n changes by {banded(found.change)} at {BREAK:g} m/s" if found else "too few runs"
    return Finding(f"It grows faster above {BREAK:g} m/s (Fig. 14)", model, "nothing: no such break can appear", words, None)


def softer(ensemble: Ensemble, model: str) -> Finding:
    """Fields of two floe sizes have nothing in common, whatever their seed, so no pairs."""
    highest = by_size(ensemble, "fh_max_first_hits_N", model)
    test = unpaired(highest[SMALL], highest[LARGE])
    ratio = ratio_band(highest[SMALL], highest[LARGE], location_of_rows)
    words = (
        f"Gumbel's location {banded(gumbel(highest[SMALL]).location, 1e-3)} against "
        f"{banded(gumbel(highest[LARGE]).location, 1e-3)} kN, ratio {banded(ratio)}; "
        f"lower in {test.count} of {test.n} pairs of fields"
    )
    asked = f"highest force of the first {FIRST_HITS:g} s, {SMALL} m below {LARGE} m"
    return Finding("Smaller floes hit more softly at first (Fig. 15)", model, asked, words, test)


def steadier(ensemble: Ensemble, model: str) -> Finding:
    swing = by_size(ensemble, "fluctuation_first_hits_N", model)
    test = unpaired(swing[SMALL], swing[LARGE])
    words = (
        f"{banded(band(swing[SMALL]), 1e-3)} against {banded(band(swing[LARGE]), 1e-3)} kN; "
        f"lower in {test.count} of {test.n} pairs of fields"
    )
    asked = f"fluctuation of Fx in the first {FIRST_HITS:g} s, {SMALL} m below {LARGE} m"
    return Finding("Smaller floes load the pile more steadily at first (Fig. 15)", model, asked, words, test)


def jam_fluctuates(ensemble: Ensemble, model: str) -> Finding:
    ratios = by_size(ensemble, "fluctuation_jam_over_before", model)[SMALL]
    test = signed_ranks(np.log(ratios[ratios > 0.0]), above=True)
    words = f"ratio {banded(band(ratios))}; above 1 in {test.count} of {test.n} fields"
    asked = f"fluctuation of Fx from {JAM[0]:g} to {JAM[1]:g} s over that before, above 1"
    trend = f"Smaller floes make Fx fluctuate more from {JAM[0]:g} s on, when they jam (Figs. 15, 16)"
    return Finding(trend, model, asked, words, test)


def pulses(ensemble: Ensemble, model: str) -> Finding:
    peaky, duration, backward = (
        by_size(ensemble, name, model) for name in ("peak_over_mean", "peak_duration_s", "fx_backward_share")
    )
    test = together([signed_ranks(np.log(peaky[size] / PULSES), above=True) for size in CASES])
    words = both_sizes(
        lambda size: (
            f"{banded(band(peaky[size]))} times the mean, peaks last {banded(band(duration[size]), 1e3)} ms, "
            f"{banded(band(backward[size]), 100.0)} % of the impulse points upstream"
        )
    )
    asked = f"highest force above {PULSES:g} times the mean of Fx (that Fx is one-sided follows from the set-up)"
    return Finding("Fx is one-sided and comes in pulses (Figs. 12, 15)", model, asked, words, test)


def smaller_across(ensemble: Ensemble, model: str) -> Finding:
    smaller, turns = by_size(ensemble, "fy_over_fx", model), by_size(ensemble, "fy_turns", model)
    test = together([signed_ranks(np.log(smaller[size][smaller[size] > 0.0]), above=False) for size in CASES])
    words = both_sizes(lambda size: f"{banded(band(smaller[size]))}, {banded(band(turns[size]))} changes of sign a run")
    asked = "largest Fy over largest Fx below 1 (that Fy has both signs follows from the set-up)"
    return Finding("Fy alternates in sign and is smaller (Figs. 12, 15)", model, asked, words, test)


def upstream(ensemble: Ensemble, model: str) -> Finding:
    near, half = (by_size(ensemble, f"upstream_{angle}_deg_share", model) for angle in (45, 90))
    test = together([signed_ranks(near[size] - 0.5, above=True) for size in CASES])
    words = both_sizes(
        lambda size: f"{banded(band(near[size]), 100.0)} % within 45°, {banded(band(half[size]), 100.0)} % within 90°"
    )
    asked = "more than half of the impulse within 45° of upstream (that all is within 90° follows from the set-up)"
    return Finding("The load sits on the upstream arc (Figs. 13, 18)", model, asked, words, test)


def lane(ensemble: Ensemble, model: str) -> Finding:
    behind = by_size(ensemble, "ice_behind_over_beside", model)
    test = together([signed_ranks(behind[size] - 0.5, above=False) for size in CASES])
    words = both_sizes(lambda size: banded(band(behind[size])))
    asked = "concentration behind the pile over that beside it below 0.5"
    return Finding("A lane opens behind the pile (Figs. 10, 16)", model, asked, words, test)


def jam(ensemble: Ensemble, model: str) -> Finding:
    dense, slow = (by_size(ensemble, name, model) for name in ("ice_ahead_over_beside", "speed_ahead_over_current"))
    tests = [signed_ranks(dense[size] - 1.0, above=True) for size in CASES]
    tests += [signed_ranks(slow[size] - 1.0, above=False) for size in CASES]
    words = both_sizes(lambda size: f"concentration {banded(band(dense[size]))}, speed {banded(band(slow[size]))}")
    asked = "concentration ahead over that beside above 1, speed ahead over the current's below 1"
    return Finding("Ice jams and slows down ahead of the pile (Figs. 11, 16, 17)", model, asked, words, together(tests))


TRENDS = (rises_with_speed, faster_above, softer, steadier, jam_fluctuates, pulses, smaller_across, upstream, lane, jam)


def enough(ensemble: Ensemble, model: str) -> bool:
    """Have both floe sizes been run with so many fields that a test could find something?"""
    return all(len(ensemble.chosen(model, size, SIZE_SPEED)) >= FEWEST for size in CASES)


def verdicts(ensemble: Ensemble) -> list[Verdict]:
    """Every trend with every model, judged at one level for all tests together."""
    found = [check(ensemble, model) for check in TRENDS for model in ensemble.models]
    tested = [finding for finding in found if finding.test and enough(ensemble, finding.model)]
    chances = dict(zip(map(id, tested), holm([finding.test.p for finding in tested]), strict=True))
    judged = []
    for finding in found:
        if finding.test is None:
            judged.append(Verdict(finding, SETUP, math.nan))
            continue
        p = chances.get(id(finding), math.nan)
        word = OPEN if not p < LEVEL else AGREES if finding.test.towards else DISAGREES
        judged.append(Verdict(finding, word, p))
    return judged

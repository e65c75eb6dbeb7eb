"""The paper's trends, one after the other: what it says, what the runs say, and whether the two agree."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from validation.liu2015.measures import FIRST_HITS, JAM, Ensemble
from validation.liu2015.plan import LARGE, SIZE_SPEED, SMALL
from validation.liu2015.statistics import Band, complete_rows, exponents, mean_band, slopes, trend, unpaired

#: a one-sided test below this is taken for an effect
SIGNIFICANT = 0.05
#: with fewer seeds nothing is said
FEWEST_SEEDS = 5
#: m/s above which the paper sees the force grow faster
BREAK = 0.7

AGREES, OPEN, DISAGREES, FEW = "agrees", "not shown", "**disagrees**", "too few seeds"


@dataclass(frozen=True)
class Finding:
    """The verdict on one trend with one model, and the figures behind it."""

    verdict: str
    words: str


def by_band(band: Band, threshold: float, *, above: bool) -> str:
    """Is the mean above (or below) a threshold, its whole band included?"""
    if band.n < FEWEST_SEEDS:
        return FEW
    if band.above(threshold):
        return AGREES if above else DISAGREES
    if band.below(threshold):
        return DISAGREES if above else AGREES
    return OPEN


def by_test(test_p: float, opposite_p: float, n: int) -> str:
    if n < FEWEST_SEEDS:
        return FEW
    return AGREES if test_p < SIGNIFICANT else DISAGREES if opposite_p < SIGNIFICANT else OPEN


def number(value: float, digits: int = 3) -> str:
    if not math.isfinite(value):
        return "–"
    text = f"{value:.{digits}g}"
    return f"{value:.0f}" if "e+" in text else text


def banded(band: Band, scale: float = 1.0) -> str:
    """Mean and its band, as 113 (74 to 151)."""
    if not math.isfinite(band.low):
        return number(scale * band.value)
    return f"{number(scale * band.value)} ({number(scale * band.low)} to {number(scale * band.high)})"


def chance(p: float) -> str:
    return "–" if not math.isfinite(p) else "< 0.001" if p < 0.001 else f"{p:.2g}"


def speed_table(ensemble: Ensemble, model: str, name: str = "fh_max_N") -> tuple[np.ndarray, np.ndarray]:
    """Speeds (k,) [m/s], and the measure (seeds, k) of the seeds that were run at all of them."""
    speeds = ensemble.speeds(model, LARGE)
    if not speeds:
        return np.zeros(0), np.zeros((0, 0))
    return np.array(speeds), complete_rows([ensemble.of(name, model, LARGE, speed) for speed in speeds])


def parted(speeds: np.ndarray, table: np.ndarray, fit) -> tuple[np.ndarray, np.ndarray]:
    """A fit per seed up to BREAK and from BREAK on."""
    low, high = speeds <= BREAK + 1e-9, speeds >= BREAK - 1e-9
    return fit(speeds[low], table[:, low]), fit(speeds[high], table[:, high])


def rises_with_speed(ensemble: Ensemble, model: str) -> Finding:
    speeds, table = speed_table(ensemble, model)
    if len(speeds) < 3:
        return Finding(FEW, "fewer than three speeds")
    rising, falling = trend(table), trend(table[:, ::-1])
    power = mean_band(exponents(speeds, table))
    words = f"Page's trend test p {chance(rising)}; F ~ v^n with n = {banded(power)} over all speeds; n = {len(table)} seeds"
    return Finding(by_test(rising, falling, len(table)), words)


def faster_above(ensemble: Ensemble, model: str) -> Finding:
    speeds, table = speed_table(ensemble, model)
    if np.sum(speeds <= BREAK + 1e-9) < 2 or np.sum(speeds >= BREAK - 1e-9) < 2:
        return Finding(FEW, f"fewer than two speeds to a side of {BREAK:g} m/s")
    before, after = parted(speeds, table, slopes)
    below, above = parted(speeds, table, exponents)
    words = (
        f"slope {banded(mean_band(before), 1e-3)} kN per m/s up to {BREAK:g} m/s, {banded(mean_band(after), 1e-3)} from there on, "
        f"difference {banded(mean_band(after - before), 1e-3)}; exponent {banded(mean_band(below))}, then "
        f"{banded(mean_band(above))}; n = {len(table)}"
    )
    return Finding(by_band(mean_band(after - before), 0.0, above=True), words)


def one_sided(ensemble: Ensemble, model: str, size: str) -> Finding:
    backward = mean_band(ensemble.of("fx_backward_share", model, size, SIZE_SPEED).values())
    peaky = mean_band(ensemble.of("peak_over_mean", model, size, SIZE_SPEED).values())
    duration = mean_band(ensemble.of("peak_duration_s", model, size, SIZE_SPEED).values())
    words = (
        f"{number(100.0 * backward.value)} % of the impulse points upstream; the highest peak is {banded(peaky)} times the mean, "
        f"peaks last {banded(duration, 1e3)} ms; n = {peaky.n}"
    )
    verdict = FEW if peaky.n < FEWEST_SEEDS else AGREES if backward.value < 0.01 and peaky.low > 10.0 else DISAGREES
    return Finding(verdict, words)


def alternates(ensemble: Ensemble, model: str, size: str) -> Finding:
    lowest, highest = (ensemble.of(name, model, size, SIZE_SPEED) for name in ("fy_min_N", "fy_max_N"))
    both = sum(lowest[seed] < 0.0 < highest[seed] for seed in lowest)
    smaller = mean_band(ensemble.of("fy_over_fx", model, size, SIZE_SPEED).values())
    turns = mean_band(ensemble.of("fy_turns", model, size, SIZE_SPEED).values())
    words = (
        f"both signs in {both} of {len(lowest)} seeds, {banded(turns)} changes of sign a run; "
        f"largest Fy / largest Fx {banded(smaller)}"
    )
    verdict = by_band(smaller, 1.0, above=False)
    return Finding(verdict if both == len(lowest) or verdict == FEW else OPEN, words)


def upstream(ensemble: Ensemble, model: str, size: str) -> Finding:
    near, half = (mean_band(ensemble.of(f"upstream_{angle}_deg_share", model, size, SIZE_SPEED).values()) for angle in (45, 90))
    words = f"{banded(near, 100.0)} % of the impulse within 45° of upstream, {banded(half, 100.0)} % within 90°; n = {near.n}"
    return Finding(by_band(near, 0.5, above=True), words)


def softer(ensemble: Ensemble, model: str, name: str, what: str) -> Finding:
    """Is a measure smaller with the small floes? Their fields have nothing in common with the large ones', so no pairs."""
    large, small = (ensemble.of(name, model, size, SIZE_SPEED) for size in (LARGE, SMALL))
    falls, rises = unpaired(small.values(), large.values()), unpaired(large.values(), small.values())
    words = (
        f"{what} {banded(mean_band(small.values()), 1e-3)} against {banded(mean_band(large.values()), 1e-3)} kN; the small floes' "
        f"is lower in {falls.rises} of {falls.n} pairs, p {chance(falls.p)}; n = {len(small)} and {len(large)}"
    )
    return Finding(by_test(falls.p, rises.p, min(len(small), len(large))), words)


def jam_fluctuates(ensemble: Ensemble, model: str) -> Finding:
    ratios = ensemble.of("fluctuation_jam_over_before", model, SMALL, SIZE_SPEED)
    band = mean_band(ratios.values())
    more = sum(value > 1.0 for value in ratios.values())
    times = f"{JAM[0]:g} to {JAM[1]:g} s"
    words = f"fluctuation of Fx from {times} over that before: {banded(band)}; above 1 in {more} of {len(ratios)} seeds"
    return Finding(by_band(band, 1.0, above=True), words)


def lane(ensemble: Ensemble, model: str, size: str) -> Finding:
    band = mean_band(ensemble.of("ice_behind_over_beside", model, size, SIZE_SPEED).values())
    words = f"concentration behind the pile over that beside it {banded(band)}; n = {band.n}"
    return Finding(by_band(band, 0.5, above=False), words)


def jam(ensemble: Ensemble, model: str, size: str) -> Finding:
    dense = mean_band(ensemble.of("ice_ahead_over_beside", model, size, SIZE_SPEED).values())
    slow = mean_band(ensemble.of("speed_ahead_over_current", model, size, SIZE_SPEED).values())
    words = f"concentration ahead over that beside {banded(dense)}, speed ahead over the current {banded(slow)}; n = {dense.n}"
    verdicts = {by_band(dense, 1.0, above=True), by_band(slow, 1.0, above=False)}
    return Finding(verdicts.pop() if len(verdicts) == 1 else OPEN, words)


#: trends that the paper shows for both sizes: its words, the check, and the figure of the large and of the small floes
BOTH_SIZES = (
    ("Fx is one-sided and comes in pulses", one_sided, ("Fig. 12", "Fig. 15")),
    ("Fy alternates in sign and is smaller", alternates, ("Fig. 12", "Fig. 15")),
    ("The load sits on the upstream arc", upstream, ("Fig. 13", "Fig. 18")),
    ("A lane opens behind the pile", lane, ("Fig. 10", "Fig. 16")),
    ("Ice jams and slows down ahead of the pile", jam, ("Fig. 11", "Figs. 16, 17")),
)


def findings(ensemble: Ensemble, model: str) -> list[tuple[str, Finding]]:
    """Every trend of the paper in words, with what one model makes of it."""
    late = f"from {JAM[0]:g} to {JAM[1]:g} s"
    first = f"highest force of the first {FIRST_HITS:g} s"
    shown = [
        ("The highest force rises with ice speed (Fig. 14)", rises_with_speed(ensemble, model)),
        (f"It grows faster above {BREAK:g} m/s (Fig. 14)", faster_above(ensemble, model)),
        ("Smaller floes hit more softly at first (Fig. 15)", softer(ensemble, model, "fh_max_first_hits_N", first)),
        (
            f"Smaller floes load the pile more steadily in the first {FIRST_HITS:g} s (Fig. 15)",
            softer(ensemble, model, "fluctuation_first_hits_N", "fluctuation of Fx"),
        ),
        (f"Smaller floes make Fx fluctuate more {late}, when they jam (Figs. 15, 16)", jam_fluctuates(ensemble, model)),
    ]
    for words, check, places in BOTH_SIZES:
        for size, place in zip((LARGE, SMALL), places, strict=True):
            shown.append((f"{words}, {size} m ({place})", check(ensemble, model, size)))
    return shown

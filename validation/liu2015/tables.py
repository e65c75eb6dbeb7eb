"""Tables of the page: highest and mean loads, speed by speed, model by model, and the character of load and ice."""

from __future__ import annotations

from validation.liu2015.ice import DRIFT, STRIP
from validation.liu2015.measures import COARSE, EQUAL_DRIFT, PASSING_DRIFT, Ensemble
from validation.liu2015.plan import CASES, LARGE, SIZE_SPEED
from validation.liu2015.similarity import HIGHEST, MEAN, likeness
from validation.liu2015.statistics import QUOTED, band, gumbel, paired_ratio
from validation.liu2015.trends import banded, number

#: head of the column, measure, factor from SI
CHARACTER = (
    ("impulse along x, kN s", "fx_impulse_Ns", 1e-3),
    ("time in contact, %", "contact_time_share", 100.0),
    ("peaks", "peaks", 1.0),
    ("their duration, ms", "peak_duration_s", 1e3),
    (f"fluctuation of {COARSE:g} s means of Fx, kN", "fluctuation_N", 1e-3),
    ("largest Fy / Fx", "fy_over_fx", 1.0),
    ("impulse within 45° of upstream, %", "upstream_45_deg_share", 100.0),
    ("ice behind / beside", "ice_behind_over_beside", 1.0),
    ("ice ahead / beside", "ice_ahead_over_beside", 1.0),
    ("speed ahead / current", "speed_ahead_over_current", 1.0),
)
GUMBEL_HEADS = ("location, kN", "scale, kN", f"exceeded by one field of {1.0 / (1.0 - QUOTED):.0f}, kN", "r")


def row(*cells: str) -> str:
    return "| " + " | ".join(cells) + " |"


def head(*cells: str) -> list[str]:
    return [row(*cells), row(*["---"] * len(cells))]


def points(ensemble: Ensemble) -> list[tuple[str, str, float]]:
    """Model, size and speed of every point that has a run."""
    return [(model, size, speed) for model in ensemble.models for size in CASES for speed in ensemble.speeds(model, size)]


def tables(ensemble: Ensemble) -> list[str]:
    return [*loads(ensemble), *whole_runs(ensemble), *neighbours(ensemble), *models(ensemble), *character(ensemble)]


def fitted(ensemble: Ensemble, name: str, point: tuple[str, str, float]) -> list[str]:
    """The cells of GUMBEL_HEADS."""
    law = gumbel(ensemble.of(name, *point).values())
    return [*(banded(part, 1e-3) for part in (law.location, law.scale, law.quantile)), number(law.correlation)]


def loads(ensemble: Ensemble) -> list[str]:
    lines = [
        "### Loads at equal drift",
        "",
        f"Highest horizontal force of the first {EQUAL_DRIFT:g} m of drift: Gumbel's law, fitted to one value a field by most "
        "likelihood. r: correlation of the values with the law's quantiles. Of n fields the scale comes out too small by some "
        "0.8/n of itself.",
        "",
        *head("model", "floes, m", "speed, m/s", "n", *GUMBEL_HEADS, f"mean Fx of the first {EQUAL_DRIFT:g} m, kN"),
    ]
    for point in points(ensemble):
        model, size, speed = point
        cells = [f"`{model}`", size, f"{speed:g}", str(len(ensemble.chosen(*point))), *fitted(ensemble, HIGHEST, point)]
        lines.append(row(*cells, banded(band(ensemble.of(MEAN, *point).values()), 1e-3)))
    return [*lines, ""]


def whole_runs(ensemble: Ensemble) -> list[str]:
    """At the one speed that both sizes were run at: in equal time equal drift."""
    lines = [
        f"### Loads of whole runs at {SIZE_SPEED:g} m/s",
        "",
        f"As above, over all 100 s, {PASSING_DRIFT:g} m of drift.",
        "",
        *head("model", "floes, m", "n", *GUMBEL_HEADS, "mean Fx, kN"),
    ]
    for point in points(ensemble):
        model, size, speed = point
        if speed == SIZE_SPEED:
            cells = [f"`{model}`", size, str(len(ensemble.chosen(*point))), *fitted(ensemble, "fh_max_N", point)]
            lines.append(row(*cells, banded(band(ensemble.of("fx_mean_N", *point).values()), 1e-3)))
    return [*lines, ""]


def neighbours(ensemble: Ensemble) -> list[str]:
    lines = [
        "### From one speed to the next",
        "",
        f"Highest force of the same field at two speeds, first {EQUAL_DRIFT:g} m of drift, floes of {LARGE} m: ratio (geometric "
        "mean) and the exponent n that it stands for (mean of the fields' own).",
        "",
        *head("model", "speeds, m/s", "ratio", "n"),
    ]
    for model in ensemble.models:
        found = likeness(ensemble, model)
        if found is None:
            continue
        for slow, fast, local in zip(found.speeds[:-1], found.speeds[1:], found.local, strict=True):
            ratio = paired_ratio(*(ensemble.of(HIGHEST, model, LARGE, speed) for speed in (slow, fast)))
            lines.append(row(f"`{model}`", f"{slow:g} to {fast:g}", banded(ratio), banded(local)))
    return [*lines, ""]


def models(ensemble: Ensemble) -> list[str]:
    """`consistent` over `liu2015`, field by field."""
    if len(ensemble.models) < 2:
        return []
    base, other = ensemble.models
    lines = [
        f"### `{other}` over `{base}`",
        "",
        f"The same fields with the two contact models, first {EQUAL_DRIFT:g} m of drift: ratio over the fields (geometric mean).",
        "",
        *head("floes, m", "speed, m/s", "fields", "highest force", "mean Fx"),
    ]
    for size in CASES:
        for speed in sorted(set(ensemble.speeds(base, size)) & set(ensemble.speeds(other, size))):
            highest, mean = (
                paired_ratio(*(ensemble.of(name, model, size, speed) for model in (base, other))) for name in (HIGHEST, MEAN)
            )
            lines.append(row(size, f"{speed:g}", str(highest.n), banded(highest), banded(mean)))
    return [*lines, ""]


def character(ensemble: Ensemble) -> list[str]:
    lines = [
        f"### Character of the load, and the ice, at {SIZE_SPEED:g} m/s",
        "",
        "Means over the fields. Peaks: unbroken rows of 10 ms windows whose highest force reaches a tenth of the run's highest; in "
        f"contact: windows with any contact. Ice ahead and behind: in strips {STRIP:g} m long and as wide as the pile, from "
        f"{DRIFT[0]:g} to {DRIFT[1]:g} m of drift.",
        "",
        *head("model", "floes, m", "n", *(words for words, _, _ in CHARACTER)),
    ]
    for point in points(ensemble):
        model, size, speed = point
        if speed == SIZE_SPEED:
            bands = [banded(band(ensemble.of(name, *point).values()), factor) for _, name, factor in CHARACTER]
            lines.append(row(f"`{model}`", size, str(len(ensemble.chosen(*point))), *bands))
    return [*lines, ""]

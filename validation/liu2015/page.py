"""The part of the README that is made from the runs: what they were made with, verdicts, likeness of speeds, figures, tables."""

from __future__ import annotations

import math
import subprocess
from collections import Counter
from pathlib import Path
from statistics import median

from validation.liu2015 import figures, figures_ice, figures_speed
from validation.liu2015.ice import DRIFT
from validation.liu2015.measures import EQUAL_DRIFT, Ensemble
from validation.liu2015.plan import LARGE, MODELS, SIZE_SPEED, SMALL, plan
from validation.liu2015.runner import PACKAGE, source_digest
from validation.liu2015.similarity import BREAK, SAME_HIT, likeness
from validation.liu2015.statistics import CONFIDENCE, FEWEST, FEWEST_SCATTER, LEVEL, RESAMPLES
from validation.liu2015.tables import row, tables
from validation.liu2015.trends import banded, chance, number, verdicts

START, END = "<!-- results: written by validation/liu2015/run.py -->", "<!-- end of the results -->"
RUNS_TABLE = "runs.csv"


def write(ensemble: Ensemble, folder: Path) -> Path:
    """Write figures, the table of all runs and the page in this folder; what stands on the page outside the marks is kept.

    Raises ValueError, with nothing written, for runs of different sources.
    """
    made_with = provenance(ensemble)
    folder.mkdir(parents=True, exist_ok=True)
    ensemble.write(folder / RUNS_TABLE)
    parts = [made_with, trends(ensemble), similarity(ensemble), pictures(ensemble, folder), tables(ensemble)]
    lines = ["", *(line for part in parts for line in part), ""]
    page = folder / "README.md"
    text = page.read_text(encoding="utf-8") if page.exists() else f"# The case of Liu, Long & Ji (2015)\n\n{START}\n{END}\n"
    before, _, rest = text.partition(START)
    _, _, after = rest.partition(END)
    page.write_text(f"{before}{START}\n" + "\n".join(lines) + f"{END}{after}", encoding="utf-8")
    return page


def one_state(ensemble: Ensemble) -> str:
    """Digest of the sources that all runs were made with; empty where it is not known. Raises ValueError where they differ."""
    sources = Counter(result.sources for result in ensemble.results)
    if len(sources) > 1:
        counts = ", ".join(f"{count} with {state or 'unknown ones'}" for state, count in sources.most_common())
        raise ValueError(f"the runs were made with different sources ({counts}) and cannot be compared; --renew makes them anew")
    return next(iter(sources))


def commit() -> str:
    """The commit that the package is of, where this is a clean checkout; else empty."""

    def git(*words: str) -> str:
        try:
            return subprocess.run(["git", *words], capture_output=True, text=True, check=True).stdout.strip()
        except (OSError, subprocess.CalledProcessError):
            return ""

    last = git("log", "-1", "--first-parent", "--format=%h", "--", str(PACKAGE))
    return "" if git("status", "--porcelain", "--", str(PACKAGE)) else last


def provenance(ensemble: Ensemble) -> list[str]:
    """How many runs of the plan, by which sources, and how well they conserve energy."""
    state, planned = one_state(ensemble), set(plan())
    count = sum(result.run in planned for result in ensemble.results)
    durations = {f"{result.folder.summary.get('simulated_s', 0.0):g}": None for result in ensemble.results}
    residual = max(result.measures["residual_over_work"] for result in ensemble.results)
    whole = "All" if count == len(planned) else f"{count} of the"
    lines = [f"{whole} {len(planned)} runs of the plan, of {', '.join(durations)} s each."]
    if count < len(planned):
        done = Counter(result.run.model for result in ensemble.results if result.run in planned)
        of = Counter(run.model for run in planned)
        parts = ", ".join(f"{done[model]} of {of[model]} with `{model}`" for model in MODELS)
        lines.append(f"**The rest is still to do**: there are {parts}. It brings more tests, so that p may rise.")
    if extra := len(ensemble.results) - count:
        lines.append(f"{extra} further runs beside the plan.")
    if not state:
        lines.append("With which state of the sources they were made is not known.")
    else:
        of = commit() if state == source_digest() else ""
        lines.append(f"One state of the sources made them, `{state}`" + (f", that of commit `{of}`." if of else "."))
    lines.append(f"Energy residual over work of the current: at most {residual:.1e}.")
    return [" ".join([*lines, *step_check(ensemble)]), ""]


def step_check(ensemble: Ensemble) -> list[str]:
    """What became of the highest loads with half the time step, in the runs that looked."""
    checks = [result.folder.summary.get("error_check", {}).get("change", {}).get("fh_max") for result in ensemble.results]
    changes = [abs(change) for change in checks if change is not None]
    if not changes:
        return []
    return [
        f"In {len(changes)} of them the highest load was replayed with half the time step; it changes by "
        f"{number(100.0 * median(changes))} % (median) and at most {number(100.0 * max(changes))} %."
    ]


def trends(ensemble: Ensemble) -> list[str]:
    """How things were tested, then a verdict a trend and model, with the figures behind it."""
    judged = verdicts(ensemble)
    count = sum(math.isfinite(verdict.p) for verdict in judged)
    rule = (
        f"One level for the whole page: {100.0 * LEVEL:g} % for the {count} tests of this table together, by Holm's method; p is "
        "what is left after that correction. Tests are two-sided: between floe sizes Mann & Whitney's, over the fields of one "
        "size Wilcoxon's signed ranks; where a row asks several things, of both sizes or of two measures, all must hold, and p "
        "is the largest. *Agrees*, *disagrees*: p is below the level, on the paper's side or on the other; *cannot be told*: it is "
        "not; "
        "*follows from the set-up*: no other outcome was possible, so it is no evidence for the model, nor against the paper. "
        f"In brackets: {100.0 * CONFIDENCE:g} % bands of single numbers, here and below, from {RESAMPLES} bootstrap samples of the "
        "fields (expanded percentiles, which cannot leave the range of the data); they are not corrected for their number, and no "
        f"verdict rests on them. Of fewer than {FEWEST} fields neither test nor band is given, of fewer than {FEWEST_SCATTER} no "
        "band of a correlation or of Gumbel's law."
    )
    lines = ["### Trends of the paper", "", rule, ""]
    lines += [row("trend", "asked of the runs", "model", "verdict", "p", "figures"), row(*["---"] * 6)]
    for verdict in judged:
        found = verdict.finding
        lines.append(row(found.trend, found.asked, f"`{found.model}`", verdict.word, chance(verdict.p), found.words))
    return [*lines, ""]


def similarity(ensemble: Ensemble) -> list[str]:
    """How far the speeds are copies of each other."""
    found = {model: like for model in ensemble.models if (like := likeness(ensemble, model))}
    if not found:
        return []
    heads = (
        "model",
        "fields",
        "n of the highest force",
        "n of the mean of Fx",
        f"change of n at {BREAK:g} m/s",
        "lowest correlation of two speeds",
        "median",
        "s of ln F from field to field",
        "s that field and v^n leave",
        f"fields with the same highest hit (within {SAME_HIT:g} m) at all speeds",
    )
    lines = [
        "### One field at several speeds",
        "",
        f"Floes of {LARGE} m, the first {EQUAL_DRIFT:g} m of drift at every speed. n: exponent of F ~ v^n, fitted field by field; "
        "correlation: of ln F over the fields, of the two speeds that are least alike and of the median pair; s: standard "
        "deviation.",
        "",
        row(*heads),
        row(*["---"] * len(heads)),
    ]
    for model, like in found.items():
        pair = f"{banded(like.correlation)}, {like.least_alike[0]:g} and {like.least_alike[1]:g} m/s"
        cells = [f"`{model}`", str(like.fields), banded(like.exponent), banded(like.mean_exponent), banded(like.change), pair]
        cells += [number(like.median_correlation), number(like.between), number(like.left), f"{like.same} of {like.fields}"]
        lines.append(row(*cells))
    return [*lines, ""]


def pictures(ensemble: Ensemble, folder: Path) -> list[str]:
    """Draw all figures; a line for each that the runs allow."""
    at = f"at {SIZE_SPEED:g} m/s"
    over = f"mean over the seeds and from {DRIFT[0]:g} to {DRIFT[1]:g} m of drift"
    drawn = [
        (
            "force_by_speed",
            figures_speed.force_by_speed(ensemble),
            f"One field at several speeds, floes of {LARGE} m, the first {EQUAL_DRIFT:g} m of drift (Fig. 14)",
        ),
        ("force_by_size", figures.force_by_size(ensemble), f"Two floe sizes {at} (Figs. 12, 15)"),
        (
            "load_around",
            figures.load_around(ensemble),
            f"Load around the pile {at}, mean and 95 % band, upstream shaded (Figs. 13, 18)",
        ),
        ("mean_ice", figures_ice.mean_ice(ensemble), f"Concentration and speed of the ice {at}, {over} (Figs. 11, 17)"),
    ]
    for size, force, ice in ((LARGE, "Fig. 12", "Figs. 10, 11"), (SMALL, "Fig. 15", "Figs. 16, 17")):
        caption = f"Force on the pile {at}, floes of {size} m, one seed ({force})"
        drawn.append((f"force_history_{size}", figures.force_history(ensemble, size), caption))
        drawn.append(
            (f"plan_{size}", figures_ice.plan_views(ensemble, size), f"Lane and jam {at}, floes of {size} m, one seed ({ice})")
        )
    lines = ["### Figures", ""]
    for name, figure, caption in drawn:
        for file in figures.save(figure, folder / f"{name}.png"):
            lines += [f"![{caption}]({file})", "", f"*{caption}.*", ""]
    return lines

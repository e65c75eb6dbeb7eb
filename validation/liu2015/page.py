"""The part of the README that is made from the runs: verdicts, figures, tables, and what the runs were made with."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from statistics import median

from validation.liu2015 import figures, figures_ice
from validation.liu2015.ice import DRIFT, STRIP
from validation.liu2015.measures import COARSE, EQUAL_DRIFT, PASSING_DRIFT, Ensemble
from validation.liu2015.plan import CASES, LARGE, SIZE_SPEED, SMALL
from validation.liu2015.statistics import FEWEST, RESAMPLES, mean_band, median_band, paired
from validation.liu2015.trends import AGREES, DISAGREES, FEW, FEWEST_SEEDS, OPEN, SIGNIFICANT, banded, chance, findings, number

START, END = "<!-- results: written by validation/liu2015/run.py -->", "<!-- end of the results -->"
RUNS_TABLE = "runs.csv"

VERDICTS = {
    AGREES: "Agrees with the paper",
    OPEN: "Not shown either way",
    DISAGREES: "Disagrees with the paper",
    FEW: "Too few seeds to say",
}


def write(ensemble: Ensemble, folder: Path) -> Path:
    """Write figures, the table of all runs and the page in this folder; what stands on the page outside the marks is kept."""
    folder.mkdir(parents=True, exist_ok=True)
    ensemble.write(folder / RUNS_TABLE)
    lines = ["", *provenance(ensemble), *verdicts(ensemble), *pictures(ensemble, folder), *tables(ensemble), ""]
    page = folder / "README.md"
    text = page.read_text(encoding="utf-8") if page.exists() else f"# The case of Liu, Long & Ji (2015)\n\n{START}\n{END}\n"
    before, _, rest = text.partition(START)
    _, _, after = rest.partition(END)
    page.write_text(f"{before}{START}\n" + "\n".join(lines) + f"{END}{after}", encoding="utf-8")
    return page


def provenance(ensemble: Ensemble) -> list[str]:
    """How many runs, by which sources, and how well they conserve energy."""
    count = len(ensemble.results)
    durations = {f"{result.folder.summary.get('simulated_s', 0.0):g}": None for result in ensemble.results}
    sources = Counter(result.sources or "unknown" for result in ensemble.results)
    residual = max(result.measures["residual_over_work"] for result in ensemble.results)
    lines = [
        f"{count} completed runs of {', '.join(durations)} s; energy residual over work of the current at most {residual:.1e}."
    ]
    if list(sources) == ["unknown"]:
        lines.append("With which state of the sources they were made is not known.")
    elif len(sources) == 1:
        lines.append(f"All were made with one state of the sources (`{next(iter(sources))}`).")
    else:
        states = ", ".join(f"{runs} with `{state}`" for state, runs in sources.most_common())
        lines.append(f"**They were made with different states of the sources**: {states}.")
    return [*lines, *step_check(ensemble), ""]


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


def verdicts(ensemble: Ensemble) -> list[str]:
    """In a sentence a verdict, then the figures behind each of them."""
    lines = ["### Trends of the paper", ""]
    table = ["| trend | model | verdict | figures (mean and 95 % band) |", "| --- | --- | --- | --- |"]
    rows = {model: findings(ensemble, model) for model in ensemble.models}
    for model, found in rows.items():
        for verdict, words in VERDICTS.items():
            trends = [trend for trend, finding in found if finding.verdict == verdict]
            if len(trends) == len(found):
                lines.append(f"- `{model}`: {words}: all.")
            elif trends:
                lines.append(f"- `{model}`: {words}: {'; '.join(trends)}.")
    for pair in zip(*rows.values(), strict=True):
        for (trend, finding), model in zip(pair, rows, strict=True):
            table.append(f"| {trend} | `{model}` | {finding.verdict} | {finding.words} |")
    rule = (
        "*Agrees*: the 95 % band lies wholly on the paper's side (of 0 for the change of slope, of 1 for ratios, of 0.5 for the "
        f"lane and the arc of 45°), or p < {SIGNIFICANT:g} one-sided; *disagrees*: on the other side; *not shown*: neither. "
        f"Nothing is said of fewer than {FEWEST_SEEDS} seeds."
    )
    return [*lines, "", *table, "", rule, ""]


def pictures(ensemble: Ensemble, folder: Path) -> list[str]:
    """Draw all figures; a line for each that the runs allow."""
    at = f"at {SIZE_SPEED:g} m/s"
    over = f"mean over the seeds and from {DRIFT[0]:g} to {DRIFT[1]:g} m of drift"
    drawn = [
        ("force_by_speed", figures.force_by_speed(ensemble), "Highest and mean force against ice speed, floes of 2.8 m (Fig. 14)"),
        ("force_by_size", figures.force_by_size(ensemble), f"Two floe sizes {at}; bars: 95 % band of the mean (Figs. 12, 15)"),
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


def points(ensemble: Ensemble) -> list[tuple[str, str, float]]:
    """Model, size and speed of every point that has a run."""
    return [(model, size, speed) for model in ensemble.models for size in CASES for speed in ensemble.speeds(model, size)]


def tables(ensemble: Ensemble) -> list[str]:
    return [*loads(ensemble), *character(ensemble), *neighbours(ensemble), *models(ensemble)]


def loads(ensemble: Ensemble) -> list[str]:
    lines = [
        "### Loads",
        "",
        "Mean over the seeds and its 95 % band (Student's t); s: standard deviation over the seeds; median with its band from",
        f"{RESAMPLES} bootstrap samples. No band is given of fewer than {FEWEST} seeds. Every speed reaches {EQUAL_DRIFT:g} m of",
        f"drift; up to {PASSING_DRIFT:g} m, or the end of the run, ice comes to the pile.",
        "",
        "| model | floes, m | speed, m/s | n | highest force, kN | s, kN | median, kN | in the first "
        f"{EQUAL_DRIFT:g} m, kN | highest Fx, kN | mean Fx, kN | mean Fx up to {PASSING_DRIFT:g} m, kN | 99 % of 10 ms means, kN |",
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |",
    ]
    for model, size, speed in points(ensemble):
        highest = ensemble.of("fh_max_N", model, size, speed).values()
        band, median = mean_band(highest), median_band(highest)
        others = ("fh_max_equal_drift_N", "fx_max_N", "fx_mean_N", "fx_mean_passing_N", "fx_p99_of_means_N")
        cells = [
            f"`{model}`",
            size,
            f"{speed:g}",
            str(band.n),
            banded(band, 1e-3),
            number(1e-3 * band.deviation),
            banded(median, 1e-3),
        ]
        cells += [banded(mean_band(ensemble.of(name, model, size, speed).values()), 1e-3) for name in others]
        lines.append("| " + " | ".join(cells) + " |")
    return [*lines, ""]


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


def character(ensemble: Ensemble) -> list[str]:
    lines = [
        "### Character of the load, and the ice",
        "",
        "Peaks: unbroken rows of 10 ms windows whose highest force reaches a tenth of the run's highest; in contact: windows",
        f"with any contact. Ice ahead and behind: in strips {STRIP:g} m long and as wide as the pile, from {DRIFT[0]:g} to",
        f"{DRIFT[1]:g} m of drift.",
        "",
        "| model | floes, m | speed, m/s | n | " + " | ".join(head for head, _, _ in CHARACTER) + " |",
        "| --- | --- | --- | --- |" + " --- |" * len(CHARACTER),
    ]
    for model, size, speed in points(ensemble):
        bands = [(mean_band(ensemble.of(name, model, size, speed).values()), factor) for _, name, factor in CHARACTER]
        cells = [f"`{model}`", size, f"{speed:g}", str(len(ensemble.chosen(model, size, speed)))]
        lines.append("| " + " | ".join(cells + [banded(band, factor) for band, factor in bands]) + " |")
    return [*lines, ""]


def neighbours(ensemble: Ensemble) -> list[str]:
    lines = [
        "### From one speed to the next",
        "",
        "Highest force of the same ice field at two speeds; Wilcoxon's signed ranks, one-sided, each test for itself.",
        "",
        "| model | speeds, m/s | seeds that rise | median ratio | p |",
        "| --- | --- | --- | --- | --- |",
    ]
    for model in ensemble.models:
        speeds = ensemble.speeds(model, LARGE)
        for slow, fast in zip(speeds[:-1], speeds[1:], strict=True):
            test = paired(*(ensemble.of("fh_max_N", model, LARGE, speed) for speed in (slow, fast)))
            lines.append(
                f"| `{model}` | {slow:g} to {fast:g} | {test.rises} of {test.n} | {number(test.ratio)} | {chance(test.p)} |"
            )
    return [*lines, ""]


def models(ensemble: Ensemble) -> list[str]:
    """`consistent` over `liu2015`, field by field."""
    if len(ensemble.models) < 2:
        return []
    base, other = ensemble.models
    lines = [
        f"### `{other}` over `{base}`",
        "",
        "The same ice fields with the two contact models; p as above, that the first is higher.",
        "",
        "| floes, m | speed, m/s | highest force: seeds that rise | median ratio | p | mean Fx: median ratio |",
        "| --- | --- | --- | --- | --- | --- |",
    ]
    for size in CASES:
        for speed in sorted(set(ensemble.speeds(base, size)) & set(ensemble.speeds(other, size))):
            highest, mean = (
                paired(ensemble.of(name, base, size, speed), ensemble.of(name, other, size, speed))
                for name in ("fh_max_N", "fx_mean_N")
            )
            cells = [
                size,
                f"{speed:g}",
                f"{highest.rises} of {highest.n}",
                number(highest.ratio),
                chance(highest.p),
                number(mean.ratio),
            ]
            lines.append("| " + " | ".join(cells) + " |")
    return [*lines, ""]

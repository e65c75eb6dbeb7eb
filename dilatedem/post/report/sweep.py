"""report.html of a sweep, of seeds alone, or of runs side by side: statistics with bands, rare loads, figures, the runs."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

from dilatedem.post.ensembles.laws import LEVELS, Extremes
from dilatedem.post.ensembles.measures import HIGHEST, MEAN_ALONG, QUANTITIES
from dilatedem.post.ensembles.study import Ensemble, Study
from dilatedem.post.ensembles.sweeps import relative, value_words
from dilatedem.post.ensembles.table import Laws, of_quantity
from dilatedem.post.figures.canvas import Drawing
from dilatedem.post.figures.sweep import plural, turning_label, turns, vector_words
from dilatedem.post.labels import axis_label, number, show
from dilatedem.post.report.page import inline, render
from dilatedem.results.doubts import doubts
from dilatedem.results.files import read_summary
from dilatedem.statistics import Band, enough_for, needed

#: statistics that the tables show, with their heads
SHOWN = {
    "mean": "mean", "standard_deviation": "standard deviation", "median": "median", "percentile_90": "90 % of runs below",
}  # fmt: skip
#: share of the mean to which it is told how many runs it takes
CLOSENESS = 0.1

Rows = list[list[str]]


def write_sweep_report(study: Study, laws: Laws, figures: list[tuple[Drawing, str]]) -> Path:
    """Write report.html of a sweep or a comparison."""
    sweep = study.sweep
    sweep.folder.mkdir(exist_ok=True)
    return render(
        "sweep.html",
        sweep.folder / "report.html",
        title=sweep.title,
        keys=[(key, head_words(study, key)) for key in sweep.keys],
        figures=inline(figures),
        looked_at=part_words(study),
        few=few_words(study),
        statistics=[table for structure in sweep.structures for table in statistics_tables(study, structure)],
        enough=enough_words(study),
        rare=[table for structure in sweep.structures if (table := rare_table(study, structure, laws))["rows"]],
        hits=f"{number(study.threshold / 1e3, 3)} kN, apart by {number(study.gap)} s or more below it",
        runs=run_table(study),
        count=len(sweep.runs),
        completed=sum(run.completed for run in sweep.runs),
    )


def part_words(study: Study) -> str:
    """Which part of the runs was looked at, and why."""
    said = f"Looked at: {study.part.words()}"
    if study.equalized:
        said += ", as far as the ice drifts in all of the runs, so that each meets as much of it"
    if study.left_out:
        said += f". Left out, as they end before: {', '.join(study.left_out)}"
    return f"{said}."


def few_words(study: Study) -> str:
    """What is left out of the tables for want of runs, nothing where nothing is."""
    least = enough_for(0.9)
    counts = [len(ensemble.members) for ensemble in study.ensembles]
    if min(counts, default=least) >= least:
        return ""
    return f"What 90 % of the runs stay below is told from {least} runs on: of fewer it would be no more than the largest."


def statistics_tables(study: Study, structure: str) -> list[dict[str, Any]]:
    """Of seeds alone all quantities in one table, else a row for each setting of the keys, in a table each for the main ones."""
    if not study.sweep.keys:
        rows = [
            [words[0].upper() + words[1:], *statistics_cells(ensemble, structure, quantity)]
            for ensemble in study.ensembles
            for quantity, words in QUANTITIES.items()
            if len(ensemble.sample(structure, quantity))
        ]
        return [{"title": f"{structure} (kN; hits: number)", "head": ["of each run"], "rows": rows}] if rows else []
    tables = []
    for quantity in (HIGHEST, MEAN_ALONG):
        rows = [
            [*value_cells(study, ensemble.values), *statistics_cells(ensemble, structure, quantity)]
            for ensemble in study.ensembles
            if len(ensemble.sample(structure, quantity))
        ]
        if rows:
            head = [head_words(study, key) for key in study.sweep.keys]
            tables.append({"title": f"{structure}: {QUANTITIES[quantity]} (kN)", "head": head, "rows": rows})
    return tables


def head_words(study: Study, key: str) -> str:
    """A key at the head of a column."""
    return turning_label(key) if turns(study, key) else axis_label(key)


def value_cells(study: Study, values: dict[str, Any]) -> list[str]:
    """Values of the keys; both components of a velocity that turns."""
    keys = study.sweep.keys
    return [vector_words(values[key]) if turns(study, key) else value_words(key, values[key]) for key in keys]


def statistics_cells(ensemble: Ensemble, structure: str, quantity: str) -> list[str]:
    """Number of runs, then each statistic with its band."""
    unit = 1e3 if quantity.endswith("_N") else 1.0
    found = of_quantity(ensemble, structure, quantity)
    return [str(found["mean"].n), *(band_words(found[name] / unit) for name in SHOWN)]


def band_words(band: Band) -> str:
    """An estimate and, behind it, its band as far as it is known; the band alone where there is no estimate."""
    value = number(band.value, 3)
    if band.closed:
        return f"{value} ({number(band.low, 3)} to {number(band.high, 3)})"
    if math.isfinite(band.low) and band.low != 0.0:
        return f"{value} (over {number(band.low, 3)})" if math.isfinite(band.value) else f"over {number(band.low, 3)}"
    return f"{value} (below {number(band.high, 3)})" if math.isfinite(band.high) else value


def enough_words(study: Study) -> list[str]:
    """How many runs it takes to know the mean of the highest load well, for each structure."""
    said = []
    for structure in study.sweep.structures:
        counts = [needed(ensemble.sample(structure, HIGHEST), CLOSENESS) for ensemble in study.ensembles]
        counts = [count for count in counts if count is not None]
        if counts:
            most = f"{min(counts)} to {max(counts)}" if min(counts) < max(counts) else str(counts[0])
            said.append(f"{structure}: about {most} runs")
    return said


def rare_table(study: Study, structure: str, laws: Laws) -> dict[str, Any]:
    """Loads that one of so many runs exceeds, by the three laws, and how well these fit."""
    rows = []
    for place, ensemble in enumerate(study.ensembles):
        found = laws.get((place, structure))
        if found is None or found.gumbel is None:
            continue
        rows += [[*value_cells(study, ensemble.values), *cells] for cells in law_rows(found)]
    return {"title": structure, "head": [head_words(study, key) for key in study.sweep.keys], "levels": LEVELS, "rows": rows}


def law_rows(found: Extremes) -> Rows:
    """Law, what it is fitted to, its shape, its levels, how well it fits."""
    rows = []
    for name, words in (("gumbel", "Gumbel"), ("gev", "GEV"), ("pareto", "generalized Pareto")):
        law = getattr(found, name)
        if law is None:
            continue
        levels = [band_words(found.levels[name, runs] / 1e3) for runs in LEVELS]
        if name == "pareto":
            to = f"{plural(len(law.peaks), 'hit')} over {number(law.threshold / 1e3, 3)} kN"
        else:
            to = plural(len(law.maxima), "run")
        fit = "–" if name == "gev" else f"{number(100.0 * law.chance, 2)} %"
        shape = "0" if name == "gumbel" else band_words(law.shape)
        rows.append([words, to, shape, *levels, fit])
    return rows


def run_table(study: Study) -> dict[str, Any]:
    """One row for each run, with a link to its own report where there is one; parts of structures would go beyond a page."""
    sweep = study.sweep
    quantities = (("fh_max", "highest horizontal"), ("along_max", "highest along"), ("along_mean", "mean along"))
    columns = [(name, quantity, label) for name in sweep.structures if "/" not in name for quantity, label in quantities]
    head = [head_words(study, key) for key in sweep.keys] + ["Seed", "Status"]
    head += [f"{name}: {label} (kN)" for name, _, label in columns] + ["Residual / work (%)"]
    rows = []
    for run in sweep.runs:
        loads = [run.loads.get(name, {}).get(quantity, math.nan) for name, quantity, _ in columns]
        cells = value_cells(study, run.values) + [show(run.seed), run.status]
        cells += [number(load / 1e3) for load in loads] + [number(100.0 * run.residual_over_work, 2)]
        page = run.folder / "report.html"
        link = relative(page, sweep.folder) if page.is_file() else ""
        untouched = [name for name in sweep.structures if "/" not in name and run.loads.get(name, {}).get("fh_max") == 0.0]
        said = [run.message, *(f"no ice touched {name}, which counts as no load" for name in untouched if run.completed)]
        said += doubts(read_summary(run.folder / "summary.json"))
        rows.append({"name": run.folder.name, "link": link, "cells": cells, "message": "; ".join(filter(None, said))})
    return {"head": head, "rows": rows}

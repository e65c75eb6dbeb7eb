"""report.html of a sweep, of seeds alone, or of runs side by side: statistics with bands, rare loads, figures, the runs."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

from dilatedem.post.ensembles.study import Study
from dilatedem.post.ensembles.sweeps import relative
from dilatedem.post.ensembles.table import Laws
from dilatedem.post.figures.canvas import Drawing
from dilatedem.post.labels import number, show
from dilatedem.post.report.ensembles import ensemble_tables, head_words, value_cells
from dilatedem.post.report.page import inline, render
from dilatedem.results.doubts import doubts
from dilatedem.results.files import read_summary


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
        ensembles=ensemble_tables(study, laws),
        runs=run_table(study),
        count=len(sweep.runs),
        completed=sum(run.completed for run in sweep.runs),
    )


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

"""What `post` must leave alone: it replaces reports and figures of its own, in folders of runs and sweeps, and nothing else."""

from __future__ import annotations

import re
from pathlib import Path

from dilatedem.errors import CaseError
from dilatedem.files.whose import is_marked, matching, refuse_foreign, refuse_links
from dilatedem.results.files import is_run, is_sweep

REPORT, FIGURES, SUMMARY = "report.html", "figures", "summary.json"
COMPARISON_TABLE, STATISTICS = "comparison.csv", "statistics.csv"
#: in every report there is one of these; the first stands there since 0.3
REPORT_MARKS = (b'content="dilatedem"', b"Run of dilatedem:", b"<code>dilatedem post</code>")
#: what the first line of a table of statistics ends with
STATISTICS_END = "structure,quantity,statistic,n,value,low,high"
FIGURE = re.compile(r".*\.(png|svg|pdf)(\.tmp)?")


def refuse_harm(folder: Path) -> None:
    """Raises CaseError unless `post` may write into the folder of a run or a sweep."""
    if not (is_run(folder) or is_sweep(folder)):
        raise CaseError(f"{folder}: neither a run (case.toml) nor a sweep (sweep.csv) is in this folder")
    if not is_sweep(folder) and not is_marked(folder / "case.toml"):
        raise CaseError(f"{folder}: holds no run: its case.toml is not one that a run wrote, so nothing is written beside it")
    _refuse_in(folder)
    _refuse_table(folder / STATISTICS)


def refuse_harm_beside(folder: Path) -> None:
    """The same for the folder of a comparison, which may be there or not."""
    refuse_links([folder, folder / COMPARISON_TABLE])
    if not _is_comparison(folder / COMPARISON_TABLE):
        refuse_foreign(folder, (folder / name for name in (COMPARISON_TABLE, STATISTICS, REPORT, FIGURES)), "comparison")
    _refuse_in(folder)
    _refuse_table(folder / STATISTICS)


def _refuse_in(folder: Path) -> None:
    refuse_links([folder / REPORT, folder / SUMMARY, folder / FIGURES, *matching(folder / FIGURES, FIGURE)])
    report = folder / REPORT
    if report.exists() and not (report.is_file() and any(mark in report.read_bytes() for mark in REPORT_MARKS)):
        raise CaseError(f"{report}: stands in the way: it is no report of dilatedem; move it away")


def _refuse_table(table: Path) -> None:
    refuse_links([table])
    if table.exists() and not (table.is_file() and _first_line(table).endswith(STATISTICS_END)):
        raise CaseError(f"{table}: stands in the way: it is no table of dilatedem; move it away")


def _is_comparison(table: Path) -> bool:
    if not table.is_file():
        return False
    return {"seed", "run", "status"} <= set(_first_line(table).split(","))


def _first_line(table: Path) -> str:
    with open(table, encoding="utf-8", errors="replace") as file:
        return file.readline().rstrip("\n")

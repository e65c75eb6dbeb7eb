"""Runs of the studies of loads: made where they are not there, at most so many at a time, and the highest load of each."""

import argparse
import json
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from dilatedem.case.load import case_from
from dilatedem.output import folder
from dilatedem.results.load import load
from dilatedem.run.loop import run

HERE = Path(__file__).parent
RUNS = Path("runs/loads")
#: way [m] that the ice drifts in a run, whatever its speed
WAY = 30.0


@dataclass(frozen=True)
class Wanted:
    """A run: its folder under RUNS, the case that it is made of, and what is set in it, by dotted key."""

    name: str
    case: Path
    settings: dict[str, Any]


@dataclass(frozen=True)
class Found:
    """What a run gave: highest horizontal load [N], mean along the current [N], peaks of its load events [N]."""

    peak: float
    mean: float
    events: np.ndarray


def made(wanted: Wanted) -> Path:
    """The folder of a run that is complete."""
    out = RUNS / wanted.name
    summary = out / "summary.json"
    if not summary.exists() or json.loads(summary.read_text())["status"] != "completed":
        settings = {"output.snapshot_interval": 0.0, "time.error_check": False, **wanted.settings}
        run(case_from(wanted.case, settings), out, resume=folder.holds_run(out), quiet=True)
    return out


def found(wanted: list[Wanted], jobs: int, structure: str = "pile") -> dict[str, Found]:
    """What the runs gave, by name; those that are not there are made first, `jobs` at a time."""
    with ProcessPoolExecutor(jobs) as pool:
        folders = list(pool.map(made, wanted))
    results = {}
    for each, out in zip(wanted, folders, strict=True):
        told = load(out)
        loads, hits = told.summary["loads"][structure], told.hits
        peaks = hits.peak_N[hits.structure == structure].to_numpy()
        results[each.name] = Found(loads["fh_max_N"], loads["along_mean_N"], peaks)
    return results


def arguments(about: str) -> argparse.Namespace:
    """Of a study that is called as a module."""
    parser = argparse.ArgumentParser(description=about)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--seeds", type=int, default=3)
    return parser.parse_args()


def write_between(page: Path, start: str, end: str, text: str) -> None:
    """Put text between two marks of a page."""
    before, rest = page.read_text(encoding="utf-8").split(start, 1)
    page.write_text(f"{before}{start}\n\n{text}\n{end}{rest.split(end, 1)[1]}", encoding="utf-8")

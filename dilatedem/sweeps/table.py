"""sweep.csv: a row a run, in the order of the grid."""

import csv
import io
import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from dilatedem.case.grid import SEED_KEY
from dilatedem.errors import CaseError
from dilatedem.files.atomic import write_text
from dilatedem.output import folder
from dilatedem.results.files import read_summary
from dilatedem.results.sweep import is_number, read_rows
from dilatedem.results.tables import read_table, split_by_structure
from dilatedem.sweeps.plan import Job
from dilatedem.sweeps.together import Together

TABLE = "sweep.csv"

#: of summary.json's loads, these go to the table, as <structure>_<load>
LOADS = (
    "fx_max_N", "fx_mean_N", "fy_max_N", "fy_min_N", "fh_max_N", "along_max_N", "along_mean_N", "across_max_N", "across_min_N",
    "mh_max_Nm", "mz_max_Nm", "mz_min_Nm", "fx_min_N", "fy_mean_N", "along_min_N", "across_mean_N",
)  # fmt: skip
#: per cent of the windows of forces.csv whose highest horizontal load is no higher than <structure>_fh_p<per cent>_N
PERCENTILES = (5, 50, 90, 95, 99)
#: of forces.csv itself
SPREAD = ("fh_mean_N", *(f"fh_p{percent}_N" for percent in PERCENTILES))


class Table:
    """The table of a sweep in the folder `out`; what a run has come to is read once, when it is over."""

    def __init__(self, todo: Sequence[Job], out: Path):
        self._todo, self._path = todo, out / TABLE
        self._results: dict[str, dict[str, Any]] = {}  # by the run's folder
        self._together = Together([_setting(job) for job in todo])
        if self._path.exists():
            self._take_over(*read_rows(out))

    def _take_over(self, header: list[str], rows: list[dict[str, str]]) -> None:
        """What an earlier sweep wrote of runs that were completed then; an earlier version wrote less."""
        if {"simulated_s", "residual_over_work"} <= set(header):
            names = header[header.index("status") + 1 : header.index("residual_over_work") + 1]
            known = {job.folder.name for job in self._todo if job.status == "completed"}
            done = [row for row in rows if row["run"] in known and row["status"] == "completed"]
            self._results = {row["run"]: {name: row[name] for name in names} for row in done}

    def write(self) -> None:
        """Rewrites the file atomically.

        The columns left of `seed` are the keys that vary, and the components of those that are vectors; `run` is the folder,
        relative to that of the table.
        """
        rows = [self._row(job) for job in self._todo]
        rows = [row | columns for row, columns in zip(rows, self._together.columns(rows), strict=True)]
        columns = list(dict.fromkeys(name for row in rows for name in row))
        columns.remove("message")
        text = io.StringIO(newline="")
        table = csv.DictWriter(text, [*columns, "message"], restval="", lineterminator="\n")
        table.writeheader()
        table.writerows(rows)
        write_text(self._path, text.getvalue())

    def _row(self, job: Job) -> dict[str, Any]:
        name, varied = job.folder.name, {override.key: override.value for override in job.point if override.origin != "--seeds"}
        row: dict[str, Any] = {}
        for key, value in varied.items():
            row |= {key: _cell(value)} | {part: number for part, number in _components(key, value).items() if part not in varied}
        row |= {"seed": job.case.field.seed, "run": name, "status": job.status}
        if job.status != "waiting" and name not in self._results:
            self._results[name] = _results(job, _summary(job), _spread(job))
        return row | self._results.get(name, _results(job, {}, {})) | {"message": job.message}


def _setting(job: Job) -> str:
    """What the runs of an ensemble share: the values of the keys that vary, the seed apart."""
    return repr([(override.key, override.value) for override in job.point if override.key != SEED_KEY])


def _results(job: Job, summary: dict[str, Any], spread: dict[str, dict[str, float]]) -> dict[str, Any]:
    """What a run has come to, empty cells where that is not known."""
    loads, row = summary.get("loads", {}), {name: summary.get(name, "") for name in ("steps", "simulated_s", "wall_s")}
    # The structures of the case first, so that the columns stand before anything has run; walls and the total follow.
    for name in dict.fromkeys([name for structure in job.case.structure for name in structure.names()] + list(loads)):
        found = loads.get(name, {}) | spread.get(name, {})
        row |= {f"{name}_{load}": found.get(load, "") for load in (*LOADS, *SPREAD)}
    return row | {"residual_over_work": summary.get("energy", {}).get("residual_over_work", "")}


def _summary(job: Job) -> dict[str, Any]:
    """summary.json of a run, empty where there is none that can be read."""
    try:
        return read_summary(job.folder / folder.SUMMARY)
    except CaseError:  # damaged
        return {}


def _spread(job: Job) -> dict[str, dict[str, float]]:
    """Of each record of forces.csv: the mean size of the horizontal load, and percentiles of its highest [N], over all windows."""
    try:
        histories = split_by_structure(read_table(job.folder / folder.FORCES), job.case.model_dump(include={"structure"}))
        return {name: _figures(history) for name, history in histories.items()}
    except (CaseError, KeyError, TypeError, ValueError):  # damaged
        return {}


def _figures(history: dict[str, np.ndarray]) -> dict[str, float]:
    """SPREAD of one record; a window counts by its length, as the last one may be short."""
    lengths = np.diff(history["time_s"], prepend=0.0)
    mean = float(np.average(np.hypot(history["fx_N"], history["fy_N"]), weights=lengths))
    return dict(zip(SPREAD, [mean, *np.percentile(history["fh_max_N"], PERCENTILES).tolist()], strict=True))


def _components(key: str, value: Any) -> dict[str, float]:
    """The numbers of a vector, by the keys that they have in a case."""
    if not (isinstance(value, list) and value and all(map(is_number, value))):
        return {}
    return {f"{key}.{i}": number for i, number in enumerate(value)}


def _cell(value: Any) -> str:
    return value if isinstance(value, str) else json.dumps(value, default=str)

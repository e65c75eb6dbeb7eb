"""Several runs as one table: from the sweep.csv of a sweep, or from the cases of run folders side by side."""

from __future__ import annotations

import csv
import io
import math
import os
import re
from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from dilatedem.files.atomic import write_text
from dilatedem.post.labels import flatten, show
from dilatedem.post.loads import load_statistics
from dilatedem.post.read import RunFolder, open_run
from dilatedem.results.files import is_run
from dilatedem.results.soundness import damaged
from dilatedem.results.sweep import locate, parse_value, read_rows, varied_keys

LOAD_COLUMN = re.compile(r"(?P<structure>.+)_(?P<quantity>(?:f[xyzh]|along|across|m[zh])_(?:max|min|mean))_Nm?")
SEED_KEY = "field.seed"
# Keys in which two runs may differ without being different experiments.
INCIDENTAL = re.compile(r"(title|version|output\..*)$")


@dataclass(frozen=True)
class SweepRun:
    """One run: the values of the varied keys, how it ended, what it found."""

    values: dict[str, Any]  # varied key -> value; None where this case does without the key
    seed: int | None
    folder: Path
    status: str
    message: str
    loads: dict[str, dict[str, float]]  # structure -> quantity (fx_max, fx_mean, ...) -> N
    residual_over_work: float = math.nan

    @property
    def completed(self) -> bool:
        return self.status == "completed"


@dataclass(frozen=True)
class Sweep:
    """Runs that differ in these keys, the seed apart."""

    title: str
    folder: Path
    keys: list[str]
    runs: list[SweepRun]

    @property
    def structures(self) -> list[str]:
        return list(dict.fromkeys(name for run in self.runs for name in run.loads))


def read_sweep(folder: Path) -> Sweep:
    """The sweep in this folder: the columns left of `seed` are what varied.

    Raises CaseError when its sweep.csv is another kind of table.
    """
    header, records = read_rows(folder)
    keys = [name for name in varied_keys(header) if name != SEED_KEY]
    runs = [sweep_run(record, keys, folder) for record in records]
    return Sweep(sweep_title(folder, runs), folder, keys, runs)


def sweep_run(record: dict[str, str], keys: list[str], folder: Path) -> SweepRun:
    """One row of sweep.csv."""
    loads: dict[str, dict[str, float]] = {}
    for name, text in record.items():
        match = LOAD_COLUMN.fullmatch(name)
        if match and text:
            loads.setdefault(match["structure"], {})[match["quantity"]] = value = to_float(text)
            if not math.isfinite(value):
                raise damaged(folder / "sweep.csv", f"{name} = {text[:40]} is no finite number")
    seed = to_float(record["seed"])
    return SweepRun(
        values={key: parse_value(record[key]) for key in keys},
        seed=int(seed) if math.isfinite(seed) else None,
        folder=locate(record["run"], folder),
        status=record.get("status") or "unknown",
        message=record.get("message", ""),
        loads=loads,
        residual_over_work=to_float(record.get("residual_over_work", "")),
    )


def sweep_title(folder: Path, runs: Iterable[SweepRun]) -> str:
    for run in runs:
        if is_run(run.folder):
            return open_run(run.folder).title
    return folder.name


def to_float(text: Any) -> float:
    """A number, or nan where there is none."""
    try:
        return float(text)
    except (TypeError, ValueError):
        return math.nan


def compare_runs(runs: list[RunFolder], folder: Path) -> Sweep:
    """Run folders given side by side, as a sweep over the keys in which their cases differ.

    folder: where the comparison is to be written.
    """
    flat = [flatten(run.case) for run in runs]
    every = list(dict.fromkeys(key for case in flat for key in case))
    differing = [key for key in every if any(case.get(key) != flat[0].get(key) for case in flat)]
    keys = [key for key in differing if key != SEED_KEY and not INCIDENTAL.match(key)]
    compared = [
        SweepRun(
            values={key: case.get(key) for key in keys},
            seed=case.get(SEED_KEY),
            folder=run.path,
            status=str(run.summary.get("status", "unknown")),
            message=str(run.summary.get("message") or ""),
            loads={name: headline(load_statistics(history, run.current)) for name, history in run.forces.items()},
            residual_over_work=to_float(run.summary.get("energy", {}).get("residual_over_work")),
        )
        for run, case in zip(runs, flat, strict=True)
    ]
    titles = list(dict.fromkeys(run.title for run in runs))
    title = titles[0] if len(titles) == 1 else f"Comparison of {len(runs)} runs"
    return Sweep(title, folder, keys, compared)


def run_alone(run: RunFolder) -> Sweep:
    """A run, as far as it came, as a sweep of one."""
    sweep = compare_runs([run], run.path)
    return replace(sweep, runs=[replace(sweep.runs[0], status="completed")])


def headline(statistics: dict[str, Any]) -> dict[str, float]:
    """The figures of load_statistics that sweep.csv also holds, under the same names."""
    if not statistics["windows"]:
        return {}
    return {
        "fx_max": statistics["fx"]["max_N"],
        "fx_mean": statistics["fx"]["mean_N"],
        "fy_max": statistics["fy"]["max_N"],
        "fy_min": statistics["fy"]["min_N"],
        "fh_max": statistics["fh"]["peak_N"],
    } | _sideways(statistics)


def _sideways(statistics: dict[str, Any]) -> dict[str, float]:
    """Of the same, forces along and across the current, and moments, where forces.csv holds their extremes."""
    if "moment" not in statistics:
        return {}
    along, across = statistics.get("along_current", statistics["fx"]), statistics.get("across_current", statistics["fy"])
    return {
        "along_max": along["max_N"], "along_mean": along["mean_N"], "across_max": across["max_N"], "across_min": across["min_N"],
        "mh_max": statistics["moment"]["peak_Nm"], "mz_max": statistics["moment"]["mz"]["max_Nm"],
        "mz_min": statistics["moment"]["mz"]["min_Nm"],
    }  # fmt: skip


def write_table(sweep: Sweep, path: Path) -> None:
    """The runs as a CSV file with the columns of sweep.csv."""
    quantities = (
        "fx_max", "fx_mean", "fy_max", "fy_min", "fh_max", "along_max", "along_mean", "across_max", "across_min", "mh_max",
        "mz_max", "mz_min",
    )  # fmt: skip
    columns = [(name, quantity) for name in sweep.structures for quantity in quantities]
    header = [*sweep.keys, "seed", "run", "status"]
    units = ["Nm" if quantity.startswith("m") else "N" for _, quantity in columns]
    header += [f"{name}_{quantity}_{unit}" for (name, quantity), unit in zip(columns, units, strict=True)]
    header += ["residual_over_work", "message"]
    text = io.StringIO(newline="")
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(header)
    for run in sweep.runs:
        loads = [run.loads.get(name, {}).get(quantity, "") for name, quantity in columns]
        values = ["" if run.values[key] is None else run.values[key] for key in sweep.keys]
        folder = relative(run.folder, sweep.folder)
        residual = run.residual_over_work if math.isfinite(run.residual_over_work) else ""
        writer.writerow([*values, run.seed, folder, run.status, *loads, residual, run.message])
    write_text(path, text.getvalue())


def relative(path: Path, start: Path) -> str:
    """`path` as seen from the folder `start`, with forward slashes, so that a moved tree keeps its links."""
    return Path(os.path.relpath(path.resolve(), start.resolve())).as_posix()


def axis_value(key: str, value: Any) -> float | str | None:
    """Where a value lies on the axis of its key: a velocity by its size, a word as a category."""
    if value is None:
        return None
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, int | float):
        return float(value)
    if isinstance(value, list) and is_velocity(key):
        return math.hypot(*value)
    return ", ".join(str(part) for part in value) if isinstance(value, list) else str(value)


def is_velocity(key: str) -> bool:
    """Whether a key is a velocity, or a component of one."""
    return key.endswith(("velocity", "velocity.0", "velocity.1"))


def value_words(key: str, value: Any) -> str:
    """A value as text; a velocity towards +x by its size alone."""
    along_x = isinstance(value, list) and is_velocity(key) and not any(value[1:]) and value[0] >= 0.0
    return show(value[0] if along_x else value)

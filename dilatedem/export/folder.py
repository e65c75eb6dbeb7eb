"""Which files of a run become which: export/NAME_loads.* and export/NAME_heights.csv."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from dilatedem import __version__
from dilatedem.errors import CaseError
from dilatedem.export.formats import COMPONENTS, FORMATS, Loads, heights_as_csv
from dilatedem.export.heights import Spread, spread_over_height
from dilatedem.export.history import KEEP, ROUND_OFF, History, Windows, sampled
from dilatedem.files.atomic import write_text
from dilatedem.results.archive import read_archive
from dilatedem.results.files import read_case
from dilatedem.results.soundness import require_table
from dilatedem.results.tables import Table, read_table, row_count, split_by_structure

#: in the first line of each file: what has it may be replaced
MARK = "written by dilatedem export"


def export(
    run: Path, *, structures: Sequence[str] = (), step: float | None = None, keep: str = "both", formats: Sequence[str] = (),
    out: Path | None = None,
) -> list[tuple[Path, str]]:  # fmt: skip
    """Write the loads of a run for other programs; returns each file with a sentence about it.

    structures: their names as in forces.csv, all unless given; step [s]: that of the run's windows unless given; keep: of
    history.KEEP; formats: of FORMATS, all unless given; out: folder, `export` in that of the run unless given.
    Raises CaseError, before anything is written, for what there is not and for files that something else has written.
    """
    case = read_case(run)
    window = float(case.get("output", {}).get("force_interval", 0.01))
    step = window if step is None else step
    if not step >= window * (1.0 - ROUND_OFF):
        raise CaseError(f"--step {step:g}: must be at least output.force_interval = {window:g} s: forces.csv holds nothing shorter")
    if keep not in KEEP:
        raise CaseError(f"--keep {keep}: must be one of {', '.join(KEEP)}")
    if strange := [kind for kind in formats if kind not in FORMATS]:
        raise CaseError(f"--format {strange[0]}: must be one of {', '.join(FORMATS)}")
    tables = _chosen(run, case, structures)
    maps = read_archive(run / "run.h5").load_maps
    written: list[tuple[Path, str, str]] = []  # file, text, sentence
    folder = out or run / "export"
    for name, table in tables.items():
        loads, sentence = _loads(run, case, name, table, step, keep)
        for kind in formats or FORMATS:
            suffix, text = FORMATS[kind]
            written.append((folder / f"{_file_name(name)}_loads.{suffix}", text(loads), sentence))
        if name in maps and maps[name].impulse.any():
            spread = spread_over_height(maps[name])
            about = _about_heights(run, name, table, spread, _level(case))
            written.append((folder / f"{_file_name(name)}_heights.csv", heights_as_csv(name, spread, about), about[-1]))
    _refuse_foreign(path for path, _, _ in written)
    folder.mkdir(parents=True, exist_ok=True)
    for path, text, _ in written:
        write_text(path, text)
    return [(path, sentence) for path, _, sentence in written]


def _chosen(run: Path, case: dict[str, Any], names: Sequence[str]) -> dict[str, Table]:
    """The rows of forces.csv by structure, of those that were asked for."""
    tables = split_by_structure(require_table(read_table(run / "forces.csv"), run / "forces.csv"), case)
    tables = {name: table for name, table in tables.items() if row_count(table)}
    if not tables:
        raise CaseError(f"{run}: this run has no loads in forces.csv")
    if strange := [name for name in names if name not in tables]:
        raise CaseError(f"--structure {strange[0]}: there is no such structure in forces.csv; there are {', '.join(tables)}")
    return {name: tables[name] for name in names or tables}


def _loads(run: Path, case: dict[str, Any], name: str, table: Table, step: float, keep: str) -> tuple[Loads, str]:
    histories = {component: sampled(_windows(table, component), step, keep) for component in COMPONENTS}
    fx, fy = histories["fx_N"], histories["fy_N"]
    highest, reached = float(table["fh_max_N"].max()), float(np.hypot(fx.value, fy.value).max())
    sentence = (
        f"{name}: {len(fx.value)} samples of {step:g} s; {_costs(histories)}; highest horizontal load "
        f"{reached / 1e3:.4g} kN of {highest / 1e3:.4g} kN"
    )
    about = [
        f"loads of the ice on {name}, {MARK} {__version__} from the run {run.resolve().name}",
        f"samples every {step:g} s with straight lines between them; N, N m, axes of the run (z up)",
        f"moments about the structure's place at z = {_level(case):g} m, in the run's forces.csv",
        *(_about(component, history) for component, history in histories.items()),
        f"highest horizontal load: {reached:.6g} N, of the run {highest:.6g} N",
    ]
    return Loads(name, histories, about), sentence


def _windows(table: Table, component: str) -> Windows:
    """A component of the loads with its extremes; those of its windows' means where the file has no others."""
    base, _, unit = component.partition("_")
    mean = table[component]
    low, high = (table.get(f"{base}_{which}_{unit}", mean) for which in ("min", "max"))
    return Windows(table["time_s"], mean, low, high)


def _about(component: str, history: History) -> str:
    cost = history.cost
    ends = np.array([cost.lowest[0], cost.highest[0], cost.lowest[1], cost.highest[1]])
    least, most, low, high = np.where(np.abs(ends) < ROUND_OFF * np.abs(ends).max(), 0.0, ends)
    lost = f"; of the others up to {100.0 * cost.largest_loss:.2g} % is missing" if cost.kept < cost.peaks else ""
    return (
        f"{component}: impulse off by {cost.impulse_error:.1e} of itself, on the way by {cost.running_error:.1e} of it at most; "
        f"from {least:.6g} to {most:.6g}, in the run from {low:.6g} to {high:.6g}; {cost.kept} of {cost.peaks} peaks kept{lost}"
    )


def _costs(histories: dict[str, History]) -> str:
    costs = [history.cost for history in histories.values()]
    kept, peaks = (sum(getattr(histories[name].cost, which) for name in ("fx_N", "fy_N")) for which in ("kept", "peaks"))
    loss = max(histories[name].cost.largest_loss for name in ("fx_N", "fy_N"))
    lost = f" ({100.0 * loss:.3g} % of one missing at most: a smaller step, or --keep peaks)" if kept < peaks else ""
    return f"impulses off by {max(cost.impulse_error for cost in costs):.0e}; {kept} of {peaks} peaks of fx and fy kept{lost}"


def _level(case: dict[str, Any]) -> float:
    """Height [m] that moments are stated about."""
    return float(case.get("output", {}).get("moment_level", 0.0))


def _about_heights(run: Path, name: str, table: Table, spread: Spread, level: float) -> list[str]:
    """What a spread over height is, and how it agrees with the moments of the run."""
    return [
        f"load of the ice on {name} by height over the water level, {MARK} {__version__} from the run {run.resolve().name}",
        "share: of the normal impulse of the run; a node at z_m bears this share of every history of the load",
        "contacts count at their one point of application, in the bin that holds it; those beyond the bounds in the border bins",
        f"{name}: the load acts at z = {spread.height:.3g} m on average{_by_moments(table, level)}",
    ]


def _by_moments(table: Table, level: float) -> str:
    """The same height by the moments, in words: of the mean horizontal force and the moment about the axis across it."""
    length = np.diff(table["time_s"], prepend=0.0)
    fx, fy, mx, my = (float((table[column] * length).sum()) for column in ("fx_N", "fy_N", "mx_Nm", "my_Nm"))
    square = fx * fx + fy * fy
    return f", by its moments at {level + (my * fx - mx * fy) / square:.3g} m" if square > 0.0 else ""


def _file_name(structure: str) -> str:
    return re.sub(r"[^A-Za-z0-9_-]+", "_", structure)


def _refuse_foreign(paths) -> None:
    """Raises CaseError for the first file that is there and was not written here."""
    for path in paths:
        if path.is_symlink() or (path.exists() and not (path.is_file() and MARK.encode() in path.read_bytes()[:400])):
            raise CaseError(f"{path}: stands in the way: it is no export of dilatedem; move it away or choose another --out")

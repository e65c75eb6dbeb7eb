"""What is made of each folder: figures, statistics and report of a run, of a sweep, of runs side by side."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

import numpy as np

from dilatedem.errors import CaseError, SimulationStopped
from dilatedem.files.atomic import write_text
from dilatedem.files.faults import told_as
from dilatedem.post.ensembles.laws import extremes
from dilatedem.post.ensembles.study import AS_IT_SUITS, Choice, Study, study
from dilatedem.post.ensembles.sweeps import Sweep, compare_runs, read_sweep, run_alone, write_table
from dilatedem.post.ensembles.table import Laws, write_statistics
from dilatedem.post.figures import canvas
from dilatedem.post.figures.canvas import Drawing
from dilatedem.post.figures.energy import energy_figure, residual_share
from dilatedem.post.figures.extremes import extremes_figure
from dilatedem.post.figures.field import field_figure, plan_figure, speed_figure
from dilatedem.post.figures.grid import grid_figure
from dilatedem.post.figures.hits import hit_figure
from dilatedem.post.figures.loads import force_figure, peak_figure
from dilatedem.post.figures.map import load_around_figure, load_map_figure
from dilatedem.post.figures.motion import motion_figure
from dilatedem.post.figures.rose import rose_figure
from dilatedem.post.figures.spectrum import spectrum_figure
from dilatedem.post.figures.sweep import sweep_figure
from dilatedem.post.harm import COMPARISON_TABLE, refuse_harm, refuse_harm_beside
from dilatedem.post.loads import angular_statistics, event_statistics, hit_statistics, hit_threshold, load_statistics
from dilatedem.post.read import RunFolder, open_run
from dilatedem.post.report.ensembles import ensemble_tables
from dilatedem.post.report.front import Signed
from dilatedem.post.report.page import write_run_report
from dilatedem.post.report.sweep import write_sweep_report
from dilatedem.post.snapshots import snapshots_at
from dilatedem.results.doubts import doubts
from dilatedem.results.files import is_run, is_sweep, read_summary
from dilatedem.results.snapshots import Snapshot
from dilatedem.results.tables import row_count

MOMENTS = (0.0, 0.5, 1.0)  # of the run's time that the plan views show, as in Liu 2015, Fig. 10
#: figures of the laws of rare loads in the report of a sweep
MOST_LAWS = 8


def post_folders(folders: list[Path], choice: Choice = AS_IT_SUITS, signed: Signed | None = None) -> list[Path]:
    """See dilatedem.post.post. Every folder is checked before anything is written."""
    # `dilatedem post runs/*` meets the comparison that it wrote the last time.
    folders = [folder for folder in dict.fromkeys(folders) if not (folder / COMPARISON_TABLE).is_file()]
    runs = [folder for folder in folders if is_run(folder) and not is_sweep(folder)]
    beside = common_folder(runs) / "comparison" if len(runs) > 1 else None
    if choice.asked and not choice.blocks and not beside and len(runs) == len(folders):
        raise CaseError(f"{folders[0]}: a single run; a part, a threshold and a gap are for sweeps, runs side by side, and --block")
    with told_as(CaseError):
        for folder in folders:
            refuse_harm(folder)
        if beside:
            refuse_harm_beside(beside)
    with told_as(SimulationStopped):
        return _post_all(folders, beside, choice, signed)


def _post_all(folders: list[Path], beside: Path | None, choice: Choice, signed: Signed | None) -> list[Path]:
    """beside: the folder of a comparison, None for none"""
    written: list[Path] = []
    runs: list[RunFolder] = []
    for folder in folders:
        if is_sweep(folder):
            written += post_sweep(read_sweep(folder), choice)
        else:
            run = open_run(folder)
            written += post_run(run, signed, choice)
            runs.append(run)
    if beside:
        beside.mkdir(exist_ok=True)
        sweep = compare_runs(runs, beside)
        write_table(sweep, beside / COMPARISON_TABLE)
        written += [beside / COMPARISON_TABLE, *post_sweep(sweep, choice)]
    return written


def common_folder(runs: list[Path]) -> Path:
    """The deepest folder that holds all these run folders, and is none of them."""
    parents = [str(run.resolve().parent) for run in runs]
    return Path(os.path.commonpath(parents))


def post_run(run: RunFolder, signed: Signed | None = None, choice: Choice = AS_IT_SUITS) -> list[Path]:
    """Figures, statistics and report of one run, and of the blocks that it is to be cut into.

    signed: what the report's front page says of who made it.
    """
    found = study(run_alone(run), choice) if choice.blocks else None
    laws, statistics = {} if found is None else all_extremes(found), run_statistics(run)
    drawings = run_drawings(run) + (sweep_drawings(found, laws) if found else [])
    written, figures = save_all(drawings, run.path / "figures")
    if merge_summary(run.path / "summary.json", statistics):
        written.append(run.path / "summary.json")
    if found:
        written.append(write_statistics(found, laws))
    written.append(write_run_report(run, statistics, figures, signed, ensemble_tables(found, laws) if found else None))
    return written


def all_extremes(found: Study) -> Laws:
    """The laws of the highest loads of each ensemble on each structure."""
    return {
        (number, structure): extremes(found, ensemble, structure)
        for number, ensemble in enumerate(found.ensembles)
        for structure in found.sweep.structures
    }


def post_sweep(sweep: Sweep, choice: Choice = AS_IT_SUITS) -> list[Path]:
    """Statistics, figures and report of runs that differ in some keys, or in the seed alone."""
    found = study(sweep, choice)
    laws = all_extremes(found)
    written, figures = save_all(sweep_drawings(found, laws), sweep.folder / "figures")
    written.append(write_statistics(found, laws))
    written.append(write_sweep_report(found, laws, figures))
    return written


def sweep_drawings(found: Study, laws: Laws) -> list[Drawing]:
    """All figures of a sweep in the order of the report; of the laws of rare loads the first MOST_LAWS."""
    drawings: list[Drawing | None] = []
    for structure in found.sweep.structures:
        drawings += [sweep_figure(found, structure, key) for key in found.sweep.keys]
        drawings += [grid_figure(found, structure), rose_figure(found, structure)]
    rare = [
        extremes_figure(found, found.ensembles[number], structure, law, number + 1) for (number, structure), law in laws.items()
    ]  # fmt: skip
    return [drawing for drawing in [*drawings, *[drawing for drawing in rare if drawing][:MOST_LAWS]] if drawing is not None]


def save_all(drawings: list[Drawing], folder: Path) -> tuple[list[Path], list[tuple[Drawing, str]]]:
    """Write every figure; return the files, and each figure with its SVG for the report."""
    written: list[Path] = []
    figures: list[tuple[Drawing, str]] = []
    for drawing in drawings:
        files, svg = canvas.save(drawing, folder)
        written += files
        figures.append((drawing, svg))
    return written, figures


def run_drawings(run: RunFolder) -> list[Drawing]:
    """All figures that the files of this run allow, in the order of the report."""
    snapshots = snapshots_at(run, MOMENTS)
    upstream = run.upstream_angle
    drawings: list[Drawing | None] = []
    outlines = initial_outlines(run, snapshots)
    if outlines:
        drawings.append(field_figure(run, outlines))
    if snapshots:
        drawings += [plan_figure(run, snapshots), speed_figure(run, snapshots)]
    for name, history in run.forces.items():
        if not history["fh_max_N"].any():
            continue  # never touched
        hits = hits_on(run, name)
        drawings += [force_figure(name, history, hits), peak_figure(name, history, run.current, hits)]
        load_map = run.load_maps.get(name)
        if load_map is not None and load_map.place == "angle":
            drawings.append(load_around_figure(load_map, upstream))
        if load_map is not None:
            outline = run.outlines[name].outline if name in run.outlines and run.outlines[name].bounded else None
            drawings.append(load_map_figure(load_map, upstream, afloat=run.afloat, outline=outline))
    if run.floes is not None:
        drawings += [hit_figure(run, hit, place) for place, hit in enumerate(run.kept_hits, start=1)]
    drawings += [motion_figure(name, motion, run.forces.get(name)) for name, motion in run.motion.items() if row_count(motion)]
    swinging = run.summary.get("natural_frequencies") or {}
    for name in [name for name in swinging if row_count(run.motion.get(name, {}))]:
        drawings.append(spectrum_figure(name, run.motion[name], swinging[name], run.forces.get(name)))
    if row_count(run.energy):
        drawings.append(energy_figure(run.energy, run.energy_labels))
    return [drawing for drawing in drawings if drawing is not None]


def initial_outlines(run: RunFolder, snapshots: list[Snapshot]) -> list[np.ndarray]:
    """Outlines of the floes at the start, from run.h5, which has others where ice enters, or from a snapshot of t = 0."""
    if run.ice is not None and "inflow" not in run.boundaries:
        return run.ice.outlines
    return snapshots[0].outlines if snapshots and snapshots[0].time == 0.0 else []


def hits_on(run: RunFolder, name: str) -> dict[str, Any]:
    """What counts as a hit in this run, and how many there were on one structure, told by its windows.

    A run that tells load events itself says what counts; else the floes do.
    """
    told, history = run.summary.get("hits") or {}, run.forces[name]
    threshold, gap = told.get("threshold_N"), told.get("gap_s")
    if threshold is None or gap is None:
        return hit_statistics(history, hit_threshold(None if run.ice is None else run.ice.mass))
    found = hit_statistics(history, threshold, gap)
    return found | event_statistics(run.hits[name]) if name in run.hits else found


def run_statistics(run: RunFolder) -> dict[str, Any]:
    """What goes under `post` in summary.json."""
    loads: dict[str, Any] = {}
    for name, history in run.forces.items():
        loads[name] = load_statistics(history, run.current)
        if row_count(history):
            loads[name]["hits"] = hits_on(run, name)
        load_map = run.load_maps.get(name)
        if load_map is not None and load_map.place == "angle":
            loads[name]["around"] = angular_statistics(load_map, run.upstream_angle)
    share = residual_share(run.energy) if row_count(run.energy) else None
    return {"simulated_s": run.simulated, "loads": loads, "largest_residual_over_work": share, "doubts": doubts(run.summary)}


def merge_summary(path: Path, statistics: dict[str, Any]) -> bool:
    """Put the statistics under `post` of summary.json and leave its other keys as they are.

    Returns False, and writes nothing, when there is a summary.json that cannot be read.
    """
    summary = read_summary(path)
    if not summary and path.exists():
        return False
    summary["post"] = statistics
    write_text(path, json.dumps(summary, indent=2, ensure_ascii=False) + "\n")
    return True

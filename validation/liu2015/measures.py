"""What is taken from one run, and the runs put together: every measure by model, size, speed and seed."""

from __future__ import annotations

import csv
import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from dilatedem.post.loads import angular_statistics, hit_statistics, line_load, load_statistics, window_lengths
from dilatedem.post.read import RunFolder, open_run
from dilatedem.results.tables import Table
from validation.liu2015.ice import Raster, drift, mean_ice, strips
from validation.liu2015.plan import Run, found
from validation.liu2015.runner import completed, say, sources_of

PILE = "pile"
#: m of drift that every speed from 0.1 m/s on reaches in 100 s: up to it, as much ice has met the pile at every speed
EQUAL_DRIFT = 10.0
#: m of drift up to which ice comes to the pile at full width; then the field, 33 m of it ahead of the pile, comes to its end
PASSING_DRIFT = 30.0
FIRST_HITS = 20.0  # s; the paper's "initial collisions"
JAM = (60.0, 85.0)  # s; when the paper sees the small floes jam
COARSE = 0.1  # s; forces are averaged over it before their fluctuation is taken
#: share of a run's highest force from which on an unbroken row of windows is a peak, as in the runs on record
PEAK_THRESHOLD = 0.1
SWING = 0.01  # of the largest force along y; smaller ones are no hit to either side


@dataclass(frozen=True)
class Result:
    """One completed run: its measures, the load around the pile, and the ice about it."""

    run: Run
    folder: RunFolder
    sources: str
    measures: dict[str, float]
    angle_edges: np.ndarray  # (places + 1,) [deg]
    load_around: np.ndarray  # (places,) [N/m]
    ice: Raster


def results(root: Path) -> list[Result]:
    """Every completed run below this folder; one whose files are missing is named and left out."""
    read = []
    for run in found(root):
        if completed(run.folder(root)):
            try:
                read.append(result(run, root))
            except (OSError, KeyError) as fault:
                say(f"{run.folder(root)}: left out: {fault}")
    return read


def result(run: Run, root: Path) -> Result:
    folder = open_run(run.folder(root))
    ice = mean_ice(folder)
    around = folder.load_maps[PILE]
    measures = load_measures(folder) | strips(folder, ice)
    return Result(run, folder, sources_of(folder.path), measures, around.place_edges, line_load(around), ice)


def load_measures(folder: RunFolder) -> dict[str, float]:
    """Loads in N, N s and s, from the history of every window and the map of impulses."""
    history = folder.forces[PILE]
    time, lengths = history["time_s"], window_lengths(history["time_s"])
    statistics = load_statistics(history)
    peaks = hit_statistics(history, max(PEAK_THRESHOLD * statistics["fh"]["peak_N"], np.finfo(float).tiny), gap=0.0)
    fx, fy, highest = history["fx_N"], history["fy_N"], history["fh_max_N"]
    drifted = drift(folder, time)
    early, passing = drifted <= EQUAL_DRIFT + 1e-6, drifted <= PASSING_DRIFT + 1e-6
    largest_y = max(statistics["fy"]["max_N"], -statistics["fy"]["min_N"])
    peak = statistics["fh"]["peak_N"]
    measures = {
        "fh_max_N": peak,
        "fh_max_equal_drift_N": float(highest[early].max(initial=0.0)),
        "fh_max_equal_drift_at_m": float(drifted[early][np.argmax(highest[early])]) if np.any(early) else math.nan,
        "fx_max_N": statistics["fx"]["max_N"],
        "fx_min_N": statistics["fx"]["min_N"],
        "fx_mean_N": statistics["fx"]["mean_N"],
        "fx_mean_equal_drift_N": float(np.average(fx[early], weights=lengths[early])) if np.any(early) else math.nan,
        "fx_mean_passing_N": float(np.average(fx[passing], weights=lengths[passing])),
        "fx_impulse_Ns": statistics["fx"]["impulse_Ns"],
        "fx_p99_of_means_N": float(np.percentile(fx, 99.0)),
        "fx_backward_share": share(-fx, lengths),
        "fy_max_N": statistics["fy"]["max_N"],
        "fy_min_N": statistics["fy"]["min_N"],
        "fy_over_fx": ratio(largest_y, statistics["fx"]["max_N"]),
        "fy_impulse_over_fx": ratio(abs(statistics["fy"]["impulse_Ns"]), statistics["fx"]["impulse_Ns"]),
        "fy_positive_share": share(fy, lengths),
        "fy_turns": float(turns(fy)),
        "peaks": float(peaks["count"]),
        "peak_duration_s": peaks["mean_duration_s"],
        "peak_over_mean": ratio(peak, statistics["fx"]["mean_N"]),
        "contact_time_share": statistics["contact_time_fraction"],
        "fh_max_first_hits_N": float(highest[time <= FIRST_HITS].max(initial=0.0)),
        "fluctuation_N": fluctuation(history, 0.0, math.inf),
        "fluctuation_first_hits_N": fluctuation(history, 0.0, FIRST_HITS),
        "fluctuation_jam_over_before": ratio(fluctuation(history, *JAM), fluctuation(history, 0.0, JAM[0])),
        "residual_over_work": folder.summary.get("energy", {}).get("residual_over_work") or 0.0,  # null: the loads did no work
        "largest_overlap_m": folder.summary.get("contact", {}).get("largest_overlap_m", math.nan),
    }
    around = angular_statistics(folder.load_maps[PILE], folder.upstream_angle)
    for half in (45, 90):
        measures[f"upstream_{half}_deg_share"] = around.get(f"share_within_{half}_deg_of_upstream", math.nan)
    centre = around.get("centre_of_load_from_zero_deg", math.nan) + (folder.upstream_angle or 0.0)
    measures["centre_of_load_deg"] = (centre + 180.0) % 360.0 - 180.0  # from +x, as in the runs on record
    return measures


def ratio(value: float, reference: float) -> float:
    return value / reference if reference else math.nan


def share(force: np.ndarray, lengths: np.ndarray) -> float:
    """Of the impulse to both sides, the share that pushes towards +; nan without any force."""
    return ratio(float(np.sum(np.maximum(force, 0.0) * lengths)), float(np.sum(np.abs(force) * lengths)))


def turns(force: np.ndarray) -> int:
    """How often the force changes its sign from one hit to the next."""
    hits = force[np.abs(force) > SWING * np.abs(force).max(initial=0.0)]
    return int(np.sum(np.diff(np.sign(hits)) != 0.0))


def fluctuation(history: Table, start: float, end: float) -> float:
    """Standard deviation [N] of the force along x, averaged over COARSE, between two times [s]; nan if the run ends before."""
    time = history["time_s"]
    chosen = (time > start + 1e-9) & (time <= end + 1e-9)
    width = max(1, round(COARSE / float(np.median(np.diff(time)))))
    count = int(chosen.sum()) // width
    if count < 2 or (math.isfinite(end) and time[-1] < end - COARSE):
        return math.nan
    return float(history["fx_N"][chosen][: count * width].reshape(count, width).mean(axis=1).std())


class Ensemble:
    """The results of all runs, asked by model, size and speed."""

    def __init__(self, results: list[Result]):
        self.results = sorted(results, key=lambda result: result.run)

    def chosen(self, model: str, size: str, speed: float) -> list[Result]:
        return [result for result in self.results if (result.run.model, result.run.size, result.run.speed) == (model, size, speed)]

    def of(self, name: str, model: str, size: str, speed: float) -> dict[int, float]:
        """A measure by seed."""
        return {result.run.seed: result.measures.get(name, math.nan) for result in self.chosen(model, size, speed)}

    def speeds(self, model: str, size: str) -> list[float]:
        return sorted({result.run.speed for result in self.results if (result.run.model, result.run.size) == (model, size)})

    @property
    def models(self) -> list[str]:
        """In the order of the plan: the paper's laws first."""
        return sorted({result.run.model for result in self.results}, reverse=True)

    def write(self, path: Path) -> None:
        """One row a run, one column a measure."""
        columns = list(dict.fromkeys(name for result in self.results for name in result.measures))
        with open(path, "w", newline="", encoding="utf-8") as file:
            table = csv.writer(file, lineterminator="\n")
            table.writerow(["model", "size_m", "speed_m_s", "seed", "sources", *columns])
            for result in self.results:
                run = result.run
                cells = [f"{result.measures[name]:.6g}" if name in result.measures else "" for name in columns]
                table.writerow([run.model, run.size, run.speed, run.seed, result.sources, *cells])

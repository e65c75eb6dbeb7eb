"""What `dilatedem info` says: the run or sweep in a folder, how far it got, its headline loads."""

from __future__ import annotations

import math
from collections import Counter
from pathlib import Path

from dilatedem.post.ensembles.sweeps import read_sweep, value_words
from dilatedem.post.labels import axis_label, number
from dilatedem.post.loads import load_statistics
from dilatedem.post.read import RunFolder, open_run
from dilatedem.results.doubts import doubts
from dilatedem.results.files import is_sweep


def describe(folder: Path) -> str:
    """Lines of plain text. Raises CaseError when the folder holds neither a run nor a sweep."""
    return describe_sweep(folder) if is_sweep(folder) else describe_run(open_run(folder))


def describe_run(run: RunFolder) -> str:
    summary = run.summary
    lines = [run.title, f"  {'folder':<12}{run.path}", f"  {'status':<12}{status_words(run)}"]
    if summary.get("message"):
        lines.append(f"  {'':<12}{summary['message']}")
    lines.append(f"  {'model':<12}{model_words(run)}")
    if summary.get("steps"):
        lines.append(f"  {'steps':<12}{step_words(summary)}")
    for name, history in run.forces.items():
        lines.append(f"  {'load':<12}{name}: {load_words(load_statistics(history, run.current))}")
    if not run.forces:
        lines.append(f"  {'load':<12}none recorded")
    checked = (summary.get("error_check") or {}).get("message")
    if checked:
        lines.append(f"  {'step error':<12}{checked}")
    if bent := bending_words(summary):
        lines.append(f"  {'bending':<12}{bent}")
    words = energy_words(summary.get("energy") or {})
    if words:
        lines.append(f"  {'energy':<12}{words}")
    lines += [f"  {'caution':<12}{doubt}" for doubt in doubts(summary)]
    return "\n".join(lines)


def status_words(run: RunFolder) -> str:
    """How far the run got."""
    status = str(run.summary.get("status", "unknown (no summary.json)"))
    duration = run.case.get("time", {}).get("duration")
    reached = f"{number(run.simulated, 5)} s"
    return f"{status}, {reached} of {number(float(duration), 5)} s" if duration else f"{status}, {reached}"


def model_words(run: RunFolder) -> str:
    count = run.summary.get("floes") or (len(run.ice.outlines) if run.ice else None)
    size = run.domain_size
    floes = f"{count} floes" if count is not None else "floes"
    kinds = [f"{structure.get('kind')} '{structure.get('name')}'" for structure in run.structures]
    against = ", ".join(kinds) if kinds else "no structure"
    flows = ", ".join(f"{what} {number(math.hypot(*flow), 3)} m/s" for what, flow in run.flows.items()) or "current 0 m/s"
    model = run.case.get("contact", {}).get("model", "")
    return f"{floes} in {size[0]:g} m x {size[1]:g} m, {against}, {flows}, contact {model}"


def step_words(summary: dict) -> str:
    words = f"{summary['steps']}"
    if summary.get("dt_s"):
        words += f" of {number(summary['dt_s'], 3)} s"
        if summary.get("dt_critical_s"):
            words += f" ({number(summary['dt_s'] / summary['dt_critical_s'], 2)} of the critical one)"
    if summary.get("wall_s"):
        words += f", {number(summary['wall_s'], 3)} s of wall time"
    return words


def load_words(statistics: dict) -> str:
    if not statistics["windows"]:
        return "no rows yet"
    if statistics["fh"]["peak_N"] == 0.0:
        return "never touched"
    fh, fx, fy = statistics["fh"], statistics["fx"], statistics["fy"]
    if "along_current" in statistics:
        mean = f"mean along the current {number(statistics['along_current']['mean_N'] / 1e3, 3)} kN"
    else:
        mean = f"mean along x {number(fx['mean_N'] / 1e3, 3)} kN"
    return (
        f"peak {number(fh['peak_N'] / 1e3, 3)} kN at {number(fh['peak_time_s'], 5)} s, "
        f"{mean}, along x {number(fx['min_N'] / 1e3, 3)} to {number(fx['max_N'] / 1e3, 3)} kN, "
        f"along y {number(fy['min_N'] / 1e3, 3)} to {number(fy['max_N'] / 1e3, 3)} kN, "
        f"{_moment_words(statistics)}in contact {number(100.0 * statistics['contact_time_fraction'], 3)} % of the time"
    )


def _moment_words(statistics: dict) -> str:
    """The highest overturning moment; nothing of a run that did not record it."""
    moment = statistics.get("moment")
    return f"overturning moment up to {number(moment['peak_Nm'] / 1e3, 3)} kN m, " if moment else ""


def bending_words(summary: dict) -> str:
    """What pulled floes that bend most, and how many would have broken; nothing of a run that had none."""
    found = summary.get("flexure") or {}
    if found.get("largest_Pa") is None or not found.get("floes"):
        return ""
    strength = f"flexural strength of {number(found['strength_Pa'] / 1e6, 3)} MPa"
    above = f"{found['above_strength']} of {found['floes']} floes passed the {strength}"
    if found.get("first_above_s") is not None:
        above += f", the first at {number(found['first_above_s'], 5)} s"
    most = f"floe {found['largest_body']} was pulled most, by {number(found['largest_Pa'] / 1e6, 3)} MPa"
    return f"{most} at {number(found['largest_time_s'], 5)} s; {above}"


def energy_words(energy: dict) -> str:
    """How large the residual of the ledger is, beside the work of the loads, where they did any, and the energy turned over."""
    beside = (("residual_over_work", "the work of water and wind"), ("residual_over_turned_over", "the energy turned over"))
    words = [f"{number(100.0 * energy[key], 3)} % of {what}" for key, what in beside if energy.get(key) is not None]
    return f"residual {', '.join(words)}" if words else ""


def describe_sweep(folder: Path) -> str:
    sweep = read_sweep(folder)
    ended = ", ".join(f"{count} {status}" for status, count in Counter(run.status for run in sweep.runs).items())
    lines = [
        f"Sweep: {sweep.title}",
        f"  {'folder':<12}{folder}",
        f"  {'runs':<12}{len(sweep.runs)} ({ended})",
    ]
    for key in sweep.keys:
        values = list(dict.fromkeys(value_words(key, run.values[key]) for run in sweep.runs))
        lines.append(f"  {'varied':<12}{axis_label(key)} [{key}]: {'; '.join(values)}")
    for name in sweep.structures:
        peaks = [run.loads[name]["fh_max"] for run in sweep.runs if "fh_max" in run.loads.get(name, {})]
        if peaks:
            low, high = number(min(peaks) / 1e3, 3), number(max(peaks) / 1e3, 3)
            lines.append(f"  {'load':<12}{name}: highest horizontal force from {low} to {high} kN")
    return "\n".join(lines)

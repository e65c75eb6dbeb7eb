"""The run as rows of tables: loads and contacts, the ledger, how it was made."""

from __future__ import annotations

from typing import Any

import numpy as np

from dilatedem.post.labels import kilo, number, show
from dilatedem.post.read import RunFolder

PAIRS = {"ice_ice": "floe on floe", "ice_structure": "floe on structure"}

Rows = list[list[str]]


def load_rows(statistics: dict[str, Any], level: float = 0.0) -> Rows:
    """What, value and unit of the load on one structure; none where there is nothing to tell.

    level: height [m] about which moments are stated.
    """
    if not statistics["windows"] or statistics["fh"]["peak_N"] == 0.0:
        return []
    fh, fx, fy = statistics["fh"], statistics["fx"], statistics["fy"]
    rows = [
        ["highest horizontal force", kilo(fh["peak_N"]), f"kN, at {number(fh['peak_time_s'], 5)} s"],
        ["force along x, lowest to highest", f"{kilo(fx['min_N'])} to {kilo(fx['max_N'])}", "kN"],
        ["force along y, lowest to highest", f"{kilo(fy['min_N'])} to {kilo(fy['max_N'])}", "kN"],
    ]
    window = f"{number(1e3 * statistics['window_s'], 3)} ms"
    for axis, entry in (("x", fx), ("y", fy)):
        rows.append([f"mean force along {axis}", kilo(entry["mean_N"]), "kN"])
        spread = f"standard deviation of the {window} means along {axis}"
        rows.append([spread, kilo(entry["std_of_window_means_N"]), "kN"])
        rows.append([f"impulse along {axis}", kilo(entry["impulse_Ns"]), "kN s"])
    for side, words in (("along_current", "along the current"), ("across_current", "across the current, positive to its left")):
        if side in statistics:
            rows.append([f"mean force {words}", kilo(statistics[side]["mean_N"]), "kN"])
            if "max_N" in statistics[side]:
                entry = statistics[side]
                rows.append([f"force {words}, lowest to highest", f"{kilo(entry['min_N'])} to {kilo(entry['max_N'])}", "kN"])
    if "moment" in statistics:
        moment, about = statistics["moment"], f"z = {number(level)} m"
        when = f"kN m, at {number(moment['peak_time_s'], 5)} s"
        rows.append([f"highest overturning moment about {about}", kilo(moment["peak_Nm"]), when])
        for axis in ("mx", "my", "mz"):
            span = f"{kilo(moment[axis]['min_Nm'])} to {kilo(moment[axis]['max_Nm'])}"
            rows.append([f"moment about {axis[1]} at {about}, lowest to highest", span, "kN m"])
    rows.append(["share of time in contact", number(100.0 * statistics["contact_time_fraction"], 3), "%"])
    if "hits" in statistics:
        hits = statistics["hits"]
        apart = f"apart by {number(hits['gap_s'])} s or more below that"
        rows += [
            [f"separate hits: horizontal force of at least {kilo(hits['threshold_N'])} kN, {apart}", str(hits["count"]), ""],
            ["mean duration of these, from the first load above to the last", number(hits["mean_duration_s"], 3), "s"],
            ["longest of them", number(hits["longest_duration_s"], 3), "s"],
            ["mean time of a hit above that force", number(hits["mean_time_above_s"], 3), "s"],
        ]
    for half in (45, 90):
        part = (statistics.get("around") or {}).get(f"share_within_{half}_deg_of_upstream")
        if part is not None:
            what = f"share of the load within {half}° of the upstream direction"
            rows.append([what, number(100.0 * part, 3), "%"])
    around = statistics.get("around") or {}
    if around:
        zero = around["zero_of_angles"]
        rows.append([f"centre of the load, 0° = {zero}", number(around["centre_of_load_from_zero_deg"], 3), "°"])
    return rows


def motion_rows(summary: dict[str, Any], structure: str) -> Rows:
    """How far a structure that moves came, and what its base bore at most; none of one that is held."""
    most = (summary.get("motion") or {}).get(structure)
    if not most:
        return []
    return [
        ["largest displacement", number(most["displacement_max_m"], 4), f"m, at {number(most['displacement_max_time_s'], 5)} s"],
        ["largest force on its base", kilo(most["reaction_max_N"]), f"kN, at {number(most['reaction_max_time_s'], 5)} s"],
    ] + beam_rows(most, (summary.get("natural_frequencies") or {}).get(structure) or {})


def beam_rows(most: dict[str, float], frequencies: dict[str, list[float]]) -> Rows:
    """What the foot of a beam bore at most at any time step, and how fast it swings; none of a structure that is on no beam."""
    if "base_moment_max_Nm" not in most:
        return []
    force, moment = most["base_force_max_N"], most["base_moment_max_Nm"]
    rows = [
        ["highest force on its foot, of all steps", kilo(force), f"kN, up to {number(most['base_force_max_time_s'], 5)} s"],
        ["highest moment about its foot, of all steps", kilo(moment), f"kN m, up to {number(most['base_moment_max_time_s'], 5)} s"],
    ]
    for axis in "xy":
        told = ", ".join(number(frequency, 4) for frequency in frequencies.get(f"along_{axis}_Hz", []))
        rows.append([f"natural frequencies along {axis}", told, "Hz"])
    return rows


def step_rows(summary: dict[str, Any], structure: str) -> Rows:
    """What half the time step changes of the load on a structure; none unless it bore the run's highest load, and was checked."""
    checked = summary.get("error_check") or {}
    if checked.get("structure") != structure or not checked.get("change"):
        return []
    window = f"impulse from {number(checked['start_s'], 5)} to {number(checked['end_s'], 5)} s"
    kinds = {"fh_max": "highest horizontal force", "impulse_h": f"horizontal {window}", "impulse_x": f"{window} along x"}
    changes = {kind: checked["change"].get(kind) for kind in kinds}
    return [
        [f"in the one hit replayed, half the time step changes the {kinds[kind]} by", number(100.0 * change, 2), "%"]
        for kind, change in changes.items()
        if change is not None
    ]


def unchecked(summary: dict[str, Any]) -> str:
    """Why the error of the time step is not known although the case asks for it; empty where it is."""
    checked = summary.get("error_check") or {}
    return "" if checked.get("change") else str(checked.get("message", ""))


def quantile_table(statistics: dict[str, Any]) -> dict[str, Any]:
    """Forces that the maxima of the windows stay below, in so many per cent of the windows."""
    if not statistics["windows"]:
        return {"head": [], "rows": []}
    rows = []
    for name, key in (("horizontal", "fh"), ("along x", "fx")):
        quantiles = statistics[key]["quantiles_of_window_maxima_N"]
        rows.append([name, *[kilo(value) for value in quantiles.values()]])
    window = number(1e3 * statistics["window_s"], 3)
    return {"head": [f"{share} %" for share in quantiles], "rows": rows, "window": window}


def energy_rows(run: RunFolder, statistics: dict[str, Any]) -> Rows:
    """Every term of the ledger at its end."""
    rows: Rows = []
    for name, column in run.energy.items():
        if name == "time_s" or not len(column):
            continue
        end, change = float(column[-1]), float(column[-1] - column[0])
        rows.append([name.replace("_", " "), number(end / 1e3, 5), number(change / 1e3, 5)])
    share = statistics.get("largest_residual_over_work")
    if share is not None:
        rows.append(["largest residual / largest work of the loads", f"{number(100.0 * share, 3)} %", ""])
    share = (run.summary.get("energy") or {}).get("residual_over_turned_over")
    if share is not None:
        rows.append(["largest residual / energy turned over", f"{number(100.0 * share, 3)} %", ""])
    return rows


def contact_table(run: RunFolder) -> list[dict[str, Any]]:
    """Per kind of pair a table: mode, contact-steps, share, impulse, highest force, deepest overlap.

    Modes that never occurred are left out.
    """
    tables = []
    for pair, contacts in run.contacts.items():
        columns = contacts.columns
        steps = columns.get("steps", np.zeros(len(contacts.mode)))
        total = float(steps.sum())
        rows = [
            [
                mode,
                show(int(steps[i])),
                number(100.0 * float(steps[i]) / total, 3) if total else "–",
                kilo(float(columns["impulse_Ns"][i])),
                kilo(float(columns["max_force_N"][i])),
                number(1e3 * float(columns["max_overlap_m"][i]), 3),
            ]
            for i, mode in enumerate(contacts.mode)
            if steps[i] > 0
        ]
        tables.append({"pair": PAIRS.get(pair, pair.replace("_", " ")), "rows": rows})
    return tables


def fact_rows(run: RunFolder) -> Rows:
    """How the run was made."""
    summary = run.summary
    facts = [
        ("floes", "floes", ""),
        ("seed", "seed", ""),
        ("steps", "steps", ""),
        ("time step", "dt_s", "s"),
        ("critical time step", "dt_critical_s", "s"),
        ("simulated", "simulated_s", "s"),
        ("wall time", "wall_s", "s"),
        ("of which compiling", "compile_s", "s"),
        ("threads", "threads", ""),
    ]
    rows = [[label, show(summary[key]), unit] for label, key, unit in facts if summary.get(key) is not None]
    if inflow := summary.get("inflow"):
        told = [
            ("ice that has come", "ice_m", "m"),
            ("floes that entered", "entered", ""),
            ("bodies that left", "left", ""),
            ("ice waited for room", "waited_s", "s"),
        ]
        rows += [[label, show(inflow[key]), unit] for label, key, unit in told if inflow.get(key) is not None]
    elif run.ice is not None and len(run.ice.mass):
        rows.append(["mass of all floes", number(float(run.ice.mass.sum()) / 1e3), "t"])
    return rows + bending_rows(summary.get("flexure") or {})


def bending_rows(flexure: dict[str, Any]) -> Rows:
    """What pulled floes that bend most, and how many would have broken; none of a run without such."""
    if not flexure.get("floes") or flexure.get("largest_Pa") is None:
        return []
    when = f"MPa, of floe {flexure['largest_body']} at {number(flexure['largest_time_s'], 5)} s"
    first = flexure.get("first_above_s")
    return [
        ["largest tension in floes that bend", number(flexure["largest_Pa"] / 1e6, 3), when],
        [
            f"floes above the flexural strength of {number(flexure['strength_Pa'] / 1e6, 3)} MPa, which would have broken",
            f"{flexure['above_strength']} of {flexure['floes']}", f"the first at {number(first, 5)} s" if first is not None else "",
        ],
    ]  # fmt: skip


def version_rows(summary: dict[str, Any]) -> Rows:
    rows = [["dilatedem", str(summary["version"])]] if summary.get("version") else []
    return rows + [[name, str(version)] for name, version in (summary.get("versions") or {}).items()]

"""The front page of a report: what was run, when, where and how, who answers for it, and the figures that matter most."""

from __future__ import annotations

import hashlib
import math
from dataclasses import dataclass
from datetime import datetime
from typing import Any

from dilatedem.post.labels import kilo, number, show
from dilatedem.post.read import RunFolder
from dilatedem.post.report.iso import SHARE, STRENGTHS, bound_of

Rows = list[list[str]]


@dataclass(frozen=True)
class Signed:
    """What whoever hands a report in writes on its front page; what is empty is a line to be filled in by hand."""

    project: str = ""
    document: str = ""  # number or name, and revision
    prepared_by: str = ""
    checked_by: str = ""
    approved_by: str = ""

    def rows(self) -> list[dict[str, str]]:
        """The roles, and who has them."""
        return [
            {"role": "prepared by", "name": self.prepared_by}, {"role": "checked by", "name": self.checked_by},
            {"role": "approved by", "name": self.approved_by},
        ]  # fmt: skip


def identity_rows(run: RunFolder) -> Rows:
    """What tells this run from any other; what its files do not say is left out."""
    told, summary = run.summary.get("origin") or {}, run.summary
    machine = ", ".join(filter(None, (told.get("machine"), told.get("processor"), cores(told.get("cores")), told.get("system"))))
    found = [
        ("begun", moment(told.get("started"))), ("last written", moment(told.get("written"))), ("machine", machine),
        ("program", f"dilatedem {summary['version']}" if summary.get("version") else ""),
        ("command", told.get("command", "")), ("run folder", run.path.resolve().name),
        ("case.toml, SHA-256", case_hash(run)), ("repeat it by", "dilatedem run case.toml --out again"),
    ]  # fmt: skip
    return [[what, value] for what, value in found if value]


def moment(text: str | None) -> str:
    """A time of summary.json as a reader takes it, with its distance from UTC."""
    try:
        return datetime.fromisoformat(text or "").strftime("%d %B %Y, %H:%M:%S UTC%z").replace("UTC+0000", "UTC").lstrip("0")
    except ValueError:
        return text or ""


def cores(count: str | None) -> str:
    return f"{count} cores" if count else ""


def case_hash(run: RunFolder) -> str:
    """SHA-256 of the bytes of case.toml."""
    return hashlib.sha256((run.path / "case.toml").read_bytes()).hexdigest()


def basis_rows(run: RunFolder) -> Rows:
    """The case in a few lines: ice, water, structures, contact, time."""
    contact, sides = run.case.get("contact", {}), " by ".join(number(side) for side in run.domain_size)
    held = {each.get("name"): each.get("support", {}).get("kind", "held") for each in run.structures}
    structures = [f"{each.get('name')} ({each.get('kind')}, {held[each.get('name')]})" for each in run.structures]
    return [
        ["ice", ice_words(run)],
        ["domain", f"{sides} m, {run.boundaries[0]} along x, {run.boundaries[1]} along y"],
        ["water and wind", sea_words(run)],
        ["structures", ", ".join(structures) or "none"],
        ["contact", ", ".join([contact.get("model", ""), *(f"{key} {show(contact.get(key))}" for key in ("damping", "friction"))])],
        ["time", f"{number(run.simulated, 5)} s of {show(run.case.get('time', {}).get('duration'))} s"],
    ]


def ice_words(run: RunFolder) -> str:
    """How many floes of which size, how thick, and whether they crush."""
    ice, count = run.case.get("ice", {}), run.summary.get("floes")
    words = [f"{show(count)} floes"] if count is not None else []
    if run.ice is not None and len(run.ice.plan_area):
        words.append(f"{number(math.sqrt(float(run.ice.plan_area.mean())), 3)} m in size")
    if ice.get("thickness"):
        words.append(f"{number(float(ice['thickness']))} m thick")
    limit = ice.get("crushing_pressure")
    words.append("no crushing" if limit is None else f"crushing at {number(float(limit) / 1e6)} MPa")
    return ", ".join(words)


def sea_words(run: RunFolder) -> str:
    """Current, wind and waves."""
    words = [f"{what} {number(math.hypot(*flow), 3)} m/s towards {direction(flow)}" for what, flow in run.flows.items()]
    for what, (least, most) in run.changing_flows.items():
        words.append(f"{what} from a table, {number(least, 3)} to {number(most, 3)} m/s")
    for wave in run.case.get("wave", []):
        height, period = (number(float(wave.get(key, 0.0))) for key in ("amplitude", "period"))
        words.append(f"wave of {height} m amplitude and {period} s")
    return "; ".join(words) or "at rest"


def direction(flow: tuple[float, float]) -> str:
    """Where a flow goes, in words along an axis, else in degrees from +x."""
    words = {(1, 0): "+x", (-1, 0): "\N{MINUS SIGN}x", (0, 1): "+y", (0, -1): "\N{MINUS SIGN}y"}
    signs = tuple((value > 0.0) - (value < 0.0) for value in flow)
    return words.get(signs) or f"{number(math.degrees(math.atan2(flow[1], flow[0])), 3)}° from +x"


def headline(run: RunFolder, statistics: dict[str, Any]) -> dict[str, Any]:
    """One row a structure, without its parts: highest load, 99 % load, mean, moment, events, and level ice beside them [kN]."""
    weakest = min(STRENGTHS.values())
    rows = []
    for name, entry in statistics["loads"].items():
        if not entry["windows"] or "/" in name:
            continue
        bound, moment_, fh = bound_of(run, name), entry.get("moment"), entry["fh"]
        rows.append([
            name, kilo(fh["peak_N"]), number(fh["peak_time_s"], 5) if fh["peak_N"] else "–",
            kilo(fh["quantiles_of_window_maxima_N"][SHARE]), kilo(entry.get("along_current", entry["fx"])["mean_N"]),
            kilo(moment_["peak_Nm"]) if moment_ else "–", str(entry.get("hits", {}).get("count", "–")),
            kilo(bound.force(weakest)) if bound else "–",
        ])  # fmt: skip
    side = "along the current" if any(run.current) else "along x"
    head = ["structure", "highest (kN)", "at (s)", f"{SHARE} % (kN)", f"mean {side} (kN)", "moment (kN m)", "events"]
    return {"head": [*head, f"level ice, C_R {number(weakest / 1e6)} MPa (kN)"], "rows": rows}

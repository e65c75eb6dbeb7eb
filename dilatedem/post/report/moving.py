"""Snapshots in plan for the script of the page, which shows the ice moving."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from dilatedem.post.figures.field import speed_scale
from dilatedem.post.figures.plan import choose_view, domain_limits
from dilatedem.post.read import RunFolder
from dilatedem.post.report.pack import FULL, pack, scaled
from dilatedem.results.snapshots import Snapshot, read_snapshot
from dilatedem.results.whole import whole_snapshot

#: pictures, and corners of all pictures together, at most: more makes the page long to load
PICTURES, CORNERS = 120, 400_000
#: steps between a floe at rest and the fastest that is told apart
SPEEDS = 255


def moving_plan(run: RunFolder) -> dict[str, Any] | None:
    """View, sides, flows and pictures; None where fewer than two snapshots can be read."""
    shown = evenly(run)
    if len(shown) < 2:
        return None
    view = choose_view(run, [snapshot.outlines for snapshot in shown], [snapshot.time for snapshot in shown])
    unit = max(abs(limit) for limit in (*view.x, *view.y)) * 1.5 / FULL  # room for floes that stick out
    fastest = speed_scale(run, shown)
    held = structures_at(run, 0.0)
    return {
        "view": [*view.x, *view.y], "sides": [list(limits) for limits in domain_limits(run)], "unit": unit, "fastest": fastest,
        "periodic": [side == "periodic" for side in run.boundaries], "boundaries": list(run.boundaries), "structures": held,
        "flows": {what: list(flow) for what, flow in run.flows.items()},
        "of": len(run.snapshots),
        "pictures": [
            picture(snapshot, unit, fastest) | ({"structures": structures_at(run, snapshot.time)} if run.motion else {})
            for snapshot in shown
        ],
    }  # fmt: skip


def evenly(run: RunFolder) -> list[Snapshot]:
    """Snapshots at even distances, as many as there is room for, the first and the last among them."""
    listed = run.snapshots
    found = [snapshot for snapshot in (_readable(run, entry) for entry in listed[:1]) if snapshot]
    if not found:
        return []
    corners = sum(map(len, found[0].outlines))
    count = min(len(listed), PICTURES, max(2, CORNERS // max(1, corners)))
    rest = [listed[i] for i in np.unique(np.round(np.linspace(0, len(listed) - 1, count)).astype(int))[1:]]
    return found + [snapshot for snapshot in (_readable(run, entry) for entry in rest) if snapshot]


def _readable(run: RunFolder, entry: tuple[float, Path]) -> Snapshot | None:
    """One of the run's snapshots, (time [s], file); None of one that was cut short."""
    time, path = entry
    try:
        return whole_snapshot(read_snapshot(path, time), run.floes)
    except OSError:
        return None


def picture(snapshot: Snapshot, unit: float, fastest: float) -> dict[str, Any]:
    """Time [s], corners of the floes' outlines in units of `unit` [m], and their speeds in SPEEDS steps of the scale."""
    outlines = [outline for outline in snapshot.outlines if len(outline) > 2]
    kept = np.array([len(outline) > 2 for outline in snapshot.outlines], dtype=bool)
    speeds = np.clip(snapshot.speed[kept] / fastest, 0.0, 1.0) * SPEEDS
    points = np.concatenate(outlines) if outlines else np.zeros((0, 2))
    counts = np.array([len(outline) for outline in outlines])
    packed = {"corners": pack(counts, "u2"), "points": scaled(points, unit), "speeds": pack(np.round(speeds), "u1")}
    return {"time": snapshot.time} | packed


def structures_at(run: RunFolder, time: float) -> list[dict[str, Any]]:
    """Outlines of the structures [m] to the millimetre."""
    return [
        {"outline": np.round(plan.outline, 3).tolist(), "bounded": plan.bounded}
        for plan in run.outlines_at(time).values()
        if len(plan.outline)
    ]

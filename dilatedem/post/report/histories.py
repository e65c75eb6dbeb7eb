"""Load histories for the script of the page, which lets a reader zoom into them down to the windows of forces.csv."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from dilatedem.post.loads import window_lengths
from dilatedem.post.report.pack import FULL, pack, scaled
from dilatedem.results.tables import Table

#: columns of all histories of a page together; beyond that windows are joined, by their extremes
COLUMNS = 40_000
#: label, columns of mean, lowest and highest (none of what has none), and divisor
PANELS = (
    ("Force along x (kN)", "fx_N", "fx_min_N", "fx_max_N"),
    ("Force along y (kN)", "fy_N", "fy_min_N", "fy_max_N"),
    ("Highest horizontal force (kN)", None, None, "fh_max_N"),
    ("Highest overturning moment (kN m)", None, None, "mh_max_Nm"),
)


def history_data(structure: str, history: Table, columns: int) -> dict[str, Any]:
    """Edges of the columns [s] and what the panels show in them [kN, kN m], at most so many columns."""
    time, length = history["time_s"], window_lengths(history["time_s"])
    joined = max(1, math.ceil(len(time) / max(1, columns)))
    first = np.arange(0, len(time), joined)
    last = np.append(first[1:], len(time)) - 1
    panels = [panel(history, length, first, *names) for names in PANELS if names[3] in history]
    peak = int(np.argmax(history["fh_max_N"]))
    return {
        "structure": structure, "edges": pack(np.append(time[0] - length[0], time[last]), "f4"), "panels": panels,
        "window": float(joined * np.median(length)), "peak": float(time[peak]),
    }  # fmt: skip


def panel(
    history: Table, length: np.ndarray, first: np.ndarray, label: str, mean: str | None, low: str | None, high: str
) -> dict[str, Any]:
    """A panel's columns in units of its scale; length [s] of the windows; first: the window with which each column begins."""
    shown: dict[str, np.ndarray] = {"high": np.maximum.reduceat(history[high], first) / 1e3}
    if low is not None:
        shown["low"] = np.minimum.reduceat(history[low], first) / 1e3
    if mean is not None:
        shown["mean"] = np.add.reduceat(history[mean] * length, first) / np.add.reduceat(length, first) / 1e3
    scale = max(float(np.abs(values).max()) for values in shown.values()) / FULL or 1.0
    return {"label": label, "scale": scale} | {name: scaled(values, scale) for name, values in shown.items()}

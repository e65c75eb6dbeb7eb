"""Loads of many runs against what was varied: ice speed (Liu 2015, Fig. 14), floe size, any key."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from dilatedem.post.canvas import MARKERS, SERIES, Drawing, file_name, new_figure, styled
from dilatedem.post.labels import axis_label, describe_key
from dilatedem.post.sweeps import Sweep, SweepRun, axis_value, value_words

PANELS = (("fh_max", "Highest horizontal force (kN)"), ("fx_mean", "Mean force along x (kN)"))


@dataclass(frozen=True)
class Group:
    """Runs that differ in nothing but the seed."""

    place: float | str  # on the axis of the key that is drawn
    values: dict[str, Any]
    runs: list[SweepRun]

    def loads(self, structure: str, quantity: str) -> np.ndarray:
        """(runs,) [N], of the completed runs that have it."""
        found = [run.loads.get(structure, {}).get(quantity, math.nan) for run in self.runs if run.completed]
        return np.array([value for value in found if math.isfinite(value)])


def group_runs(sweep: Sweep, key: str) -> list[Group]:
    """The runs by their values of all varied keys; numbers ascend along `key`, words keep the sweep's order.

    Runs that do without the key are left out.
    """
    groups: dict[str, Group] = {}
    for run in sweep.runs:
        place = axis_value(key, run.values[key])
        if place is not None:
            groups.setdefault(repr(sorted(run.values.items())), Group(place, run.values, [])).runs.append(run)
    return sorted(groups.values(), key=lambda group: math.inf if isinstance(group.place, str) else group.place)


def varies(groups: list[Group], key: str) -> bool:
    return any(group.values[key] != groups[0].values[key] for group in groups)


def setting_words(values: dict[str, Any], keys: list[str]) -> str:
    """The values of these keys, for the legend."""
    words = []
    for key in keys:
        what, unit = describe_key(key)
        words.append(f"{what} {value_words(key, values[key])} {unit}".rstrip())
    return ", ".join(words)


@styled
def sweep_figure(sweep: Sweep, structure: str, key: str) -> Drawing | None:
    """Highest and mean force on a structure against one key; a line for each setting of the other keys."""
    groups = group_runs(sweep, key)
    groups = [group for group in groups if len(group.loads(structure, "fh_max"))]
    if len({group.place for group in groups}) < 2:
        return None
    others = [other for other in sweep.keys if other != key and varies(groups, other)]
    lines: dict[str, list[Group]] = {}
    for group in groups:
        lines.setdefault(setting_words(group.values, others), []).append(group)
    if len(lines) > len(SERIES):
        lines = {"": groups}  # more settings than anybody can tell apart: dots without a legend
    # Between words, and between dots of many settings, there is nothing to join.
    joined = isinstance(groups[0].place, float) and (len(lines) > 1 or not others)
    figure = new_figure(6.6, 5.8)
    panels = figure.subplots(2, 1, sharex=True)
    for axes, (quantity, label) in zip(panels, PANELS, strict=True):
        for index, (setting, members) in enumerate(lines.items()):
            look = {"color": SERIES[index], "marker": MARKERS[index], "markersize": 5.5, "label": setting}
            look |= {"markeredgecolor": "white", "linewidth": 1.2 if joined else 0.0}
            draw_line(axes, members, structure, quantity, look)
        axes.set_ylabel(label)
        axes.grid(True)
        low, high = axes.get_ylim()
        axes.set_ylim(min(0.0, low), max(high, 0.0) + 0.04 * abs(high))
    panels[1].set_xlabel(axis_label(key))
    numeric = [group.place for group in groups if isinstance(group.place, float)]
    if numeric:
        panels[1].margins(x=0.05)
    panels[0].set_title(f"Ice force on {structure}")
    if len(lines) > 1:
        columns = 2 if max(map(len, lines)) < 36 else 1
        figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=columns)
    caption = sweep_caption(structure, key, groups, others)
    name = f"force_by_{file_name(key)}_{file_name(structure)}"
    return Drawing(name, f"Force on {structure} by {describe_key(key)[0]}", caption, figure)


def draw_line(axes: Axes, groups: list[Group], structure: str, quantity: str, look: dict[str, Any]) -> None:
    """A dot per run; where runs differ in the seed alone, their mean and one standard deviation about it."""
    place, mean, spread = [], [], []
    for group in groups:
        loads = group.loads(structure, quantity) / 1e3
        if not len(loads):
            continue
        place.append(group.place)
        mean.append(float(loads.mean()))
        spread.append(float(loads.std(ddof=1)) if len(loads) > 1 else 0.0)
        if len(loads) > 1:
            dots = {"color": look["color"], "alpha": 0.5, "markersize": 3.5, "markeredgewidth": 0}
            axes.plot([group.place] * len(loads), loads, look["marker"], zorder=2, **dots)
    if any(spread):
        axes.errorbar(place, mean, yerr=spread, capsize=3.0, elinewidth=1.0, zorder=3, **look)
    else:
        axes.plot(place, mean, zorder=3, **look)


def sweep_caption(structure: str, key: str, groups: list[Group], others: list[str]) -> str:
    counts = sorted({len(group.loads(structure, "fh_max")) for group in groups})
    repeats = f"{counts[0]} to {counts[-1]} runs" if len(counts) > 1 else plural(counts[0], "run")
    spread = ""
    if counts[-1] > 1:
        spread = " Small dots: single runs; large ones: mean over the seeds; bars: one standard deviation."
    left_out = sum(not run.completed for group in groups for run in group.runs)
    words = f" Left out: {plural(left_out, 'run')} that did not complete." if left_out else ""
    by = f", for each {' and '.join(describe_key(other)[0] for other in others)}" if others else ""
    return (
        f"Highest horizontal force of any time step (above) and mean force along x (below) on {structure}, kN, against "
        f"{axis_label(key)[0].lower() + axis_label(key)[1:]}{by}; {repeats} to a point.{spread}{words}"
    )


def plural(count: int, noun: str) -> str:
    return f"{count} {noun}" if count == 1 else f"{count} {noun}s"

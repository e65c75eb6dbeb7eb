"""The load on a structure in time (Liu 2015, Figs. 12, 15) and at its peak."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from dilatedem.post.figures.canvas import BLACK, BLUE, GREEN, SKY, VERMILION, Drawing, file_name, new_figure, styled
from dilatedem.post.labels import number
from dilatedem.post.loads import along_and_across, hit_words, window_lengths
from dilatedem.results.tables import Table

# Windows are joined to about so many columns: more than a page resolves, few enough for an SVG.
COLUMNS_DRAWN = 1600
PEAK_VIEW = 0.5  # s shown to either side of the highest peak


@styled
def force_figure(structure: str, history: Table, hits: dict[str, Any] | None = None) -> Drawing:
    """Force along x and y against time: means of the windows, extremes of every step, the highest marked.

    hits: `hit_statistics` of the history, for the caption.
    """
    figure = new_figure(8.2, 5.2)
    panels = figure.subplots(2, 1, sharex=True)
    joined = max(1, math.ceil(len(history["time_s"]) / COLUMNS_DRAWN))
    for axes, axis in zip(panels, ("x", "y"), strict=True):
        draw_force(axes, history, axis, joined)
        axes.set_ylabel(f"Force along {axis} (kN)")
        mark_extreme(axes, history, axis)
    panels[0].legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=2, borderaxespad=0.2)
    panels[0].set_title(f"Ice force on {structure}")
    panels[1].set_title(hit_words(hits).strip(), fontsize=8.5)
    panels[1].set_xlabel("Time (s)")
    width = joined * float(np.median(window_lengths(history["time_s"])))
    caption = (
        f"Ice force on {structure} along x and y (kN) against time (s); positive forces push it towards +x "
        "and +y. Band: lowest and highest force of every time step; line: mean force over "
        f"{number(1e3 * width, 3)} ms. The extreme of each panel is marked.{hit_words(hits)}"
    )
    return Drawing(f"force_{file_name(structure)}", f"Force history, {structure}", caption, figure)


def draw_force(axes: Axes, history: Table, axis: str, joined: int, *, of: str = "") -> None:
    """Envelope and mean, `joined` windows to a column; `of` goes in front of the legend's words."""
    time, length = history["time_s"], window_lengths(history["time_s"])
    first = np.arange(0, len(time), joined)
    duration = np.add.reduceat(length, first)
    mean = np.add.reduceat(history[f"f{axis}_N"] * length, first) / duration / 1e3
    low = np.minimum.reduceat(history[f"f{axis}_min_N"], first) / 1e3
    high = np.maximum.reduceat(history[f"f{axis}_max_N"], first) / 1e3
    start = time[0] - length[0]
    edges = start + np.concatenate([[0.0], np.cumsum(duration)])
    band = {"color": SKY, "alpha": 0.75, "linewidth": 0.4, "label": f"{of}extremes of every step"}
    axes.fill_between(edges, with_end(low), with_end(high), step="post", zorder=2, **band)
    line = {"color": BLUE, "linewidth": 0.7, "label": f"{of}mean"}
    axes.step(edges, with_end(mean), where="post", zorder=3, **line)
    axes.axhline(0.0, color=BLACK, linewidth=0.5, zorder=1)
    axes.grid(True)
    axes.set_xlim(edges[0], max(edges[-1], edges[0] + 1e-9))
    axes.margins(y=0.08)


def with_end(values: np.ndarray) -> np.ndarray:
    """Values (n,) of windows as heights (n + 1,) of a step line over the windows' edges."""
    return np.append(values, values[-1])


def mark_extreme(axes: Axes, history: Table, axis: str) -> None:
    """A ring and its value at the force of largest size in the panel."""
    low, high = history[f"f{axis}_min_N"], history[f"f{axis}_max_N"]
    value = high if high.max(initial=0.0) >= -low.min(initial=0.0) else low
    index = int(np.argmax(np.abs(value)))
    if value[index] == 0.0:
        return
    time, force = float(history["time_s"][index]), float(value[index]) / 1e3
    ring = {"markerfacecolor": "none", "markeredgecolor": VERMILION, "clip_on": False}
    axes.plot([time], [force], "o", zorder=5, **ring)
    left = time < 0.5 * sum(axes.get_xlim())
    axes.annotate(
        f"{number(force, 3)} kN at {number(time, 5)} s",
        xy=(time, force),
        xytext=(9 if left else -9, 0),
        textcoords="offset points",
        ha="left" if left else "right",
        va="center",
        color="#8a3c00",
        bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 1.0},
        zorder=6,
    )


@styled
def peak_figure(
    structure: str, history: Table, current: tuple[float, float] = (0.0, 0.0), hits: dict[str, Any] | None = None
) -> Drawing | None:
    """The half second to either side of the highest horizontal force, window by window.

    current: velocity of the water [m/s], along and across which the means are drawn; hits: `hit_statistics`, for their threshold.
    """
    highest = history["fh_max_N"]
    index = int(np.argmax(highest))
    if highest[index] <= 0.0:
        return None
    time, length = history["time_s"], window_lengths(history["time_s"])
    centre = float(time[index])
    near = np.abs(time - centre) <= max(PEAK_VIEW, 5.0 * float(length[index]))
    part = {name: column[near] for name, column in history.items()}
    figure = new_figure(6.6, 3.4)
    axes = figure.add_subplot()
    edges = np.append(part["time_s"] - window_lengths(part["time_s"]), part["time_s"][-1])
    axes.fill_between(edges, 0.0, with_end(part["fh_max_N"]) / 1e3, step="post", color=SKY, alpha=0.45, linewidth=0.0, zorder=2)
    still = not any(current)
    words = ("mean along x", "mean along y") if still else ("mean along the current", "mean across it")
    lines = [("highest of any step", part["fh_max_N"], VERMILION, "-")]
    lines += [(word, force, *look) for word, force, look in zip(
        words, along_and_across(part, current), ((BLUE, "-"), (GREEN, (0, (4, 1.5)))), strict=True
    )]  # fmt: skip
    for label, force, colour, style in lines:
        axes.step(edges, with_end(force) / 1e3, where="post", zorder=4, color=colour, linewidth=1.1, linestyle=style, label=label)
    axes.axhline(0.0, color=BLACK, linewidth=0.5, zorder=1)
    axes.grid(True)
    axes.set_xlim(edges[0], edges[-1])
    axes.margins(y=0.08)
    if hits and 0.0 < hits["threshold_N"] < highest[index]:
        threshold = {"color": BLACK, "linewidth": 0.8, "linestyle": (0, (1, 2)), "zorder": 3}
        axes.axhline(hits["threshold_N"] / 1e3, label=f"a hit: {number(hits['threshold_N'] / 1e3, 3)} kN", **threshold)
    axes.set_xlabel("Time (s)")
    axes.set_ylabel("Horizontal force (kN)")
    figure.legend(*axes.get_legend_handles_labels(), loc="outside upper right", ncols=len(axes.lines) - 1)
    peak, window = number(highest[index] / 1e3, 3), number(1e3 * float(length[index]), 3)
    sides = "along x and y (there is no current)" if still else "along the current and across it, positive to its left"
    caption = (
        f"The highest peak on {structure}: {peak} kN near t = {number(centre, 5)} s (kN against s). Red, shaded: highest "
        f"horizontal force of any step in each window of {window} ms, whatever its direction; blue and green: mean force of the "
        f"window {sides}; dotted: the least force that counts as a hit."
    )
    return Drawing(f"peak_{file_name(structure)}", f"Highest peak, {structure}", caption, figure)

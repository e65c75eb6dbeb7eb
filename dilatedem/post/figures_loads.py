"""The load on a structure: in time (Liu 2015, Figs. 12, 15), at its peak, around the pile (Figs. 13, 18)."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.ticker import MaxNLocator

from dilatedem.post.canvas import BLACK, BLUE, SKY, VERMILION, Drawing, file_name, new_figure, styled
from dilatedem.post.labels import number
from dilatedem.post.loads import angular_statistics, line_load, mean_force_by_place, window_lengths
from dilatedem.results.archive import LoadMap
from dilatedem.results.tables import Table

# Windows are joined to about so many columns: more than a page resolves, few enough for an SVG.
COLUMNS_DRAWN = 1600
PRESSURE_RANGE = 1e3  # highest over lowest pressure of the load map's colours
PEAK_VIEW = 0.5  # s shown to either side of the highest peak


@styled
def force_figure(structure: str, history: Table) -> Drawing:
    """Force along x and y against time: means of the windows, extremes of every step, the highest marked."""
    figure = new_figure(8.2, 5.2)
    panels = figure.subplots(2, 1, sharex=True)
    joined = max(1, math.ceil(len(history["time_s"]) / COLUMNS_DRAWN))
    for axes, axis in zip(panels, ("x", "y"), strict=True):
        draw_force(axes, history, axis, joined)
        axes.set_ylabel(f"Force along {axis} (kN)")
        mark_extreme(axes, history, axis)
    panels[0].legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=2, borderaxespad=0.2)
    panels[0].set_title(f"Ice force on {structure}")
    panels[1].set_xlabel("Time (s)")
    width = joined * float(np.median(window_lengths(history["time_s"])))
    caption = (
        f"Ice force on {structure} along x and y (kN) against time (s); positive forces push it towards +x "
        "and +y. Band: lowest and highest force of every time step; line: mean force over "
        f"{number(1e3 * width, 3)} ms. The extreme of each panel is marked."
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
def peak_figure(structure: str, history: Table) -> Drawing | None:
    """The half second to either side of the highest horizontal force, window by window."""
    highest = history["fh_max_N"]
    index = int(np.argmax(highest))
    if highest[index] <= 0.0:
        return None
    time, length = history["time_s"], window_lengths(history["time_s"])
    centre = float(time[index])
    near = np.abs(time - centre) <= max(PEAK_VIEW, 5.0 * float(length[index]))
    part = {name: column[near] for name, column in history.items()}
    figure = new_figure(6.2, 3.2)
    axes = figure.add_subplot()
    draw_force(axes, part, "x", 1, of="x: ")
    edges = np.append(part["time_s"] - window_lengths(part["time_s"]), part["time_s"][-1])
    line = {"color": VERMILION, "linewidth": 1.0, "label": "horizontal: highest"}
    axes.step(edges, with_end(part["fh_max_N"]) / 1e3, where="post", zorder=4, **line)
    axes.set_xlabel("Time (s)")
    axes.set_ylabel("Force (kN)")
    axes.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=3, borderaxespad=0.2)
    peak, window = number(highest[index] / 1e3, 3), number(1e3 * float(length[index]), 3)
    caption = (
        f"The highest peak on {structure}: {peak} kN near t = {number(centre, 5)} s (kN against s). Band and "
        f"blue line: force along x, extremes of every step and mean of each window of {window} ms; "
        "red line: highest horizontal force of each window."
    )
    return Drawing(f"peak_{file_name(structure)}", f"Highest peak, {structure}", caption, figure)


@styled
def load_around_figure(load_map: LoadMap, upstream: float | None) -> Drawing:
    """Mean line load around an upright structure, in the directions of the plan view."""
    load = line_load(load_map) / 1e3
    edges = np.radians(load_map.place_edges)
    figure = new_figure(5.4, 5.4)
    axes = figure.add_subplot(projection="polar")
    rings = MaxNLocator(4, steps=[1, 2, 2.5, 5, 10]).tick_values(0.0, float(load.max(initial=0.0)) or 1.0)
    sector = {"align": "edge", "color": BLUE, "edgecolor": "white", "linewidth": 0.4}
    axes.bar(edges[:-1], load, width=np.diff(edges), zorder=3, **sector)
    axes.set_ylim(0.0, 1.1 * rings[-1])
    rays = range(0, 360, 30)
    axes.set_thetagrids(rays, labels=[f"{number(ray - 360 if ray > 180 else ray)}°" for ray in rays])
    axes.tick_params(axis="x", pad=2)
    axes.set_rlabel_position(67.5)
    axes.set_rticks(rings[1:])
    for label in axes.get_yticklabels():
        label.set_bbox({"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 0.6})
    axes.set_axisbelow(True)
    words = ""
    if upstream is not None:
        mark_upstream(axes, upstream)
        share = angular_statistics(load_map, upstream).get("share_within_45_deg_of_upstream")
        words = " The upstream side, from which the current comes, is shaded."
        if share is not None:
            words += f" {number(100.0 * share, 3)} % of the load lies within 45° of the upstream direction."
    quantity = f"Mean load on {load_map.structure} (kN per m of its circumference)"
    if upstream is not None and math.sin(math.radians(upstream)) > 0.3:
        axes.set_xlabel(quantity, labelpad=8)  # the arrow of the current has taken the place above
    else:
        axes.set_title(quantity, loc="center", pad=14)
    caption = (
        f"Mean normal ice load around {load_map.structure} over {number(load_map.duration)} s, kN per metre "
        f"of circumference (radius {number(load_map.radius)} m), by the place of contact: 0° is the +x side, "
        f"angles run counter-clockwise as in the plan view.{words} Sum of all sectors: "
        f"{number(float(mean_force_by_place(load_map).sum()) / 1e3, 3)} kN."
    )
    name = f"load_around_{file_name(load_map.structure)}"
    return Drawing(name, f"Load around {load_map.structure}", caption, figure)


def mark_upstream(axes: Axes, upstream: float) -> None:
    """Shade the half that faces the current and draw the current's arrow on its side, outside the circle."""
    top = axes.get_ylim()[1]
    facing = np.radians(np.linspace(upstream - 90.0, upstream + 90.0, 91))
    axes.fill_between(facing, 0.0, top, color=SKY, alpha=0.22, linewidth=0.0, zorder=0)
    angle = math.radians(upstream)
    arrow = {"arrowstyle": "-|>,head_width=0.3,head_length=0.6", "color": BLACK, "linewidth": 1.6}
    axes.annotate("", xy=(angle, 1.15 * top), xytext=(angle, 1.38 * top), arrowprops=arrow, annotation_clip=False)
    across, upward = math.cos(angle), math.sin(angle)
    side = "center" if abs(across) < 0.3 else "left" if across > 0.0 else "right"
    level = "center" if abs(upward) < 0.3 else "bottom" if upward > 0.0 else "top"
    axes.text(angle, 1.39 * top, "current", ha=side, va=level)


@styled
def load_map_figure(load_map: LoadMap, upstream: float | None) -> Drawing | None:
    """Mean pressure on the developed surface: around (or along) and over height, where any ice touched."""
    if not load_map.impulse.any() or not load_map.duration > 0.0:
        return None
    around = load_map.place == "angle"
    across = np.diff(load_map.place_edges)
    if around:
        across = np.radians(across) * load_map.radius
    area = across[:, None] * np.diff(load_map.height_edges)[None, :]
    pressure = load_map.impulse / load_map.duration / area / 1e3
    edges = load_map.place_edges
    if around and upstream is not None:
        edges, pressure = seen_from(upstream, edges, pressure)
    figure = new_figure(7.2, 2.9)
    axes = figure.add_subplot()
    # One floe that leans on the pile for a minute outweighs all passing hits: their traces need a log scale.
    shown, top = np.ma.masked_less_equal(pressure.T, 0.0), float(pressure.max())
    scale = {"cmap": "viridis_r", "norm": LogNorm(top / PRESSURE_RANGE, top), "rasterized": True}
    mesh = axes.pcolormesh(edges, load_map.height_edges, shown, **scale)
    bar = figure.colorbar(mesh, ax=axes, pad=0.015, extend="min")
    bar.set_label("Mean pressure (kPa)")
    rows = np.flatnonzero(load_map.impulse.any(axis=0))
    low, high = load_map.height_edges[rows[0]], load_map.height_edges[rows[-1] + 1]
    axes.set_ylim(low - 0.15 * (high - low), high + 0.15 * (high - low))
    axes.axhline(0.0, color=BLACK, linewidth=0.7, linestyle=(0, (6, 3)))
    axes.set_ylabel("Height above water (m)")
    origin = "the upstream direction" if upstream is not None else "the +x side"
    if around:
        axes.set_xticks(range(-180, 181, 45))
        axes.set_xlim(edges[0], edges[-1])
        axes.set_xlabel(f"Angle from {origin} (°), counter-clockwise seen from above")
    else:
        axes.set_xlabel(f"{load_map.label or 'Distance'} (m)")
    caption = (
        f"Where the ice pressed on {load_map.structure}: mean normal pressure (kPa, log scale) over "
        f"{number(load_map.duration)} s on the developed surface; white: never touched; dashed: still water."
    )
    name = f"load_map_{file_name(load_map.structure)}"
    return Drawing(name, f"Load map of {load_map.structure}", caption, figure)


def seen_from(origin: float, edges: np.ndarray, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Sectors around a pile, edges (n + 1,) and values (n, ...), ordered by the angle from `origin` [deg]."""
    start = (edges[:-1] - origin + 180.0) % 360.0 - 180.0
    order = np.argsort(start)
    width = np.diff(edges)[order]
    return np.append(start[order], start[order][-1] + width[-1]), values[order]

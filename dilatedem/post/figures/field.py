"""The ice field in plan: at the start (Liu 2015, Fig. 7), at several times (Fig. 10), by speed (Fig. 11)."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from dilatedem.post.figures.canvas import FAST_ICE, ICE, ICE_EDGE, WATER, Drawing, new_figure, styled
from dilatedem.post.figures.plan import (
    DRIFT_SHOWN,
    View,
    choose_view,
    draw_domain,
    draw_floes,
    draw_flows,
    draw_structures,
    dress,
)
from dilatedem.post.labels import number
from dilatedem.post.read import RunFolder
from dilatedem.results.snapshots import Snapshot

SPEED_MAP = "viridis"
PAGE_WIDTH = 10.0  # inch, of a row of panels
SIDES = {
    "periodic": "dashed where periodic",
    "open": "dotted where open",
    "outflow": "dotted where ice leaves",
    "inflow": "dotted where ice enters and leaves",
    "wall": "full lines where walls stand",
}


@styled
def field_figure(run: RunFolder, outlines: list[np.ndarray]) -> Drawing:
    """The field as it was generated; outlines: those of run.h5, or of the first snapshot."""
    view = choose_view(run, [outlines])
    width = 5.6
    figure = new_figure(width, panel_height(view, width))
    axes = figure.add_subplot()
    draw_scene(axes, run, outlines, view, fixed=fixed_floes(run, np.arange(len(outlines))))
    draw_flows(axes, run)
    axes.set_title(f"{len(outlines)} floes at t = 0")
    size = ""
    if run.ice is not None and len(run.ice.plan_area) and "inflow" not in run.boundaries:
        area = run.ice.plan_area
        lx, ly = run.domain_size
        size = (
            f" Mean floe size (root of the mean plan area) {number(math.sqrt(area.mean()), 3)} m; "
            f"the floes drawn cover {number(100.0 * area.sum() / (lx * ly), 3)} % of the domain "
            "(floes that touch a structure at the start are left out)."
        )
    caption = f"The initial ice field in plan, true to scale, {scene_words(run)}.{size}"
    return Drawing("field", "Initial ice field", caption, figure)


@styled
def plan_figure(run: RunFolder, snapshots: list[Snapshot]) -> Drawing:
    """The floes at their true place and shape at each of these times."""
    view = choose_view(run, [snapshot.outlines for snapshot in snapshots], [snapshot.time for snapshot in snapshots])
    figure, panels = panel_grid(view, len(snapshots))
    for axes, snapshot in zip(panels, snapshots, strict=True):
        draw_scene(axes, run, snapshot.outlines, view, fixed=fixed_floes(run, snapshot.body), time=snapshot.time)
        axes.set_title(f"t = {number(snapshot.time)} s")
    draw_flows(panels[0], run)
    words = f"{scene_words(run)}.{drift_words(run)}"
    caption = f"The ice in plan at {time_words(snapshots)}, true to scale, {words}"
    return Drawing("plan", "Ice field in time", caption, figure)


@styled
def speed_figure(run: RunFolder, snapshots: list[Snapshot]) -> Drawing:
    """The same views, floes coloured by their speed over ground."""
    view = choose_view(run, [snapshot.outlines for snapshot in snapshots], [snapshot.time for snapshot in snapshots])
    figure, panels = panel_grid(view, len(snapshots), bar=True)
    highest = speed_scale(run, snapshots)
    floes, fastest = None, 0.0
    for axes, snapshot in zip(panels, snapshots, strict=True):
        dress(axes, run, view)
        draw_domain(axes, run)
        style = {"cmap": SPEED_MAP, "clim": (0.0, highest), "edgecolors": ICE_EDGE, "linewidths": 0.35}
        floes = draw_floes(axes, run, view, snapshot.outlines, array=snapshot.speed, **style)
        draw_structures(axes, run, snapshot.time)
        axes.set_title(f"t = {number(snapshot.time)} s")
        fastest = max(fastest, float(snapshot.speed.max(initial=0.0)))
    draw_flows(panels[0], run)
    beyond = fastest > 1.001 * highest
    if floes is not None:
        place = {"shrink": 0.6, "aspect": 30, "pad": 0.015}
        bar = figure.colorbar(floes, ax=panels, extend="max" if beyond else "neither", **place)
        bar.set_label("Speed of the floes (m/s)")
        bar.outline.set_linewidth(0.6)
    cut = ""
    if beyond:
        cut = f" The scale ends at {number(highest, 3)} m/s; the fastest floe has {number(fastest, 3)} m/s."
    caption = f"Speed of each floe over ground (m/s) at {time_words(snapshots)}, {scene_words(run)}.{cut}"
    return Drawing("speed", "Speed of the floes", caption, figure)


def draw_scene(
    axes: Axes, run: RunFolder, outlines: list[np.ndarray], view: View, *, fixed: np.ndarray, time: float = 0.0
) -> None:
    """White floes on water, the domain, and the structures where they are at a time [s]."""
    dress(axes, run, view, water=WATER)
    draw_domain(axes, run)
    colours = np.where(fixed, FAST_ICE, ICE)
    draw_floes(axes, run, view, outlines, facecolors=list(colours), edgecolors=ICE_EDGE, linewidths=0.5)
    draw_structures(axes, run, time)


def fixed_floes(run: RunFolder, body: np.ndarray) -> np.ndarray:
    """Which of these bodies (n,) the case holds fast."""
    held = [index for index, entry in enumerate(run.case.get("body", [])) if entry.get("fixed")]
    return np.isin(body, held)


def speed_scale(run: RunFolder, snapshots: list[Snapshot]) -> float:
    """Upper end of the colour scale [m/s]: nearly all floes, and the current, but no single fast outlier."""
    speeds = np.concatenate([snapshot.speed for snapshot in snapshots] or [np.zeros(1)])
    usual = float(np.percentile(speeds, 99.5)) if len(speeds) else 0.0
    return max(usual, math.hypot(*run.current), 1e-6)


def panel_height(view: View, width: float) -> float:
    """Height [inch] of a figure of this width with one true-scale panel, labels included."""
    return (width - 0.75) * view.height / view.width + 0.75


def panel_grid(view: View, count: int, *, bar: bool = False) -> tuple[Figure, list[Axes]]:
    """Panels side by side, or one above the other where the view is much wider than high; axes are shared."""
    stacked = view.width > 1.3 * view.height and count > 1
    rows, columns = (count, 1) if stacked else (1, count)
    width = 6.4 if stacked else PAGE_WIDTH * min(1.0, 0.18 + 0.4 * count)
    room = 0.9 if bar else 0.0
    panel = (width - 0.6 - room) / columns
    height = rows * (panel * view.height / view.width + 0.3) + 0.45
    figure = new_figure(width, height)
    axes = figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)
    return figure, list(axes.flat)


def scene_words(run: RunFolder) -> str:
    """What else the picture holds besides floes."""
    words = []
    bounded = [structure.bounded for structure in run.outlines.values() if len(structure.outline)]
    if any(bounded):
        words.append("the structure in orange" if bounded.count(True) == 1 else "structures in orange")
    if not all(bounded):
        words.append("unbounded ones hatched on their solid side")
    sides = dict.fromkeys(SIDES.get(kind, kind) for kind in run.boundaries)
    words.append(f"the domain's sides {' and '.join(sides)}")
    if flows := run.flows:
        words.append(f"the arrow{'s give' if len(flows) > 1 else ' gives'} the {' and the '.join(flows)}")
    return "; ".join(words)


def time_words(snapshots: list[Snapshot]) -> str:
    times = [number(snapshot.time) for snapshot in snapshots]
    listed = times[0] if len(times) == 1 else ", ".join(times[:-1]) + " and " + times[-1]
    return f"t = {listed} s"


def drift_words(run: RunFolder) -> str:
    if "open" not in run.boundaries:
        return ""
    return f" Floes that left through an open side are followed for {DRIFT_SHOWN:g} domain lengths at most."

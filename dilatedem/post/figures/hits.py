"""One load event: its force at every step, and the floes that pushed at its peak."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Polygon

from dilatedem.post.figures.canvas import BLACK, BLUE, ICE, ICE_EDGE, SKY, VERMILION, WATER, Drawing, new_figure, styled
from dilatedem.post.figures.loads import with_end
from dilatedem.post.figures.plan import draw_structures
from dilatedem.post.labels import number
from dilatedem.post.loads import window_lengths
from dilatedem.post.read import RunFolder
from dilatedem.results.hits import KeptHit
from dilatedem.results.tables import Table

#: length of the longest arrow, and width of what is shown around the floes, as shares of the floes' extent
ARROW, MARGIN = 0.22, 0.12
#: m that are shown at least
LEAST_VIEW = 2.0
#: arrows of less than this share of the longest are dots
SHORTEST = 0.03
#: more floes are drawn without their numbers
NUMBERED = 25


@styled
def hit_figure(run: RunFolder, hit: KeptHit, place: int) -> Drawing:
    """A load event, the `place`-th highest of the run: force against time, and the chain of floes in plan."""
    figure = new_figure(8.2, 3.9)
    history, plan = figure.subplots(1, 2, width_ratios=(1.15, 1.0))
    _draw_force(history, hit, run.forces.get(hit.structure, {}))
    _draw_chain(plan, run, hit)
    figures, peak = hit.figures, number(hit.figures["peak_N"] / 1e3, 3)
    pressure, area = number(figures["pressure_Pa"] / 1e6, 3), number(figures["area_m2"], 3)
    caption = (
        f"Load event {place} by its height: {peak} kN on {hit.structure} at {number(figures['peak_time_s'], 6)} s. Left: "
        f"horizontal force at every step (red), and of the windows of forces.csv the highest step (shaded) and the mean (blue), kN "
        f"against ms from the peak. Right: {_who(hit)}, {hit.mode}, mean nominal pressure {pressure} MPa over {area} m²; arrows "
        f"end where floes press, towards the structure, their length is the horizontal force (a dot: next to nothing); m."
    )
    title = f"Load event {place}: {peak} kN on {hit.structure}"
    return Drawing(f"hit_{place:02d}", title, caption, figure)


def _who(hit: KeptHit) -> str:
    """Who pushed, in words."""
    leading, count = int(hit.figures["body"]), int(hit.figures["bodies"])
    if count == 1:
        return f"floe {leading} alone pushed"
    shown = "" if len(hit.floe) == count else f" (the nearest {len(hit.floe)} are shown)"
    return f"{count} floes pushed{shown}, led by floe {leading}"


def _draw_force(axes: Axes, hit: KeptHit, windows: Table) -> None:
    """Horizontal force against the time from the peak, at every step and window by window."""
    peak = hit.figures["peak_time_s"]
    if len(windows.get("time_s", ())):
        length = window_lengths(windows["time_s"])
        near = (windows["time_s"] > hit.time[0]) & (windows["time_s"] - length < hit.time[-1])
        if near.any():
            edges = 1e3 * (np.append(windows["time_s"][near] - length[near], windows["time_s"][near][-1]) - peak)
            mean = np.hypot(windows["fx_N"][near], windows["fy_N"][near])
            highest = {"color": SKY, "alpha": 0.45, "linewidth": 0.0, "label": "highest of a window"}
            axes.fill_between(edges, 0.0, with_end(windows["fh_max_N"][near]) / 1e3, step="post", **highest)
            axes.step(edges, with_end(mean) / 1e3, where="post", color=BLUE, linewidth=0.9, label="mean of a window")
    force = np.hypot(hit.force[:, 0], hit.force[:, 1])
    axes.plot(1e3 * (hit.time - peak), force / 1e3, color=VERMILION, linewidth=1.0, zorder=3, label="every step")
    axes.set_xlim(*(1e3 * (hit.time[[0, -1]] - peak)))
    axes.set_ylim(0.0, 1.18 * float(force.max()) / 1e3)
    axes.grid(True)
    axes.set_xlabel("Time from the peak (ms)")
    axes.set_ylabel("Horizontal force (kN)")
    axes.set_title(f"{hit.structure}, peak at {number(peak, 6)} s")
    axes.legend(loc="upper left", ncols=3, fontsize=7.5, handlelength=1.2, columnspacing=0.9, borderaxespad=0.2)


def _draw_chain(axes: Axes, run: RunFolder, hit: KeptHit) -> None:
    """The floes that pushed, where they were at the peak, and the forces between them."""
    reference = hit.contact_point[0, :2] if len(hit.contact_point) else hit.position[0, :2]
    outlines = [_outline(run, hit, k, reference) for k in range(len(hit.floe))]
    for floe, outline in zip(hit.floe, outlines, strict=True):
        axes.add_patch(Polygon(outline, facecolor=ICE, edgecolor=ICE_EDGE, linewidth=0.8, zorder=2))
        if len(outlines) <= NUMBERED:
            axes.annotate(str(floe), outline.mean(axis=0), ha="center", va="center", fontsize=7.0, color=ICE_EDGE, zorder=6)
    points = np.concatenate([*outlines, reference[None]])
    middle = 0.5 * (points.min(axis=0) + points.max(axis=0))
    extent = max(LEAST_VIEW, float(np.ptp(points, axis=0).max()))
    draw_structures(axes, run, hit.figures["peak_time_s"])
    _draw_arrows(axes, run, hit, reference, ARROW * extent)
    half = (0.5 + MARGIN) * extent
    axes.set_xlim(middle[0] - half, middle[0] + half)
    axes.set_ylim(middle[1] - half, middle[1] + half)
    axes.set_aspect("equal")
    axes.set_facecolor(WATER)
    axes.set_xlabel("x (m)")
    axes.set_ylabel("y (m)")
    count = int(hit.figures["bodies"])
    axes.set_title(f"{count} {'floe' if count == 1 else 'floes'} pushed")


def _outline(run: RunFolder, hit: KeptHit, k: int, reference: np.ndarray) -> np.ndarray:
    """(corners, 2) [m] of floe k of the event at its peak: that of t = 0, turned and moved; the image nearest to a reference."""
    floes = run.floes
    number_ = int(np.flatnonzero(floes.columns["body"] == hit.floe[k])[0])
    start = np.array([floes.columns["x0_m"][number_], floes.columns["y0_m"][number_]])
    sine, cosine = math.sin(hit.turned[k]), math.cos(hit.turned[k])
    turn = np.array([[cosine, sine], [-sine, cosine]])
    whole = int(np.flatnonzero(run.ice.columns["body"] == floes.columns.get("floe", floes.columns["body"])[number_])[0])
    return (run.ice.outlines[whole] - start) @ turn + _image(run, hit.position[k, :2], reference)


def _image(run: RunFolder, point: np.ndarray, reference: np.ndarray) -> np.ndarray:
    """The periodic image of a point (2,) [m] that is nearest to a reference."""
    period = [size if kind == "periodic" else math.inf for size, kind in zip(run.domain_size, run.boundaries, strict=True)]
    away = (point - reference) / period
    return point - np.where(np.isfinite(period), period, 0.0) * np.round(away)


def _draw_arrows(axes: Axes, run: RunFolder, hit: KeptHit, reference: np.ndarray, longest: float) -> None:
    """Contact forces as arrows that end at the contact, on the body that stands nearer to the structure."""
    order = {int(floe): k for k, floe in enumerate(hit.floe)}
    force = np.hypot(hit.contact_force[:, 0], hit.contact_force[:, 1])
    if not force.max(initial=0.0) > 0.0:
        return
    for (a, b), point, pushed, size in zip(hit.contact_body.tolist(), hit.contact_point, hit.contact_force, force, strict=True):
        # behind every floe stands what it pushes on; structures are never pushed on by others
        nearer = b if b < 0 or (a >= 0 and order.get(b, len(order)) < order.get(a, len(order))) else a
        end = _image(run, point[:2], reference)
        vector = (pushed if nearer == b else -pushed)[:2] * (longest / force.max())
        if size < SHORTEST * force.max():
            axes.plot(*end, ".", color=BLACK, markersize=3.0, zorder=7)
            continue
        look = {"arrowstyle": "-|>", "color": BLACK, "linewidth": 1.1, "shrinkA": 0.0, "shrinkB": 0.0, "mutation_scale": 8.0}
        axes.annotate("", xy=end, xytext=end - vector, arrowprops=look, zorder=7)

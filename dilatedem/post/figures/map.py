"""Where on a structure the load acts: around a pile (Liu 2015, Figs. 13, 18), and over its developed surface."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.ticker import MaxNLocator

from dilatedem.post.figures.canvas import BLACK, BLUE, SKY, VERMILION, Drawing, file_name, new_figure, styled
from dilatedem.post.labels import number
from dilatedem.post.loads import SENSE, angular_statistics, from_zero, mean_force_by_place, zero_words
from dilatedem.results.archive import LoadMap

DECADES = 2.0  # of the load map's colours, at most
#: colour of what is said about the ice and the current over a load map
MARK = "#5a2a00"


@styled
def load_around_figure(load_map: LoadMap, upstream: float | None) -> Drawing:
    """Mean force on each sector of an upright structure, in the directions of the plan view; angles from upstream.

    upstream: direction from which the current comes, degrees from +x; None in still water, where angles count from +x.
    """
    force = mean_force_by_place(load_map)
    divisor, unit = (1e3, "kN") if force.max(initial=0.0) >= 1e3 else (1.0, "N")
    force = force / divisor
    edges = np.radians(load_map.place_edges)
    figure = new_figure(5.4, 5.0)
    axes = figure.add_subplot(projection="polar")
    rings = MaxNLocator(4, steps=[1, 2, 2.5, 5, 10]).tick_values(0.0, float(force.max(initial=0.0)) or 1.0)
    sector = {"align": "edge", "color": BLUE, "edgecolor": "white", "linewidth": 0.4}
    axes.bar(edges[:-1], force, width=np.diff(edges), zorder=3, **sector)
    axes.set_ylim(0.0, 1.1 * rings[-1])
    rays = np.arange(-150, 181, 30)
    axes.set_thetagrids((rays + (upstream or 0.0)) % 360.0, labels=[f"{number(ray)}°" for ray in rays])
    axes.tick_params(axis="x", pad=4)
    axes.set_rlabel_position((upstream or 0.0) + (75.0 if upstream is None else -105.0))
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
    width = f"sector of {sector_words(load_map)}"
    figure.suptitle(f"Mean load on {load_map.structure} per {width} ({unit})", fontsize=9.5)
    figure.supxlabel(f"0° = {zero_words(upstream)}; angles {SENSE}", fontsize=9.0)
    caption = (
        f"Mean normal ice load around {load_map.structure} over {number(load_map.duration)} s, {unit} on each {width}, by the "
        f"place of contact, in the directions of the plan view: 0° is {zero_words(upstream)}, angles run {SENSE}.{words} Sum of "
        f"all sectors: {number(float(force.sum()), 3)} {unit}."
    )
    name = f"load_around_{file_name(load_map.structure)}"
    return Drawing(name, f"Load around {load_map.structure}", caption, figure)


def sector_words(load_map: LoadMap) -> str:
    """Width of a bin of the first axis, with its unit."""
    width = float(np.diff(load_map.place_edges).mean())
    return f"{number(width, 3)}°" if load_map.place == "angle" else f"{number(width, 3)} m"


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
def load_map_figure(
    load_map: LoadMap, upstream: float | None, *, afloat: tuple[float, float] | None = None, outline: np.ndarray | None = None
) -> Drawing | None:
    """Impulse in each bin of the developed surface: around (or along) and over height, where any ice touched.

    upstream: as above; afloat: draft and freeboard [m] of the floes, to be marked; outline (k, 2) [m]: of a structure whose first
    axis runs around it, to mark the upstream direction there.
    """
    if not load_map.impulse.any() or not load_map.duration > 0.0:
        return None
    edges, impulse = load_map.place_edges, load_map.impulse
    around = load_map.place == "angle"
    if around and upstream is not None:
        edges, impulse = seen_from(upstream, edges, impulse)
    divisor, unit = (1e3, "kN s") if impulse.max() >= 1e3 else (1.0, "N s")
    figure = new_figure(7.4, 3.5)
    axes = figure.add_subplot()
    # One floe that leans on the pile for a minute outweighs all passing hits: their traces need a log scale, but a short one.
    shown, top = np.ma.masked_less_equal(impulse.T / divisor, 0.0), float(impulse.max()) / divisor
    scale = {"cmap": "viridis_r", "norm": LogNorm(top / 10.0**DECADES, top), "rasterized": True}
    mesh = axes.pcolormesh(edges, load_map.height_edges, shown, **scale)
    below = bool((shown < top / 10.0**DECADES).any())
    bar = figure.colorbar(mesh, ax=axes, pad=0.015, extend="min" if below else "neither")
    bar.set_label(f"Impulse per bin ({unit})")
    rows = np.flatnonzero(load_map.impulse.any(axis=0))
    low, high = load_map.height_edges[rows[0]], load_map.height_edges[rows[-1] + 1]
    if afloat:
        low, high = min(low, -afloat[0]), max(high, afloat[1])
    axes.set_ylim(low - 0.12 * (high - low), high + 0.12 * (high - low))
    axes.set_xlim(edges[0], edges[-1])
    mark_heights(axes, afloat)
    axes.set_ylabel("Height above water (m)")
    place = upstream_place(load_map, upstream, outline)
    if around:
        axes.set_xticks(range(-180, 181, 45))
        axes.set_xlabel(f"Angle (°): 0 = {zero_words(upstream)}; {SENSE}")
        place = None if upstream is None else 0.0
    else:
        axes.set_xlabel(f"{load_map.label or 'Distance'} (m)")
    if place is not None:
        axes.axvline(place, color=MARK, linewidth=0.8, linestyle=(0, (1, 1.5)))
        axes.text(place, 1.01, "upstream", transform=axes.get_xaxis_transform(), ha="center", va="bottom", color=MARK)
    elif (side := upstream_side(load_map, upstream)) is not None:
        where = {"ha": "right", "x": 1.0, "s": "upstream →"} if side > 0.0 else {"ha": "left", "x": 0.0, "s": "← upstream"}
        axes.text(y=1.01, transform=axes.transAxes, va="bottom", color=MARK, **where)
    height = float(np.diff(load_map.height_edges).mean())
    bins = f"{sector_words(load_map)} by {number(1e3 * height, 3)} mm"
    caption = (
        f"Where the ice pressed on {load_map.structure}: normal impulse ({unit}) in each bin of {bins} of the developed surface, "
        f"summed over {number(load_map.duration)} s; log scale of {number(DECADES, 1)} decades, less than that in its lightest "
        "colour; white: never touched. A contact counts with its whole force in the bin that holds its one point of application: "
        f"sums over bins mean something, an impulse over the area of a bin does not.{height_words(afloat)}"
    )
    name = f"load_map_{file_name(load_map.structure)}"
    return Drawing(name, f"Load map of {load_map.structure}", caption, figure)


def mark_heights(axes: Axes, afloat: tuple[float, float] | None) -> None:
    """The water level, and how deep and how high floes float."""
    axes.axhline(0.0, color=BLACK, linewidth=0.8, linestyle=(0, (6, 3)))
    label = {"transform": axes.get_yaxis_transform(), "ha": "right", "fontsize": 7.5, "zorder": 6}
    label["bbox"] = {"facecolor": "white", "edgecolor": "none", "alpha": 0.75, "pad": 0.8}
    for height, words in zip((-afloat[0], afloat[1]), ("draft", "freeboard"), strict=True) if afloat else ():
        axes.axhline(height, color=VERMILION, linewidth=0.8, linestyle=(0, (3, 2)))
        axes.text(0.995, height, words, color=MARK, va="top" if height < 0.0 else "bottom", **label)


def height_words(afloat: tuple[float, float] | None) -> str:
    """What the horizontal lines are."""
    if not afloat:
        return " Dashed: z = 0."
    draft, freeboard = (number(value, 3) for value in afloat)
    return f" Dashed: still water (black); draft, {draft} m, and freeboard, {freeboard} m, of floes of the case's thickness (red)."


def upstream_place(load_map: LoadMap, upstream: float | None, outline: np.ndarray | None) -> float | None:
    """Where on an axis around an outline (k, 2) [m] the upstream direction meets it [m]; None for any other axis."""
    centre = load_map.attributes.get("center_m")
    if upstream is None or outline is None or not len(outline) or centre is None or "axis" in load_map.attributes:
        return None
    direction = np.array([math.cos(math.radians(upstream)), math.sin(math.radians(upstream))])
    corners = np.asarray(outline) - np.asarray(centre)[:2]
    passed = 0.0
    for start, end in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        side = end - start
        turn = direction[0] * side[1] - direction[1] * side[0]
        length = float(np.hypot(*side))
        if abs(turn) > 1e-12 * length:
            along = (direction[1] * start[0] - direction[0] * start[1]) / turn
            ahead = (start[0] * side[1] - start[1] * side[0]) / turn
            if 0.0 <= along <= 1.0 and ahead > 0.0:
                return passed + float(along) * length
        passed += length
    return None


def upstream_side(load_map: LoadMap, upstream: float | None) -> float | None:
    """+1 or -1: the end of an axis along a line at which the current comes; None across it, and for any other axis."""
    axis = load_map.attributes.get("axis")
    if upstream is None or axis is None:
        return None
    along = math.cos(math.radians(upstream)) * float(axis[0]) + math.sin(math.radians(upstream)) * float(axis[1])
    return math.copysign(1.0, along) if abs(along) > 1e-6 else None


def seen_from(origin: float, edges: np.ndarray, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Sectors around a pile, edges (n + 1,) and values (n, ...), ordered by the angle from `origin` [deg]."""
    start = from_zero(edges[:-1], origin)
    order = np.argsort(start)
    width = np.diff(edges)[order]
    return np.append(start[order], start[order][-1] + width[-1]), values[order]

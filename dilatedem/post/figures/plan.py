"""The scene seen from above, true to scale: floes, structures, domain and current."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.patches import Polygon, Rectangle
from matplotlib.ticker import MaxNLocator

from dilatedem.post.figures.canvas import BLACK, STRUCTURE, STRUCTURE_EDGE
from dilatedem.post.read import RunFolder

DRIFT_SHOWN = 0.5  # domain lengths that floes are followed beyond an open side
MARGIN = 0.02  # of the domain's larger side, around everything
RASTER_FLOES = 2000  # more floes are drawn as pixels also in an SVG, which would grow to many megabytes
SIDE_STYLE = {"periodic": (0, (6, 3)), "open": (0, (1, 2)), "outflow": (0, (1, 2)), "inflow": (0, (1, 2)), "wall": "solid"}


@dataclass(frozen=True)
class View:
    """The part of the plane that is drawn [m]."""

    x: tuple[float, float]
    y: tuple[float, float]

    @property
    def width(self) -> float:
        return self.x[1] - self.x[0]

    @property
    def height(self) -> float:
        return self.y[1] - self.y[0]


def domain_limits(run: RunFolder) -> tuple[tuple[float, float], tuple[float, float]]:
    """((x_low, x_high), (y_low, y_high)) [m]."""
    lx, ly = run.domain_size
    return (-lx / 2.0, lx / 2.0), (-ly / 2.0, ly / 2.0)


def drawn_limits(run: RunFolder, view: View) -> tuple[tuple[float, float], tuple[float, float]]:
    """((x_low, x_high), (y_low, y_high)) [m] of what is drawn: the view; the domain along a periodic axis."""
    limits = domain_limits(run)
    x = limits[0] if run.boundaries[0] == "periodic" else view.x
    y = limits[1] if run.boundaries[1] == "periodic" else view.y
    return x, y


def choose_view(run: RunFolder, fields: list[list[np.ndarray]], times: Sequence[float] = (0.0,)) -> View:
    """The domain, and beyond its open sides as far as the floes of these fields went, up to DRIFT_SHOWN, and the structures."""
    limits = [list(axis) for axis in domain_limits(run)]
    points = [outline for outlines in fields for outline in outlines if len(outline) > 2]
    stacked = np.concatenate(points) if points else np.zeros((1, 2))
    for axis, (low, high) in enumerate(domain_limits(run)):
        if run.boundaries[axis] == "periodic":
            continue
        reach = DRIFT_SHOWN * (high - low)
        limits[axis][0] = max(low - reach, min(low, float(stacked[:, axis].min())))
        limits[axis][1] = min(high + reach, max(high, float(stacked[:, axis].max())))
        for structure in (structure for time in times for structure in run.outlines_at(time).values()):
            if structure.bounded and len(structure.outline):
                places = structure.outline[:, axis]
                limits[axis] = [min(limits[axis][0], float(places.min())), max(limits[axis][1], float(places.max()))]
    margin = MARGIN * max(run.domain_size)
    return View((limits[0][0] - margin, limits[0][1] + margin), (limits[1][0] - margin, limits[1][1] + margin))


def periodic_copies(run: RunFolder, outlines: list[np.ndarray]) -> tuple[list[np.ndarray], np.ndarray]:
    """Outlines and, for those that stick out across a periodic side, their images on the other side.

    Returns the outlines to draw and, for each, the index of the floe it belongs to.
    """
    drawn = list(outlines)
    owner = list(range(len(outlines)))
    for axis, (low, high) in enumerate(domain_limits(run)):
        if run.boundaries[axis] != "periodic":
            continue
        shift = np.zeros(2)
        shift[axis] = high - low
        for outline, floe in list(zip(drawn, owner, strict=True)):
            if outline[:, axis].max() > high:
                drawn.append(outline - shift)
                owner.append(floe)
            if outline[:, axis].min() < low:
                drawn.append(outline + shift)
                owner.append(floe)
    return drawn, np.array(owner, dtype=np.int64)


def draw_floes(axes: Axes, run: RunFolder, view: View, outlines: list[np.ndarray], **appearance) -> PolyCollection:
    """Add the floes and their periodic images; `array` in `appearance` is a value per floe to be coloured."""
    drawn, owner = periodic_copies(run, outlines)
    for name in ("array", "facecolors"):
        if name in appearance and len(appearance[name]) == len(outlines):
            appearance[name] = np.asarray(appearance[name])[owner]
    floes = PolyCollection(drawn, zorder=2, rasterized=len(drawn) > RASTER_FLOES, **appearance)
    axes.add_collection(floes, autolim=False)
    # Across a periodic side the floe goes on at the other side, so it is cut there.
    (x_low, x_high), (y_low, y_high) = drawn_limits(run, view)
    floes.set_clip_path(Rectangle((x_low, y_low), x_high - x_low, y_high - y_low, transform=axes.transData))
    return floes


def draw_domain(axes: Axes, run: RunFolder) -> None:
    """The domain's sides: dashed where periodic, dotted where open, a full line where a wall."""
    (x_low, x_high), (y_low, y_high) = domain_limits(run)
    for axis, sides in enumerate((((x_low, x_low), (x_high, x_high)), ((y_low, y_low), (y_high, y_high)))):
        kind = run.boundaries[axis]
        line = {
            "color": BLACK,
            "linewidth": 1.6 if kind == "wall" else 0.9,
            "linestyle": SIDE_STYLE.get(kind, "solid"),
        }
        for side in sides:
            along = (y_low, y_high) if axis == 0 else (x_low, x_high)
            x, y = (side, along) if axis == 0 else (along, side)
            axes.plot(x, y, zorder=3, scalex=False, scaley=False, **line)


def draw_structures(axes: Axes, run: RunFolder, time: float = 0.0) -> None:
    """Structures filled, where they are at a time [s]; unbounded ones as the line of their face, hatched on the solid side."""
    for structure in run.outlines_at(time).values():
        outline = structure.outline
        if not len(outline):
            continue
        if structure.bounded:
            style = {"facecolor": STRUCTURE, "edgecolor": STRUCTURE_EDGE, "linewidth": 0.9, "zorder": 4}
            axes.add_patch(Polygon(outline, **style))
            continue
        style = {"facecolor": "none", "edgecolor": STRUCTURE, "hatch": "////", "linewidth": 0.0, "zorder": 4}
        axes.add_patch(Polygon(outline, **style))
        axes.plot(*outline[:2].T, color=STRUCTURE_EDGE, linewidth=1.4, zorder=4, scalex=False, scaley=False)


def draw_flows(axes: Axes, run: RunFolder) -> None:
    """Speed and direction of the current and of the wind, above the upper right corner of the axes."""
    height = 12.0
    for what, (u, v) in run.flows.items():
        corner = {"xy": (1.0, 1.0), "xycoords": "axes fraction", "textcoords": "offset points", "va": "center"}
        arrow = {"fontsize": 17.0, "ha": "center", "rotation": math.degrees(math.atan2(v, u))}
        axes.annotate("\N{LONG RIGHTWARDS ARROW}", xytext=(-13.0, height), **arrow, **corner)
        axes.annotate(f"{what} {math.hypot(u, v):.3g} m/s", xytext=(-30.0, height - 1.0), ha="right", **corner)
        height += 19.0


def dress(axes: Axes, run: RunFolder, view: View, *, water: str | None = None) -> None:
    """Limits, true scale, labels; water of this colour, which ends at periodic sides."""
    axes.set_xlim(*view.x)
    axes.set_ylim(*view.y)
    axes.set_aspect("equal")
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(MaxNLocator(nbins=7, steps=[1, 2, 5, 10]))
    axes.set_xlabel("x (m)")
    axes.set_ylabel("y (m)")
    axes.label_outer()
    if water is not None:
        (x_low, x_high), (y_low, y_high) = drawn_limits(run, view)
        axes.add_patch(Rectangle((x_low, y_low), x_high - x_low, y_high - y_low, color=water, linewidth=0, zorder=0))

"""The figure over ice speeds (Fig. 14): the same fields at every speed, counted by drift."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullLocator

from dilatedem.post.figures.canvas import new_figure, styled
from validation.liu2015.figures import APART, COLOUR, MARKER
from validation.liu2015.measures import EQUAL_DRIFT, Ensemble
from validation.liu2015.plan import MODELS
from validation.liu2015.similarity import BREAK, Likeness, likeness
from validation.liu2015.statistics import Band, band, gumbel

#: m/s; highest forces of a field at other speeds are drawn over that at this one
REFERENCE_SPEED = 0.3


@styled
def force_by_speed(ensemble: Ensemble) -> Figure | None:
    """Highest force, mean force, likeness of the fields' highest forces, exponent from speed to speed."""
    found = {model: like for model in MODELS if (like := likeness(ensemble, model)) is not None}
    if not found:
        return None
    figure = new_figure(9.4, 7.2)
    panels = figure.subplots(2, 2)
    for model, like in found.items():
        draw_highest(panels[0, 0], model, like)
        draw_mean(panels[0, 1], model, like)
        draw_likeness(panels[1, 0], model, like)
        draw_exponents(panels[1, 1], model, like)
    first = f"first {EQUAL_DRIFT:g} m of drift"
    for axes, label, title in (
        (panels[0, 0], "Highest horizontal force (kN)", f"Highest force, {first}; thick: Gumbel's location"),
        (panels[0, 1], "Mean force along x (kN)", f"Mean force, {first}; thick: mean"),
    ):
        log_speeds(axes, next(iter(found.values())).speeds)
        axes.set_ylabel(label)
        axes.set_title(title)
    speed = np.array([0.3, 1.0])
    level = 1.6 * max(float((like.mean[:, -1] / like.speeds[-1] ** 2).mean()) for like in found.values()) / 1e3
    panels[0, 1].plot(speed, level * speed**2, "k--", linewidth=0.9, label="v²")
    panels[0, 1].legend(loc="lower right")
    dress_likeness(panels[1, 0])
    panels[1, 1].axvline(BREAK, color="0.4", linestyle=":", linewidth=1.0)
    place = {"xy": (BREAK, 0.02), "xycoords": ("data", "axes fraction"), "ha": "right"}
    panels[1, 1].annotate(f"the paper's break: {BREAK:g} m/s ", color="0.3", fontsize=8.0, **place)
    panels[1, 1].set_title("Exponent between a speed and the next")
    panels[1, 1].set_xlabel("Ice speed (m/s)")
    panels[1, 1].set_ylabel("n of F ~ v^n, highest force")
    panels[1, 1].set_xlim(0.0, 1.05)
    panels[1, 1].grid(True)
    figure.legend(*panels[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=2)
    return figure


def log_speeds(axes: Axes, speeds: np.ndarray) -> None:
    axes.set_xscale("log")
    axes.set_yscale("log")
    # 0.9 and 1 would run into each other
    axes.set_xticks(speeds, ["" if speed == 0.9 else f"{speed:g}" for speed in speeds])
    axes.xaxis.set_minor_locator(NullLocator())
    axes.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axes.yaxis.set_major_formatter("{x:g}")
    axes.yaxis.set_minor_locator(NullLocator())
    axes.set_xlabel("Ice speed (m/s)")
    axes.grid(True)


def draw_highest(axes: Axes, model: str, like: Likeness) -> None:
    """A line a field, and Gumbel's location with its band."""
    axes.plot(like.speeds, like.highest.T / 1e3, color=COLOUR[model], alpha=0.35, linewidth=0.8, zorder=2)
    bands = [gumbel(forces).location for forces in like.highest.T]
    label = f"{model}: thin: a field each (n = {like.fields}); thick: all, with 95 % band"
    draw_bands(axes, like.speeds, bands, model, label)


def draw_mean(axes: Axes, model: str, like: Likeness) -> None:
    place = like.speeds * (1.0 + APART[model])
    axes.plot(place, like.mean.T / 1e3, color=COLOUR[model], alpha=0.3, linewidth=0.8, zorder=2)
    draw_bands(axes, place, [band(forces) for forces in like.mean.T], model, None)


def draw_bands(axes: Axes, place: np.ndarray, bands: list[Band], model: str, label: str | None) -> None:
    """Estimates [N] and their bands, in kN."""
    low, high = np.array([one.low for one in bands]) / 1e3, np.array([one.high for one in bands]) / 1e3
    axes.fill_between(place, low, high, color=COLOUR[model], alpha=0.18, linewidth=0, zorder=1)
    look = {"color": COLOUR[model], "marker": MARKER[model], "markeredgecolor": "white", "zorder": 3}
    axes.plot(place, [one.value / 1e3 for one in bands], label=label, **look)


def draw_likeness(axes: Axes, model: str, like: Likeness) -> None:
    """Highest force of a field over its geometric mean of all fields: at each speed against that at REFERENCE_SPEED."""
    relative = np.exp(np.log(like.highest) - np.log(like.highest).mean(axis=0))
    base = int(np.argmin(np.abs(like.speeds - REFERENCE_SPEED)))
    for column in range(len(like.speeds)):
        if column != base:
            look = {"color": COLOUR[model], "alpha": 0.55, "ms": 4.0, "mew": 0}
            axes.plot(relative[:, base], relative[:, column], MARKER[model], **look)


def dress_likeness(axes: Axes) -> None:
    axes.set_xscale("log")
    axes.set_yscale("log")
    low, high = min(axes.get_xlim()[0], axes.get_ylim()[0]), max(axes.get_xlim()[1], axes.get_ylim()[1])
    axes.plot([low, high], [low, high], "k--", linewidth=0.9, zorder=1)
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(LogLocator(subs=(1.0, 1.5, 2.0, 3.0, 5.0, 7.0)))
        axis.set_major_formatter("{x:g}")
        axis.set_minor_locator(NullLocator())
    axes.set_xlim(low, high)
    axes.set_ylim(low, high)
    axes.set_title("The same fields, speed against speed")
    axes.set_xlabel(f"Highest force of a field over that of all (geometric mean), {REFERENCE_SPEED:g} m/s")
    axes.set_ylabel("The same at each other speed")
    axes.grid(True)


def draw_exponents(axes: Axes, model: str, like: Likeness) -> None:
    middle = np.sqrt(like.speeds[:-1] * like.speeds[1:]) + APART[model]
    low, high = np.array([one.low for one in like.local]), np.array([one.high for one in like.local])
    value = np.array([one.value for one in like.local])
    axes.axhspan(like.exponent.low, like.exponent.high, color=COLOUR[model], alpha=0.15, linewidth=0)
    look = {"color": COLOUR[model], "marker": MARKER[model], "linestyle": "none", "capsize": 3.0, "zorder": 3}
    axes.errorbar(middle, value, yerr=[value - low, high - value], **look)

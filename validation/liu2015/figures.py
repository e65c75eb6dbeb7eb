"""Figures of the loads at one speed: in time (Figs. 12, 15), around the pile (Figs. 13, 18), by floe size."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from dilatedem.post.figures.canvas import BLUE, PNG_DPI, SKY, VERMILION, new_figure, styled
from dilatedem.post.figures.loads import COLUMNS_DRAWN, draw_force, mark_extreme
from validation.liu2015.measures import FIRST_HITS, PILE, Ensemble, Result
from validation.liu2015.plan import CASES, LARGE, MODELS, SIZE_SPEED, SMALL
from validation.liu2015.statistics import FEWEST, band, gumbel

COLOUR = {"liu2015": BLUE, "consistent": VERMILION}
MARKER = {"liu2015": "o", "consistent": "s"}
#: so far apart the models stand at one speed, m/s, and at one size, as a share of the distance between the sizes
APART = {"liu2015": -0.008, "consistent": 0.008}
SHOWN_SEED = 1
#: sectors of the load map joined into one
SECTORS_JOINED = 2


def save(figure: Figure | None, path: Path) -> list[str]:
    """Write a figure, if there is one; returns its name, for the page that shows it."""
    if figure is None:
        path.unlink(missing_ok=True)
        return []
    figure.savefig(path, dpi=PNG_DPI, metadata={"Software": None}, bbox_inches="tight", pad_inches=0.06)
    return [path.name]


def count_words(counts: list[int]) -> str:
    low, high = min(counts), max(counts)
    return f"n = {low}" if low == high else f"n = {low} to {high}"


def shown_run(ensemble: Ensemble, model: str, size: str) -> Result | None:
    """The run whose history and ice are drawn."""
    found = [result for result in ensemble.chosen(model, size, SIZE_SPEED) if result.run.seed == SHOWN_SEED]
    return found[0] if found else None


@styled
def force_history(ensemble: Ensemble, size: str) -> Figure | None:
    """Force along x and y of one seed, a column a model."""
    chosen = [run for run in (shown_run(ensemble, model, size) for model in MODELS) if run is not None]
    if not chosen:
        return None
    figure = new_figure(4.6 * len(chosen) + 1.2, 4.6)
    panels = figure.subplots(2, len(chosen), sharex=True, sharey="row", squeeze=False)
    for column, result in enumerate(chosen):
        history = result.folder.forces[PILE]
        joined = max(1, math.ceil(len(history["time_s"]) / COLUMNS_DRAWN))
        for row, axis in enumerate(("x", "y")):
            draw_force(panels[row, column], history, axis, joined)
            mark_extreme(panels[row, column], history, axis)
            panels[row, 0].set_ylabel(f"Force along {axis} (kN)")
        panels[0, column].set_title(f"{result.run.model}, floes of {size} m, {SIZE_SPEED:g} m/s, seed {SHOWN_SEED}")
        panels[1, column].set_xlabel("Time (s)")
    figure.legend(*panels[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=2)
    return figure


@styled
def load_around(ensemble: Ensemble) -> Figure | None:
    """Line load around the pile, mean over the seeds with its band; a row a size, a column a model."""
    models = [model for model in MODELS if any(ensemble.chosen(model, size, SIZE_SPEED) for size in CASES)]
    if not models:
        return None
    figure = new_figure(4.3 * len(models) + 0.2, 8.6)
    panels = figure.subplots(2, len(models), squeeze=False, subplot_kw={"projection": "polar"})
    for row, size in zip(panels, CASES, strict=True):
        tops = [draw_around(axes, ensemble.chosen(model, size, SIZE_SPEED), model) for axes, model in zip(row, models, strict=True)]
        for axes, model in zip(row, models, strict=True):
            dress_polar(axes, max(tops))
            axes.set_title(f"{model}, {size} m, n = {len(ensemble.chosen(model, size, SIZE_SPEED))}", loc="center", pad=12)
    figure.supxlabel("Mean normal load (kN per metre of circumference) by place of contact", fontsize=9.0)
    return figure


def draw_around(axes: Axes, found: list[Result], model: str) -> float:
    """Mean over these runs and its band; returns how far out [kN/m] is worth showing."""
    if not found:
        return 0.0
    loads = np.array([result.load_around for result in found]) / 1e3
    loads = loads.reshape(len(found), -1, SECTORS_JOINED).mean(axis=2)
    edges = np.radians(found[0].angle_edges[::SECTORS_JOINED])
    bands = [band(column) for column in loads.T]
    axes.stairs([one.value for one in bands], edges, color=COLOUR[model], linewidth=1.2, zorder=3)
    mean = max(one.value for one in bands)
    if len(found) < FEWEST:
        return mean
    low, high = [one.low for one in bands], [one.high for one in bands]
    axes.stairs(high, edges, baseline=low, fill=True, color=COLOUR[model], alpha=0.25, zorder=2)
    return min(max(high), 2.0 * mean)


def dress_polar(axes: Axes, top: float) -> None:
    """The upstream half shaded; directions as in the plan view, angles counter-clockwise from upstream as everywhere."""
    rings = MaxNLocator(4, steps=[1, 2, 2.5, 5, 10]).tick_values(0.0, top or 1.0)
    axes.set_ylim(0.0, rings[-1])
    axes.fill_between(np.radians(np.linspace(90.0, 270.0, 91)), 0.0, rings[-1], color=SKY, alpha=0.16, linewidth=0, zorder=0)
    axes.set_thetagrids(range(0, 360, 45), labels=["±180°", "−135°", "−90°", "−45°", "0°", "45°", "90°", "135°"])
    axes.set_rticks(rings[1:-1])
    axes.set_rlabel_position(22.5)
    axes.text(np.pi, 1.02 * rings[-1], "upstream\n\n", ha="right", va="center", fontsize=8.0)
    axes.set_axisbelow(True)


@styled
def force_by_size(ensemble: Ensemble) -> Figure | None:
    """What the paper says of smaller floes: the first hits, the highest force, how steady it is. A dot a field."""
    models = [model for model in MODELS if all(ensemble.chosen(model, size, SIZE_SPEED) for size in (LARGE, SMALL))]
    if not models:
        return None
    shown = (
        ("fh_max_first_hits_N", f"Highest force, first {FIRST_HITS:g} s (kN)", lambda values: gumbel(values).location),
        ("fh_max_N", "Highest force, whole run (kN)", lambda values: gumbel(values).location),
        ("fluctuation_first_hits_N", f"Fluctuation of Fx, first {FIRST_HITS:g} s (kN)", band),
    )
    figure = new_figure(9.4, 3.7)
    panels = figure.subplots(1, len(shown))
    for axes, (name, label, estimate) in zip(panels, shown, strict=True):
        counts = []
        for model in models:
            bands = []
            for place, size in enumerate((LARGE, SMALL)):
                value = np.array(list(ensemble.of(name, model, size, SIZE_SPEED).values())) / 1e3
                at = np.full(len(value), place + 12.0 * APART[model])
                axes.plot(at, value, "o", color=COLOUR[model], alpha=0.4, ms=3.5, mew=0, zorder=2)
                bands.append(estimate(value))
            counts += [one.n for one in bands]
            place = np.arange(2) + 6.0 * APART[model]
            error = [[one.value - one.low for one in bands], [one.high - one.value for one in bands]]
            look = {"color": COLOUR[model], "marker": MARKER[model], "capsize": 3.0, "label": model, "zorder": 3}
            axes.errorbar(place, [one.value for one in bands], yerr=error, **look)
        axes.set_xticks([0, 1], [f"{LARGE} m", f"{SMALL} m"])
        axes.set_xlim(-0.4, 1.4)
        axes.set_ylim(bottom=0.0)
        axes.set_xlabel(f"Mean floe size ({count_words(counts)})")
        axes.set_ylabel(label)
        axes.set_title("mean, 95 % band" if estimate is band else "Gumbel's location, 95 % band")
        axes.grid(True, axis="y")
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=2)
    return figure

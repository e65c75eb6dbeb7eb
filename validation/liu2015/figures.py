"""Figures of the loads: over ice speed (Fig. 14), in time (Figs. 12, 15), around the pile (Figs. 13, 18), by floe size."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, MaxNLocator

from dilatedem.post.canvas import BLUE, PNG_DPI, SKY, VERMILION, new_figure, styled
from dilatedem.post.figures_loads import COLUMNS_DRAWN, draw_force, mark_extreme
from validation.liu2015.measures import EQUAL_DRIFT, FIRST_HITS, PASSING_DRIFT, PILE, Ensemble, Result
from validation.liu2015.plan import CASES, LARGE, MODELS, SIZE_SPEED, SMALL
from validation.liu2015.statistics import FEWEST, Band, mean_band

COLOUR = {"liu2015": BLUE, "consistent": VERMILION}
MARKER = {"liu2015": "o", "consistent": "s"}
#: so far apart the models stand at one speed, m/s, and at one size, as a share of the distance between the sizes
APART = {"liu2015": -0.008, "consistent": 0.008}
SHOWN_SEED = 1
#: a band reaches out of the picture beyond so many times the highest seed: with two seeds it is twelve times their spread
BAND_ROOM = 1.5
#: sectors of the load map joined into one
SECTORS_JOINED = 2


def save(figure: Figure | None, path: Path) -> list[str]:
    """Write a figure, if there is one; returns its name, for the page that shows it."""
    if figure is None:
        path.unlink(missing_ok=True)
        return []
    figure.savefig(path, dpi=PNG_DPI, metadata={"Software": None}, bbox_inches="tight", pad_inches=0.06)
    return [path.name]


@styled
def force_by_speed(ensemble: Ensemble) -> Figure | None:
    """Highest and mean force against ice speed, each seed a dot, the mean with its band."""
    models = [model for model in MODELS if len(ensemble.speeds(model, LARGE)) > 1]
    if not models:
        return None
    figure = new_figure(8.6, 6.6)
    panels = figure.subplots(2, 2)
    shown = (
        (panels[0, 0], "fh_max_N", "Highest horizontal force (kN)", "over the whole run, as in the paper's Fig. 14"),
        (panels[1, 0], "fh_max_equal_drift_N", "Highest horizontal force (kN)", f"over the first {EQUAL_DRIFT:g} m of drift"),
        (panels[1, 1], "fx_mean_passing_N", "Mean force along x (kN)", f"over the first {PASSING_DRIFT:g} m of drift"),
        (panels[0, 1], "fh_max_N", "Highest horizontal force (kN)", "the same, both axes logarithmic"),
    )
    for axes in panels[:1, 1]:
        axes.set_xscale("log")
        axes.set_yscale("log")
    for axes, name, label, title in shown:
        seeds = np.concatenate([draw_speeds(axes, ensemble, model, name) for model in models])
        low, high = axes.get_ylim()
        axes.set_ylim(max(low, seeds.min() / BAND_ROOM) if axes.get_yscale() == "log" else 0.0, min(high, BAND_ROOM * seeds.max()))
        axes.set_ylabel(label)
        axes.set_title(title)
        axes.grid(True)
    for axes in panels.flat:
        axes.set_xlabel("Ice speed (m/s)")
        if axes.get_yscale() == "linear":
            axes.set_xlim(left=0.0)
    speeds = sorted({speed for model in models for speed in ensemble.speeds(model, LARGE)})
    # 0.9 and 1 would run into each other
    panels[0, 1].set_xticks(speeds, ["" if speed == 0.9 else f"{speed:g}" for speed in speeds])
    panels[0, 1].minorticks_off()
    panels[0, 1].yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    panels[0, 1].yaxis.set_major_formatter("{x:g}")
    figure.legend(*panels[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=2)
    return figure


def draw_speeds(axes: Axes, ensemble: Ensemble, model: str, name: str) -> np.ndarray:
    """Seeds, mean and band of one model; returns the values of all seeds [kN]."""
    speeds = ensemble.speeds(model, LARGE)
    values = [np.array(list(ensemble.of(name, model, LARGE, speed).values())) / 1e3 for speed in speeds]
    bands = [mean_band(value) for value in values]
    place = np.array(speeds)
    for at, value in zip(place, values, strict=True):
        beside = at * (1.0 + 2.0 * APART[model]) if axes.get_xscale() == "log" else at + APART[model]
        axes.plot(np.full(len(value), beside), value, "o", color=COLOUR[model], alpha=0.4, ms=3.5, mew=0, zorder=2)
    label = f"{model}: mean, 95 % band of the mean; dots: seeds ({count_words([band.n for band in bands])} a speed)"
    draw_bands(axes, place, bands, model, label)
    return np.concatenate(values)


def draw_bands(axes: Axes, place: np.ndarray, bands: list[Band], model: str, label: str) -> None:
    low, high = np.array([band.low for band in bands]), np.array([band.high for band in bands])
    positive = np.maximum(low, 1e-3) if axes.get_yscale() == "log" else low
    axes.fill_between(place, positive, high, color=COLOUR[model], alpha=0.18, linewidth=0, zorder=1)
    look = {"color": COLOUR[model], "marker": MARKER[model], "markeredgecolor": "white", "zorder": 3}
    axes.plot(place, [band.value for band in bands], label=label, **look)


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
    bands = [mean_band(column) for column in loads.T]
    axes.stairs([band.value for band in bands], edges, color=COLOUR[model], linewidth=1.2, zorder=3)
    mean = max(band.value for band in bands)
    if len(found) < FEWEST:
        return mean
    low, high = [max(band.low, 0.0) for band in bands], [band.high for band in bands]
    axes.stairs(high, edges, baseline=low, fill=True, color=COLOUR[model], alpha=0.25, zorder=2)
    return min(max(high), 2.0 * mean)


def dress_polar(axes: Axes, top: float) -> None:
    """The upstream half shaded, angles as in the plan view."""
    rings = MaxNLocator(4, steps=[1, 2, 2.5, 5, 10]).tick_values(0.0, top or 1.0)
    axes.set_ylim(0.0, rings[-1])
    axes.fill_between(np.radians(np.linspace(90.0, 270.0, 91)), 0.0, rings[-1], color=SKY, alpha=0.16, linewidth=0, zorder=0)
    axes.set_thetagrids(range(0, 360, 45), labels=["0°", "45°", "90°", "135°", "±180°", "−135°", "−90°", "−45°"])
    axes.set_rticks(rings[1:-1])
    axes.set_rlabel_position(22.5)
    axes.text(np.pi, 1.02 * rings[-1], "upstream\n\n", ha="right", va="center", fontsize=8.0)
    axes.set_axisbelow(True)


@styled
def force_by_size(ensemble: Ensemble) -> Figure | None:
    """What the paper says of smaller floes: the first hits, the highest force, how steady it is. A dot a seed."""
    models = [model for model in MODELS if all(ensemble.chosen(model, size, SIZE_SPEED) for size in (LARGE, SMALL))]
    if not models:
        return None
    shown = (
        ("fh_max_first_hits_N", f"Highest force, first {FIRST_HITS:g} s (kN)"),
        ("fh_max_N", "Highest force, whole run (kN)"),
        ("fluctuation_N", "Deviation of 0.1 s means of Fx (kN)"),
    )
    figure = new_figure(9.4, 3.5)
    for axes, (name, label) in zip(figure.subplots(1, 3), shown, strict=True):
        counts = []
        for model in models:
            bands = []
            for place, size in enumerate((LARGE, SMALL)):
                value = np.array(list(ensemble.of(name, model, size, SIZE_SPEED).values())) / 1e3
                at = np.full(len(value), place + 12.0 * APART[model])
                axes.plot(at, value, "o", color=COLOUR[model], alpha=0.4, ms=3.5, mew=0, zorder=2)
                bands.append(mean_band(value))
            counts += [band.n for band in bands]
            place = np.arange(2) + 6.0 * APART[model]
            error = [[band.value - band.low for band in bands], [band.high - band.value for band in bands]]
            look = {"color": COLOUR[model], "marker": MARKER[model], "capsize": 3.0, "label": model, "zorder": 3}
            axes.errorbar(place, [band.value for band in bands], yerr=error, **look)
        axes.set_xticks([0, 1], [f"{LARGE} m", f"{SMALL} m"])
        axes.set_xlim(-0.4, 1.4)
        axes.set_ylim(bottom=0.0)
        axes.set_xlabel(f"Mean floe size ({count_words(counts)})")
        axes.set_ylabel(label)
        axes.grid(True, axis="y")
        axes.legend(loc="best")
    return figure

"""Pictures of the page: the ice in plan, the load against the way, fields beside each other, and what engineers plot."""

from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import numpy as np
from matplotlib import pyplot
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.patches import Rectangle

from dilatedem.results.load import load
from dilatedem.statistics import mean
from validation.managed_ice.fields import SHAPES
from validation.managed_ice.runs import PIECE, TO, Found, Point

HERE = Path(__file__).parent
COLOURS = dict(zip(SHAPES, ("#D55E00", "#0072B2"), strict=True))
#: so many MN are one of what axes show
MEGA = 1e-6
#: m of way after which plans are drawn
DRAWN = 20.0

Runs = dict[Point, Found]


def draw_plans(folders: dict[str, Path]) -> None:
    """The ice in plan after a way of DRAWN, a panel each of the folders by title."""
    figure, panels = pyplot.subplots(2, len(folders) // 2, figsize=(9.6, 10.4), layout="constrained", sharex=True, sharey=True)
    for axes, (title, folder) in zip(panels.T.ravel(), folders.items(), strict=True):
        run = load(folder)
        (wall,) = run.case["structure"]
        speed, size, channel = -wall["support"]["velocity"][0], wall["size"], run.case["domain"]["size"]
        shot = run.snapshot(DRAWN / speed)
        axes.add_collection(PolyCollection(list(shot.outlines), facecolors="#CFE8F5", edgecolors="#33566B", linewidths=0.6))
        place = wall["center"][0] - DRAWN
        axes.add_patch(Rectangle((place - 0.5 * size[0], -0.5 * size[1]), *size, color="#444444"))
        for side in (-0.5, 0.5):
            axes.axhline(side * channel[1], color="black", linewidth=1.5)
        axes.annotate("", (place - 14.0, 0.0), (place - 3.0, 0.0), arrowprops={"arrowstyle": "->", "color": "#D55E00", "lw": 2.0})
        axes.set(title=title, aspect="equal", xlim=(-0.5 * channel[0] - 22.0, 0.5 * channel[0] + 2.0), ylim=(-53.0, 53.0))
        axes.grid(False)
    for axes in panels[-1]:
        axes.set_xlabel("x (m)")
    for axes in panels[:, 0]:
        axes.set_ylabel("y (m)")
    figure.savefig(HERE / "plans.png", dpi=100)
    pyplot.close(figure)


def draw_histories(runs: Runs, concentrations: tuple[float, ...]) -> None:
    """Mean load of pieces of the way, of both shapes, with bands over fields."""
    figure, panels = pyplot.subplots(1, len(concentrations), figsize=(9.6, 3.8), layout="constrained", sharey=True)
    for axes, concentration in zip(panels, concentrations, strict=True):
        for shape, colour in COLOURS.items():
            chosen = [found for point, found in runs.items() if (point.shape, point.concentration) == (shape, concentration)]
            told = np.array([found.history for found in chosen])
            bands = [mean(MEGA * values) for values in told.T]
            way = PIECE * (np.arange(len(bands)) + 0.5)
            axes.plot(way, [each.value for each in bands], color=colour, label=f"{shape}, mean of {len(told)} fields")
            low, high = [each.low for each in bands], [each.high for each in bands]
            axes.fill_between(way, low, high, color=colour, alpha=0.25, linewidth=0.0)
        axes.set(xlabel="way of the wall (m)", title=f"concentration {concentration:g}", xlim=(0.0, TO))
        axes.grid(alpha=0.3)
    panels[0].set(ylabel="mean load along the way (MN)", ylim=(0.0, None))
    panels[-1].legend(fontsize=8)
    figure.savefig(HERE / "histories.png", dpi=110)
    pyplot.close(figure)


def draw_fields(runs: Runs, concentrations: tuple[float, ...]) -> None:
    """Mean, spread and peak of every field, and their bands."""
    figure, panels = pyplot.subplots(1, 3, figsize=(9.6, 3.8), layout="constrained")
    for axes, what, label in zip(panels, ("mean", "spread", "peak"), ("mean load", "spread in time", "highest load"), strict=True):
        for place, concentration in enumerate(concentrations):
            for (shape, colour), aside in zip(COLOURS.items(), (-0.17, 0.17), strict=True):
                chosen = [found for point, found in runs.items() if (point.shape, point.concentration) == (shape, concentration)]
                values = MEGA * np.array([getattr(found, what) for found in chosen])
                told = mean(values)
                axes.plot(np.full(len(values), place + aside - 0.06), values, "o", color=colour, alpha=0.45, markersize=4)
                named = shape if place == 0 else None
                reach = [[told.value - told.low], [told.high - told.value]]
                look = {"color": colour, "marker": "_", "capsize": 4, "lw": 1.8, "label": named}
                axes.errorbar(place + aside + 0.06, told.value, reach, **look)
        axes.set_xticks(range(len(concentrations)), [f"{each:g}" for each in concentrations])
        axes.set(xlabel="concentration", ylabel=f"{label} (MN)", xlim=(-0.5, len(concentrations) - 0.5), ylim=(0.0, None))
        axes.grid(axis="y", alpha=0.3)
    panels[0].legend(fontsize=8)
    figure.savefig(HERE / "fields.png", dpi=110)
    pyplot.close(figure)


def draw_trends(runs: Runs, series: dict[str, tuple[str, list[Point]]]) -> None:
    """Mean and highest load against each quantity: name in `Point` -> label of its axis, points."""
    figure, panels = pyplot.subplots(2, len(series), figsize=(9.6, 5.6), layout="constrained", sharex="col", sharey="row")
    for column, (key, (label, points)) in zip(panels.T, series.items(), strict=True):
        for axes, what in zip(column, ("mean", "peak"), strict=True):
            for shape, colour in COLOURS.items():
                _draw_series(axes, key, [point for point in points if point.shape == shape], runs, what, colour)
            axes.grid(alpha=0.3)
        column[1].set_xlabel(label)
    panels[0, 0].set(ylabel="mean load (MN)", ylim=(0.0, None))
    panels[1, 0].set(ylabel="highest load (MN)", ylim=(0.0, None))
    panels[0, 0].legend(SHAPES, fontsize=8)
    figure.savefig(HERE / "trends.png", dpi=110)
    pyplot.close(figure)


def _draw_series(axes: Axes, key: str, points: list[Point], runs: Runs, what: str, colour: str) -> None:
    levels = sorted({getattr(point, key) for point in points})
    some = [MEGA * np.array([getattr(runs[p], what) for p in points if getattr(p, key) == level]) for level in levels]
    middle, low, high = (np.array([of(each) for each in some]) for of in (np.mean, np.min, np.max))
    axes.errorbar(levels, middle, [middle - low, high - middle], color=colour, marker="o", markersize=4, capsize=3)

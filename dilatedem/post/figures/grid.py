"""Loads over two keys at once: a map of the grid that was swept."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.axes import Axes

from dilatedem.post.ensembles.measures import HIGHEST
from dilatedem.post.ensembles.study import Study
from dilatedem.post.figures.canvas import Drawing, file_name, new_figure, styled
from dilatedem.post.figures.sweep import PANELS, Places, place_label, places
from dilatedem.post.labels import describe_key, number
from dilatedem.statistics import mean

#: with more values along an axis the cells have no room for their numbers
MOST_WRITTEN = 8


@styled
def grid_figure(study: Study, structure: str) -> Drawing | None:
    """Highest and mean force on a structure over the two keys of a sweep; None where it has not two of two values at least."""
    if len(study.sweep.keys) != 2:
        return None
    x, y = (places(study, key) for key in study.sweep.keys)
    loaded = any(len(ensemble.sample(structure, HIGHEST)) for ensemble in study.ensembles)
    if len(set(x.values())) < 2 or len(set(y.values())) < 2 or not loaded:
        return None
    figure = new_figure(8.2, 3.9)
    for axes, (quantity, label) in zip(figure.subplots(1, 2), PANELS, strict=True):
        draw_cells(axes, study, structure, quantity, x, y)
        axes.set_title(label)
        axes.set_xlabel(place_label(study.sweep.keys[0], x))
        axes.set_ylabel(place_label(study.sweep.keys[1], y))
    names = [describe_key(key)[0] for key in study.sweep.keys]
    caption = (
        f"Highest horizontal force of any time step (left) and mean force along the current (right) on {structure}, kN, means over "
        f"the {study.noun}s; {study.looked_at}. In each cell the mean, its 95 % band (from 5 {study.noun}s on), and their number."
    )
    title = f"Force on {structure} by {' and '.join(names)}"
    return Drawing(f"map_{file_name('_'.join(study.sweep.keys))}_{file_name(structure)}", title, caption, figure)


def draw_cells(axes: Axes, study: Study, structure: str, quantity: str, x: Places, y: Places) -> None:
    """A cell for each pair of values, as dark as its force."""
    across, up = _ordered(x), _ordered(y)
    force = np.full((len(up), len(across)), math.nan)
    words: dict[tuple[int, int], str] = {}
    for n in x.keys() & y.keys():
        values = study.ensembles[n].sample(structure, quantity) / 1e3
        if len(values):
            cell = up.index(y[n]), across.index(x[n])
            band = mean(values)
            force[cell] = band.value
            ends = f"\n{number(band.low, 3)} to {number(band.high, 3)}" if band.closed else ""
            words[cell] = f"{number(band.value, 3)}{ends}\nn = {band.n}"
    image = axes.imshow(force, origin="lower", aspect="auto", cmap="cividis")
    axes.figure.colorbar(image, ax=axes, shrink=0.9)
    axes.set_xticks(range(len(across)), [_words(value) for value in across])
    axes.set_yticks(range(len(up)), [_words(value) for value in up])
    middle = 0.5 * (np.nanmin(force) + np.nanmax(force))
    if max(force.shape) <= MOST_WRITTEN:
        for (row, column), text in words.items():
            colour = "black" if force[row, column] > middle else "white"
            axes.annotate(text, (column, row), ha="center", va="center", fontsize=7.0, color=colour)


def _ordered(found: Places) -> list[float | str]:
    """The values of a key along an axis: numbers ascend, words keep the order of the sweep."""
    values = list(dict.fromkeys(found.values()))
    return values if any(isinstance(value, str) for value in values) else sorted(values)


def _words(value: float | str) -> str:
    return value if isinstance(value, str) else f"{value:g}"

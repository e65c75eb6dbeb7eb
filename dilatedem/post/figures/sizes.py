"""Sizes of floes: how many are larger than a size, those that came about beside those asked for."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator, NullFormatter, ScalarFormatter

from dilatedem.post.figures.canvas import BLUE, ORANGE


def draw_sizes(axes: Axes, asked: np.ndarray, reached: np.ndarray) -> None:
    """Shares of floes over sizes, roots of plan areas (n,) [m2], on logarithmic axes: a power law is a line."""
    for areas, colour, width, label in ((asked, ORANGE, 4.0, "asked for"), (reached, BLUE, 1.2, "reached")):
        axes.step(np.sort(np.sqrt(areas)), np.arange(len(areas), 0, -1) / len(areas), color=colour, linewidth=width, label=label)
    axes.set(xscale="log", yscale="log", xlabel="Floe size, root of the plan area (m)", ylabel="Share of floes that are larger")
    least, most = axes.get_xlim()
    ticks = [mark for mark in MaxNLocator(5, steps=[1, 2, 5, 10]).tick_values(least, most) if least < mark < most]
    axes.set_xticks([*ticks, *(mark for mark in (0.5, 1.0, 2.0) if least < mark < min(ticks))])
    axes.xaxis.set_major_formatter(ScalarFormatter())
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.grid()
    axes.legend(loc="lower left")

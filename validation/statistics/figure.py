"""The picture of README.md: coverage of every band, beside what is asked for and what 1000 ensembles leave to chance."""

import math
from collections.abc import Sequence
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot

from validation.statistics.coverage import LEAST, MOST

#: of the numbers of runs, in their order
LOOKS = (("#D55E00", "o"), ("#0072B2", "s"), ("#009E73", "^"))


def draw(rows: Sequence[dict[str, str]], path: Path) -> None:
    """A line for each band and law, a mark for each number of runs; rows: of coverage.csv."""
    lines = sorted(dict.fromkeys((row["band"], row["law"]) for row in rows), key=lambda line: line[0], reverse=True)
    sizes = sorted({int(row["runs"]) for row in rows})
    figure, axes = pyplot.subplots(figsize=(7.6, 0.165 * len(lines) + 1.2), layout="constrained")
    axes.axvspan(LEAST, MOST, color="0.92", zorder=0)
    axes.axvline(95.0, color="0.5", linewidth=0.8, zorder=1)
    for size, (colour, mark) in zip(sizes, LOOKS, strict=False):
        chosen = [row for row in rows if int(row["runs"]) == size]
        held = [float(row["coverage_percent"]) for row in chosen]
        error = [196.0 * math.sqrt(0.95 * 0.05 / int(row["ensembles"])) for row in chosen]
        places = [lines.index((row["band"], row["law"])) + 0.22 * (sizes.index(size) - 1) for row in chosen]
        look = {"color": colour, "marker": mark, "markersize": 4.0, "linestyle": "none", "elinewidth": 0.6, "label": f"{size} runs"}
        axes.errorbar(held, places, xerr=error, **look)
    axes.set_yticks(range(len(lines)), [f"{band}, {law}" for band, law in lines], fontsize=6.5)
    axes.set(xlabel="ensembles whose 95 % band holds what is true (%)", ylim=(-0.7, len(lines) - 0.3))
    axes.grid(axis="y", alpha=0.25)
    axes.legend(fontsize=8, loc="lower left")
    figure.savefig(path, dpi=110)
    pyplot.close(figure)

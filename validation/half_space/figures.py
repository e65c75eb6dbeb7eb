"""A figure per family: the half-space as dots, the laws as thin lines."""

from collections import defaultdict
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot as plt  # noqa: E402  (after the backend)

#: column -> colour and label of the laws
LAWS = {
    "point": ("tab:blue", "point"),
    "line": ("tab:green", "line"),
    "face": ("tab:orange", "face"),
    "widened": ("tab:red", "widened patch"),
}

#: column -> label along x, and what a panel's title says of it
LABELS = {"tilt": "tilt, rad", "width": "width, m", "angle": "angle between the axes, degrees", "length": "length, m"}
TITLES = {"radius": "radius", "radius_other": "other radius", "length": "length", "width": "width", "overlap": "overlap"}


def number(row: dict, column: str) -> float:
    return float(row[column]) if row[column] != "" else float("nan")


def panels(rows: list[dict], family: str, parameter: str) -> dict[str, list[dict]]:
    """Rows of one panel each, under a title made of the geometry in which the rows differ."""
    varying = [c for c in TITLES if c != parameter and len({row[c] for row in rows}) > 1]
    if family == "square":
        varying.remove("width")  # the same as the length
    groups = defaultdict(list)
    for row in rows:
        groups[", ".join(f"{TITLES[c]} {row[c]} m" for c in varying).replace("inf m", "without end")].append(row)
    return groups


def panel(axis, rows: list[dict], parameter: str) -> None:
    """One panel: a curve of the laws, dots of the half-space (open ones: ends cut off)."""
    cut = [row for row in rows if row["ends"] == "cut"]
    rows = [row for row in rows if row["ends"] != "cut"]
    x = [number(row, parameter) for row in rows]
    for column, (colour, label) in LAWS.items():
        y = [number(row, column) for row in rows]
        if any(value == value for value in y):
            axis.plot(x, y, color=colour, linewidth=0.9, label=label)
    axis.plot(x, [number(row, "force") for row in rows], "k.", markersize=6, label="half-space")
    if cut:
        values = [number(row, "force") for row in cut]
        axis.plot(
            [number(row, parameter) for row in cut], values, "o", color="0.4", markersize=5, fillstyle="none", label="its ends cut"
        )
    axis.set_yscale("log")
    if min(x) > 0:
        axis.set_xscale("log")
    else:
        axis.set_xscale("symlog", linthresh=min(value for value in x if value > 0))
        axis.set_xlim(left=0)
    axis.grid(alpha=0.3, linewidth=0.4)
    axis.set_xlabel(LABELS[parameter])


def draw(rows: list[dict], family: str, parameter: str, path: Path) -> None:
    """Force against the family's parameter, one panel for each set of the other ones."""
    groups = panels(rows, family, parameter)
    columns = 2
    height = -(-len(groups) // columns)
    figure, axes = plt.subplots(height, columns, figsize=(4.5 * columns, 3.4 * height), squeeze=False, layout="constrained")
    for axis, (title, group) in zip(axes.flat, groups.items(), strict=True):
        panel(axis, group, parameter)
        axis.set_title(title, fontsize=9)
    for axis in axes[:, 0]:
        axis.set_ylabel("F/E*, m$^2$")
    fullest = max(axes.flat, key=lambda axis: len(axis.get_legend_handles_labels()[0]))  # ends without limit have no line law
    fullest.legend(fontsize=8)
    figure.savefig(path, dpi=100)
    plt.close(figure)

"""Loads by the direction of the current: a rose."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from matplotlib.projections.polar import PolarAxes
from matplotlib.ticker import MaxNLocator

from dilatedem.post.ensembles.measures import HIGHEST, MEAN_ALONG
from dilatedem.post.ensembles.study import Ensemble, Study
from dilatedem.post.figures.canvas import MARKERS, SERIES, Drawing, file_name, new_figure, styled
from dilatedem.post.figures.sweep import direction, setting_words
from dilatedem.post.labels import number
from dilatedem.statistics import mean

#: with fewer directions a rose shows nothing that two numbers do not
FEWEST = 3
#: keys that turn the current, and change its speed
CURRENT = "water.velocity"
#: degrees between settings of the same direction, so that all are seen
ASIDE = 4.0
PANELS = ((HIGHEST, "Highest horizontal force (kN)"), (MEAN_ALONG, "Mean force along the current (kN)"))


def directions(study: Study) -> dict[int, float]:
    """Where the current goes to in each ensemble [deg from +x], by its number; of those that have one."""
    found = {}
    for n, ensemble in enumerate(study.ensembles):
        currents = {direction(list(member.current)) for member in ensemble.members}
        if len(currents) == 1 and None not in currents:
            found[n] = currents.pop()
    return found


@styled
def rose_figure(study: Study, structure: str) -> Drawing | None:
    """Highest and mean force on a structure around the circle of the current's directions; a line for each other setting."""
    found = {n: angle for n, angle in directions(study).items() if len(study.ensembles[n].sample(structure, HIGHEST))}
    if len(set(found.values())) < FEWEST:
        return None
    lines: dict[str, list[int]] = {}
    for n in sorted(found, key=found.__getitem__):
        lines.setdefault(_setting(study, study.ensembles[n]), []).append(n)
    figure = new_figure(8.2, 4.4)
    shown = list(lines.items())[: len(SERIES)]
    for place, (quantity, label) in enumerate(PANELS, start=1):
        axes = figure.add_subplot(1, 2, place, projection="polar")
        for index, (setting, members) in enumerate(shown):
            look = {"color": SERIES[index], "marker": MARKERS[index], "label": setting}
            aside = (index - 0.5 * (len(shown) - 1)) * ASIDE
            draw_petals(axes, study, {n: found[n] + aside for n in members}, structure, quantity, look)
        axes.set_ylim(bottom=0.0)
        axes.set_title(label, pad=16)
        axes.set_rlabel_position(_free_angle(list(found.values())))
        axes.yaxis.set_major_locator(MaxNLocator(5, prune="upper"))
        axes.tick_params(axis="y", labelsize=7.5)
    if len(lines) > 1:
        figure.legend(*axes.get_legend_handles_labels(), loc="outside lower center", ncols=2)
    runs = sorted({len(study.ensembles[n].sample(structure, HIGHEST)) for n in found})
    caption = (
        f"Highest horizontal force of any time step (left) and mean force along the current (right) on {structure}, kN, outwards, "
        f"against the direction that the current goes to, degrees from +x counter-clockwise; {study.looked_at}, "
        f"{' to '.join(map(str, dict.fromkeys((runs[0], runs[-1]))))} {study.noun}s to a direction. Small dots: {study.noun}s; "
        f"large marks: their mean, at the end of a pale spoke; thin bars: its 95 % band, from 5 {study.noun}s on. A mean against "
        f"the current is at the centre."
        f"{' Settings stand side by side.' if len(shown) > 1 else ''}"
    )
    return Drawing(f"rose_{file_name(structure)}", f"Load rose, {structure}", caption, figure)


def draw_petals(
    axes: PolarAxes, study: Study, angles: dict[int, float], structure: str, quantity: str, look: dict[str, Any]
) -> None:  # fmt: skip
    """Runs as dots, their mean as a mark on a spoke, its band as a bar. A mean against the current is drawn at the centre."""
    for n, degrees in angles.items():
        values = study.ensembles[n].sample(structure, quantity) / 1e3
        if not len(values):
            continue
        angle, band = math.radians(degrees), mean(values)
        colour = look["color"]
        axes.plot([angle, angle], [0.0, max(band.value, 0.0)], color=colour, linewidth=4.0, alpha=0.3, solid_capstyle="butt")
        dots = {"color": colour, "alpha": 0.45, "markersize": 3.0, "markeredgewidth": 0}
        axes.plot(np.full(len(values), angle), values.clip(0.0), "o", **dots)
        if band.closed:
            axes.plot([angle, angle], [max(band.low, 0.0), max(band.high, 0.0)], color=colour, linewidth=1.4)
    place = [math.radians(degrees) for degrees in angles.values()]
    values = [max(float(np.mean(study.ensembles[n].sample(structure, quantity))) / 1e3, 0.0) for n in angles]
    axes.plot(place, values, linestyle="none", markersize=6.0, markeredgecolor="white", zorder=4, **look)


def _setting(study: Study, ensemble: Ensemble) -> str:
    """What varies beside the direction, for the legend: the speed of the current, and the other keys."""
    speeds = {round(math.hypot(*member.current), 9) for one in study.ensembles for member in one.members}
    speed = f"current {number(math.hypot(*ensemble.members[0].current))} m/s" if len(speeds) > 1 else ""
    others = [key for key in study.sweep.keys if not key.startswith(CURRENT)]
    return ", ".join(filter(None, [speed, setting_words(ensemble.values, others)]))


def _free_angle(angles: list[float]) -> float:
    """The middle of the widest gap between directions [deg], where the numbers of the rings are in nobody's way."""
    around = sorted({angle % 360.0 for angle in angles})
    gaps = [(following - angle, angle) for angle, following in zip(around, [*around[1:], around[0] + 360.0], strict=True)]
    widest, angle = max(gaps)
    return (angle + 0.5 * widest) % 360.0

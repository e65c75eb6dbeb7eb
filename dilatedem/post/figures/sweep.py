"""Loads of many runs against what was varied: ice speed (Liu 2015, Fig. 14), floe size, any key; thin lines are single seeds."""

from __future__ import annotations

import math
from collections.abc import Collection
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import LogLocator, NullLocator

from dilatedem.post.ensembles.measures import HIGHEST, MEAN_ALONG, QUANTITIES
from dilatedem.post.ensembles.study import Ensemble, Study
from dilatedem.post.ensembles.sweeps import axis_value, is_velocity, value_words
from dilatedem.post.figures.canvas import MARKERS, SERIES, Drawing, file_name, new_figure, styled
from dilatedem.post.labels import axis_label, describe_key, number, show
from dilatedem.statistics import Band, mean

PANELS = ((HIGHEST, "Highest horizontal force (kN)"), (MEAN_ALONG, "Mean force along the current (kN)"))
#: largest over smallest value of a key from which on axes are logarithmic
LOGARITHMIC = 4.0
#: of so many values each has its number on the axis
MOST_TICKS = 8
#: more letters along an axis run into each other
MOST_LETTERS = 70

Places = dict[int, float | str]  # where an ensemble lies on the axis of a key, by its number


def places(study: Study, key: str) -> Places:
    """Numbers where all values of the key are numbers, else words; ensembles that do without the key are left out.

    A velocity is its size as long as all have one direction, else both of its components.
    """
    values = {n: ensemble.values[key] for n, ensemble in enumerate(study.ensembles)}
    in_words = turns(study, key)
    found = {
        n: vector_words(value) if in_words and value is not None else axis_value(key, value) for n, value in values.items()
    }
    return {n: place for n, place in found.items() if place is not None}


def turns(study: Study, key: str) -> bool:
    """Whether the key is a velocity that has several directions."""
    values = [ensemble.values[key] for ensemble in study.ensembles]
    return is_velocity(key) and len({direction(value) for value in values if isinstance(value, list)}) > 1


def vector_words(value: Any) -> str:
    """A vector by a few digits of each component."""
    return ", ".join(number(component, 3) for component in value) if isinstance(value, list) else show(value)


def place_label(key: str, found: Places) -> str:
    """What is on the axis of a key."""
    return turning_label(key) if is_velocity(key) and any(isinstance(place, str) for place in found.values()) else axis_label(key)


def turning_label(key: str) -> str:
    """Of a velocity that turns: the words for both components."""
    return axis_label(key).replace("speed", "along x, along y")


def direction(velocity: list[float]) -> float | None:
    """Where a velocity points to [deg from +x], None for none."""
    return round(math.degrees(math.atan2(velocity[1], velocity[0])), 6) % 360.0 if any(velocity[:2]) else None


def setting_words(values: dict[str, Any], keys: list[str], turning: Collection[str] = ()) -> str:
    """The values of these keys, for the legend; of those that are `turning` velocities both components in each case."""
    words = []
    for key in keys:
        what, unit = describe_key(key)
        if key in turning:
            what, value = what.replace("speed", "along x, along y"), vector_words(values[key])
        else:
            value = value_words(key, values[key])
        words.append(f"{what} {value} {unit}".rstrip())
    return ", ".join(words)


@styled
def sweep_figure(study: Study, structure: str, key: str) -> Drawing | None:
    """Highest and mean force on a structure against one key; a line for each setting of the other keys."""
    found = {n: place for n, place in places(study, key).items() if len(study.ensembles[n].sample(structure, HIGHEST))}
    if len(set(found.values())) < 2:
        return None
    order = sorted(found, key=lambda n: math.inf if isinstance(found[n], str) else found[n])
    ensembles = [study.ensembles[n] for n in order]
    others = [other for other in study.sweep.keys if other != key and varies(ensembles, other)]
    lines: dict[str, list[int]] = {}
    for n in order:
        lines.setdefault(setting_words(study.ensembles[n].values, others), []).append(n)
    if len(lines) > len(SERIES):
        lines = {"": order}  # more settings than anybody can tell apart: dots without a legend
    # Between words, and between dots of many settings, there is nothing to join.
    joined = isinstance(found[order[0]], float) and (len(lines) > 1 or not others)
    figure = new_figure(6.6, 5.8)
    panels = figure.subplots(2, 1, sharex=True)
    for axes, (quantity, label) in zip(panels, PANELS, strict=True):
        for index, (setting, members) in enumerate(lines.items()):
            look = {"color": SERIES[index], "marker": MARKERS[index], "markersize": 5.5, "label": setting}
            look |= {"markeredgecolor": "white", "linewidth": 1.4 if joined else 0.0}
            draw_line(axes, study, members, found, structure, quantity, look)
        axes.set_ylabel(label)
        axes.grid(True)
        dress_axes(axes, [place for place in found.values() if isinstance(place, float)])
    panels[1].set_xlabel(place_label(key, found))
    if sum(len(place) for place in set(found.values()) if isinstance(place, str)) > MOST_LETTERS:
        panels[1].tick_params(axis="x", rotation=90)
    panels[0].set_title(f"Ice force on {structure} ({study.looked_at})")
    if len(lines) > 1:
        columns = 2 if max(map(len, lines)) < 36 else 1
        figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=columns)
    caption = sweep_caption(study, structure, key, ensembles, others)
    name = f"force_by_{file_name(key)}_{file_name(structure)}"
    what = "direction of the current" if turns(study, key) else describe_key(key)[0]
    return Drawing(name, f"Force on {structure} by {what}", caption, figure)


def varies(ensembles: list[Ensemble], key: str) -> bool:
    return any(ensemble.values[key] != ensembles[0].values[key] for ensemble in ensembles)


def draw_line(
    axes: Axes, study: Study, members: list[int], found: Places, structure: str, quantity: str, look: dict[str, Any]
) -> None:  # fmt: skip
    """A thin line a seed, or dots where there is nothing to join; the mean over the seeds, or blocks, with its 95 % band."""
    faint = {"color": look["color"], "alpha": 0.4, "zorder": 2}
    for seed, (at, force) in by_seed(study, members, found, structure, quantity).items():
        joined = 0.7 if look["linewidth"] and seed is not None and not study.blocks else 0.0
        axes.plot(at, force, marker=look["marker"], markersize=3.0, markeredgewidth=0, linewidth=joined, **faint)
    known = [n for n in members if len(study.ensembles[n].sample(structure, quantity))]
    place = [found[n] for n in known]
    bands = [mean(study.ensembles[n].sample(structure, quantity)) / 1e3 for n in known]
    axes.plot(place, [band.value for band in bands], zorder=4, **look)
    draw_bands(axes, place, bands, look)


def draw_bands(axes: Axes, place: list[float | str], bands: list[Band], look: dict[str, Any]) -> None:
    """Shaded along a line, bars where there is none."""
    closed = [(at, band) for at, band in zip(place, bands, strict=True) if band.closed]
    if not closed:
        return
    at, low, value, high = zip(*((at, band.low, band.value, band.high) for at, band in closed), strict=True)
    if look["linewidth"] and len(closed) == len(bands):
        axes.fill_between(at, low, high, color=look["color"], alpha=0.18, linewidth=0, zorder=1)
    reach = np.abs([np.subtract(value, low), np.subtract(high, value)])
    axes.errorbar(at, value, yerr=reach, fmt="none", ecolor=look["color"], capsize=3.0, elinewidth=1.0, zorder=3)


def by_seed(
    study: Study, members: list[int], found: Places, structure: str, quantity: str
) -> dict[int | None, tuple[list[float | str], list[float]]]:
    """Places and forces [kN] of the runs of each seed."""
    lines: dict[int | None, tuple[list[float | str], list[float]]] = {}
    for n in members:
        for member in study.ensembles[n].members:
            force = member.loads[structure].measures.get(quantity, math.nan) if structure in member.loads else math.nan
            if math.isfinite(force):
                at, forces = lines.setdefault(member.run.seed, ([], []))
                at.append(found[n])
                forces.append(force / 1e3)
    return lines


def dress_axes(axes: Axes, numbers: list[float]) -> None:
    """Logarithmic where the key, and the forces with it, go over so wide a range, as the exponent of a speed is read off there."""
    forces = np.concatenate([np.ravel(line.get_ydata()).astype(float) for line in axes.lines])
    if numbers and min(numbers) > 0.0 and max(numbers) >= LOGARITHMIC * min(numbers) and forces.min() > 0.0:
        axes.set_xscale("log")
        axes.set_yscale("log")
        ticks = sorted(set(numbers))
        axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
        axes.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        axes.yaxis.set_major_formatter("{x:g}")
        axes.xaxis.set_minor_locator(NullLocator())
        axes.yaxis.set_minor_locator(NullLocator())
        return
    low, high = axes.get_ylim()
    axes.set_ylim(min(0.0, low), max(high, 0.0) + 0.04 * abs(high))
    if numbers:
        axes.margins(x=0.05)
        if len(set(numbers)) <= MOST_TICKS:
            axes.set_xticks(sorted(set(numbers)))


def sweep_caption(study: Study, structure: str, key: str, ensembles: list[Ensemble], others: list[str]) -> str:
    counts = sorted({len(ensemble.sample(structure, HIGHEST)) for ensemble in ensembles})
    repeats = f"{counts[0]} to {counts[-1]} {study.noun}s" if len(counts) > 1 else plural(counts[0], study.noun)
    spread = ""
    if counts[-1] > 1:
        single = "Small dots: single blocks" if study.blocks else "Thin: single runs, a line a seed where values can be joined"
        spread = f" {single}; large marks: their mean"
        spread += ", with its 95 % band." if counts[-1] >= 5 else " (a band takes 5 runs)."
    left_out = sum(not run.completed for run in study.sweep.runs)
    words = f" Left out: {plural(left_out, 'run')} that did not complete." if left_out else ""
    by = f", for each {' and '.join(describe_key(other)[0] for other in others)}" if others else ""
    label = place_label(key, places(study, key))
    return (
        f"{QUANTITIES[HIGHEST].capitalize()} of any time step (above) and {QUANTITIES[MEAN_ALONG]} (below) on {structure}, kN, "
        f"against {label[0].lower() + label[1:]}{by}; {study.looked_at}, {repeats} to a point.{spread}{words}"
    )


def plural(count: int, noun: str) -> str:
    return f"{count} {noun}" if count == 1 else f"{count} {noun}s"

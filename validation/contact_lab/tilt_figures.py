"""The figures and the table of `tilts`."""

from functools import partial

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter

from dilatedem.post.figures.canvas import new_figure, styled
from dilatedem.post.labels import number
from validation.contact_lab.drawing import COLOUR, mode_handles, mode_strip
from validation.contact_lab.probe import Answers
from validation.contact_lab.scenes import COLUMNS, MODELS
from validation.contact_lab.tilts import FIXED_HEIGHT_END, OVERLAP, ROLLS, Roll, largest_jumps

POSES = 1500
QUARTER = 0.5 * np.pi
#: title, abscissae [rad], unit of the axis as it is drawn, whether the height is fixed
COLUMNS_SHOWN = (
    ("Overlap fixed", np.linspace(0.0, QUARTER, POSES), "deg", False),
    ("Overlap fixed, logarithmic tilt", np.geomspace(1e-6, QUARTER, POSES), "rad", False),
    ("Centroid fixed", np.geomspace(1e-6, FIXED_HEIGHT_END, POSES), "rad", True),
)
ROUND_OFF = 1e-8  # of a curve's largest value: what is below is not drawn
QUANTITIES = ("Force (kN)", "Moment (kN m)", "Energy (J)")


def _values(roll: Roll, answers: Answers) -> tuple[np.ndarray, ...]:
    """Force, moment about the roller's centroid, energy, as the figure shows them."""
    moment = np.linalg.norm(answers.moment[:, roll.roller], axis=1)
    return answers.strength / 1e3, moment / 1e3, answers.energy


def _edges(values: np.ndarray, log: bool) -> np.ndarray:
    """Borders (n + 1,) between abscissae (n,)."""
    between = np.sqrt(values[1:] * values[:-1]) if log else 0.5 * (values[1:] + values[:-1])
    return np.concatenate([values[:1], between, values[-1:]])


@styled
def figure(roll: Roll) -> Figure:
    """Rows: modes of each model, force, moment, energy. Columns: COLUMNS_SHOWN."""
    drawn = new_figure(9.4, 6.6)
    drawn.get_layout_engine().set(w_pad=0.11)
    strips = len(MODELS)
    panels = drawn.subplots(strips + 3, 3, sharex="col", sharey="row", height_ratios=[0.16] * strips + [1.0] * 3)
    probes = {model: roll.probe(model) for model in MODELS}
    seen: set[int] = set()
    for column, (title, tilts, unit, fixed_height) in enumerate(COLUMNS_SHOWN):
        log = unit == "rad"
        shown = tilts if log else np.degrees(tilts)
        for row, model in enumerate(MODELS):
            probe = probes[model]
            answers = probe.at(roll.poses(probe, tilts, fixed_height=fixed_height))
            mode_strip(panels[row, column], _edges(shown, log), answers.mode)
            seen |= set(answers.mode.tolist())
            for axes, values in zip(panels[strips:, column], _values(roll, answers), strict=True):
                seen_values = np.where(values > ROUND_OFF * values.max(), values, np.nan)
                axes.plot(shown, seen_values, color=COLOUR[model], label=model, linewidth=1.1)
            if column == 0:
                name = {"rotation": 0, "ha": "right", "va": "center", "fontsize": 8.0, "color": COLOUR[model]}
                panels[row, 0].set_ylabel(model, **name)
        panels[0, column].set_title(title)
        panels[-1, column].set_xlabel(f"Tilt ({unit})")
        panels[-1, column].set_xscale("log" if log else "linear")
        if not log:
            panels[-1, column].set_xticks(range(0, 91, 15))
    for axes in panels[strips:].flat:
        axes.set_yscale("log")
        axes.yaxis.set_minor_formatter(NullFormatter())
        axes.grid(True)
    for axes, label in zip(panels[strips:, 0], QUANTITIES, strict=True):
        axes.set_ylabel(label)
    drawn.align_ylabels(panels[strips:, 0])
    drawn.suptitle(f"{roll.title[0].upper()}{roll.title[1:]}; {1e3 * OVERLAP:g} mm of overlap", x=0.01, ha="left", fontsize=10.0)
    drawn.legend(handles=mode_handles(seen), loc="outside lower center", ncols=4)
    return drawn


def jump_table() -> list[str]:
    """Largest relative change of force and moment along each path at increments of 1e-5 rad, and what is left at 1e-9 rad."""
    wanted = ("force per 1e-5 rad", "force per 1e-9 rad", "moment per 1e-5 rad", "moment per 1e-9 rad")
    lines = [f"| path | fixed | {' | '.join(f'{m}: {w}' for m in COLUMNS for w in wanted)} |"]
    lines.append("| --- | --- |" + " ---: |" * (len(COLUMNS) * len(wanted)))
    for roll in ROLLS:
        for fixed_height, end in ((False, QUARTER), (True, FIXED_HEIGHT_END)):
            fixed = "centroid" if fixed_height else "overlap"
            cells = []
            for model in COLUMNS:
                if model not in MODELS:
                    cells += ["–"] * len(wanted)
                    continue
                probe = roll.probe(model)
                poses_at = partial(roll.poses, probe, fixed_height=fixed_height)
                for what, jump in zip(("force", "moment"), largest_jumps(probe, poses_at, end, roll.roller), strict=True):
                    cells += [number(jump.change, 2), number(jump.narrowed, 2)]
                    print(
                        f"{roll.name}, {fixed} fixed, {model}: {what} changes by {jump.change:.3g} per 1e-5 rad, "
                        f"{jump.narrowed:.3g} per 1e-9 rad at {jump.tilt:.6g} rad",
                        flush=True,
                    )
            lines.append(f"| {roll.title} | {fixed} | {' | '.join(cells)} |")
    return lines

"""Restitution of central impacts against their speed, at several dampings."""

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from dilatedem.post.figures.canvas import BLUE, GREEN, ORANGE, PURPLE, new_figure, styled
from validation.contact_lab.drawing import REFERENCE
from validation.contact_lab.impacts import collide
from validation.contact_lab.pieces import RESTITUTION
from validation.contact_lab.scenes import COLUMNS, FLOE, HALF_FLOE, MODELS, SPHERE, scene

SPEEDS = np.geomspace(0.01, 2.0, 9)  # m/s
DAMPINGS = {0.1: BLUE, 0.2: GREEN, 0.36: ORANGE, 0.7: PURPLE}
TABLE_SPEEDS = (0, 4, 8)  # of SPEEDS
START_GAP = 1e-4  # m, about: bodies begin just apart

_QUARTER_TURN = [0.0, 0.0, 0.25 * np.pi]
#: name, the two solids, distance of their centroids when they touch [m]
MEETINGS = (
    ("sphere on sphere", SPHERE, SPHERE, 2.0 * SPHERE["dilated_radius"]),
    (
        "vertical edge on side", FLOE, FLOE | {"rotation": _QUARTER_TURN},
        HALF_FLOE + (HALF_FLOE - 0.04) * np.sqrt(2.0) + 0.04,
    ),
    ("side on side", FLOE, FLOE, 2.0 * HALF_FLOE),
)  # fmt: skip


def measure(model: str, first: dict, second: dict, distance: float, damping: float, speed: float) -> float:
    """Coefficient of restitution at this approach speed [m/s]."""
    half = 0.5 * (distance + START_GAP)
    placed = first | {"position": [-half, 0.0, 0.0]}, second | {"position": [half, 0.0, 0.0]}
    return collide(scene(model, *placed, damping=damping, speeds=(0.5 * speed, -0.5 * speed))).restitution


def survey() -> dict[tuple[str, str, float], np.ndarray]:
    """(meeting, model, damping) -> restitution at SPEEDS."""
    return {
        (name, model, damping): np.array([measure(model, first, second, distance, damping, v) for v in SPEEDS])
        for model in MODELS
        for name, first, second, distance in MEETINGS
        for damping in DAMPINGS
    }


@styled
def figure(found: dict) -> Figure:
    """A row for each model, a column for each meeting."""
    drawn = new_figure(9.0, 0.7 + 2.7 * len(MODELS))
    panels = drawn.subplots(len(MODELS), len(MEETINGS), sharex=True, sharey=True, squeeze=False)
    for row, model in zip(panels, MODELS, strict=True):
        for axes, (name, *_) in zip(row, MEETINGS, strict=True):
            for damping, colour in DAMPINGS.items():
                axes.axhline(RESTITUTION[damping], **REFERENCE | {"color": colour})
                axes.plot(SPEEDS, found[name, model, damping], color=colour, marker="o", markersize=3.5)
            axes.set_title(f"{model}: {name}")
            axes.set_xscale("log")
            axes.set_ylim(0.0, 1.0)
            axes.grid(True)
        row[0].set_ylabel("Restitution")
    for axes in panels[-1]:
        axes.set_xlabel("Approach speed (m/s)")
    handles = [Line2D([], [], color=c, marker="o", markersize=3.5, label=f"damping {d:g}") for d, c in DAMPINGS.items()]
    handles.append(Line2D([], [], label="one restitution at all speeds", **REFERENCE))
    drawn.legend(handles=handles, loc="outside upper center", ncols=5)
    return drawn


def table(found: dict) -> list[str]:
    """Restitution at three speeds, beside the one that a damping should give."""
    heads = [f"{model}, {SPEEDS[i]:.2g} m/s" for model in COLUMNS for i in TABLE_SPEEDS]
    lines = [f"| impact | damping | reference | {' | '.join(heads)} |", "| --- | ---: | ---: |" + " ---: |" * len(heads)]
    for name, *_ in MEETINGS:
        for damping in DAMPINGS:
            cells = []
            for model in COLUMNS:
                values = found.get((name, model, damping))
                cells += ["–"] * len(TABLE_SPEEDS) if values is None else [f"{values[i]:.3f}" for i in TABLE_SPEEDS]
            lines.append(f"| {name} | {damping:g} | {RESTITUTION[damping]:.3f} | {' | '.join(cells)} |")
    return lines

"""Force against overlap, mode by mode, with the pieces of elasticity."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure

from dilatedem.post.figures.canvas import BLACK, new_figure, styled
from dilatedem.post.labels import number
from validation.contact_lab import pieces
from validation.contact_lab.attitudes import attitude, feature_centre
from validation.contact_lab.drawing import COLOUR, REFERENCE
from validation.contact_lab.probe import Poses, Probe
from validation.contact_lab.scenes import COLUMNS, CUBE, FLOE, HALF_CUBE, MODELS, PILE, PILE_RADIUS, scene

OVERLAPS = np.geomspace(1e-5, 1e-2, 61)  # m
TABLE = (1e-4, 1e-3)  # m, overlaps of the table
R = 0.04  # m, dilated radius
EDGE = 2.0 * HALF_CUBE  # m
UPRIGHT = 0.5 - 2.0 * R  # m, a floe's vertical edge
X = np.array([1.0, 0.0, 0.0])
#: the curves often lie on each other: each must leave something of those below to be seen
WIDTH = {"liu2015": 3.0, "consistent": 1.6}
OVER = {"color": BLACK, "linewidth": 0.8, "linestyle": (0, (5, 4))}


@dataclass(frozen=True)
class Meeting:
    """A feature of a (cube or floe) on one of b (cube or pile), along x; angle: between the directions of both [rad]."""

    name: str
    first: str
    second: str  # "pile": its side
    angle: float
    piece: str  # formula, as the legend says it
    law: Callable  # (overlap, E*) -> force of the piece


def _edges(degrees: float) -> Meeting:
    angle = np.radians(degrees)
    law = lambda d, e: pieces.crossing(d, e, (R, R), angle, EDGE)  # noqa: E731
    return Meeting(f"edges crossing at {degrees:g}°", "edge", "edge", angle, "ellipse or line", law)


MEETINGS = (
    Meeting("vertex on vertex", "vertex", "vertex", 0.3, "Hertz", lambda d, e: pieces.point(d, e, (2 / R, 2 / R))),
    Meeting("vertex on edge", "vertex", "edge", 0.3, "Hertz, elliptic", lambda d, e: pieces.point(d, e, (1 / R, 2 / R))),
    Meeting("vertex on face", "vertex", "face", 0.3, "Hertz", lambda d, e: pieces.point(d, e, (1 / R, 1 / R))),
    _edges(90.0), _edges(30.0), _edges(10.0),
    Meeting("parallel edges", "edge", "edge", 0.0, "line", lambda d, e: pieces.line(d, e, EDGE, R / 2)),
    Meeting("edge on face", "edge", "face", 0.0, "line", lambda d, e: pieces.line(d, e, EDGE, R)),
    Meeting("face on face", "face", "face", 0.0, "face", lambda d, e: pieces.face(d, e, EDGE, EDGE)),
    Meeting(
        "floe's vertex on the pile", "vertex", "pile", 0.3, "Hertz, elliptic",
        lambda d, e: pieces.point(d, e, (1 / R, 1 / R + 1 / PILE_RADIUS)),
    ),
    Meeting(
        "floe's edge along the pile", "edge", "pile", 0.0, "line",
        lambda d, e: pieces.line(d, e, UPRIGHT, R * PILE_RADIUS / (R + PILE_RADIUS)),
    ),
    Meeting("floe's side on the pile", "face", "pile", 0.0, "line", lambda d, e: pieces.line(d, e, UPRIGHT, PILE_RADIUS)),
)  # fmt: skip


def place(probe: Probe, meeting: Meeting, overlaps: np.ndarray) -> Poses:
    """The two features on each other at these deepest overlaps (n,) [m], their middles opposite."""
    along = np.array([0.0, np.sin(meeting.angle), np.cos(meeting.angle)])
    turn = attitude(meeting.first, X, along)
    poses = Poses.at_rest(probe, len(overlaps))
    distance = probe.radius(0) + probe.radius(1) - overlaps
    centre = feature_centre(probe.core(0), turn, X)
    poses = poses.moved(0, position=-centre - distance[:, None] * X, rotation=turn)
    if meeting.second == "pile":
        return poses
    other = attitude(meeting.second, -X, (0.0, 0.0, 1.0))
    return poses.moved(1, position=-feature_centre(probe.core(1), other, -X), rotation=other)


def probe_of(model: str, meeting: Meeting) -> Probe:
    return Probe(scene(model, FLOE, PILE) if meeting.second == "pile" else scene(model, CUBE, CUBE))


def over_piece(model: str, meeting: Meeting) -> np.ndarray:
    """Force over that of the piece, at the overlaps of TABLE."""
    probe, overlaps = probe_of(model, meeting), np.array(TABLE)
    return probe.at(place(probe, meeting, overlaps)).strength / meeting.law(overlaps, probe.modulus)


@styled
def figure() -> tuple[Figure, list[str]]:
    """The figure, and the lines of a table: force over that of the piece."""
    drawn = new_figure(8.6, 9.4)
    panels = drawn.subplots(4, 3, sharex=True, sharey=True)
    rows = []
    for axes, meeting in zip(panels.flat, MEETINGS, strict=True):
        ratios = {}
        for model in MODELS:
            probe = probe_of(model, meeting)
            force = probe.at(place(probe, meeting, OVERLAPS)).strength
            axes.plot(1e3 * OVERLAPS, force / 1e3, color=COLOUR[model], linewidth=WIDTH[model], label=model)
            ratios[model] = over_piece(model, meeting)
        axes.plot(1e3 * OVERLAPS, meeting.law(OVERLAPS, probe.modulus) / 1e3, label="piece of elasticity", **OVER)
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.set_title(meeting.name)
        axes.text(
            0.96, 0.05, f"piece: {meeting.piece}", transform=axes.transAxes, ha="right", fontsize=8.0, color=REFERENCE["color"]
        )
        axes.grid(True)
        cells = [number(float(ratio), 3) for model in COLUMNS for ratio in ratios.get(model, ())]
        cells += ["–"] * (len(TABLE) * len(COLUMNS) - len(cells))
        rows.append(f"| {meeting.name} | {meeting.piece} | " + " | ".join(cells) + " |")
    for axes in panels[-1]:
        axes.set_xlabel("Overlap (mm)")
    for axes in panels[:, 0]:
        axes.set_ylabel("Force (kN)")
    drawn.legend(*panels[0, 0].get_legend_handles_labels(), loc="outside upper center", ncols=3)
    heads = [f"{model}, {1e3 * overlap:g} mm" for model in COLUMNS for overlap in TABLE]
    head = f"| contact | piece | {' | '.join(heads)} |"
    return drawn, [head, "| --- | --- |" + " ---: |" * len(heads), *rows]

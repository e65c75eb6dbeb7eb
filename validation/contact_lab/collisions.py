"""Kinetic energy after over before of two floes that meet elastically, without friction: all of it, if the laws are consistent."""

from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure

from dilatedem.post.figures.canvas import BLACK, new_figure, styled
from validation.contact_lab.drawing import COLOUR
from validation.contact_lab.impacts import Impact, collide
from validation.contact_lab.scenes import COLUMNS, FLOE, HALF_FLOE, MODELS, scene

SPEED = 0.3  # m/s, of approach
SHARES = (1.0, 0.5, 0.25)  # of the automatic step
RADIUS = 0.04  # m, dilated radius
RAISED = 0.03  # m
START_GAP = 1e-3  # m
APART = 0.36  # of a row, between the models in the figure
OFF_PARALLEL = (0.1, 0.5, 1.0, 2.0, 3.0, 5.0)  # degrees


@dataclass(frozen=True)
class Meeting:
    """The second floe yawed [degrees], moved sideways and up [m] against the first, which comes side first."""

    name: str
    yaw: float
    aside: float
    up: float

    @property
    def forbidden(self) -> list[int]:
        """Components of spin that symmetry keeps at zero: a plane of symmetry lets only the spin about its normal through."""
        found = set()
        if self.up == 0.0:
            found |= {0, 1}
        if self.aside == 0.0 and self.yaw in (0.0, 45.0):
            found |= {0, 2}
        return sorted(found)


def _meetings() -> list[Meeting]:
    plain = [
        ("side on side", 0.0, 0.0),
        ("side on side, 1 m aside", 0.0, 1.0),
        ("yawed 10°", 10.0, 0.0),
        ("corner on side", 45.0, 0.0),
    ]
    slight = [
        (f"{yaw:g}° off parallel" + (", 1 m aside" if aside else ""), yaw, aside) for aside in (0.0, 1.0) for yaw in OFF_PARALLEL
    ]
    return [Meeting(*entry, up) for up in (0.0, RAISED) for entry in plain + slight]


MEETINGS = _meetings()


def touching(meeting: Meeting) -> float:
    """Distance of the centroids along x [m] at which the second floe reaches the plane of the first one's side."""
    yaw, core = np.radians(meeting.yaw), HALF_FLOE - RADIUS
    return HALF_FLOE + core * (abs(np.cos(yaw)) + abs(np.sin(yaw))) + RADIUS


def impact(model: str, meeting: Meeting, share: float) -> Impact:
    half = 0.5 * (touching(meeting) + START_GAP)
    first = FLOE | {"position": [-half, 0.0, 0.0]}
    second = FLOE | {"position": [half, meeting.aside, meeting.up], "rotation": [0.0, 0.0, float(np.radians(meeting.yaw))]}
    return collide(scene(model, first, second, speeds=(0.5 * SPEED, -0.5 * SPEED)), share=share)


def survey() -> dict[tuple[str, Meeting], list[Impact]]:
    """(model, meeting) -> impacts at SHARES of the automatic step."""
    found = {}
    for model in MODELS:
        for meeting in MEETINGS:
            found[model, meeting] = [impact(model, meeting, share) for share in SHARES]
        kept = [impacts[0].kept for (m, _), impacts in found.items() if m == model]
        print(f"collisions, {model}: kinetic energy after/before {min(kept):.4f} to {max(kept):.4f}", flush=True)
    return found


def forbidden_spin(meeting: Meeting, found: Impact) -> float | None:
    """Largest component of spin that symmetry forbids [rad/s]; None where it forbids none."""
    return float(np.abs(found.spin_after[:, meeting.forbidden]).max()) if meeting.forbidden else None


def table(found: dict) -> list[str]:
    """Kinetic energy after over before [%] at each step, and the spin that should not be."""
    steps = ("step", "1/2", "1/4")
    heads = [f"{model}: {what}" for model in COLUMNS for what in (*steps, "forbidden spin, rad/s")]
    lines = [f"| collision | {' | '.join(heads)} |", "| --- |" + " ---: |" * len(heads)]
    for meeting in MEETINGS:
        cells = []
        for model in COLUMNS:
            impacts = found.get((model, meeting))
            if impacts is None:
                cells += ["–"] * (len(steps) + 1)
                continue
            spin = forbidden_spin(meeting, impacts[0])
            cells += [f"{100.0 * each.kept:.3f}" for each in impacts] + ["" if spin is None else f"{spin:.1e}"]
        lines.append(f"| {meeting.name}{', 3 cm up' if meeting.up else ''} | {' | '.join(cells)} |")
    return lines


@styled
def figure(found: dict) -> Figure:
    """Kinetic energy kept, by collision; level and raised beside each other."""
    names = [meeting.name for meeting in MEETINGS if not meeting.up]
    drawn = new_figure(9.0, 4.9)
    panels = drawn.subplots(1, 2, sharey=True, sharex=True)
    place = np.arange(len(names))
    for axes, up in zip(panels, (0.0, RAISED), strict=True):
        for s, (share, size) in enumerate(zip(SHARES, (7.0, 4.5, 2.5), strict=True)):
            for m, model in enumerate(MODELS):
                kept = [100.0 * found[model, meeting][s].kept for meeting in MEETINGS if meeting.up == up]
                style = {"color": COLOUR[model], "marker": "os"[m], "markersize": size, "linestyle": "none", "fillstyle": "none"}
                axes.plot(kept, place + APART * (m - 0.5 * (len(MODELS) - 1)), label=f"{model}, step × {share:g}", **style)
        axes.axvline(100.0, color=BLACK, linewidth=0.8)
        axes.set_title("Level" if not up else f"One floe {100 * up:g} cm up")
        axes.set_xlabel("Kinetic energy after / before (%)")
        axes.grid(True)
    panels[0].set_yticks(place, names)
    panels[0].set_ylim(len(names) - 0.5, -0.5)
    drawn.legend(*panels[0].get_legend_handles_labels(), loc="outside upper center", ncols=3)
    return drawn

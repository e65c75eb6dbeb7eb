"""How the force of a central impact rises from the first touch on, by the dashpots of `consistent`."""

from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure

from dilatedem.case.schema import Case
from dilatedem.post.figures.canvas import BLACK, BLUE, VERMILION, new_figure, styled
from dilatedem.post.labels import number
from dilatedem.run.simulation import Simulation
from dilatedem.state.clock import Status
from validation.contact_lab.restitution import MEETINGS
from validation.contact_lab.scenes import scene

SPEEDS = (0.01, 0.3, 2.0)  # m/s, of approach
DRAWN = 0.3  # m/s
DAMPING = 0.36
#: how the dampings are told apart: of the case, law and coefficient, and colour
LAWS = {
    "elastic": ("viscous", 0.0, BLACK), "viscous": ("viscous", DAMPING, VERMILION), "touch": ("touch", DAMPING, BLUE),
}  # fmt: skip
SOON = 2e-4  # s after the first touch
STEPS_BEFORE = 2.5  # steps before the first touch, at which bodies begin
LONGEST = 100_000  # steps of an impact


@dataclass(frozen=True)
class Rise:
    """The force of an impact, step by step."""

    step: float  # s
    time: np.ndarray  # (n,) s since the first touch
    force: np.ndarray  # (n,) N
    restitution: float

    @property
    def peak(self) -> float:
        return float(self.force.max())

    @property
    def first(self) -> float:
        """Share of the peak in the first step that knows of the contact."""
        return float(self.force[0]) / self.peak

    def share_at(self, time: float) -> float:
        """Share of the peak at a time [s] after the first touch."""
        return float(np.interp(time, np.r_[0.0, self.time], np.r_[0.0, self.force])) / self.peak

    @property
    def rise(self) -> float:
        """Time [s] from a tenth to nine tenths of the peak."""
        until = slice(0, int(self.force.argmax()) + 1)
        low, high = np.interp([0.1, 0.9], np.r_[0.0, self.force[until] / self.peak], np.r_[0.0, self.time[until]])
        return float(high - low)


def case_of(meeting: tuple, law: str, damping: float, speed: float, ahead: float) -> Case:
    """Two bodies just apart; ahead: time [s] until they touch."""
    _, first, second, distance = meeting
    half = 0.5 * (distance + speed * ahead)
    placed = first | {"position": [-half, 0.0, 0.0]}, second | {"position": [half, 0.0, 0.0]}
    return scene("consistent", *placed, damping=damping, damping_law=law, speeds=(0.5 * speed, -0.5 * speed))


def measure(meeting: tuple, law: str, damping: float, speed: float, step: float | None = None) -> Rise:
    """One impact; step [s]: the automatic one unless given."""
    if step is None:
        step = Simulation.of_case(case_of(meeting, law, damping, speed, SOON)).dt
    simulation = Simulation.of_case(case_of(meeting, law, damping, speed, STEPS_BEFORE * step))
    simulation.dt, simulation.span = step, 1
    bodies, force = simulation.state.bodies, []
    simulation.evaluate()
    before = bodies.velocity[1, 0] - bodies.velocity[0, 0]
    while len(force) < LONGEST and (simulation.contacts > 0 or not any(force)):
        if simulation.advance(1) != Status.DONE:
            raise ValueError(f"the impact stops after {len(force)} steps")
        force.append(float(np.linalg.norm(bodies.contact_force[0])))
    simulation.advance(1)
    after = bodies.velocity[1, 0] - bodies.velocity[0, 0]
    start = int(np.flatnonzero(force)[0])
    time = step * (np.arange(start, len(force)) + 1.0 - STEPS_BEFORE)
    return Rise(step, time, np.array(force[start:]), float(-after / before))


def survey() -> dict[tuple[str, float, str], Rise]:
    """(meeting, speed, law) -> impact."""
    return {
        (meeting[0], speed, name): measure(meeting, law, damping, speed)
        for meeting in MEETINGS
        for speed in SPEEDS
        for name, (law, damping, _) in LAWS.items()
    }


@styled
def figure(found: dict) -> Figure:
    """Force over time of each meeting at one speed."""
    drawn = new_figure(9.0, 3.3)
    panels = drawn.subplots(1, len(MEETINGS))
    for axes, (name, *_) in zip(panels, MEETINGS, strict=True):
        for law, (_, _, colour) in LAWS.items():
            rise = found[name, DRAWN, law]
            axes.plot(1e3 * np.r_[0.0, rise.time], 1e-3 * np.r_[0.0, rise.force], color=colour, label=law)
        axes.set_title(name)
        axes.set_xlabel("Time since the first touch (ms)")
        axes.set_xlim(left=0.0)
        axes.set_ylim(bottom=0.0)
        axes.grid(True)
    panels[0].set_ylabel("Force (kN)")
    drawn.legend(*panels[0].get_legend_handles_labels(), loc="outside upper center", ncols=len(LAWS))
    return drawn


def table(found: dict) -> list[str]:
    """Peak against the elastic one, restitution, and how the force rises."""
    lines = [
        "| impact | speed, m/s | dashpot | peak over elastic | restitution | first step, % of peak | 0.2 ms, % of peak | "
        "rise 10 to 90 %, ms |",
        "| --- | ---: | --- | ---: | ---: | ---: | ---: | ---: |",
    ]
    for (name, speed, law), rise in found.items():
        over = rise.peak / found[name, speed, "elastic"].peak
        shares = [number(100.0 * share, 2) for share in (rise.first, rise.share_at(SOON))]
        lines.append(
            f"| {name} | {speed:g} | {law} | {over:.3f} | {rise.restitution:.4f} | {' | '.join(shares)} | {1e3 * rise.rise:.3g} |"
        )
    return lines

"""Ice enters on the upstream side, strip by strip, and what has left through the others is dropped.

A strip enters where it has come to with the drift since t = 0, all of it outside of the domain, as fast as the ice drifts. Where
ice is backed up to there it waits, and all ice behind it: what is forced into a jam would be thrown apart by the laws of contact.
"""

import numpy as np

from dilatedem.events.clear import is_clear
from dilatedem.events.event import Event
from dilatedem.events.outflow import leave
from dilatedem.events.repack import joined, of_rows
from dilatedem.field.placement import touching_obstacles
from dilatedem.motion.timestep import critical_step
from dilatedem.scene.entering import Newcomers
from dilatedem.scene.ice import varied
from dilatedem.scene.inflow import LOOK, drift_speed, entrance
from dilatedem.scene.recipe import periodic_axes
from dilatedem.state.bodies import Bodies

#: share of a floe's own critical step that the run's may be; one for which it would be more is too small to enter. Peaks of loads
#: overshoot above it (docs/theory.md, time step)
LARGEST_SHARE = 0.5


class Inflow(Event):
    """Where a boundary of the case is "inflow"."""

    @classmethod
    def interval(cls, case) -> float:
        return LOOK if case.domain.inflow is not None else 0.0

    def __init__(self, simulation):
        super().__init__(simulation)
        case = simulation.case
        self._speed, self._entrance = drift_speed(case), entrance(case)
        self._share = max(LARGEST_SHARE, simulation.dt / simulation.critical)
        still = [structure for structure in case.structure if not structure.support.moves]
        thickest = float(varied(case, simulation.entering.stream.count).max())
        self._obstacles = [obstacle for structure in still for obstacle in structure.obstacles(thickest)]

    def happen(self, simulation) -> bool:
        inflow, before = simulation.state.inflow, simulation.state.ids
        while simulation.entering.stream.begins(int(inflow.strip[0])) - self._way(simulation) <= self._entrance:
            inflow.left[0] += leave(simulation)
            if not self._let_enter(simulation, simulation.entering.strip(int(inflow.strip[0]))):
                inflow.since[0] = min(inflow.since[0], simulation.time_s)
                inflow.waited[0] += LOOK
                inflow.lag[0] += self._speed * LOOK
                break
            inflow.strip[0] += 1
        return simulation.state.ids is not before

    def summary(self, simulation) -> dict:
        inflow = simulation.state.inflow
        return {"inflow": {
            "entered": int(inflow.entered[0]), "left": int(inflow.left[0]), "omitted": int(inflow.omitted[0]),
            "ice_m": float(self._way(simulation)), "waited_s": float(inflow.waited[0]), "waited_first_s": float(inflow.since[0]),
        }}  # fmt: skip

    def remark(self, simulation) -> str:
        inflow = simulation.state.inflow
        if not inflow.waited[0]:
            return ""
        return (
            f"ice was backed up to where new ice enters, first at t = {inflow.since[0]:.0f} s: that had to wait for "
            f"{inflow.waited[0]:.0f} s in all, and did not press from behind, so that loads from then on are too low; move the "
            "upstream side farther away"
        )

    def _way(self, simulation) -> float:
        """How far the stream has come since t = 0 [m]."""
        return self._speed * simulation.time_s - float(simulation.state.inflow.lag[0])

    def _let_enter(self, simulation, strip: Newcomers) -> bool:
        """Put a strip where the drift has brought it; returns whether there was room."""
        case, stream, inflow = simulation.case, simulation.entering.stream, simulation.state.inflow
        shift, across = stream.course.along(-self._way(simulation)), 1 - stream.course.axis
        if periodic_axes(case)[across]:
            period = case.domain.size[across]
            shift[across] = np.remainder(case.ice_velocity[across] * simulation.time_s, period)
            shift[across] -= period * round(shift[across] / period)
        outlines = strip.scene.outlines
        moved = type(outlines)(outlines.points + shift, outlines.start)
        fits = ~touching_obstacles(moved, self._obstacles, np.asarray(case.domain.size), periodic_axes(case))
        fits &= self._can_step(simulation, strip)
        rows = np.concatenate([np.flatnonzero(fits), np.arange(len(fits), len(strip.model.structure_of))])
        model, bodies = of_rows(strip.model, rows), Bodies(*(values[rows] for values in strip.bodies))
        bodies.position[: model.floating, :2] += shift
        if not is_clear(simulation, model, bodies):
            return False
        inflow.carried_in[0] += joined(simulation, model, bodies, strip.ids[fits])
        inflow.entered[0] += model.floating
        inflow.omitted[0] += strip.narrow + np.count_nonzero(~fits)
        return True

    def _can_step(self, simulation, strip: Newcomers) -> np.ndarray:
        """(floes,) whether the time step is short enough for each, and no period so short that one could meet another twice."""
        periods = [size for size, wraps in zip(simulation.case.domain.size, periodic_axes(simulation.case), strict=True) if wraps]
        floes, least = np.arange(len(strip.ids)), simulation.dt / self._share
        fits = 4.0 * strip.model.shapes.reach[floes] < min(periods, default=np.inf)
        if critical_step(strip.model, strip.bodies, floes) < least:
            fits &= [critical_step(strip.model, strip.bodies, floes[i : i + 1]) >= least for i in floes]
        return fits

"""Bodies that have left the domain through an open side are dropped: nothing meets them again."""

import numpy as np

from dilatedem.events.event import Event
from dilatedem.events.repack import whole_floes, without
from dilatedem.scene.inflow import course_of

#: s between two looks for bodies that have left
INTERVAL = 1.0


class Outflow(Event):
    """Where a boundary of the case is "outflow"."""

    @classmethod
    def interval(cls, case) -> float:
        return INTERVAL if "outflow" in case.domain.boundaries and case.domain.inflow is None else 0.0

    def happen(self, simulation) -> bool:
        return leave(simulation) > 0


def leave(simulation) -> int:
    """Drop all free bodies that lie beyond a side as a whole which ice leaves through; returns how many."""
    case, model = simulation.case, simulation.model
    count, sides = model.floating, np.full((2, 2), np.inf)  # m from the middle, along x and y, low and high
    for axis, boundary in enumerate(case.domain.boundaries):
        if boundary in ("outflow", "inflow"):
            sides[axis] = 0.5 * case.domain.size[axis]
        if boundary == "inflow":
            sides[axis, int(course_of(case).upstream > 0)] = np.inf
    position, reach = simulation.state.bodies.position[:count, :2], model.shapes.reach[:count, None]
    beyond = (-position - sides[:, 0] > reach) | (position - sides[:, 1] > reach)
    gone = whole_floes(beyond.any(axis=1) & (model.solids.inverse_mass[:count] > 0.0), model)
    if gone.any():
        without(simulation, gone)
    return int(np.count_nonzero(gone))

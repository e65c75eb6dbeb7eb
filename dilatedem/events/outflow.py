"""Bodies that have left the domain through an open side are dropped: nothing meets them again."""

import numpy as np

from dilatedem.events.event import Event
from dilatedem.events.repack import without

#: s between two looks for bodies that have left
INTERVAL = 1.0


class Outflow(Event):
    """Where a boundary of the case is "outflow"."""

    @classmethod
    def interval(cls, case) -> float:
        return INTERVAL if "outflow" in (case.domain.x_boundary, case.domain.y_boundary) else 0.0

    def happen(self, simulation) -> bool:
        """Drop all free bodies that lie beyond a side as a whole."""
        domain, model = simulation.case.domain, simulation.model
        boundaries = np.array([domain.x_boundary, domain.y_boundary])
        half = np.where(boundaries == "outflow", 0.5 * np.array(domain.size), np.inf)
        count = model.floating
        beyond = np.abs(simulation.state.bodies.position[:count, :2]) - half > model.shapes.reach[:count, None]
        gone = beyond.any(axis=1) & (model.solids.inverse_mass[:count] > 0.0)
        if gone.any():
            without(simulation, gone)
        return bool(gone.any())

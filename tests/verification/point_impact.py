"""What a case with impacts at a point is read for: overlap, force, duration, velocities before and after."""

from dataclasses import dataclass

import numpy as np

from dilatedem.run.simulation import Simulation
from dilatedem.state.clock import Status


@dataclass
class Impact:
    """One pair's impact: the largest overlap [m] and normal force [N], and how long it lasted [s]."""

    overlap: float
    force: float
    duration: float


def _peak(values: np.ndarray) -> float:
    """Largest value of a smooth history, by the parabola through the three samples around it."""
    i = int(values.argmax())
    before, top, after = values[i - 1 : i + 2]
    return float(top + (before - after) ** 2 / (8 * (2 * top - before - after)))


def impacts(simulation: Simulation, *, every: int = 1) -> dict[tuple[int, int], Impact]:
    """Run a case to its end, where nothing may touch any more; the impacts of all pairs (a, b), looked at every so many steps."""
    seen: dict[tuple[int, int], list[tuple[int, float, float]]] = {}
    steps = round(simulation.case.time.duration / simulation.dt)
    for step in range(every, steps + 1, every):
        assert simulation.advance(every) == Status.DONE
        pairs = simulation.state.pairs
        for k in np.flatnonzero(pairs.overlap[: pairs.count[0]] > 0.0):
            key = (int(pairs.a[k]), int(pairs.b[k]))
            seen.setdefault(key, []).append((step, float(pairs.overlap[k]), float(pairs.normal_force[k])))
    assert simulation.contacts == 0, "still touching at the end"
    found = {}
    for key, history in seen.items():
        step, overlap, force = np.array(history).T
        assert (np.diff(step) == every).all(), "touched twice"
        # at both ends the overlap is all but linear in time
        ends = overlap[0] / (overlap[1] - overlap[0]) + overlap[-1] / (overlap[-2] - overlap[-1])
        found[key] = Impact(_peak(overlap), _peak(force), (len(step) - 1 + ends) * every * simulation.dt)
    return found

"""The way to rest of a static case: whenever all kinetic energy together has passed a peak, everything is stopped (Cundall 1982).

A body that is stopped where its kinetic energy is largest stands where nothing pushes it; of many that hang together each stop
leaves less. So is everything wherever it is in balance, for what drifts without a force has no peak. What the stops take out is a
term of the ledger. At rest is what stands still in balance, but for a share of the largest load.
"""

from typing import NamedTuple

import numpy as np

from dilatedem.events.event import Event
from dilatedem.numerics.plain import norm
from dilatedem.output.schedule import Schedule
from dilatedem.state.modal import ModalBodies

#: steps between two looks at the kinetic energy: a third of the period of the stiffest contact
STEPS = 10
#: what is set to zero
MOTION = (
    "velocity", "angular_velocity", "angular_momentum", "middle_velocity", "middle_angular_velocity", "middle_angular_momentum",
)  # fmt: skip
MODAL_MOTION = ("rate", "middle_rate")


class Relaxed(NamedTuple):
    """How far a case is on its way to rest."""

    energy: np.ndarray  # (1,) J, kinetic, at the last look
    loss: np.ndarray  # (1,) J that stops have taken out
    stops: np.ndarray  # (1,) how many
    residual: np.ndarray  # (1,) what is out of balance at the last one, over the largest load
    settled: np.ndarray  # (1,) step at which everything was at rest; -1: it is not yet


def begun() -> Relaxed:
    """Nothing done yet."""
    return Relaxed(np.zeros(1), np.zeros(1), np.zeros(1, np.int64), np.full(1, np.inf), np.full(1, -1))


class Relaxation(Event):
    """Where `time.mode` is "relax"."""

    @classmethod
    def interval(cls, case) -> float:
        """It looks every few steps, however long they are."""
        return case.time.duration if case.time.relaxes else 0.0

    def __init__(self, simulation):
        self.schedule = Schedule(STEPS * simulation.dt, simulation.dt)

    def happen(self, simulation) -> bool:
        relaxed, now, most = simulation.state.relaxed, kinetic_energy(simulation), simulation.case.time.residual
        if now < relaxed.energy[0] or imbalance(simulation) <= most:
            _stop(simulation)
            relaxed.loss[0] += now
            relaxed.stops[0] += 1
            relaxed.residual[0], now = imbalance(simulation), 0.0
            if relaxed.residual[0] <= most and relaxed.settled[0] < 0:
                relaxed.settled[0] = simulation.state.clock.step[0]
        relaxed.energy[0] = now
        return False

    def summary(self, simulation) -> dict:
        relaxed = simulation.state.relaxed
        settled, left = int(relaxed.settled[0]), float(relaxed.residual[0])
        return {
            "relaxation": {
                "settled": settled >= 0, "residual": left if np.isfinite(left) else None, "stops": int(relaxed.stops[0]),
                "time_s": settled * simulation.dt if settled >= 0 else None,
            }
        }  # fmt: skip

    def remark(self, simulation) -> str:
        relaxed = simulation.state.relaxed
        return f"at rest after {relaxed.stops[0]} stops: {relaxed.residual[0]:.2g} of the largest load is out of balance"


def unsettled(simulation) -> str:
    """What keeps a case that should have come to rest from having done so, in a sentence; empty: nothing."""
    relaxed, time = simulation.state.relaxed, simulation.case.time
    if relaxed is None or relaxed.settled[0] >= 0:
        return ""
    left = f"{relaxed.residual[0]:.2g} of the largest load" if np.isfinite(relaxed.residual[0]) else "more than can be told"
    return (
        f"no rest within time.duration = {time.duration:g} s: after {relaxed.stops[0]} stops {left} is out of balance, not "
        f"time.residual = {time.residual:g}; give it more time, or look for a body that nothing holds"
    )


def kinetic_energy(simulation) -> float:
    """J, of all bodies that move and of their modes."""
    bodies, solids = simulation.state.bodies, simulation.model.solids
    free = solids.inverse_mass > 0.0
    straight = (solids.mass[:, None] * bodies.velocity**2)[free].sum()
    turning = (bodies.angular_momentum * bodies.angular_velocity)[free].sum()
    vibrating = (bodies.rate[free] ** 2).sum() if isinstance(bodies, ModalBodies) else 0.0
    return float(0.5 * (straight + turning + vibrating))


def imbalance(simulation) -> float:
    """The largest force, torque over the body's reach, or load on modes that is out of balance, over the largest load on a body."""
    bodies, model = simulation.state.bodies, simulation.model
    free = np.flatnonzero(model.solids.inverse_mass > 0.0)
    mass, reach = model.solids.mass[free], model.shapes.reach[free]
    load = max(float((mass * model.loads.gravity).max()), float(norm(bodies.contact_force[free]).max()))
    left = np.maximum(norm(bodies.force[free]), norm(bodies.torque[free]) / reach)
    if isinstance(bodies, ModalBodies):
        pull = bodies.mode_force[free] - model.solids.mode_square[free] * bodies.coordinate[free]
        left = np.maximum(left, np.sqrt(mass) * norm(pull))
    return float(left.max()) / load if load > 0.0 else float(left.max() > 0.0)


def _stop(simulation) -> None:
    """Have everything stand still, under the loads of this instant."""
    bodies, free = simulation.state.bodies, simulation.model.solids.inverse_mass > 0.0
    for name in (*MOTION, *(MODAL_MOTION if isinstance(bodies, ModalBodies) else ())):
        getattr(bodies, name)[free] = 0.0
    simulation.evaluate()

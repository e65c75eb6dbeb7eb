"""Two bodies that meet, from just before to well after: what a collision lab runs again and again."""

from dataclasses import dataclass

import numpy as np

from dilatedem.case.schema import Case
from dilatedem.run.simulation import Simulation
from dilatedem.state.clock import Status

CHUNK = 1200  # steps between two looks
FLIGHT = 64  # times as many steps as usual are one until the bodies meet: nothing acts on them, and they do not turn
QUIET = 0.6  # s of steady motion after which a collision is over: one end of a floe may hit long after the other
PATIENCE = 5.0  # s, in which a collision has to begin, and then to end


@dataclass(frozen=True)
class Impact:
    """Motion of two bodies before and after."""

    dt: float  # s
    kinetic_before: float  # J
    kinetic_after: float  # J
    velocity_before: np.ndarray  # (2, 3) m/s
    velocity_after: np.ndarray
    spin_after: np.ndarray  # (2, 3) rad/s
    ledger: dict[str, float]  # J, its terms afterwards

    @property
    def kept(self) -> float:
        """Kinetic energy after over before."""
        return self.kinetic_after / self.kinetic_before

    @property
    def restitution(self) -> float:
        """Speed of parting over speed of approach, along x."""
        before, after = (v[1, 0] - v[0, 0] for v in (self.velocity_before, self.velocity_after))
        return float(-after / before)


def collide(case: Case, *, share: float = 1.0, patience: float = PATIENCE) -> Impact | None:
    """Run a case of two bodies through their collision; None where they miss each other.

    share: of the automatic step; patience [s]: in which the collision has to begin. Raises ValueError where it does not end.
    """
    simulation = Simulation.of_case(case)
    simulation.dt *= share
    span, simulation.span = simulation.span, FLIGHT * simulation.span
    bodies = simulation.state.bodies
    _advance(simulation, 0)
    kinetic, velocity = simulation.energies()["kinetic"], bodies.velocity[:2].copy()
    quiet, touched, last = 0.0, False, velocity
    while not touched or quiet < QUIET:
        if not touched and simulation.time_s > patience:
            return None
        if simulation.time_s > patience + PATIENCE:
            raise ValueError(f"no end of the collision within {simulation.time_s:g} s")
        _advance(simulation, CHUNK)
        pushed = simulation.contacts > 0 or not np.allclose(bodies.velocity[:2], last, rtol=1e-12, atol=1e-12)
        touched, last = touched or pushed, bodies.velocity[:2].copy()
        if touched:
            simulation.span = span
        quiet = 0.0 if pushed else quiet + CHUNK * simulation.dt
    ledger = simulation.energies()
    return Impact(
        simulation.dt, kinetic, ledger["kinetic"], velocity, bodies.velocity[:2].copy(), bodies.angular_velocity[:2].copy(), ledger
    )


def _advance(simulation: Simulation, steps: int) -> None:
    status = simulation.advance(steps) if steps else simulation.evaluate()
    if status != Status.DONE:
        raise ValueError(f"the collision stops at {simulation.time_s:.6g} s: {status.name}")

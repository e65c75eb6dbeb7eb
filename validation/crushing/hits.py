"""One body that hits a structure in a case of this folder, followed step by step."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from dilatedem.case.load import load
from dilatedem.case.schema import Case
from dilatedem.run.simulation import Simulation
from dilatedem.state.clock import Status
from validation.crushing.references import Elastic

HERE = Path(__file__).parent
#: steps after which a hit must be over
LONGEST = 400_000
#: steps that are taken after the last contact
AFTER = 20


@dataclass(frozen=True)
class Hit:
    """What a hit did, step by step from the first contact on."""

    time: np.ndarray  # (n,) s since the first contact
    force: np.ndarray  # (n,) N
    crushed: np.ndarray  # (n,) m
    mass: float  # kg
    speed_before: float  # m/s
    speed_after: float
    energies: dict[str, float]  # J, what the ledger has gained since the start, term by term

    @property
    def peak(self) -> float:
        return float(self.force.max())

    @property
    def depth(self) -> float:
        return float(self.crushed[-1])

    @property
    def rise(self) -> float:
        """Time [s] from touch to where nothing crushes any more."""
        return float(self.time[int(np.argmax(self.crushed >= self.depth))])

    @property
    def restitution(self) -> float:
        return self.speed_after / self.speed_before

    @property
    def lost(self) -> float:
        """Energy [J] that crushing took."""
        return self.energies.get("loss_crushing", 0.0)

    @property
    def residual(self) -> float:
        """What the ledger does not account for, over the kinetic energy at the start."""
        gained = self.energies
        own = sum(gained[name] for name in ("kinetic", "elastic", "gravity", "loss_damping", "loss_friction"))
        return (own + self.lost - gained["gain_law"]) / (0.5 * self.mass * self.speed_before**2)


def case_of(name: str, *overrides: str) -> Case:
    return load(HERE / f"{name}.toml", overrides)


def begin(case: Case) -> Simulation:
    simulation = Simulation.of_case(case)
    if simulation.evaluate() != Status.DONE:
        raise ValueError("the case cannot begin")
    return simulation


def follow(simulation: Simulation) -> Hit:
    """From where it is until its body has come off again."""
    bodies, pairs = simulation.state.bodies, simulation.state.pairs
    mass, at_start = float(simulation.model.solids.mass[0]), simulation.energies()
    before = float(np.linalg.norm(bodies.velocity[0]))
    rows, after = [], 0
    while after < AFTER:
        if simulation.advance(1) != Status.DONE or len(rows) > LONGEST:
            raise ValueError(f"the hit does not end: {simulation.time_s:g} s")
        if simulation.contacts > 0 or rows:
            rows.append((simulation.time_s, float(pairs.normal_force[0]), float(pairs.crushed[0])))
        after = after + 1 if rows and simulation.contacts == 0 else 0
    time, force, crushed = np.array(rows).T
    gained = {name: value - at_start[name] for name, value in simulation.energies().items()}
    return Hit(time - time[0], force, crushed, mass, before, float(np.linalg.norm(bodies.velocity[0])), gained)


def hit(name: str, *overrides: str) -> Hit:
    return follow(begin(case_of(name, *overrides)))


def again(simulation: Simulation, speed: float) -> Hit:
    """A second hit: the body that came off is sent back the way it came from, at another speed [m/s], without turning."""
    bodies = simulation.state.bodies
    bodies.velocity[0] *= -speed / np.linalg.norm(bodies.velocity[0])
    bodies.angular_velocity[0] = 0.0
    simulation.evaluate()
    return follow(simulation)


def elastic(name: str, *overrides: str, deepest: float, count: int = 60) -> Elastic:
    """The elastic law of a case's contact at overlaps up to `deepest` [m], with no crushing: its force in so many poses."""
    simulation = begin(case_of(name, *overrides, "ice.crushing_pressure=1e15"))
    bodies, pairs = simulation.state.bodies, simulation.state.pairs
    toward = bodies.velocity[0] / np.linalg.norm(bodies.velocity[0])
    place, touch = bodies.position[0].copy(), float(pairs.wake[0] - bodies.path[0])
    overlaps = deepest * np.linspace(1.0 / count, 1.0, count) ** 2
    force = np.zeros(count)
    for i, overlap in enumerate(overlaps):
        bodies.position[0] = place + (touch + overlap) * toward
        for array in (pairs.count, pairs.limit, pairs.wake, pairs.row):
            array.fill(0)  # no memory of another pose
        if simulation.evaluate() != Status.DONE:
            raise ValueError(f"an overlap of {overlap:g} m cannot be evaluated")
        force[i] = pairs.normal_force[0]
    return Elastic(overlaps, force)

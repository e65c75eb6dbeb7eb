"""Two bodies held in given poses, and what the program says of their contact: gap, mode, force, moments, stored energy.

    probe = Probe(scene("liu2015", CUBE, FLOE))
    answers = probe.at(Poses.at_rest(probe, 100).moved(1, position=...))

Everything is read from a `Simulation` as a run sees it: force and moments from the bodies' contact loads, the energy from the
ledger. Every pose is evaluated cold, with no memory of the pose before, unless `warm` asks for it. 40 us per pose.
"""

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from dilatedem.case.schema import Case
from dilatedem.run.simulation import Simulation
from dilatedem.state.clock import Status

NO_CONTACT = -1


@dataclass(frozen=True)
class Answers:
    """What a probe found at n poses."""

    gap: (
        np.ndarray
    )  # (n,) m; in contact minus the overlap that the law uses (at the patch's centroid for `liu2015`); inf: far apart
    mode: np.ndarray  # (n,) state.modes.Mode, NO_CONTACT where the bodies are apart
    force: np.ndarray  # (n, 3) N, on b
    moment: np.ndarray  # (n, 2, 3) N m, on a about its centroid, on b about its own
    energy: np.ndarray  # (n,) J, stored

    @property
    def strength(self) -> np.ndarray:
        """(n,) N, size of the force."""
        return np.linalg.norm(self.force, axis=1)


@dataclass(frozen=True)
class Poses:
    """n poses of two bodies: centroids (n, 2, 3) [m], unit quaternions (n, 2, 4), scalar first, body to world."""

    position: np.ndarray
    orientation: np.ndarray

    @classmethod
    def at_rest(cls, probe: "Probe", count: int) -> "Poses":
        """The bodies as the case has them, `count` times."""
        bodies = probe.simulation.state.bodies
        return cls(
            np.tile(probe.start_position, (count, 1, 1)), np.tile(bodies.orientation[:2] * 0 + [1.0, 0, 0, 0], (count, 1, 1))
        )

    def moved(self, body: int, *, position=None, rotation: Rotation | None = None) -> "Poses":
        """The same with one body elsewhere: position (n, 3) or (3,), rotation n or one; what is not given stays."""
        places, turns = self.position.copy(), self.orientation.copy()
        if position is not None:
            places[:, body] = position
        if rotation is not None:
            turns[:, body] = rotation.as_quat(scalar_first=True)
        return Poses(places, turns)

    def __len__(self) -> int:
        return len(self.position)

    def __getitem__(self, part) -> "Poses":
        return Poses(self.position[part], self.orientation[part])


class Probe:
    """Two bodies of a case, a (number 0) and b (1; a structure stays where the case has it)."""

    def __init__(self, case: Case):
        self.simulation = Simulation.of_case(case)
        if len(self.simulation.state.bodies.position) != 2:
            raise ValueError("a probe holds two bodies, or a body and a structure")
        self.start_position = self.simulation.state.bodies.position.copy()
        self.start_orientation = self.simulation.state.bodies.orientation.copy()

    @property
    def modulus(self) -> float:
        """E* of the pair [Pa]."""
        return 1.0 / float(self.simulation.model.solids.compliance.sum())

    def core(self, body: int) -> np.ndarray:
        """Vertices (v, 3) of a body's core in its own frame [m]."""
        shapes = self.simulation.model.shapes
        return shapes.vertex[shapes.vertex_start[body] : shapes.vertex_start[body + 1]]

    def radius(self, body: int) -> float:
        """Dilated radius [m]."""
        return float(self.simulation.model.shapes.radius[body])

    def at(self, poses: Poses, *, warm: bool = False) -> Answers:
        """Evaluate the contact at rest in each pose; warm: every pose starts from what the one before has left.

        Raises ValueError for a pose in which the bodies overlap more than the program can mean.
        """
        count = len(poses)
        gap, mode, energy = np.empty(count), np.empty(count, np.int64), np.empty(count)
        force, moment = np.empty((count, 3)), np.empty((count, 2, 3))
        simulation = self.simulation
        bodies, pairs = simulation.state.bodies, simulation.state.pairs
        self._forget()
        for i in range(count):
            if not warm:
                self._forget()
            pairs.limit[0] = 0.0  # the list of neighbours is made anew
            bodies.position[:] = poses.position[i]
            bodies.orientation[:] = poses.orientation[i]
            if simulation.evaluate() != Status.DONE:
                raise ValueError(f"pose {i}: {float(simulation.state.clock.measure[0]):.3g} m of overlap cannot be evaluated")
            touching = pairs.overlap[0] > 0.0
            gap[i] = -pairs.overlap[0] if touching else (pairs.wake[0] if pairs.count[0] else np.inf)
            mode[i] = pairs.mode[0] if touching else NO_CONTACT
            force[i], moment[i] = bodies.contact_force[1], bodies.contact_torque
            energy[i] = simulation.energies()["elastic"]
        return Answers(gap, mode, force, moment, energy)

    def _forget(self) -> None:
        """Nothing known of any pose before: no neighbours, no closest corners, no contact."""
        for array in self.simulation.state.pairs:
            array.fill(0)

"""Two bodies held in given poses, and what the program says of their contact: gap, mode, force, moments, stored energy.

    probe = Probe(scene("liu2015", CUBE, FLOE))
    answers = probe.at(Poses.at_rest(probe, 100).moved(1, position=...))

Everything is read from a `Simulation` as a run sees it: force and moments from the bodies' contact loads, the energy from the
pairs. Every pose is evaluated cold, with no memory of another. A call of the step costs far more than a pair: many poses are
evaluated in one, each by a copy of the two bodies that is out of reach of the others. 5 us per pose.
"""

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from benchmarks.scenes import tiled
from dilatedem.case.schema import Case
from dilatedem.run.simulation import Simulation
from dilatedem.state.clock import Status

NO_CONTACT = -1
#: copies along x and along y: for a few poses, and for many
FEW, MANY = (2, 2), (8, 8)
#: m, of a pose from the origin at most
REACH = 7.0


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


class _Copies:
    """A simulation of two bodies, a (number 0) and b (1), many times."""

    def __init__(self, pair: Simulation, along: tuple[int, int]):
        self.simulation, self.count = tiled(pair, *along), along[0] * along[1]
        start, floating = self.simulation.state.bodies.position, pair.model.floating
        numbers = np.arange(len(start)).reshape(-1, self.count)
        # floes stand copy by copy, structures after all of them
        self.number = numbers.reshape(self.count, 2).T if floating == 2 else numbers
        self.moved = np.round(start[self.number[0]] - pair.state.bodies.position[0])  # (count, 3) m
        # places are rounded to what those of the farthest copy can hold: every copy is in the same pose to the last bit
        self.grid = np.spacing(np.abs(self.moved).max() + REACH)

    def at(self, position: np.ndarray, orientation: np.ndarray) -> tuple:
        """Gap, mode, force, moment and energy of up to `count` poses, as in `Answers`; copies left repeat the last."""
        asked, pose = len(position), np.minimum(np.arange(self.count), len(position) - 1)
        simulation, bodies, pairs = self.simulation, self.simulation.state.bodies, self.simulation.state.pairs
        for array in (pairs.count, pairs.frame, pairs.limit, pairs.a, pairs.b, pairs.wake, pairs.row):
            array.fill(0)  # no neighbours, no closest corners, no contact
        for body, number in enumerate(self.number):
            bodies.position[number] = np.round(position[pose, body] / self.grid) * self.grid + self.moved
            bodies.orientation[number] = orientation[pose, body]
        if simulation.evaluate() != Status.DONE:
            raise ValueError(f"{float(simulation.state.clock.measure[0]):.3g} m of overlap cannot be evaluated")
        gap, mode, energy = np.full(self.count, np.inf), np.full(self.count, NO_CONTACT), np.zeros(self.count)
        listed = int(pairs.count[0])
        where = np.searchsorted(self.number[0], pairs.a[:listed])
        touching = pairs.overlap[:listed] > 0.0
        gap[where] = np.where(touching, -pairs.overlap[:listed], pairs.wake[:listed])
        mode[where] = np.where(touching, pairs.mode[:listed], NO_CONTACT)
        energy[where] = pairs.stored[:listed]
        a, b = self.number[:, :asked]
        moment = np.stack([bodies.contact_torque[a], bodies.contact_torque[b]], axis=1)
        return gap[:asked], mode[:asked], bodies.contact_force[b], moment, energy[:asked]


class Probe:
    """Two bodies of a case, a (number 0) and b (1; a structure stays where the case has it)."""

    def __init__(self, case: Case):
        self.simulation = Simulation.of_case(case)
        if len(self.simulation.state.bodies.position) != 2:
            raise ValueError("a probe holds two bodies, or a body and a structure")
        self.start_position = self.simulation.state.bodies.position.copy()
        self._few, self._many = (_Copies(self.simulation, along) for along in (FEW, MANY))

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

    def at(self, poses: Poses) -> Answers:
        """Evaluate the contact at rest in each pose.

        Raises ValueError where the bodies overlap more than the program can mean.
        """
        copies = self._few if len(poses) <= self._few.count else self._many
        starts = range(0, len(poses), copies.count)
        parts = [slice(start, start + copies.count) for start in starts]
        found = [copies.at(poses.position[part], poses.orientation[part]) for part in parts]
        return Answers(*map(np.concatenate, zip(*found, strict=True)))

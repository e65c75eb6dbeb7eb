"""Two dilated cores that a test puts where it wants them, and what the contact kernels say about them."""

from typing import NamedTuple

import numpy as np
from scipy.spatial.transform import Rotation

from dilatedem.geometry.polyhedron import Polyhedron
from dilatedem.geometry.shapes import BodyShape, pack_shapes, tapered, tapers
from dilatedem.state.bodies import bodies_at_rest
from dilatedem.state.modes import Mode
from dilatedem.state.pairs import empty_pairs
from dilatedem.state.setting import Surroundings
from dilatedem.state.storage import MOST_CORNERS
from tests.kernels import area_of_pair, distance_of_pair, energy_of_pair, patch_of_pair


class Closest(NamedTuple):
    """Signed distance of the cores [m], unit normal from a to b, witness points (3,) in world coordinates."""

    distance: float
    normal: np.ndarray
    on_a: np.ndarray
    on_b: np.ndarray


class Patch(NamedTuple):
    mode: Mode
    point: np.ndarray  # (3,) world coordinates, m
    overlap: float  # m
    size: float  # m or m2


class Press(NamedTuple):
    """What the consistent model says of a pose, for an effective modulus of 1 Pa."""

    energy: float  # J
    force: np.ndarray  # (3,) on b, N
    moment: np.ndarray  # (3,) of that force about the centroid of a, N m
    mode: Mode
    size: float  # m or m2


class PairInPlace:
    """Cores a and b with their dilated radii [m]; period (2,) [m] of the domain, 0 = not periodic; taper: of b, a cone."""

    def __init__(self, core_a: Polyhedron, core_b: Polyhedron, radii=(0.04, 0.04), period=(0.0, 0.0), taper=0.0):
        self.cores = core_a, core_b
        shapes = pack_shapes([BodyShape(c, r, None, None) for c, r in zip(self.cores, radii, strict=True)], [])
        self.shapes = tapered(shapes, np.array([0.0, taper]))
        self.bodies = bodies_at_rest(2, 1)
        self.surroundings = Surroundings(*map(float, period))
        self._vertex, self._face_normal = self.shapes.vertex.copy(), self.shapes.face_normal.copy()
        self._scratch = np.zeros((8, MOST_CORNERS, 3))
        self.forget()

    def forget(self) -> None:
        """Start cold: no corners, no normal of an earlier evaluation."""
        self.pairs = empty_pairs(1)
        self.pairs.count[0], self.pairs.b[0] = 1, 1

    def place(self, body: int, position, rotation: Rotation | None = None) -> None:
        self.bodies.position[body] = position
        x, y, z, w = (rotation or Rotation.identity()).as_quat()
        self.bodies.orientation[body] = w, x, y, z

    def rotation(self, body: int) -> Rotation:
        return Rotation.from_quat(np.roll(self.bodies.orientation[body], -1))

    def vertices(self, body: int) -> np.ndarray:
        """Core vertices (n, 3) in world coordinates."""
        return self.rotation(body).apply(self.cores[body].vertices) + self.bodies.position[body]

    def closest(self) -> Closest:
        distance, normal, pa, pb, _ = self._evaluate()
        origin = self.bodies.position[0]
        return Closest(distance, np.array(normal), origin + pa, origin + pb)

    def patch(self) -> Patch | None:
        """None where the dilated bodies are apart."""
        distance, normal, pa, pb, offset = self._evaluate()
        overlap = self._reach(pb, offset) - distance
        if overlap <= 0.0:
            return None
        mode, _, point, depth, size, _ = patch_of_pair(
            self.shapes, self.pairs, self._vertex, self._face_normal, 0, offset, normal, pa, pb, overlap, self._scratch
        )
        return Patch(Mode(mode), self.bodies.position[0] + point, depth, size)

    def press(self, modulus: float = 1.0) -> Press | None:
        """None where the dilated bodies are apart."""
        distance, normal, pa, pb, offset = self._evaluate()
        overlap = self._reach(pb, offset) - distance
        if overlap <= 0.0:
            return None
        energy, force, moment, mode, size, _ = energy_of_pair(
            self.shapes, self.pairs, self._vertex, self._face_normal, 0, offset, normal, pb, overlap, modulus,
            self._scratch
        )
        return Press(energy, np.array(force), np.array(moment), Mode(mode), size)

    def nominal(self, depth: float) -> tuple[float, float, float]:
        """Nominal area [m2] at a crushed depth [m], its derivative by the depth [m], and how far it extends [m]."""
        _, normal, pa, pb, offset = self._evaluate()
        return area_of_pair(
            self.shapes, self.pairs, self._vertex, self._face_normal, 0, offset, normal, pa, pb, depth, self._scratch
        )

    def gap(self) -> float:
        """Distance of the dilated bodies [m], negative where they overlap."""
        distance, _, _, pb, offset = self._evaluate()
        return distance - self._reach(pb, offset)

    def _reach(self, pb, offset) -> float:
        """Sum of both radii, that of b where it is met [m]."""
        axis = self.rotation(1).apply(self.cores[1].vertices[-1])
        taper = tapers(self.shapes)[1]
        place = np.subtract(pb, offset) @ axis / np.linalg.norm(axis) if taper else 0.0
        return self.shapes.radius.sum() + taper * place

    def _evaluate(self):
        return distance_of_pair(
            self.shapes, self.surroundings, self.bodies, self.pairs, self._vertex, self._face_normal, 0
        )

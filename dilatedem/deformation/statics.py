"""What loads bend a body into, and its stress: by modes alone, and by the mesh itself (mode acceleration)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse.linalg import SuperLU, splu

from dilatedem.deformation.elements import Elements, interpolation
from dilatedem.deformation.mesh import Mesh
from dilatedem.deformation.modes import Modes, rigid_motions
from dilatedem.deformation.stress import corner_stress

#: points and weights that integrate a cubic over a triangle exactly: its middle, and three more (Strang & Fix 1973)
TRIANGLE = np.array([[1 / 3, 1 / 3, 1 / 3], [0.6, 0.2, 0.2], [0.2, 0.6, 0.2], [0.2, 0.2, 0.6]])
TRIANGLE_WEIGHTS = np.array([-27.0, 25.0, 25.0, 25.0]) / 48.0


@dataclass(frozen=True, eq=False)
class Flexibility:
    """A free body that loads bend: whatever moves it as a whole is taken out of them as its inertia takes it out.

    rigid (3n, 6): its rigid motions, orthonormal in the mass; held (6,): rows that its factors hold; free: all others.
    """

    elements: Elements
    rigid: np.ndarray
    free: np.ndarray
    factors: SuperLU

    @classmethod
    def of(cls, elements: Elements) -> Flexibility:
        """Factors of the stiffness with six displacements held, which a load in balance does not feel."""
        size = 3 * len(elements.nodes)
        free = np.setdiff1d(np.arange(size), _held(elements.nodes))
        within = elements.stiffness[free][:, free].tocsc()
        factors = splu(within, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
        return cls(elements, rigid_motions(elements), free, factors)

    def balanced(self, force: np.ndarray) -> np.ndarray:
        """(n, 3) [N] forces at nodes less the mass times the acceleration that they give the body as a whole."""
        flat = force.ravel()
        return (flat - self.elements.mass @ (self.rigid @ (self.rigid.T @ flat))).reshape(-1, 3)

    def displacement(self, force: np.ndarray) -> np.ndarray:
        """(n, 3) [m] of the nodes, without a share of a rigid motion, of forces (n, 3) [N] at nodes."""
        moved = np.zeros(force.size)
        moved[self.free] = self.factors.solve(self.balanced(force).ravel()[self.free])
        moved -= self.rigid @ (self.rigid.T @ (self.elements.mass @ moved))
        return moved.reshape(-1, 3)


def _held(nodes: np.ndarray) -> np.ndarray:
    """Six rows of the displacements of three nodes far apart that keep a body in place and leave it free to deform."""
    first = ((nodes - nodes.mean(axis=0)) ** 2).sum(axis=1).argmax()
    from_first = nodes - nodes[first]
    second = (from_first**2).sum(axis=1).argmax()
    line = from_first[second] / np.sqrt(from_first[second] @ from_first[second])
    third = (np.cross(from_first, line) ** 2).sum(axis=1).argmax()
    normal = np.cross(line, from_first[third])
    along, up = np.abs(line).argmax(), np.abs(normal).argmax()
    aside = [axis for axis in range(3) if axis != along]
    return np.array([3 * first, 3 * first + 1, 3 * first + 2, *(3 * second + axis for axis in aside), 3 * third + up])


def static_coordinates(modes: Modes, force: np.ndarray) -> np.ndarray:
    """(m,) coordinates [m sqrt(kg)] at which the modes bear forces (n, 3) [N] at nodes: phi_i . F / w_i^2."""
    return np.einsum("inc,nc->i", modes.shape, force) / modes.frequency**2


def accelerated_stress(flexibility: Flexibility, modes: Modes, force: np.ndarray, acceleration: np.ndarray) -> np.ndarray:
    """(c, 6) [Pa] by mode acceleration: what the loads would do at rest, less what accelerating modes do not bear of it.

    acceleration (m,) [m sqrt(kg)/s2] of their coordinates. Modes not among them count as at rest, with all that they bear.
    """
    at_rest = corner_stress(flexibility.elements, flexibility.displacement(force))
    return at_rest - np.einsum("i,ick->ck", acceleration / modes.frequency**2, modes.stress)


def point_loads(elements: Elements, points: np.ndarray, forces: np.ndarray) -> np.ndarray:
    """(n, 3) [N] forces at nodes that do the work of forces (p, 3) [N] at points (p, 3) [m] of a body."""
    return interpolation(elements.nodes, elements.elements, points).T @ forces


def weight(elements: Elements, acceleration: np.ndarray) -> np.ndarray:
    """(n, 3) [N] at nodes of a body in a field of gravity (3,) [m/s2]."""
    return (elements.mass @ np.tile(acceleration, len(elements.nodes))).reshape(-1, 3)


def surface_points(mesh: Mesh) -> tuple[np.ndarray, np.ndarray]:
    """Points (p, 3) [m] on the surface of a mesh and their areas (p, 3) [m2], outward: what integrates pressures over it."""
    corner = mesh.points[mesh.surface()]
    area = 0.5 * np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    points = np.einsum("qk,skc->sqc", TRIANGLE, corner)
    return points.reshape(-1, 3), (area[:, None, :] * TRIANGLE_WEIGHTS[:, None]).reshape(-1, 3)

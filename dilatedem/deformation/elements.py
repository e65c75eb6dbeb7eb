"""Finite elements: quadratic tetrahedra, whose stiffness and mass scikit-fem assembles.

Linear ones lock: a plate of them is half as stiff again.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.sparse import csr_matrix

from dilatedem.deformation.mesh import Mesh
from dilatedem.errors import CaseError

#: what to install
EXTRA = "pip install 'dilatedem[deformation]'"
#: ends of the edges of a tetrahedron, in the order of scikit-fem's nodes on them
EDGES = ((0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3))


class Material(NamedTuple):
    """Isotropic and linear elastic."""

    elastic_modulus: float  # Pa
    poisson_ratio: float
    density: float  # kg/m3


@dataclass(frozen=True, eq=False)
class Elements:
    """Quadratic tetrahedra of nodes (n, 3) [m], the corners of the mesh first.

    elements (t, 10): four corners and six middles of edges; stiffness (3n, 3n) [N/m] and mass (3n, 3n) [kg], by the displacements
    of node after node.
    """

    nodes: np.ndarray
    elements: np.ndarray
    stiffness: csr_matrix
    mass: csr_matrix
    material: Material

    @property
    def scalar_mass(self) -> csr_matrix:
        """(n, n) [kg] the mass along one axis, the same for all three."""
        return self.mass[0::3, 0::3]


def assembled(mesh: Mesh, material: Material) -> Elements:
    """Stiffness and mass of a mesh. Raises CaseError where scikit-fem is not installed."""
    try:
        import skfem
        from skfem.models.elasticity import lame_parameters, linear_elasticity
    except ImportError as error:
        raise CaseError(f"bodies that deform need scikit-fem: {EXTRA}") from error
    grid = skfem.MeshTet(mesh.points.T.copy(), mesh.tetrahedra.T.copy(), sort_t=False)
    basis = skfem.Basis(grid, skfem.ElementVector(skfem.ElementTetP2()), intorder=4)
    inertia = skfem.BilinearForm(lambda u, v, w: material.density * skfem.helpers.dot(u, v))
    elasticity = linear_elasticity(*lame_parameters(material.elastic_modulus, material.poisson_ratio))
    stiffness, mass = (_symmetric(form.assemble(basis)) for form in (elasticity, inertia))
    elements = basis.element_dofs[0::3].T // 3
    return Elements(basis.doflocs[:, 0::3].T.copy(), elements.astype(np.int64), stiffness, mass, material)


def _symmetric(matrix: csr_matrix) -> csr_matrix:
    return csr_matrix(0.5 * (matrix + matrix.T))


def shares(barycentric: np.ndarray) -> np.ndarray:
    """(..., 10) what each node of an element contributes at a point of barycentric coordinates (..., 4)."""
    middles = [4.0 * barycentric[..., a] * barycentric[..., b] for a, b in EDGES]
    return np.concatenate((barycentric * (2.0 * barycentric - 1.0), np.stack(middles, axis=-1)), axis=-1)


def share_gradients(barycentric: np.ndarray, gradients: np.ndarray) -> np.ndarray:
    """(..., 10, 3) gradients [1/m] of these shares; gradients (..., 4, 3) of the barycentric coordinates."""
    corner = (4.0 * barycentric - 1.0)[..., None] * gradients
    a, b = np.transpose(EDGES)
    middle = barycentric[..., a, None] * gradients[..., b, :] + barycentric[..., b, None] * gradients[..., a, :]
    return np.concatenate((corner, 4.0 * middle), axis=-2)


def barycentric_gradients(corners: np.ndarray) -> np.ndarray:
    """(..., 4, 3) gradients [1/m] of the barycentric coordinates of tetrahedra with corners (..., 4, 3) [m]."""
    rest = np.linalg.inv(corners[..., 1:, :] - corners[..., :1, :]).swapaxes(-1, -2)
    return np.concatenate((-rest.sum(axis=-2, keepdims=True), rest), axis=-2)


def located(nodes: np.ndarray, elements: np.ndarray, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The element (p,) that holds each of `points` (p, 3) [m], and the point's barycentric coordinates (p, 4) in it.

    A point outside belongs to the element that it is least far out of.
    """
    corners = nodes[elements[:, :4]]
    gradients, base = barycentric_gradients(corners)[:, 1:], corners[:, 0]
    owner, place = np.empty(len(points), np.int64), np.empty((len(points), 4))
    for k, point in enumerate(points):
        rest = ((point - base)[:, None, :] * gradients).sum(axis=-1)
        coordinates = np.column_stack((1.0 - rest.sum(axis=1), rest))
        owner[k] = coordinates.min(axis=1).argmax()
        place[k] = coordinates[owner[k]]
    return owner, place


def interpolation(nodes: np.ndarray, elements: np.ndarray, points: np.ndarray) -> csr_matrix:
    """(p, n) what makes of values at nodes those at points (p, 3) [m]; transposed, of forces at points those at nodes."""
    owner, place = located(nodes, elements, points)
    row = np.repeat(np.arange(len(points)), 10)
    return csr_matrix((shares(place).ravel(), (row, elements[owner].ravel())), shape=(len(points), len(nodes)))

"""Free vibration of a body: its modes, and the integrals by which they enter its motion (Bao & Jiang 2004)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import cholesky, eigh, solve_triangular
from scipy.sparse.linalg import LinearOperator, eigsh, splu

from dilatedem.deformation.elements import Elements
from dilatedem.deformation.stress import COLUMN, ROW, corner_stress

#: modes that move a body and do not bend it
RIGID = 6
#: shapes of uniform strain
STRAINS = 6
#: share of their squared frequency by which modes may differ and still be taken for one frequency's
EQUAL = 1e-6
#: share of a mode's largest displacement from which on its sign can be told
CLEAR = 0.5


@dataclass(frozen=True, eq=False)
class Modes:
    """The lowest m modes of a free body that bend it, about its centroid; their mass is 1 kg each, Eq. (16).

    nodes            (n, 3) [m] and elements (t, 10), quadratic tetrahedra
    frequency        (m,) [rad/s], ascending
    shape            (m, n, 3) [1/sqrt(kg)]: displacement of the nodes where the mode's coordinate is 1 m sqrt(kg), phi of Eq. (15)
    stress           (m, c, 6) [Pa/(m sqrt(kg))] at the corners of the mesh
    inertia_gradient (m, 3, 3) [m sqrt(kg)]: how the body's inertia changes with the coordinate, dI/dxi_i
    twist            (m, m, 3): int rho phi_i x phi_j, what Tisserand's condition leaves out: see `neglected_momentum`
    """

    nodes: np.ndarray
    elements: np.ndarray
    frequency: np.ndarray
    shape: np.ndarray
    stress: np.ndarray
    inertia_gradient: np.ndarray
    twist: np.ndarray

    @property
    def count(self) -> int:
        return len(self.frequency)

    def neglected_momentum(self, coordinate: np.ndarray, rate: np.ndarray) -> np.ndarray:
        """(3,) [kg m2/s] angular momentum that the body has in the frame where it should have none, by vibration alone.

        A frame in which H = 0, of Eq. (12), exactly turns with the body's mean; modes that are linear meet that but for
        sum_ij xi_i dxi_j/dt int rho phi_i x phi_j.
        """
        return np.einsum("i,j,ijk->k", coordinate, rate, self.twist)


def free_modes(elements: Elements, count: int, strains: bool = False) -> Modes:
    """The `count` lowest modes that bend a body. Raises ValueError where the mesh has fewer.

    strains: and the six shapes of uniform strain, mixed with those into vibrations of their common space. Loads on faces make
    uniform stresses, of which free modes bear little, as none of them has a load on its surface (MacNeal 1971).
    """
    size = elements.stiffness.shape[0]
    if not 1 <= count <= size // 2 - RIGID:
        raise ValueError(f"{count} modes were asked for, and a mesh of {len(elements.nodes)} nodes has at most {size // 2 - RIGID}")
    rigid = rigid_motions(elements)
    lowest = _lowest(elements, count + RIGID)
    if strains:
        lowest, count = np.concatenate((lowest, uniform_strains(elements)), axis=1), count + STRAINS
    square, vectors = _bending(elements, rigid, lowest, count)
    vectors = _signed(_separated(square, vectors))
    shape = vectors.T.reshape(count, -1, 3)
    gradient, twist = _inertia_gradient(elements, shape), _twist(elements, shape)
    stress = corner_stress(elements, shape)
    return Modes(elements.nodes, elements.elements, np.sqrt(square), shape, stress, gradient, twist)


def rigid_motions(elements: Elements) -> np.ndarray:
    """(3n, 6) displacements that move and turn a body about its centroid, orthonormal in its mass."""
    weight = np.asarray(elements.scalar_mass.sum(axis=1)).ravel()
    arm = elements.nodes - (weight @ elements.nodes) / weight.sum()
    motions = [np.tile(axis, (len(arm), 1)) for axis in np.eye(3)] + [np.cross(axis, arm) for axis in np.eye(3)]
    return _orthonormal(elements, np.stack([motion.ravel() for motion in motions], axis=-1))


def uniform_strains(elements: Elements) -> np.ndarray:
    """(3n, 6) displacements of a body that is strained alike everywhere, of the size of its rigid motions in the mass."""
    arm = elements.nodes - elements.nodes.mean(axis=0)
    own = [arm[:, a, None] * np.eye(3)[b] + arm[:, b, None] * np.eye(3)[a] for a, b in zip(ROW, COLUMN, strict=True)]
    shapes = np.stack([shape.ravel() for shape in own], axis=-1)
    return shapes / np.sqrt(np.einsum("na,na->a", shapes, elements.mass @ shapes))


def _orthonormal(elements: Elements, vectors: np.ndarray) -> np.ndarray:
    """The same space by vectors whose products in the mass are 0 and 1 (Cholesky, twice: the first leaves round-off)."""
    for _ in range(2):
        factor = cholesky(vectors.T @ (elements.mass @ vectors))
        vectors = solve_triangular(factor, vectors.T, trans="T").T
    return vectors


def _lowest(elements: Elements, count: int) -> np.ndarray:
    """(3n, count) the lowest modes, rigid ones included, by inverse iteration about a shift below zero.

    The shift is of the size of the lowest square of a plate of the body's extents: far from the rigid modes, at zero, for the
    factors to exist, and near for the iteration to be short.
    """
    extent = np.sort(np.ptp(elements.nodes, axis=0))
    material = elements.material
    shift = -material.elastic_modulus / material.density * (extent[0] / extent[2] ** 2) ** 2
    options = {"SymmetricMode": True}
    shifted = (elements.stiffness - shift * elements.mass).tocsc()
    factors = splu(shifted, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options=options)
    inverse = LinearOperator(shifted.shape, factors.solve)
    start = np.cos(np.arange(shifted.shape[0]) * 0.7)  # no symmetry of a body is one of these
    return eigsh(elements.stiffness, count, elements.mass, sigma=shift, which="LM", OPinv=inverse, v0=start, tol=1e-12)[1]


def _bending(elements: Elements, rigid: np.ndarray, vectors: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Squared frequencies and vectors of the modes within a space that has all rigid ones, these taken out to round-off."""
    for _ in range(2):
        vectors = vectors - rigid @ (rigid.T @ (elements.mass @ vectors))
    _, mixed = eigh(vectors.T @ (elements.mass @ vectors))
    vectors = _orthonormal(elements, vectors @ mixed[:, -count:])
    square, mixed = eigh(vectors.T @ (elements.stiffness @ vectors))
    return square, vectors @ mixed


def _separated(square: np.ndarray, vectors: np.ndarray) -> np.ndarray:
    """The same modes, those of one frequency chosen by where they move the body, not by round-off."""
    place = np.linspace(1.0, 2.0, len(vectors)) ** 2
    groups = np.split(np.arange(len(square)), np.flatnonzero(np.diff(square) > EQUAL * square[1:]) + 1)
    chosen = [vectors[:, group] @ eigh(vectors[:, group].T @ (place[:, None] * vectors[:, group]))[1] for group in groups]
    return np.concatenate(chosen, axis=1)


def _signed(vectors: np.ndarray) -> np.ndarray:
    """The same modes, each with the first of its large displacements positive."""
    large = np.abs(vectors) > CLEAR * np.abs(vectors).max(axis=0)
    first = large.argmax(axis=0)
    return vectors * np.sign(vectors[first, np.arange(vectors.shape[1])])


def _inertia_gradient(elements: Elements, shape: np.ndarray) -> np.ndarray:
    """dI/dxi_i = int rho (2 (x . phi_i) 1 - x phi_i - phi_i x), of I = int rho (r.r 1 - r r) with r = x + sum phi_i xi_i."""
    product = np.einsum("na,inb->iab", elements.scalar_mass @ elements.nodes, shape)
    trace = np.trace(product, axis1=1, axis2=2)[:, None, None]
    return 2.0 * trace * np.eye(3) - product - product.transpose(0, 2, 1)


def _twist(elements: Elements, shape: np.ndarray) -> np.ndarray:
    """int rho phi_i x phi_j."""
    mass = elements.scalar_mass
    moved = np.stack([mass @ mode for mode in shape])
    product = np.einsum("ina,jnb->ijab", shape, moved)
    return np.stack([product[..., a, b] - product[..., b, a] for a, b in ((1, 2), (2, 0), (0, 1))], axis=-1)

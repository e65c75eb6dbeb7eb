"""Stress of displacements of a mesh: at its corners, the mean over the elements around each, and what an engineer reads from it.

Components of a stress: xx, yy, zz, yz, zx, xy.
"""

import numpy as np

from dilatedem.deformation.elements import Elements, Material, barycentric_gradients, share_gradients

#: row and column of each component
ROW, COLUMN = np.array([0, 1, 2, 1, 2, 0]), np.array([0, 1, 2, 2, 0, 1])


def corner_stress(elements: Elements, displacement: np.ndarray) -> np.ndarray:
    """(..., c, 6) [Pa] at the corners of a mesh, of displacements (..., n, 3) [m] of its nodes.

    Each element has its own stress there, linear within it; the mean of all around a corner is weighted by their volumes.
    """
    corners = elements.nodes[elements.elements[:, :4]]
    gradients = barycentric_gradients(corners)
    weight = np.abs(np.linalg.det(corners[:, 1:] - corners[:, :1]))
    owner = elements.elements[:, :4]
    total = np.zeros((*displacement.shape[:-2], int(owner.max()) + 1, 6))
    for corner, place in enumerate(np.eye(4)):
        by_node = share_gradients(np.broadcast_to(place, (len(corners), 4)), gradients)
        slope = np.einsum("...eni,enj->...eij", displacement[..., elements.elements, :], by_node)
        np.add.at(total, (..., owner[:, corner], slice(None)), weight[:, None] * _hooke(slope, elements.material))
    shared = np.bincount(owner.ravel(), np.repeat(weight, 4))
    return total / shared[:, None]


def _hooke(slope: np.ndarray, material: Material) -> np.ndarray:
    """(..., 6) [Pa] of displacement gradients (..., 3, 3)."""
    shear = material.elastic_modulus / (2.0 * (1.0 + material.poisson_ratio))
    lame = 2.0 * shear * material.poisson_ratio / (1.0 - 2.0 * material.poisson_ratio)
    stress = shear * (slope[..., ROW, COLUMN] + slope[..., COLUMN, ROW])
    stress[..., :3] += lame * np.trace(slope, axis1=-2, axis2=-1)[..., None]
    return stress


def in_plane(stress: np.ndarray, normal: np.ndarray) -> np.ndarray:
    """(..., 3) [Pa] of components (..., 6) those in the plane across `normal` (3,): along two axes of it, and their shear."""
    one = np.cross(normal, np.eye(3)[np.abs(normal).argmin()])
    one /= np.sqrt(one @ one)
    axes = np.stack((one, np.cross(normal, one)))
    turned = axes @ tensors(stress) @ axes.T
    return np.stack((turned[..., 0, 0], turned[..., 1, 1], turned[..., 0, 1]), axis=-1)


def tensors(stress: np.ndarray) -> np.ndarray:
    """(..., 3, 3) of components (..., 6)."""
    tensor = np.empty((*stress.shape[:-1], 3, 3))
    tensor[..., ROW, COLUMN] = tensor[..., COLUMN, ROW] = stress
    return tensor


def von_mises(stress: np.ndarray) -> np.ndarray:
    """(...,) [Pa] of components (..., 6)."""
    xx, yy, zz, yz, zx, xy = np.moveaxis(stress, -1, 0)
    return np.sqrt(0.5 * ((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) + 3.0 * (yz**2 + zx**2 + xy**2))


def tension(stress: np.ndarray) -> np.ndarray:
    """(...,) [Pa] the largest principal stress of components (..., 6): where it is above the flexural strength, ice breaks."""
    return np.linalg.eigvalsh(tensors(stress))[..., -1]

"""Rotations outside the kernels, in NumPy."""

import numpy as np


def quaternion_from_rotation_vector(rotation) -> np.ndarray:
    """Unit quaternion (4,), scalar first, of a rotation vector (3,) [rad]."""
    rotation = np.asarray(rotation, float)
    angle = np.linalg.norm(rotation)
    # np.sinc(x) = sin(pi x)/(pi x) stays exact at zero angle
    return np.concatenate([[np.cos(0.5 * angle)], 0.5 * np.sinc(0.5 * angle / np.pi) * rotation])


def matrix_from_quaternion(q) -> np.ndarray:
    """Rotation matrices (..., 3, 3), body to world, of unit quaternions (..., 4)."""
    w, x, y, z = np.moveaxis(np.asarray(q, float), -1, 0)
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows), (0, 1), (-2, -1))

"""Rotations outside the kernels, in NumPy."""

import numpy as np

from dilatedem.numerics.plain import norm, sine_cosine


def quaternion_from_rotation_vector(rotation) -> np.ndarray:
    """Unit quaternion (4,), scalar first, of a rotation vector (3,) [rad]."""
    rotation = np.asarray(rotation, float)
    angle = norm(rotation)
    sine, cosine = sine_cosine(0.5 * angle)
    return np.array([cosine, *(rotation * (sine / angle if angle > 0.0 else 0.5))])


def matrix_from_quaternion(q) -> np.ndarray:
    """Rotation matrices (..., 3, 3), body to world, of unit quaternions (..., 4)."""
    w, x, y, z = np.moveaxis(np.asarray(q, float), -1, 0)
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows), (0, 1), (-2, -1))

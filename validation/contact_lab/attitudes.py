"""How a feature of a body is turned towards another, and where its centroid then has to be."""

import numpy as np
from scipy.spatial.transform import Rotation

#: feature -> direction in the body in which it is the outermost, and a direction along it
FEATURES = {
    "vertex": ((1.0, 1.0, 1.0), (1.0, -1.0, 0.0)),
    "edge": ((1.0, 1.0, 0.0), (0.0, 0.0, 1.0)),
    "face": ((1.0, 0.0, 0.0), (0.0, 0.0, 1.0)),
}
#: m: corners this close to the outermost belong to the same feature
SAME_HEIGHT = 1e-9


def _frame(first, second) -> np.ndarray:
    """Orthonormal columns: along `first`, `second` made square to it, and their cross product."""
    x = np.asarray(first, float) / np.linalg.norm(first)
    y = np.asarray(second, float) - np.dot(second, x) * x
    y /= np.linalg.norm(y)
    return np.column_stack([x, y, np.cross(x, y)])


def attitude(feature: str, toward, along) -> Rotation:
    """The rotation that brings a body's feature outermost along `toward`, its own direction along `along` (world)."""
    return Rotation.from_matrix(_frame(toward, along) @ _frame(*FEATURES[feature]).T)


def feature_centre(core: np.ndarray, rotation: Rotation, toward) -> np.ndarray:
    """Middle (3,) of the outermost corners of a core (v, 3) along `toward`, from the centroid, world directions [m]."""
    corners = rotation.apply(core)
    height = corners @ np.asarray(toward, float)
    return corners[height > height.max() - SAME_HEIGHT].mean(axis=0)

"""Cores of every kind that a run can meet, for tests of distance and contact."""

import numpy as np

from dilatedem.geometry.polyhedron import Polyhedron, convex_hull, prism

SQUARE = np.array([[-1.36, -1.36], [1.36, -1.36], [1.36, 1.36], [-1.36, 1.36]])


def box(x: float, y: float, z: float) -> Polyhedron:
    """Sides x, y, z [m] about the origin."""
    outline = 0.5 * np.array([[-x, -y], [x, -y], [x, y], [-x, y]])
    return prism(outline, -0.5 * z, 0.5 * z)


def polygon(corners: int, size: float, seed: int) -> np.ndarray:
    """A convex outline (n, 2) of about `size` [m], counter-clockwise, around the origin."""
    rng = np.random.default_rng(seed)
    angle = np.sort((np.arange(corners) + rng.uniform(0.1, 0.9, corners)) * 2 * np.pi / corners)
    return 0.5 * size * np.column_stack((np.cos(angle), 0.8 * np.sin(angle)))


def cores() -> dict[str, Polyhedron]:
    rng = np.random.default_rng(7)
    return {
        "sphere": convex_hull([[0.0, 0.0, 0.0]]),
        "capsule": convex_hull([[-0.7, 0.0, 0.0], [0.7, 0.0, 0.0]]),
        "plate": prism(polygon(6, 2.0, 1), 0.0, 0.0),
        "box": box(2.72, 2.72, 0.42),
        "floe": prism(polygon(7, 2.6, 2), -0.21, 0.21),
        "sliver": prism([[-1.5, 0.0], [1.5, -0.02], [1.6, 0.03]], -0.21, 0.21),
        "tetrahedron": convex_hull([[0.8, 0.0, -0.4], [-0.4, 0.7, -0.4], [-0.4, -0.7, -0.4], [0.0, 0.1, 0.9]]),
        "hull": convex_hull(rng.normal(size=(14, 3)) * [1.0, 0.8, 0.5]),
        "pile": convex_hull([[0.0, 0.0, -200.0], [0.0, 0.0, 200.0]]),
    }

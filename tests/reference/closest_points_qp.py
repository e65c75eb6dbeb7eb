"""Distance and depth of convex cores by slow and obvious ways that share nothing with the package.

Distance: the smallest |v| over the convex hull of all differences w = b_j - a_i is a quadratic programme. Its dual, min |x|
with w.x >= 1 for all w (x = v/|v|^2), is solved by non-negative least squares (Lawson & Hanson, least distance programming),
whose multipliers weigh the corners. Depth: the origin's distance to the hull of the same differences.
"""

import numpy as np
from scipy.optimize import nnls
from scipy.spatial import ConvexHull


def closest_points(a: np.ndarray, b: np.ndarray) -> tuple[float, np.ndarray, np.ndarray]:
    """Distance [m] of the convex hulls of points a (n, 3) and b (m, 3), and the closest points (3,) of both.

    0 where they intersect; the points then mean nothing.
    """
    difference = (b[None] - a[:, None]).reshape(-1, 3)
    scale = np.abs(difference).max() or 1.0
    matrix = np.vstack((difference.T / scale, np.ones(len(difference))))
    weight, _ = nnls(matrix, np.array([0.0, 0.0, 0.0, 1.0]), maxiter=100 * len(difference))
    weight = (weight / weight.sum()).reshape(len(a), len(b))
    on_a, on_b = weight.sum(axis=1) @ a, weight.sum(axis=0) @ b
    distance = float(np.linalg.norm(on_b - on_a))
    return (distance if distance > 1e-9 * scale else 0.0), on_a, on_b


def depth(a: np.ndarray, b: np.ndarray) -> float:
    """Length [m] of the shortest translation that takes intersecting hulls of a (n, 3) and b (m, 3) apart; negative if they
    are apart.
    """
    difference = (b[None] - a[:, None]).reshape(-1, 3)
    return float(-ConvexHull(difference).equations[:, 3].max())

"""Distance of convex cores without any round-off: descent over the corners of their difference in whole numbers.

Floating-point numbers are fractions of a power of two, so coordinates times a large one are whole, and whatever a step decides is
decided exactly. The descent ends only where no corner of the difference lies before the plane through the closest point square to
it, which proves that this point is the closest of all, however it was found.
"""

from fractions import Fraction
from itertools import combinations
from math import isqrt

import numpy as np

#: bits that a root is taken to beyond those of its square
ROOT_BITS = 400


def exact_distance(a: np.ndarray, b: np.ndarray) -> tuple[float, np.ndarray]:
    """Distance [m] of the convex hulls of points a (n, 3) and b (m, 3) and unit normal (3,) from a to b, both rounded once.

    0 and a vector of zeros where they touch or intersect.
    """
    bits = max(float(x).as_integer_ratio()[1].bit_length() for x in np.concatenate((a, b)).flat)
    a, b = _whole(a, bits), _whole(b, bits)
    chosen = [(a[0], b[0])]
    while True:
        point, divisor, kept = _closest([_minus(q, p) for p, q in chosen])
        if not any(point):
            return 0.0, np.zeros(3)
        corner = max(a, key=lambda p: _dot(point, p)), min(b, key=lambda q: _dot(point, q))
        if divisor * _dot(point, _minus(corner[1], corner[0])) >= _dot(point, point):
            length = isqrt(_dot(point, point) << 2 * ROOT_BITS)  # of point, times 2^ROOT_BITS
            normal = np.array([float(Fraction(x << ROOT_BITS, length)) for x in point])
            return float(Fraction(length, divisor << bits + ROOT_BITS)), normal
        chosen = [chosen[i] for i in kept] + [corner]


def _whole(points: np.ndarray, bits: int) -> list[tuple[int, ...]]:
    """Points times 2^bits, which must be whole numbers."""
    return [tuple(int(Fraction(float(x)) * 2**bits) for x in point) for point in points]


def _minus(p, q):
    return tuple(x - y for x, y in zip(p, q, strict=True))


def _dot(p, q) -> int:
    return sum(x * y for x, y in zip(p, q, strict=True))


def _closest(corners):
    """Closest point of a simplex to the origin, times a positive divisor; the divisor; numbers of the corners that span it."""
    best = None
    for count in range(1, len(corners) + 1):
        for chosen in combinations(range(len(corners)), count):
            weights = _weights([corners[i] for i in chosen])
            if min(weights) < 0 or sum(weights) == 0:
                continue
            point = tuple(sum(w * corners[i][axis] for w, i in zip(weights, chosen, strict=True)) for axis in range(3))
            square = Fraction(_dot(point, point), sum(weights) ** 2)
            if best is None or square < best[0]:
                best = square, point, sum(weights), [i for w, i in zip(weights, chosen, strict=True) if w > 0]
    return best[1:]


def _weights(corners):
    """Weights, times the determinant of the edges' products, of the point closest to the origin on the flat through all corners."""
    edges = [_minus(corner, corners[0]) for corner in corners[1:]]
    gram = [[_dot(e, f) for f in edges] for e in edges]
    right = [-_dot(e, corners[0]) for e in edges]
    weights = [  # Cramer's rule
        _determinant([[*row[:c], r, *row[c + 1 :]] for row, r in zip(gram, right, strict=True)]) for c in range(len(edges))
    ]
    return [_determinant(gram) - sum(weights), *weights]


def _determinant(matrix) -> int:
    if not matrix:
        return 1
    minors = ([row[:c] + row[c + 1 :] for row in matrix[1:]] for c in range(len(matrix)))
    return sum((-1) ** c * matrix[0][c] * _determinant(minor) for c, minor in enumerate(minors))

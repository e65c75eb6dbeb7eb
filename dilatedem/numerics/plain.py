"""Small linear algebra and the elementary functions of the set-up, in sums and products alone: every processor rounds them alike.

BLAS, LAPACK, the C library and NumPy's vector code choose an order of summation, or a polynomial, by the processor they run on, and
the last digit goes with it. Such a digit in a floe's mass is another history of contacts a minute later. What is written here
must therefore stay written out: sums in a fixed order, products, quotients and square roots, which IEEE 754 rounds in one way.
"""

import math

import numpy as np
from numpy.typing import ArrayLike

#: pi/2 as the sum of two numbers, the first of 33 bits, so that whole multiples of it up to 2^20 are exact
QUARTER, QUARTER_REST = 1.5707963267341256, 6.077100506506192e-11
#: ln 2 as the sum of two numbers, likewise
DOUBLING, DOUBLING_REST = 0.6931471803691238, 1.9082149292705877e-10
#: how often the arctangent halves its angle, which is at most pi/2: what is left, below 0.1, needs a short series
HALVINGS = 4
#: coefficients of arctan(t)/t, sin(x)/x and cos(x) in powers of the square, highest first
ARCTANGENT = tuple((-1.0) ** k / (2 * k + 1) for k in range(9, -1, -1))
SINE = tuple((-1.0) ** k / math.factorial(2 * k + 1) for k in range(9, -1, -1))
COSINE = tuple((-1.0) ** k / math.factorial(2 * k) for k in range(9, -1, -1))
#: and of exp(x) in powers of x
EXPONENTIAL = tuple(1.0 / math.factorial(k) for k in range(14, -1, -1))
#: steps of Newton's method for a root, from a start within a factor of two
ROOT_STEPS = 24


def dot(u: ArrayLike, v: ArrayLike) -> np.ndarray:
    """Scalar products (...,) of vectors (..., k)."""
    return np.multiply(u, v).sum(axis=-1)


def norm(v: ArrayLike) -> np.ndarray:
    """Lengths (...,) of vectors (..., k)."""
    return np.sqrt(dot(v, v))


def turned(matrix: np.ndarray, vectors: np.ndarray) -> np.ndarray:
    """Matrices (..., 3, 3) times vectors (..., 3)."""
    x, y, z = (vectors[..., k, None] for k in range(3))
    return matrix[..., 0] * x + matrix[..., 1] * y + matrix[..., 2] * z


def determinant(matrix: np.ndarray) -> np.ndarray:
    """Determinants (...,) of matrices (..., 3, 3), as triple products of their rows."""
    return dot(matrix[..., 0, :], np.cross(matrix[..., 1, :], matrix[..., 2, :]))


def inverse(matrix: np.ndarray) -> np.ndarray:
    """Inverses of matrices (..., 3, 3) by their adjugates: meant for inertias, which are far from singular."""
    a, b, c = (matrix[..., k, :] for k in range(3))
    adjugate = np.stack((np.cross(b, c), np.cross(c, a), np.cross(a, b)), axis=-1)
    return adjugate / determinant(matrix)[..., None, None]


def angle(y: ArrayLike, x: ArrayLike) -> np.ndarray:
    """Angles [rad] of the points (x, y), above -pi and up to pi; 0 at the origin. Within eight units of the last digit."""
    y, x = np.asarray(y, float), np.asarray(x, float)
    across, ahead = np.abs(y), np.abs(x)
    radius = np.sqrt(ahead * ahead + across * across)
    t = across / np.where(radius > 0.0, ahead + radius, 1.0)  # tan(angle/2), at most 1
    for _ in range(HALVINGS - 1):
        t = t / (1.0 + np.sqrt(1.0 + t * t))
    turn = 2.0**HALVINGS * t * _series(ARCTANGENT, t * t)
    return np.copysign(np.where(x < 0.0, 2.0 * QUARTER_REST - turn + 2.0 * QUARTER, turn), y)


def sine_cosine(x: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
    """Sines and cosines of angles [rad], a million turns at most. Within two units of the last digit of 1."""
    x = np.asarray(x, float)
    quarters = np.floor(x / QUARTER + 0.5)
    rest = (x - quarters * QUARTER) - quarters * QUARTER_REST
    sine, cosine = rest * _series(SINE, rest * rest), _series(COSINE, rest * rest)
    odd, beyond = quarters % 2.0 == 1.0, quarters % 4.0
    s, c = np.where(odd, cosine, sine), np.where(odd, sine, cosine)
    return np.where(beyond >= 2.0, -s, s), np.where((beyond == 1.0) | (beyond == 2.0), -c, c)


def exponential(x: ArrayLike) -> np.ndarray:
    """exp(x) of numbers between -700 and 700; 0 below. Within four units of the last digit."""
    x = np.asarray(x, float)
    doublings = np.floor(x / (DOUBLING + DOUBLING_REST) + 0.5)
    rest = (x - doublings * DOUBLING) - doublings * DOUBLING_REST
    return np.where(x < -700.0, 0.0, np.ldexp(_series(EXPONENTIAL, rest), np.clip(doublings, -1022.0, 1023.0).astype(np.int64)))


def nth_root(x: float, degree: int) -> float:
    """The root of a number x >= 0, of a degree of 2 or more, by Newton's method."""
    if x == 0.0:
        return 0.0
    fraction, exponent = math.frexp(x)
    y = math.ldexp(1.0, round(exponent / degree))
    for _ in range(ROOT_STEPS):
        power = y
        for _ in range(degree - 2):
            power = power * y
        y = ((degree - 1) * y + x / power) / degree
    return y


def _series(coefficients: tuple[float, ...], z: np.ndarray) -> np.ndarray:
    total = np.full_like(z, coefficients[0])
    for coefficient in coefficients[1:]:
        total = total * z + coefficient
    return total

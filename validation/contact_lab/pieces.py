"""The pieces of elasticity that contacts of dilated bodies are made of: point, line and face, each force against overlap.

They were checked against boundary elements on a half space; references of the figures, not of the program.
"""

import numpy as np
from scipy.optimize import brentq
from scipy.special import ellipe, ellipkm1

#: aspect ratio of a rectangle -> beta of its stiffness 2 E* beta sqrt(A/pi)
FACE_SHAPE = {1.0: 1.018, 2.0: 1.045, 5.6: 1.184, 10.0: 1.321}
#: damping xi -> coefficient of restitution of F = K d^p + c sqrt(m* K) d^((p-1)/2) d', c = sqrt(2 (p + 1)) xi, held at 0 or above
RESTITUTION = {0.05: 0.8588, 0.1: 0.7441, 0.2: 0.5717, 0.3: 0.4510, 0.36: 0.3953, 0.5: 0.2984, 0.7: 0.2103, 1.0: 0.1353}


def point(overlap, modulus: float, curvatures: tuple[float, float]):
    """Elliptic Hertz [N]: overlap [m]; modulus E* [Pa]; the two principal relative curvatures [1/m]."""
    low, high = sorted(0.5 * np.asarray(curvatures))
    if high - low < 1e-9 * high:
        return 4.0 / 3.0 * modulus * np.sqrt(0.5 / low) * np.asarray(overlap) ** 1.5

    def slenderness(k):  # of the ellipse, b/a = k, minus what the curvatures ask for
        first, second = ellipkm1(k * k), ellipe(1.0 - k * k)
        return k * k * (first - second) / (second - k * k * first) - low / high

    ratio = brentq(slenderness, 1e-6, 1.0 - 1e-6)
    m = 1.0 - ratio**2
    first, second = ellipkm1(ratio**2), ellipe(m)
    return 2.0 * np.pi / 3.0 * modulus * np.sqrt(np.asarray(overlap) ** 3 * (first - second) / (first**3 * m * low))


def crossing_curvatures(first: float, second: float, angle: float) -> tuple[float, float]:
    """Principal relative curvatures [1/m] of two cylinders of these radii [m] whose axes cross at `angle` [rad]."""
    mean = 0.5 * (1.0 / first + 1.0 / second)
    half = 0.5 * np.sqrt(first**-2 + second**-2 + 2.0 / (first * second) * np.cos(2.0 * angle))
    return mean - half, mean + half


def line(overlap, modulus: float, length: float, radius: float):
    """A cylinder on its side over a length [m], radius R* [m]: pi E* L d/Lam, Lam = 0.2 + ln(pi E* L^3/(F R*)) [N]."""
    start = 0.2 + np.log(length**2 / (radius * np.asarray(overlap)))
    factor = start
    for _ in range(4):
        factor = start + np.log(factor)
    return np.pi * modulus * length * overlap / factor


def crossing(overlap, modulus: float, radii: tuple[float, float], angle: float, length: float):
    """Two edges of this length that cross [N]: no stiffer than the ellipse, nor than if they were parallel."""
    joint = radii[0] * radii[1] / (radii[0] + radii[1])
    ellipse = point(overlap, modulus, crossing_curvatures(*radii, angle))
    return np.minimum(ellipse, line(overlap, modulus, length, joint))


def face(overlap, modulus: float, width: float, height: float):
    """A rectangular face [N]."""
    aspect = np.log(max(width, height) / min(width, height))
    beta = np.interp(aspect, np.log(list(FACE_SHAPE)), list(FACE_SHAPE.values()))
    return 2.0 * modulus * beta * np.sqrt(width * height / np.pi) * np.asarray(overlap)

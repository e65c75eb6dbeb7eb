"""Contact model `liu2015`: the normal laws of Liu, Long & Ji (2015), mode by mode, as printed where they can be used.

F = K overlap^kappa, kappa = 1 face on face and 3/2 in all other modes. Where the paper's formulas slip, and what that means for
results, is said in docs/theory.md.
"""

from math import pi, sqrt

from dilatedem.contact.patch import (
    EDGE_CROSSING,
    EDGE_FACE,
    FACE_FACE,
    VERTEX_EDGE,
    VERTEX_FACE,
    VERTEX_VERTEX,
)
from dilatedem.jit import device

#: shape factor of a polygonal face, Liu 2015 below Eq. (24)
BETA = 1.02


@device
def normal_stiffness(mode, modulus, first, second, size, sine):
    """Stiffness K [N/m^kappa] and exponent kappa of a contact mode.

    modulus: effective modulus, Eq. (7) [Pa]; first, second: dilated radius [m] of the body with the lower feature (corner, then
    edge, then face) and of the other; size: patch length [m] or area [m2]; sine: of the angle of two crossing edges.
    """
    if mode == FACE_FACE:
        return 2.0 * modulus * BETA * sqrt(size / pi), 1.0  # Eq. (24)
    if mode == VERTEX_FACE:
        root = sqrt(first)  # Eq. (11)
    elif mode == EDGE_FACE:
        root = size * sqrt(first)  # Eq. (19): L stands for L / 1 m
    elif mode == EDGE_CROSSING:
        # what Eqs. (14)-(17) give once a has its factors 1/2 and R' = 1/(2 lambda): R~ = sqrt(R1 R2)/sin(theta)
        root = sqrt(sqrt(first * second) / sine)  # Eq. (13)
    else:
        radius = first * second / (first + second)  # Eq. (8)
        if mode == VERTEX_VERTEX:
            root = sqrt(radius)  # Eq. (10)
        elif mode == VERTEX_EDGE:
            root = sqrt(sqrt(first * radius))  # Eq. (12)
        else:
            root = size * sqrt(radius)  # Eq. (18): L stands for L / 1 m
    return 4.0 / 3.0 * modulus * root, 1.5


@device
def damping_coefficient(damping, mass, stiffness):
    """C_n of Eq. (4): zeta sqrt(2 M K). Its units fit Eq. (3) only in SI for kappa = 3/2."""
    return damping * sqrt(2.0 * mass * stiffness)



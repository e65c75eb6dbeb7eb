"""3-vectors as tuples of scalars: they live in registers (small NumPy vectors inside kernels were 30 times slower)."""

from math import sqrt

from dilatedem.jit import device


@device
def load(array, i):
    """Row i of an (n, 3) array as a tuple."""
    return array[i, 0], array[i, 1], array[i, 2]


@device
def store(array, i, v):
    """Write the tuple v into row i of an (n, 3) array."""
    array[i, 0] = v[0]
    array[i, 1] = v[1]
    array[i, 2] = v[2]


@device
def accumulate(array, i, v):
    """Add the tuple v to row i of an (n, 3) array."""
    array[i, 0] += v[0]
    array[i, 1] += v[1]
    array[i, 2] += v[2]


@device
def add(u, v):
    return u[0] + v[0], u[1] + v[1], u[2] + v[2]


@device
def sub(u, v):
    return u[0] - v[0], u[1] - v[1], u[2] - v[2]


@device
def scale(s, v):
    return s * v[0], s * v[1], s * v[2]


@device
def along(u, s, v):
    """u + s v."""
    return u[0] + s * v[0], u[1] + s * v[1], u[2] + s * v[2]


@device
def dot(u, v):
    return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]


@device
def cross(u, v):
    return u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]


@device
def norm(v):
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2])


@device
def tangents(n):
    """Two unit vectors that complete the unit vector n to a right-handed frame (t1, t2, n).

    Duff et al. 2017: continuous but for one half-turn at n_z = 0, where only the frame jumps, never a force.
    """
    s = 1.0 if n[2] >= 0.0 else -1.0
    a = -1.0 / (s + n[2])
    b = n[0] * n[1] * a
    return (1.0 + s * n[0] * n[0] * a, s * b, -s * n[0]), (b, s + n[1] * n[1] * a, -n[1])

"""Unit quaternions, scalar first, body to world."""

from math import sqrt

from dilatedem.jit import device


@device
def rotation_matrix(w, x, y, z):
    """Rows of the rotation matrix of a unit quaternion: world = R body, as nine scalars."""
    xx, yy, zz = x * x, y * y, z * z
    xy, xz, yz = x * y, x * z, y * z
    wx, wy, wz = w * x, w * y, w * z
    return (
        (1.0 - 2.0 * (yy + zz), 2.0 * (xy - wz), 2.0 * (xz + wy)),
        (2.0 * (xy + wz), 1.0 - 2.0 * (xx + zz), 2.0 * (yz - wx)),
        (2.0 * (xz - wy), 2.0 * (yz + wx), 1.0 - 2.0 * (xx + yy)),
    )


@device
def to_world(R, v):
    """R v."""
    return (
        R[0][0] * v[0] + R[0][1] * v[1] + R[0][2] * v[2],
        R[1][0] * v[0] + R[1][1] * v[1] + R[1][2] * v[2],
        R[2][0] * v[0] + R[2][1] * v[1] + R[2][2] * v[2],
    )


@device
def to_body(R, v):
    """R^T v."""
    return (
        R[0][0] * v[0] + R[1][0] * v[1] + R[2][0] * v[2],
        R[0][1] * v[0] + R[1][1] * v[1] + R[2][1] * v[2],
        R[0][2] * v[0] + R[1][2] * v[1] + R[2][2] * v[2],
    )


@device
def turned(q, spin, dt):
    """The quaternion q after turning for a time dt at the constant body-frame angular velocity `spin` [rad/s].

    Cayley map: the angle is 2 atan(|spin| dt / 2), third-order close to |spin| dt, with no sine and the norm kept exactly.
    """
    w, x, y, z = q
    a, b, c = 0.5 * dt * spin[0], 0.5 * dt * spin[1], 0.5 * dt * spin[2]
    pw = w - x * a - y * b - z * c
    px = x + w * a + y * c - z * b
    py = y + w * b + z * a - x * c
    pz = z + w * c + x * b - y * a
    s = 1.0 / sqrt(pw * pw + px * px + py * py + pz * pz)
    return pw * s, px * s, py * s, pz * s

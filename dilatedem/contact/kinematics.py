"""How two bodies move at a point where they touch, and how easily they give way there."""

from dilatedem.jit import item
from dilatedem.numerics.rotation import rotation_matrix, to_body
from dilatedem.numerics.vector import add, cross, load, sub


@item
def relative_velocity(velocity, spin, a, b, point, arm):
    """Velocity of b against a [m/s] at `point` from the centroid of a, `arm` from that of b."""
    va = add(load(velocity, a), cross(load(spin, a), point))
    vb = add(load(velocity, b), cross(load(spin, b), arm))
    return sub(vb, va)


@item
def mobility(i, solids, orientation, lever, normal):
    """1/m' [1/kg] of body i at `lever` from its centroid along the unit vector `normal`: 1/m + (r x n).I^-1.(r x n)."""
    total = solids.inverse_mass[i]
    if total == 0.0:
        return 0.0
    q = orientation
    arm = to_body(rotation_matrix(q[i, 0], q[i, 1], q[i, 2], q[i, 3]), cross(lever, normal))
    for r in range(3):
        for c in range(3):
            total += arm[r] * solids.inverse_inertia[i, r, c] * arm[c]
    return total

"""Friction as a spring in the tangent plane that slips at Coulomb's limit (Liu 2015, Eqs. (5) and (6), made incremental).

The paper's min(F*, sign(F*) mu F_n) is wrong for negative F*, and a scalar knows no direction in the plane: the spring is a
vector, kept with the contact through changes of mode, turned with the normal, stretched by the sliding of each step.
"""

from math import sqrt

from dilatedem.jit import device
from dilatedem.numerics.vector import add, along, dot, scale


@device
def carried_over(slip, normal):
    """The spring vector of the last step in today's tangent plane, its length kept."""
    before = dot(slip, slip)
    if before == 0.0:
        return slip
    flat = along(slip, -dot(slip, normal), normal)
    after = dot(flat, flat)
    if after == 0.0:
        return flat
    return scale(sqrt(before / after), flat)


@device
def slide(slip, sliding, stiffness, limit):
    """Spring after the tangential displacement `sliding` [m], no stronger than `limit` [N], and how far the contact slipped [m]."""
    stretched = add(slip, sliding)
    length = sqrt(dot(stretched, stretched))
    if stiffness * length <= limit:
        return stretched, 0.0
    held = limit / stiffness
    return scale(held / length, stretched), length - held


@device
def rescaled(slip, old, new):
    """The spring vector when its stiffness has changed from `old` to `new` [N/m], and the energy that this cost [J].

    A stiffer spring keeps its force, or it would have energy it was never given; a softer one keeps its elongation, and what its
    force loses on the way is left to the caller (it depends on where the step ends). After Mindlin and Deresiewicz (1953).
    """
    if new <= old or old == 0.0:
        return slip, 0.0
    return scale(old / new, slip), 0.5 * old * dot(slip, slip) * (1.0 - old / new)

"""The spring of friction: in the tangent plane, it slips at Coulomb's limit (Liu 2015, Eqs. (5) and (6), made incremental).

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
def length(slip, turned):
    """Elongation of the spring: of its vector in the tangent plane, and of the turning about the normal at the arm of the patch."""
    return sqrt(dot(slip, slip) + turned * turned)


@device
def slide(slip, turned, sliding, turning, stiffness, limit):
    """Spring after the displacement `sliding` and the turning `turning` [m], no stronger than `limit` [N]; how far it slipped [m].

    Sliding and turning share the limit: what a patch needs to hold a moment it cannot use against sliding.
    """
    stretched, wrung = add(slip, sliding), turned + turning
    whole = length(stretched, wrung)
    if stiffness * whole <= limit:
        return stretched, wrung, 0.0
    held = limit / stiffness
    return scale(held / whole, stretched), held / whole * wrung, whole - held


@device
def rescaled(old, new):
    """What is left of the spring's elongation when its stiffness has changed from `old` to `new` [N/m] in a step, and what part of
    the step's displacement still stretches it.

    A stiffer spring keeps its force, or it would have energy it was never given: its elongation shrinks, and its force rises by
    the displacement times the mean stiffness of the step. A softer one keeps its elongation. After Mindlin and Deresiewicz (1953).
    """
    if new <= old or old == 0.0:
        return 1.0, 1.0
    return old / new, 0.5 * (1.0 + old / new)


@device
def viscous_share(slip, turned, sliding, turning, stiffness, dashpot, limit):
    """The largest share, 0..1, of a dashpot's force that spring and dashpot together may have within `limit` [N].

    slip, turned: elongation of the spring [m], itself within the limit; sliding, turning: its rate [m/s].
    """
    # |f + s g| = limit, f the spring's force, g the dashpot's
    gg = dashpot * dashpot * (dot(sliding, sliding) + turning * turning)
    if gg == 0.0:
        return 1.0
    fg = stiffness * dashpot * (dot(slip, sliding) + turned * turning)
    room = limit * limit - stiffness * stiffness * (dot(slip, slip) + turned * turned)
    if gg + 2.0 * fg <= room:  # all of it
        return 1.0
    return min(1.0, (sqrt(fg * fg + gg * max(room, 0.0)) - fg) / gg)

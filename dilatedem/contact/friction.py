"""Friction of a contact (Liu 2015, Eqs. (5) and (6), made incremental): its spring moved on by a step, and what that cost."""

from math import sqrt
from typing import NamedTuple

from dilatedem.contact.laws import carry, rubbed
from dilatedem.contact.spring import carried_over, slide, viscous_share
from dilatedem.jit import item
from dilatedem.numerics.vector import along, dot, load, scale
from dilatedem.state.response import relative_spin, relative_velocity


class Held(NamedTuple):
    """What friction does to a contact, and what it cost in the last step."""

    slip: tuple  # m, elongation of the spring in the tangent plane
    wrung: float  # m, the same of turning about the normal, at the arm `grip`
    force: tuple  # N, on b, the normal force with it
    torsion: float  # N, against turning, at the arm `grip`
    damping_power: float  # W that damping takes up, that of the normal part with it
    lost: float  # J
    made: float  # J that the law made by changing the spring


@item
def hold(contact, k, dt, solids, bodies, pairs, pressed, arm):
    """Friction of contact k, pressed as `Pressed` says, as `Held`; arm: from the centroid of b to the point [m].

    The turning of a patch about its normal stretches the same spring, at the arm `grip`. Where one of the bodies is a structure,
    that is b: its coefficient of friction is that of the pair.
    """
    a, b, direction, stiffness = pairs.a[k], pairs.b[k], pressed.direction, pressed.shear_stiffness
    limit, grip = solids.friction[b] * pressed.normal_force, pairs.grip[k]
    before, before_turned = carried_over(load(pairs.slip, k), direction), pairs.wrung[k]
    slid = relative_velocity(bodies.middle_velocity, bodies.middle_angular_velocity, a, b, pressed.point, arm)
    slid, turned = along(slid, -dot(slid, direction), direction), 0.0
    if grip > 0.0:
        turned = grip * dot(relative_spin(bodies.middle_angular_velocity, a, b), direction)
    old_stiffness, opened = pairs.shear_stiffness[k], pairs.overlap[k] == 0.0
    shrink, stretch = 1.0, dt
    if not opened:
        shrink, stretch = carry(contact, old_stiffness, stiffness)
        stretch *= dt
    slip, wrung, slipped = slide(
        scale(shrink, before), shrink * before_turned, scale(stretch, slid), stretch * turned, stiffness, limit
    )
    force = along(scale(pressed.normal_force, direction), -stiffness, slip)
    torsion, damping_power = stiffness * wrung, pressed.damping_power
    if pressed.dashpot > 0.0:
        dashpot = pressed.dashpot * sqrt(contact.stiffness_ratio)
        sliding = along(pressed.velocity, -dot(pressed.velocity, direction), direction)
        turning = grip * dot(pressed.turning, direction)
        share = viscous_share(slip, wrung, sliding, turning, stiffness, dashpot, limit)
        force = along(force, -share * dashpot, sliding)
        torsion += share * dashpot * turning
        damping_power += share * dashpot * (dot(sliding, sliding) + turning * turning)
    lost, made = rubbed(
        contact, dt, opened, (old_stiffness, before, before_turned), (stiffness, slip, wrung), slid, turned, slipped
    )
    return Held(slip, wrung, force, torsion, damping_power, lost, made)

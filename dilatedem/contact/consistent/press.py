"""The normal part of a contact by the energy of its pose: where the force acts, what damping adds, what friction leans on."""

from math import sqrt
from typing import NamedTuple

from dilatedem.contact.consistent.cone import energy_of_pose
from dilatedem.contact.consistent.dashpot import dashpot
from dilatedem.contact.crushing.depth import UNTRIED, WHOLE, dearer, note_crushed, settle, worn
from dilatedem.contact.pressed import Pressed
from dilatedem.contact.search.cone import radius_at
from dilatedem.jit import device, item
from dilatedem.numerics.vector import along, cross, dot, norm, scale, store, sub
from dilatedem.state.response import mobility, relative_spin, relative_velocity, yielding

#: share of the sum of the radii past which the distance of the cores means nothing to the energy: they are about to touch
DEEPEST_SHARE = 0.95
#: tangent stiffness over F^2/W: p/(p + 1) of a power law F = K overlap^p, largest for p = 3/2
TANGENT = 0.6
NONE = (0.0, 0.0, 0.0)


class Acting(NamedTuple):
    """What acts at a pose; places from the centroid of a."""

    point: tuple  # m, centre of pressure
    arm: tuple  # m, from the centroid of b to it
    direction: tuple  # unit vector of the force on b
    couple: tuple  # N m on b, along the force
    velocity: tuple  # m/s, of b against a at the point
    turning: tuple  # rad/s, of b against a
    square: float  # N2, of the elastic force
    elastic: float  # N
    power: float  # W that it takes up
    strength: float  # N s/m, of the dashpot
    share: float  # elastic force and dashpot over the elastic force


@device
def pressure_centre(force, unit, moment, through):
    """The wrench of a force and its moment about the origin as a force at a point and a couple along it.

    unit: 1/force^2; through: a point in whose plane across the force the centre of pressure is looked for.
    """
    foot = scale(unit, cross(force, moment))
    point = along(foot, dot(sub(through, foot), force) * unit, force)
    return point, scale(dot(moment, force) * unit, force)


@item
def _rocking_couple(dashpot, force, spread, normal, turning):
    """Couple on b [N m] of a dashpot [N s/m] spread over the patch, against the relative angular velocity `turning` [rad/s]."""
    one, two = cross(spread[0], normal), cross(spread[1], normal)
    couple = along(scale(-dashpot * dot(one, turning), one), -dashpot * dot(two, turning), two)
    square, most = dot(couple, couple), force * force * (dot(one, one) + dot(two, two))
    return scale(sqrt(most / square), couple) if square > most else couple


@item
def _act(contact, k, a, b, solids, bodies, pairs, offset, through, energy, force, moment):
    """The elastic wrench of a pose and its dashpot, as `Acting`; through: as of `pressure_centre`, from a's centroid."""
    square = dot(force, force)
    elastic, unit = sqrt(square), 1.0 / square
    direction = scale(unit * elastic, force)  # the division need not wait for the root
    point, couple = pressure_centre(force, unit, moment, through)
    arm = sub(point, offset)
    velocity = relative_velocity(bodies.velocity, bodies.angular_velocity, a, b, point, arm)
    turning = relative_spin(bodies.angular_velocity, a, b)
    power = -dot(force, velocity) - dot(couple, turning)
    share, strength = 1.0, 0.0
    if contact.damping > 0.0:
        give = mobility(a, solids, bodies.orientation, point, direction) + mobility(b, solids, bodies.orientation, arm, direction)
        give += yielding(k, solids, pairs)
        strength = dashpot(contact, elastic, give * energy, power * (unit * elastic))
        share = max(1.0 + strength * power * unit, 0.0)
    return Acting(point, arm, direction, couple, velocity, turning, square, elastic, power, strength, share)


@device
def force_change_consistent(contact, k, shapes, vertex, face_normal, solids, pairs, offset, normal, pa, pb, gap, scratch):
    """By how much [N] the elastic force of contact k at a pose differs from what it is now; nothing is written.

    Arguments as of `press_consistent`.
    """
    a, b, crushed, ahead = pairs.a[k], pairs.b[k], worn(contact, k, pairs), 0.0
    reach = shapes.radius[a] + radius_at(shapes, vertex, b, sub(pb, offset))
    if crushed - gap < DEEPEST_SHARE * reach:
        modulus = 1.0 / (solids.compliance[a] + solids.compliance[b])
        _, force, _, _, _, _ = energy_of_pose(
            vertex, face_normal, shapes, a, b, pairs.corners[k], pairs.corner_a[k], pairs.corner_b[k], offset, normal, pb, crushed,
            -gap, modulus, scratch,
        )  # fmt: skip
        ahead = norm(force)
    return abs(ahead - sqrt(pairs.tangent[k] / TANGENT * pairs.stored[k]))


@item
def press_consistent(contact, k, dt, shapes, vertex, face_normal, solids, bodies, pairs, offset, normal, pa, pb, gap, scratch):
    """The normal part of contact k, as `Pressed`; arguments as of `liu2015.press_liu2015`. Writes the pair's couple, its grip and
    its tangent.

    Damping multiplies the elastic wrench by 1 + c (dW/dt)/F^2, never below 0, with the c [N s/m] of `dashpot.dashpot`: restitution
    depends on the damping alone. m*: what the bodies oppose at the centre of pressure, `response.mobility`. Rocking, which
    changes W only to second order, meets the same dashpot spread over the patch: a couple -c J omega, J the second moments of the
    overlap. It cannot lift the patch: its arm stays within their root. Where ice crushes, the pose is looked at again until force
    and crushed depth agree.
    """
    a, b = pairs.a[k], pairs.b[k]
    crushed = worn(contact, k, pairs)
    reach = shapes.radius[a] + radius_at(shapes, vertex, b, sub(pb, offset))
    whole = crushed - gap  # overlap of what has not crushed [m]
    modulus = 1.0 / (solids.compliance[a] + solids.compliance[b])
    search, found, settled = UNTRIED, WHOLE, False
    while not settled:
        overlap = whole - crushed
        middle = along(pa, shapes.radius[a] - 0.5 * overlap, normal)
        energy, force, moment, mode, size, spread = 0.0, NONE, NONE, 0, 1.0, (NONE, NONE)
        if whole < DEEPEST_SHARE * reach:
            energy, force, moment, mode, size, spread = energy_of_pose(
                vertex, face_normal, shapes, a, b, pairs.corners[k], pairs.corner_a[k], pairs.corner_b[k], offset, normal, pb,
                crushed, overlap, modulus, scratch,
            )  # fmt: skip
        if not (energy > 0.0 and dot(force, force) > 0.0):
            store(pairs.couple, k, NONE)
            pairs.grip[k] = 0.0
            return Pressed(mode, size, overlap, middle, normal, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, NONE, NONE)
        acting = _act(contact, k, a, b, solids, bodies, pairs, offset, middle, energy, force, moment)
        settled, crushed, search, found = settle(
            contact, k, dt, acting.velocity, search, crushed, acting.elastic, acting.share * acting.elastic, energy, overlap,
            vertex, face_normal, shapes, bodies, pairs, offset, normal, pa, pb, scratch,
        )  # fmt: skip
    note_crushed(contact, k, crushed, found, bodies, pairs, pa)
    crumbled = found.lost * dearer(contact, search, crushed, acting.elastic, energy, overlap)
    direction, strength, share = acting.direction, acting.strength, min(acting.share, found.limit / acting.elastic)
    rocking, rocking_power = NONE, 0.0
    if contact.damping > 0.0:
        rocking = _rocking_couple(strength, share * acting.elastic, spread, direction, acting.turning)
        rocking_power = -dot(rocking, acting.turning)
    damping_power = (share - 1.0) * acting.power + rocking_power
    store(pairs.couple, k, along(rocking, share, acting.couple))
    pairs.grip[k] = sqrt(dot(spread[0], spread[0]) + dot(spread[1], spread[1]))
    stiffness = acting.square / energy
    pairs.tangent[k] = TANGENT * stiffness
    shear_stiffness = 0.5 * contact.stiffness_ratio * stiffness
    return Pressed(
        mode=mode, size=size, overlap=overlap, point=acting.point, direction=direction, normal_force=share * acting.elastic,
        elastic_power=acting.power, damping_power=damping_power, shear_stiffness=shear_stiffness, dashpot=strength,
        stored=energy, gain=0.0, crumbled=crumbled, velocity=acting.velocity, turning=acting.turning,
    )  # fmt: skip

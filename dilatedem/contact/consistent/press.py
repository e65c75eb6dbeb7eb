"""The normal part of a contact by the energy of its pose: where the force acts, what damping adds, what friction leans on."""

from math import sqrt

from dilatedem.contact.consistent.join import pose_energy
from dilatedem.contact.kinematics import mobility, relative_velocity
from dilatedem.jit import device, item
from dilatedem.numerics.vector import along, cross, dot, load, norm, scale, store, sub

#: share of the sum of the radii past which the distance of the cores means nothing to the energy: they are about to touch
DEEPEST_SHARE = 0.95
#: tangent stiffness over F^2/W: p/(p + 1) of a power law F = K overlap^p, largest for p = 3/2
TANGENT = 0.6


@device
def pressure_centre(force, moment, through):
    """The wrench of a force and its moment about the origin as a force at a point and a couple along it.

    through: a point in whose plane across the force the centre of pressure is looked for.
    """
    square = dot(force, force)
    foot = scale(1.0 / square, cross(force, moment))
    point = along(foot, dot(sub(through, foot), force) / square, force)
    return point, scale(dot(moment, force) / square, force)


@item
def press_consistent(k, shapes, vertex, face_normal, solids, bodies, pairs, contact, offset, normal, pa, pb, gap, scratch):
    """The normal part of contact k; arguments and results as of `liu2015.press_liu2015`. Writes the pair's couple.

    Damping multiplies the elastic wrench by 1 + xi sqrt(2 m*/W) (dW/dt)/F, never below 0. For any law F = K overlap^p that adds
    c sqrt(m* K) overlap^((p-1)/2) times the approach speed with c = sqrt(2 (p+1)) xi: restitution depends on xi alone. m*: what
    the bodies oppose at the centre of pressure, `kinematics.mobility`.
    """
    a, b = pairs.a[k], pairs.b[k]
    reach = shapes.radius[a] + shapes.radius[b]
    middle = along(pa, shapes.radius[a] + 0.5 * gap, normal)
    none = (0.0, 0.0, 0.0)
    energy, elastic, mode, size, force, moment = 0.0, 0.0, 0, 1.0, none, none
    if -gap < DEEPEST_SHARE * reach:
        modulus = 1.0 / (solids.compliance[a] + solids.compliance[b])
        energy, force, moment, mode, size = pose_energy(
            vertex, face_normal, shapes, a, b, pairs.corner_a[k, 0], pairs.corner_b[k, 0], offset, normal, pb, modulus, scratch
        )
        elastic = norm(force)
    if not (energy > 0.0 and elastic > 0.0):
        store(pairs.couple, k, none)
        return mode, size, -gap, middle, normal, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    direction = scale(1.0 / elastic, force)
    point, couple = pressure_centre(force, moment, middle)
    arm = sub(point, offset)
    velocity = relative_velocity(bodies.velocity, bodies.angular_velocity, a, b, point, arm)
    turning = sub(load(bodies.angular_velocity, b), load(bodies.angular_velocity, a))
    elastic_power = -dot(force, velocity) - dot(couple, turning)
    approach = elastic_power / elastic
    share = 1.0
    if contact.damping > 0.0:
        give = mobility(a, solids, bodies.orientation, point, direction) + mobility(b, solids, bodies.orientation, arm, direction)
        share = max(1.0 + contact.damping * sqrt(2.0 / (give * energy)) * approach, 0.0)
    store(pairs.couple, k, scale(share, couple))
    pairs.tangent[k] = TANGENT * elastic * elastic / energy
    shear_stiffness = 0.5 * contact.stiffness_ratio * elastic * elastic / energy
    return (
        mode, size, -gap, point, direction, elastic, share * elastic, approach, elastic_power, shear_stiffness, energy, 0.0,
    )  # fmt: skip

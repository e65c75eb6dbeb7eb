"""How a body moves and what it opposes to a force: the one door to both, for contacts and for motion."""

from dilatedem.jit import by_type, item
from dilatedem.numerics.rotation import rotation_matrix, to_body, to_world
from dilatedem.numerics.vector import add, along, cross, dot, load, sub
from dilatedem.state.bodies import WateredSolids
from dilatedem.state.modal import ModalSolids


@item
def is_free(i, solids):
    """Whether body i moves under its loads; the others are held."""
    return solids.inverse_mass[i] > 0.0


@item
def is_joined(i, solids):
    """Whether body i is part of a floe of several."""
    return solids.floe[i] >= 0


@item
def are_joined(a, b, solids):
    """Whether two bodies are parts of one floe."""
    return solids.floe[a] >= 0 and solids.floe[a] == solids.floe[b]


@item
def gives_way(i, solids):
    """Whether body i moves where it is pushed: it is free, or part of a structure that is sprung."""
    return solids.inverse_mass[i] > 0.0 or solids.give[i, 0] > 0.0


@item
def stride_of(a, b, workspace):
    """How many steps the stride of two bodies that may touch took which ends at this instant; 0 where none ends.

    Both take it where both move; what stands still comes along at every instant.
    """
    return workspace.stride[a] if workspace.island[a] >= 0 else workspace.stride[b]


@item
def point_velocity(velocity, spin, i, lever):
    """Velocity [m/s] of the point of body i at `lever` from its centroid."""
    return add(load(velocity, i), cross(load(spin, i), lever))


@item
def relative_velocity(velocity, spin, a, b, point, arm):
    """Velocity of b against a [m/s] at `point` from the centroid of a, `arm` from that of b."""
    return sub(point_velocity(velocity, spin, b, arm), point_velocity(velocity, spin, a, point))


@item
def relative_spin(spin, a, b):
    """How b turns against a [rad/s]."""
    return sub(load(spin, b), load(spin, a))


@item
def _pushed(i, solids, velocity, time, force):
    return along(velocity, time * solids.inverse_mass[i], force)


@item
def _pushed_with_water(i, solids, velocity, time, force):
    level, heave = time * solids.inverse_mass[i], time * solids.inverse_heave_mass[i]
    return velocity[0] + level * force[0], velocity[1] + level * force[1], velocity[2] + heave * force[2]


#: pushed(i, solids, velocity, time, force): the velocity [m/s] that a force [N] makes of `velocity` in a time [s].
pushed = by_type(_pushed, {WateredSolids: _pushed_with_water}, at=1)


@item
def body_spin(i, solids, momentum):
    """Angular velocity [rad/s] that an angular momentum [kg m2/s] means, both in the frame of body i."""
    give = solids.inverse_inertia
    return (
        give[i, 0, 0] * momentum[0] + give[i, 0, 1] * momentum[1] + give[i, 0, 2] * momentum[2],
        give[i, 1, 0] * momentum[0] + give[i, 1, 1] * momentum[1] + give[i, 1, 2] * momentum[2],
        give[i, 2, 0] * momentum[0] + give[i, 2, 1] * momentum[1] + give[i, 2, 2] * momentum[2],
    )


@item
def spin_of(i, solids, orientation, momentum):
    """Angular velocity [rad/s, world axes] of body i with angular momentum `momentum` [kg m2/s, world axes]."""
    R = rotation_matrix(orientation[i, 0], orientation[i, 1], orientation[i, 2], orientation[i, 3])
    return to_world(R, body_spin(i, solids, to_body(R, momentum)))


@item
def reduced_mass(a, b, solids):
    """Mass [kg] with which two bodies, one of them free at least, oppose being pushed apart along the line of their centroids."""
    return 1.0 / ((solids.inverse_mass[a] + solids.give[a, 0]) + (solids.inverse_mass[b] + solids.give[b, 0]))


@item
def carried_mobility(i, solids, orientation, lever, normal):
    """1/m' [1/kg] of body i of a structure, as `mobility`: of all parts together, as their support lets them move.

    (n_x^2 + n_y^2)/M + (r x n)_z^2/J, r from the structure's place. Springs and dashpots of the support are left out: a contact is
    over before they have been bent. Zero for what is held or driven.
    """
    give, turn = solids.give[i, 0], solids.give[i, 1]
    if give == 0.0:
        return 0.0
    total = give * (normal[0] * normal[0] + normal[1] * normal[1])
    if turn > 0.0:
        R = rotation_matrix(orientation[i, 0], orientation[i, 1], orientation[i, 2], orientation[i, 3])
        arm = add(to_world(R, load(solids.seat, i)), lever)
        moment = arm[0] * normal[1] - arm[1] * normal[0]
        total += turn * moment * moment
    return total


@item
def _lightness(i, solids, normal):
    return solids.inverse_mass[i]


@item
def _lightness_with_water(i, solids, normal):
    level, heave = solids.inverse_mass[i], solids.inverse_heave_mass[i]
    return level * (normal[0] * normal[0] + normal[1] * normal[1]) + heave * normal[2] * normal[2]


#: lightness(i, solids, normal): 1/m [1/kg] with which body i as a whole gives way along the unit vector `normal`.
lightness = by_type(_lightness, {WateredSolids: _lightness_with_water}, at=1)


@item
def _no_water(i, solids, bodies):
    return 0.0, 0.0


@item
def _water_taken_along(i, solids, bodies):
    v, w, q = load(bodies.velocity, i), load(bodies.angular_velocity, i), bodies.orientation
    R = rotation_matrix(q[i, 0], q[i, 1], q[i, 2], q[i, 3])
    upright = dot(w, (R[0][2], R[1][2], R[2][2]))
    straight = solids.added_mass[i, 0] * (v[0] * v[0] + v[1] * v[1]) + solids.added_mass[i, 1] * v[2] * v[2]
    return 0.5 * straight, 0.5 * solids.added_inertia[i] * (dot(w, w) - upright * upright)


#: water_energies(i, solids, bodies): kinetic energy [J] of the water that body i takes along, where it moves and where it turns.
water_energies = by_type(_no_water, {WateredSolids: _water_taken_along}, at=1)


@item
def mobility(i, solids, orientation, lever, normal):
    """1/m' [1/kg] of body i at `lever` from its centroid along the unit vector `normal`: 1/m + (r x n).I^-1.(r x n)."""
    total = lightness(i, solids, normal)
    if total == 0.0:
        return carried_mobility(i, solids, orientation, lever, normal)
    q, give = orientation, solids.inverse_inertia
    # turned by the quaternion itself: for one vector its matrix takes longer; the inertia is symmetric
    axis, arm = (q[i, 1], q[i, 2], q[i, 3]), cross(lever, normal)
    twice = cross(arm, axis)
    twice = add(twice, twice)
    x, y, z = add(along(arm, q[i, 0], twice), cross(twice, axis))
    xx, yy, zz = give[i, 0, 0] * x * x, give[i, 1, 1] * y * y, give[i, 2, 2] * z * z
    xy, xz, yz = give[i, 0, 1] * x * y, give[i, 0, 2] * x * z, give[i, 1, 2] * y * z
    return total + ((xx + yy) + zz) + 2.0 * ((xy + xz) + yz)


@item
def _stiff(k, solids, pairs):
    return 0.0


@item
def _yielding(k, solids, pairs):
    return pairs.yields[k]


#: yielding(k, solids, pairs): 1/m' [1/kg] with which the modes of both bodies give way to the contact of pair k.
yielding = by_type(_stiff, {ModalSolids: _yielding}, at=1)


@item
def _reduced(k, a, b, solids, pairs):
    return reduced_mass(a, b, solids)


@item
def _reduced_by_modes(k, a, b, solids, pairs):
    return 1.0 / (1.0 / reduced_mass(a, b, solids) + pairs.yields[k])


#: pressed_mass(k, a, b, solids, pairs): as `reduced_mass`, of the bodies of pair k as they bend; what a dashpot is made for.
pressed_mass = by_type(_reduced, {ModalSolids: _reduced_by_modes}, at=3)


@item
def bulge(i, solids, bodies):
    """How far [m] no point of body i is from where it is unbent."""
    farthest = 0.0
    for m in range(solids.mode_count[i]):
        farthest += abs(bodies.coordinate[i, m]) * solids.mode_reach[i, m]
    return farthest

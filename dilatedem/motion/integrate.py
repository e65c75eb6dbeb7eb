"""Motion of one body: velocity Verlet in translation, its counterpart with quaternions in rotation.

Both are second order, also under velocity-dependent forces: those see a velocity predicted for the same instant. From half step to
half step a force's work is then exactly force x velocity x dt, so that the ledger closes. Rotation keeps the angular momentum in
world axes as its state: without torque |L| cannot change.
"""

from dilatedem.jit import device, item
from dilatedem.numerics.rotation import rotation_matrix, to_body, to_world, turned
from dilatedem.numerics.vector import along, cross, dot, load, store
from dilatedem.state.response import are_joined, body_spin, is_free, pushed, spin_of


@item
def _middle(i, dt, solids, bodies, R):
    """Velocity [m/s], angular momentum [kg m2/s] and spin [rad/s] of body i half a step ahead, kicked by the loads there are.

    R: its rotation matrix. The spin is in the body frame, from Euler's equation.
    """
    velocity = pushed(i, solids, load(bodies.velocity, i), 0.5 * dt, load(bodies.force, i))
    momentum = along(load(bodies.angular_momentum, i), 0.5 * dt, load(bodies.torque, i))
    own = to_body(R, momentum)
    own = along(own, 0.5 * dt, cross(own, body_spin(i, solids, own)))
    return velocity, momentum, body_spin(i, solids, own)


@item
def _travel(dt, velocity, spin, reach, frame):
    """Bound on the distance [m] that any point of a body moves, in the frame (2,) [m/s] where paths are measured."""
    # sums instead of lengths: no smaller, and without a square root
    moved = abs(velocity[0] - frame[0]) + abs(velocity[1] - frame[1]) + abs(velocity[2])
    return dt * (moved + (abs(spin[0]) + abs(spin[1]) + abs(spin[2])) * reach)


@item
def travel(i, dt, solids, bodies, reach, frame):
    """How far `drift` would move body i at most [m]; nothing is written."""
    q = bodies.orientation
    velocity, _, spin = _middle(i, dt, solids, bodies, rotation_matrix(q[i, 0], q[i, 1], q[i, 2], q[i, 3]))
    return _travel(dt, velocity, spin, reach, frame)


@item
def drift(i, dt, solids, bodies, reach, frame):
    """Half a kick and the whole move of body i; velocities become a prediction for the end of the step.

    frame (2,) [m/s]: where paths are measured. Returns a bound on the distance that any of its points moved in that frame [m].
    """
    q = bodies.orientation
    R = rotation_matrix(q[i, 0], q[i, 1], q[i, 2], q[i, 3])
    middle, momentum, spin = _middle(i, dt, solids, bodies, R)
    store(bodies.middle_velocity, i, middle)
    store(bodies.velocity, i, pushed(i, solids, middle, 0.5 * dt, load(bodies.force, i)))
    store(bodies.position, i, along(load(bodies.position, i), dt, middle))

    store(bodies.middle_angular_momentum, i, momentum)
    store(bodies.middle_angular_velocity, i, to_world(R, spin))
    w, x, y, z = turned((q[i, 0], q[i, 1], q[i, 2], q[i, 3]), spin, dt)
    q[i, 0], q[i, 1], q[i, 2], q[i, 3] = w, x, y, z
    store(bodies.angular_velocity, i, spin_of(i, solids, q, along(momentum, 0.5 * dt, load(bodies.torque, i))))
    return _travel(dt, middle, spin, reach, frame)


@item
def place_ahead(i, dt, solids, bodies, position, orientation):
    """Write to rows of `position` (n, 3) and `orientation` (n, 4) where `drift` would bring body i."""
    q = bodies.orientation
    if not is_free(i, solids):
        store(position, i, load(bodies.position, i))
        orientation[i, 0], orientation[i, 1], orientation[i, 2], orientation[i, 3] = q[i, 0], q[i, 1], q[i, 2], q[i, 3]
        return
    middle, _, spin = _middle(i, dt, solids, bodies, rotation_matrix(q[i, 0], q[i, 1], q[i, 2], q[i, 3]))
    store(position, i, along(load(bodies.position, i), dt, middle))
    w, x, y, z = turned((q[i, 0], q[i, 1], q[i, 2], q[i, 3]), spin, dt)
    orientation[i, 0], orientation[i, 1], orientation[i, 2], orientation[i, 3] = w, x, y, z


@item
def kick(i, dt, solids, bodies):
    """The second half of the kick of body i, by the loads at the end of the step; `complete_spin` turns it into a spin."""
    store(bodies.velocity, i, pushed(i, solids, load(bodies.middle_velocity, i), 0.5 * dt, load(bodies.force, i)))
    store(bodies.angular_momentum, i, along(load(bodies.middle_angular_momentum, i), 0.5 * dt, load(bodies.torque, i)))


@item
def complete_spin(i, solids, bodies):
    """Angular velocity of body i from its angular momentum: for whoever looks at the bodies, the next step does not need it."""
    store(bodies.angular_velocity, i, spin_of(i, solids, bodies.orientation, load(bodies.angular_momentum, i)))


@device
def kinetic_energy(i, solids, bodies):
    """J, with that of the water that turns with the body; zero for a fixed body. That of a floe of several parts as it turns is the
    first one's."""
    if not is_free(i, solids):
        return 0.0
    v = load(bodies.velocity, i)
    turning = dot(load(bodies.angular_momentum, i), load(bodies.angular_velocity, i))
    if i > 0 and are_joined(i - 1, i, solids):
        turning = 0.0
    return 0.5 * (solids.mass[i] * dot(v, v) + turning)

"""Motion of bodies that bend: velocity Verlet of each mode beside that of the body as a whole (Bao & Jiang 2004, Eqs. (11)-(15)).

The body's inertia is that of its bent shape, I = I0 + sum dI/dxi_i xi_i; with the angular momentum L as the state of its rotation,
the energy 1/2 L.I^-1.L + 1/2 sum (xi_i'^2 + w_i^2 xi_i^2) has as its gradient the centrifugal force 1/2 w.(dI/dxi_i).w on a mode,
which loses what a bent body gains as it turns.
"""

from dilatedem.jit import by_type, item
from dilatedem.motion import integrate
from dilatedem.numerics.rotation import rotation_matrix, to_body
from dilatedem.numerics.vector import along, dot, load, store
from dilatedem.state.modal import ModalSolids
from dilatedem.state.response import body_spin, spin_of


@item
def _stiffen(i, solids, bodies, lag):
    """Write the inverse inertia of body i as it is bent `lag` [s] of its middle rates after its coordinates."""
    inertia, gradient, coordinate, rate = solids.inertia, solids.inertia_gradient, bodies.coordinate, bodies.middle_rate
    xx, yy, zz = inertia[i, 0, 0], inertia[i, 1, 1], inertia[i, 2, 2]
    yz, zx, xy = inertia[i, 1, 2], inertia[i, 2, 0], inertia[i, 0, 1]
    for m in range(solids.mode_count[i]):
        out = coordinate[i, m] + lag * rate[i, m]
        xx += out * gradient[i, m, 0, 0]
        yy += out * gradient[i, m, 1, 1]
        zz += out * gradient[i, m, 2, 2]
        yz += out * gradient[i, m, 1, 2]
        zx += out * gradient[i, m, 2, 0]
        xy += out * gradient[i, m, 0, 1]
    a, b, c = yy * zz - yz * yz, yz * zx - xy * zz, xy * yz - yy * zx
    d, e, f = xx * zz - zx * zx, xy * zx - xx * yz, xx * yy - xy * xy
    unit, give = 1.0 / (xx * a + xy * b + zx * c), solids.inverse_inertia
    give[i, 0, 0], give[i, 1, 1], give[i, 2, 2] = unit * a, unit * d, unit * f
    give[i, 0, 1] = give[i, 1, 0] = unit * b
    give[i, 0, 2] = give[i, 2, 0] = unit * c
    give[i, 1, 2] = give[i, 2, 1] = unit * e


@item
def _vibration(i, dt, solids, bodies):
    """Bound on the distance [m] that any point of body i moves by its modes in a step."""
    moved = 0.0
    for m in range(solids.mode_count[i]):
        moved += abs(bodies.rate[i, m] + 0.5 * dt * bodies.mode_force[i, m]) * solids.mode_reach[i, m]
    return dt * moved


@item
def _travel_bending(i, dt, solids, bodies, reach, frame):
    _stiffen(i, solids, bodies, 0.0)  # a run that is resumed has the inertia of the unbent body
    return integrate.travel(i, dt, solids, bodies, reach, frame) + _vibration(i, dt, solids, bodies)


@item
def _drift_bending(i, dt, solids, bodies, reach, frame):
    moved = _vibration(i, dt, solids, bodies)
    for m in range(solids.mode_count[i]):
        bodies.middle_rate[i, m] = bodies.rate[i, m] + 0.5 * dt * bodies.mode_force[i, m]
    _stiffen(i, solids, bodies, 0.5 * dt)  # of the middle of the step, as is the momentum that turns the body
    moved += integrate.drift(i, dt, solids, bodies, reach, frame)
    for m in range(solids.mode_count[i]):
        bodies.coordinate[i, m] += dt * bodies.middle_rate[i, m]
        bodies.rate[i, m] = bodies.middle_rate[i, m] + 0.5 * dt * bodies.mode_force[i, m]
    _stiffen(i, solids, bodies, 0.0)
    momentum = along(load(bodies.middle_angular_momentum, i), 0.5 * dt, load(bodies.torque, i))
    store(bodies.angular_velocity, i, spin_of(i, solids, bodies.orientation, momentum))
    return moved


@item
def _load_modes(i, dt, solids, bodies):
    """What acts on each mode of body i at this instant: contacts, its own stiffness and damping, the centrifugal force."""
    power, q, gradient = 0.0, bodies.orientation, solids.inertia_gradient
    momentum = load(bodies.angular_momentum, i)
    if dt > 0.0:
        momentum = along(load(bodies.middle_angular_momentum, i), 0.5 * dt, load(bodies.torque, i))
    spin = body_spin(i, solids, to_body(rotation_matrix(q[i, 0], q[i, 1], q[i, 2], q[i, 3]), momentum))
    for m in range(solids.mode_count[i]):
        damped = solids.mode_damping[i, m] * bodies.rate[i, m]
        power += damped * bodies.rate[i, m]
        rows = (load(gradient[i, m], 0), load(gradient[i, m], 1), load(gradient[i, m], 2))
        outwards = 0.5 * dot(spin, (dot(rows[0], spin), dot(rows[1], spin), dot(rows[2], spin)))
        bodies.mode_force[i, m] = bodies.mode_load[i, m] + outwards - damped - solids.mode_square[i, m] * bodies.coordinate[i, m]
    bodies.mode_loss[i] += 0.5 * dt * (power + bodies.mode_power[i])
    bodies.mode_power[i] = power


@item
def _kick_bending(i, dt, solids, bodies):
    integrate.kick(i, dt, solids, bodies)
    for m in range(solids.mode_count[i]):
        bodies.rate[i, m] = bodies.middle_rate[i, m] + 0.5 * dt * bodies.mode_force[i, m]


@item
def _no_modes(i, dt, solids, bodies):
    pass


@item
def _sum_nothing(chosen, first, last, awake, solids, bodies, pairs, workspace):
    pass


@item
def _sum_pushes(chosen, first, last, awake, solids, bodies, pairs, workspace):
    """What contacts do to the modes of the bodies chosen[first:last], in the order of the pairs, as `contact.sums.sum_contacts`."""
    low, high, push = chosen[first], chosen[last - 1], workspace.mode_push
    for w in range(first, last):
        for m in range(solids.mode_count[chosen[w]]):
            bodies.mode_load[chosen[w], m] = 0.0
    for w in range(awake):
        k = workspace.awake[w]
        a, b = pairs.a[k], pairs.b[k]
        if pairs.overlap[k] > 0.0:
            if low <= a <= high:
                for m in range(solids.mode_count[a]):
                    bodies.mode_load[a, m] += push[k, 0, m]
            if low <= b <= high:
                for m in range(solids.mode_count[b]):
                    bodies.mode_load[b, m] += push[k, 1, m]


@item
def _never_bends(i, solids):
    return False


@item
def _may_bend(i, solids):
    return solids.mode_count[i] > 0


@item
def _no_energy(i, solids, bodies):
    return 0.0


@item
def _energy_of_modes(i, solids, bodies):
    total = 0.0
    for m in range(solids.mode_count[i]):
        total += bodies.rate[i, m] ** 2 + solids.mode_square[i, m] * bodies.coordinate[i, m] ** 2
    return 0.5 * total


#: As `motion.integrate` has them, of bodies that may bend.
travel = by_type(integrate.travel, {ModalSolids: _travel_bending}, at=2)
drift = by_type(integrate.drift, {ModalSolids: _drift_bending}, at=2)
kick = by_type(integrate.kick, {ModalSolids: _kick_bending}, at=2)
#: load_modes(i, dt, solids, bodies): before `kick`, once all loads on the body are there.
load_modes = by_type(_no_modes, {ModalSolids: _load_modes}, at=2)
#: sum_pushes(chosen, first, last, awake, solids, bodies, pairs, workspace): beside `contact.sums.sum_contacts`.
sum_pushes = by_type(_sum_nothing, {ModalSolids: _sum_pushes}, at=4)
#: bends(i, solids): whether body i has modes.
bends = by_type(_never_bends, {ModalSolids: _may_bend}, at=1)
#: modal_energy(i, solids, bodies): kinetic and elastic energy [J] of the modes of body i.
modal_energy = by_type(_no_energy, {ModalSolids: _energy_of_modes}, at=1)

"""Motion of structures that are not held: the driven follow their table of time, the others swing on their supports.

M u'' + C u' + K u = F for each of the three ways that a support gives way, F the load of the ice, in the steps of
`motion.integrate`: half a kick, the whole move, the loads at the new place against a velocity predicted for it, half a kick.
"""

from math import cos, sin

from dilatedem.jit import by_type, device, item
from dilatedem.motion.vibrate import push_modes, vibrate
from dilatedem.numerics.vector import add, load, store
from dilatedem.state.supports import Carried, ModalSupports

DRIVEN, MODAL = int(Carried.DRIVEN), int(Carried.MODAL)
#: columns of `Loads.step_load` that a support bears: along x, along y, about z
BORNE = (0, 1, 5)


@item
def carry_structures(dt, model, bodies, excursions, clock):
    """Move the structures that are not held, and their parts with them, by a step of dt [s]; a step of 0 moves nothing."""
    if dt == 0.0:
        return
    supports = model.supports
    time = clock.since_time[0] + (clock.step[0] + 1 - clock.since_step[0]) * dt
    for m in range(len(supports.moving)):
        s = supports.moving[m]
        if supports.kind[s] == DRIVEN:
            _drive(s, time, dt, supports, excursions)
        else:
            swing(s, dt, supports, excursions)
        shift = (excursions.displacement[s, 0], excursions.displacement[s, 1], 0.0)
        store(excursions.center, s, add(load(supports.place, s), shift))
        _place_parts(m, dt, model.floating, supports, bodies, excursions)
        _take_along(s, model.whole_of, excursions)


@device
def _drive(s, time, dt, supports, excursions):
    """Put structure s where its table has it at `time` [s]: cubic between two rows, beyond the last as fast as there."""
    times, first, last = supports.knot_time, supports.knot_start[s], supports.knot_start[s + 1] - 1
    low, high = first, last
    while high - low > 1:
        middle = (low + high) // 2
        if times[middle] <= time:
            low = middle
        else:
            high = middle
    for c in range(3):
        before = excursions.displacement[s, c]
        if time <= times[first] or time >= times[last]:
            k = first if time <= times[first] else last
            rate = supports.slope[k, c]
            place = supports.knot[k, c] + rate * (time - times[k])
        else:
            h = times[high] - times[low]
            x = (time - times[low]) / h
            rise = supports.knot[high, c] - supports.knot[low, c]
            begin, end = h * supports.slope[low, c] - rise, h * supports.slope[high, c] - rise
            place = supports.knot[low, c] + x * rise + x * (1.0 - x) * ((1.0 - x) * begin - x * end)
            rate = (rise + (1.0 - x) * (1.0 - 3.0 * x) * begin - x * (2.0 - 3.0 * x) * end) / h
        excursions.displacement[s, c] = place
        excursions.velocity[s, c] = rate
        excursions.middle_velocity[s, c] = (place - before) / dt


@device
def _swing(s, dt, supports, excursions):
    """Half a kick and the whole move of structure s; its velocity becomes a prediction for the end of the step."""
    for c in range(3):
        kick = 0.5 * dt * supports.inverse_mass[s, c] * excursions.force[s, c]
        middle = excursions.velocity[s, c] + kick
        excursions.middle_velocity[s, c] = middle
        excursions.displacement[s, c] += dt * middle
        excursions.velocity[s, c] = middle + kick


@device
def _swing_or_vibrate(s, dt, supports, excursions):
    if supports.kind[s] == MODAL:
        vibrate(s, dt, supports, excursions)
    else:
        _swing(s, dt, supports, excursions)


#: swing(s, dt, supports, excursions): half a kick and the whole move of structure s, on springs or as a beam.
swing = by_type(_swing, {ModalSupports: _swing_or_vibrate}, at=2)


@device
def _turned(angle, seat):
    """`seat` (3,) [m] turned by an angle [rad] about z."""
    if angle == 0.0:
        return seat
    c, s = cos(angle), sin(angle)
    return c * seat[0] - s * seat[1], s * seat[0] + c * seat[1], seat[2]


@device
def _place_parts(m, dt, floating, supports, bodies, excursions):
    """Bring the parts of the structure number m of those that move to where it is, and have them move as it does."""
    s = supports.moving[m]
    yaw, spin = excursions.displacement[s, 2], excursions.middle_velocity[s, 2]
    u, v = excursions.middle_velocity[s, 0], excursions.middle_velocity[s, 1]
    for p in range(supports.part_start[m], supports.part_start[m + 1]):
        i, seat = floating + supports.part[p], load(supports.seat, p)
        store(bodies.position, i, add(load(excursions.center, s), _turned(yaw, seat)))
        # the chord of the step: across the arm at its middle
        arm = _turned(yaw - 0.5 * dt * spin, seat)
        store(bodies.middle_velocity, i, (u - spin * arm[1], v + spin * arm[0], 0.0))
        bodies.middle_angular_velocity[i, 2] = spin
        w, x, y, z = supports.upright[p, 0], supports.upright[p, 1], supports.upright[p, 2], supports.upright[p, 3]
        if yaw != 0.0:
            c, h = cos(0.5 * yaw), sin(0.5 * yaw)
            w, x, y, z = c * w - h * z, c * x - h * y, c * y + h * x, c * z + h * w
        q = bodies.orientation
        q[i, 0], q[i, 1], q[i, 2], q[i, 3] = w, x, y, z
    _give_velocities(m, floating, supports, bodies, excursions)


@device
def _give_velocities(m, floating, supports, bodies, excursions):
    """Have the parts of the structure number m of those that move be as fast as it is at this instant."""
    s = supports.moving[m]
    u, v, spin = load(excursions.velocity, s)
    for p in range(supports.part_start[m], supports.part_start[m + 1]):
        i = floating + supports.part[p]
        x, y = bodies.position[i, 0] - excursions.center[s, 0], bodies.position[i, 1] - excursions.center[s, 1]
        store(bodies.velocity, i, (u - spin * y, v + spin * x, 0.0))
        bodies.angular_velocity[i, 2] = spin


@device
def _take_along(s, whole_of, excursions):
    """Have the structures that are parts of structure s be where it is, and as fast."""
    for part in range(len(whole_of)):
        if whole_of[part] == s:
            store(excursions.center, part, load(excursions.center, s))
            store(excursions.displacement, part, load(excursions.displacement, s))
            store(excursions.velocity, part, load(excursions.velocity, s))


@item
def push_structures(dt, model, bodies, excursions, loads):
    """The loads of this instant on all structures that move, the second half of their kick, and what the step took of drives and
    dashpots; dt = 0: the loads alone."""
    supports = model.supports
    for m in range(len(supports.moving)):
        s = supports.moving[m]
        push(s, dt, loads, supports, excursions)
        if dt > 0.0 and supports.kind[s] != DRIVEN:
            _give_velocities(m, model.floating, supports, bodies, excursions)
            _take_along(s, model.whole_of, excursions)


@device
def _push(s, dt, loads, supports, excursions):
    """The same of structure s, in each of its three ways c.

    Work is force times displacement, the forces' mean over the step: with it the kinetic energy of the Verlet steps closes.
    """
    for c in range(3):
        ice, middle = loads.step_load[s, BORNE[c]], excursions.middle_velocity[s, c]
        if supports.kind[s] == DRIVEN:
            excursions.work[s] -= 0.5 * dt * (ice + excursions.ice[s, c]) * middle
        else:
            dashpot = -supports.damping[s, c] * excursions.velocity[s, c]
            excursions.loss[s] -= 0.5 * dt * (dashpot + excursions.dashpot[s, c]) * middle
            force = ice - supports.stiffness[s, c] * excursions.displacement[s, c] + dashpot
            excursions.dashpot[s, c], excursions.force[s, c] = dashpot, force
            if dt > 0.0:
                excursions.velocity[s, c] = middle + 0.5 * dt * supports.inverse_mass[s, c] * force
        excursions.ice[s, c] = ice


@device
def _push_all_kinds(s, dt, loads, supports, excursions):
    if supports.kind[s] == MODAL:
        push_modes(s, dt, loads, supports, excursions)
    else:
        _push(s, dt, loads, supports, excursions)


#: push(s, dt, loads, supports, excursions): the loads of this instant on structure s, the end of its kick, what the step took.
push = by_type(_push, {ModalSupports: _push_all_kinds}, at=3)


@item
def carried_travel(i, dt, velocity, spin, plan_reach, frame):
    """Bound on the distance [m] that any point of body i, carried by a structure that moves, goes in the frame (2,) [m/s].

    velocity, spin (n, 3): of all bodies, [m/s] and [rad/s].
    """
    moved = abs(velocity[i, 0] - frame[0]) + abs(velocity[i, 1] - frame[1])
    return dt * (moved + abs(spin[i, 2]) * plan_reach[i])

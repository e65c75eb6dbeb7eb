"""Motion of bodies that bend: each mode swings by itself, under loads that stay, beside the body as a whole (Bao & Jiang 2004,
Eqs. (11)-(15)).

A step of h is damping, half a kick, a swing, half a kick. The swing turns (w xi, xi') by the angle w h, and a kick by a load f is
f tan(w h/2)/w: under a load that stays a mode that rests at f/w^2 rests there, however long the step, energy is kept but for what
damping takes, and no long step is bounded by fast modes: one that would turn by more than 2 rad turns by that, more slowly than it
does. The step of contacts resolves them all (`motion.timestep`).

A bent body turns by the angular velocity G L, L its angular momentum, and G = I^-1 - sum I^-1 dI/dxi_i I^-1 xi_i, to first order in
xi as the inertia I + sum dI/dxi_i xi_i is. The energy 1/2 L.G.L + 1/2 sum (xi_i'^2 + w_i^2 xi_i^2) has as its gradient the
centrifugal force 1/2 w.(dI/dxi_i).w on a mode, w = I^-1 L, which loses what a bent body gains as it turns.
"""

from dilatedem.jit import by_type, item
from dilatedem.motion import integrate
from dilatedem.numerics.rotation import rotation_matrix, to_body
from dilatedem.numerics.vector import along, load
from dilatedem.state.modal import ModalSolids
from dilatedem.state.response import bulge

#: half the angle [rad] that a mode swings by in a step, at most
WIDEST = 1.0
#: rows of `ModalSolids.swing`
TURN, FORTH, BACK, KICK, KEPT, SLACK, BY_RATE, BY_PLACE = 0, 1, 2, 3, 4, 5, 6, 7


@item
def _set_swing(i, dt, solids):
    """How the modes of body i swing in a step of dt [s]: numbers that are kept for the next step of the same length.

    Of tan, a fraction that is true to 1e-3 up to `WIDEST`; of the exponential by which rates decay, five terms.
    """
    swing = solids.swing
    for m in range(solids.mode_count[i]):
        frequency = solids.mode_frequency[i, m]
        half = min(0.5 * dt * frequency, WIDEST)
        square = half * half
        t = half * (15.0 - square) / (15.0 - 6.0 * square)
        unit, z = 1.0 / (1.0 + t * t), dt * solids.mode_damping[i, m]
        swing[i, TURN, m] = (1.0 - t * t) * unit
        swing[i, FORTH, m] = 2.0 * t * unit / frequency
        swing[i, BACK, m] = -2.0 * t * unit * frequency
        swing[i, KICK, m] = t / frequency
        swing[i, KEPT, m] = 1.0 / (1.0 + z * (1.0 + z / 2.0 * (1.0 + z / 3.0 * (1.0 + z / 4.0))))
        slowness = 1.0 / frequency
        # no farther than to the other side of where it would rest, nor faster than by there
        swing[i, SLACK, m] = slowness * slowness
        swing[i, BY_PLACE, m] = min(2.0, dt * frequency) * solids.mode_reach[i, m]
        swing[i, BY_RATE, m] = swing[i, BY_PLACE, m] * slowness
    solids.swing_time[i] = dt


@item
def _bent_inertia(i, solids, bodies):
    """xx, yy, zz, yz, zx, xy of the inverse inertia of body i as it is bent."""
    rest, gradient, out = solids.rest_inertia, solids.inertia_change, bodies.coordinate
    xx, yy, zz, yz, zx, xy = rest[i, 0], rest[i, 1], rest[i, 2], rest[i, 3], rest[i, 4], rest[i, 5]
    for m in range(solids.mode_count[i]):
        own = out[i, m]
        xx += own * gradient[i, m, 0]
        yy += own * gradient[i, m, 1]
        zz += own * gradient[i, m, 2]
        yz += own * gradient[i, m, 3]
        zx += own * gradient[i, m, 4]
        xy += own * gradient[i, m, 5]
    return xx, yy, zz, yz, zx, xy


@item
def _set_inertia(i, solids, six):
    give = solids.inverse_inertia
    give[i, 0, 0], give[i, 1, 1], give[i, 2, 2] = six[0], six[1], six[2]
    give[i, 1, 2] = give[i, 2, 1] = six[3]
    give[i, 2, 0] = give[i, 0, 2] = six[4]
    give[i, 0, 1] = give[i, 1, 0] = six[5]


@item
def _travel_bending(i, dt, solids, bodies, reach, frame):
    if solids.mode_count[i] > 0:
        if solids.swing_time[i] == 0.0:
            _set_inertia(i, solids, _bent_inertia(i, solids, bodies))  # a run that is resumed has that of the unbent body
        if solids.swing_time[i] != dt:
            _set_swing(i, dt, solids)
    moved = integrate.travel(i, dt, solids, bodies, reach, frame)
    for m in range(solids.mode_count[i]):
        aside = abs(bodies.coordinate[i, m] - bodies.mode_force[i, m] * solids.swing[i, SLACK, m])
        moved += abs(bodies.rate[i, m]) * solids.swing[i, BY_RATE, m] + aside * solids.swing[i, BY_PLACE, m]
    return moved


@item
def _swing(i, dt, solids, bodies):
    """Damping, half a kick and the swing of the modes of body i; rates become a prediction for the end of the step.

    Returns a bound on the distance that any of its points is moved by them [m].
    """
    if solids.swing_time[i] != dt:
        _set_swing(i, dt, solids)
    swing, out, rate, force = solids.swing, bodies.coordinate, bodies.rate, bodies.mode_force
    moved, lost, pace = 0.0, 0.0, 1.0 / dt
    for m in range(solids.mode_count[i]):
        before, old, kick = rate[i, m], out[i, m], swing[i, KICK, m] * force[i, m]
        kept = swing[i, KEPT, m] * before
        lost += before * before - kept * kept
        start = kept + kick
        new = swing[i, TURN, m] * old + swing[i, FORTH, m] * start
        rate[i, m] = swing[i, BACK, m] * old + swing[i, TURN, m] * start + kick
        bodies.middle_rate[i, m] = (new - old) * pace
        out[i, m] = new
        moved += abs(new - old) * solids.mode_reach[i, m]
    bodies.mode_loss[i] += 0.5 * lost
    return moved


@item
def _drift_bending(i, dt, solids, bodies, reach, frame):
    if solids.mode_count[i] == 0 or dt == 0.0:
        return integrate.drift(i, dt, solids, bodies, reach, frame)
    give = solids.inverse_inertia
    before = give[i, 0, 0], give[i, 1, 1], give[i, 2, 2], give[i, 1, 2], give[i, 2, 0], give[i, 0, 1]
    moved = _swing(i, dt, solids, bodies)
    after = _bent_inertia(i, solids, bodies)
    middle = (
        0.5 * (before[0] + after[0]), 0.5 * (before[1] + after[1]), 0.5 * (before[2] + after[2]), 0.5 * (before[3] + after[3]),
        0.5 * (before[4] + after[4]), 0.5 * (before[5] + after[5]),
    )  # fmt: skip
    _set_inertia(i, solids, middle)  # of the middle of the step, as is the momentum that turns the body
    moved += integrate.drift(i, dt, solids, bodies, reach, frame)
    _set_inertia(i, solids, after)
    return moved


@item
def _load_modes(i, dt, solids, bodies):
    """What acts on each mode of body i at this instant: contacts, water, wind, the centrifugal force; the end of its kick."""
    if solids.mode_count[i] == 0:
        return
    q, change, force = bodies.orientation, solids.inertia_change, bodies.mode_force
    momentum = load(bodies.angular_momentum, i)
    if dt > 0.0:
        momentum = along(load(bodies.middle_angular_momentum, i), 0.5 * dt, load(bodies.torque, i))
    x, y, z = to_body(rotation_matrix(q[i, 0], q[i, 1], q[i, 2], q[i, 3]), momentum)
    xx, yy, zz, yz, zx, xy = -0.5 * x * x, -0.5 * y * y, -0.5 * z * z, -y * z, -z * x, -x * y
    for m in range(solids.mode_count[i]):
        outwards = (
            xx * change[i, m, 0] + yy * change[i, m, 1] + zz * change[i, m, 2]
            + yz * change[i, m, 3] + zx * change[i, m, 4] + xy * change[i, m, 5]
        )  # fmt: skip
        new = bodies.mode_load[i, m] + outwards
        if dt > 0.0:
            bodies.rate[i, m] += solids.swing[i, KICK, m] * (new - force[i, m])
        force[i, m] = new


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
def _rigid(i, solids, bodies):
    return 0.0


@item
def _shake(i, solids, bodies):
    total = 0.0
    for m in range(solids.mode_count[i]):
        total += abs(bodies.middle_rate[i, m]) * solids.mode_reach[i, m]
    return total


@item
def _out(i, solids, bodies):
    return bulge(i, solids, bodies)


@item
def _same(k, solids, pairs, opening):
    return opening


@item
def _opening(k, solids, pairs, opening):
    """As the law found it, for bodies as they are bent, where that is faster."""
    return max(abs(opening), abs(pairs.elastic_power[k]) / pairs.normal_force[k]) if pairs.normal_force[k] > 0.0 else opening


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
#: load_modes(i, dt, solids, bodies): once all loads on the body are there.
load_modes = by_type(_no_modes, {ModalSolids: _load_modes}, at=2)
#: sum_pushes(chosen, first, last, awake, solids, bodies, pairs, workspace): beside `contact.sums.sum_contacts`.
sum_pushes = by_type(_sum_nothing, {ModalSolids: _sum_pushes}, at=4)
#: shake(i, solids, bodies): how fast [m/s] any point of body i moved by its modes in the last step, at most
shake = by_type(_rigid, {ModalSolids: _shake}, at=1)
#: bent_by(i, solids, bodies): how far [m] any point of body i is from where it is unbent, at most
bent_by = by_type(_rigid, {ModalSolids: _out}, at=1)
#: opening_of(k, solids, pairs, opening): how fast [m/s] contact k opens or deepens, from what its bodies as a whole do
opening_of = by_type(_same, {ModalSolids: _opening}, at=1)
#: modal_energy(i, solids, bodies): kinetic and elastic energy [J] of the modes of body i.
modal_energy = by_type(_no_energy, {ModalSolids: _energy_of_modes}, at=1)

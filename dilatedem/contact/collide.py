"""One pair of bodies: gap, patch, forces, and the energy that the step cost. The result is written to the pair alone."""

from dilatedem.contact.crushing.depth import remember, worn
from dilatedem.contact.friction import hold
from dilatedem.contact.laws import press
from dilatedem.contact.search.closest import farthest_vertex
from dilatedem.contact.search.cone import closest, radius_at
from dilatedem.contact.spring import length
from dilatedem.jit import by_type, device, item
from dilatedem.numerics.vector import accumulate, along, dot, load, scale, store, sub
from dilatedem.state.ledger import GAIN_LAW, LOSS_CRUSHING, LOSS_DAMPING, LOSS_FRICTION
from dilatedem.state.modal import ModalSolids


@device
def separation(position, a, b, surroundings):
    """From the centroid of a to the nearest periodic image of b's [m]."""
    dx = position[b, 0] - position[a, 0]
    dy = position[b, 1] - position[a, 1]
    if surroundings.period_x > 0.0:
        dx -= surroundings.period_x * round(dx / surroundings.period_x)
    if surroundings.period_y > 0.0:
        dy -= surroundings.period_y * round(dy / surroundings.period_y)
    return dx, dy, position[b, 2] - position[a, 2]


@device
def _meet_half_space(vertex, shapes, pairs, k, a, b, position):
    """As `closest_points`, for a body above the plane b."""
    out = load(shapes.plane_normal, b)
    normal = scale(-1.0, out)
    i, low = farthest_vertex(vertex, shapes.vertex_start[a], shapes.vertex_start[a + 1], normal)
    distance = dot(out, sub(load(position, a), load(position, b))) - low
    pairs.rounds[k] = 1
    pairs.corners[k] = 1
    pairs.corner_a[k, 0] = i
    pa = load(vertex, i)
    return distance, normal, pa, along(pa, distance, normal)


@device
def _end_contact(pairs, k, dt):
    """No overlap, no spring, no force. What the spring still held is lost to friction."""
    pairs.cost[k, LOSS_FRICTION] = 0.5 * pairs.shear_stiffness[k] * length(load(pairs.slip, k), pairs.wrung[k]) ** 2
    pairs.cost[k, LOSS_DAMPING] = 0.5 * dt * pairs.damping_power[k]
    pairs.cost[k, GAIN_LAW] = 0.0
    pairs.cost[k, LOSS_CRUSHING] = 0.0
    pairs.damping_power[k] = 0.0
    pairs.elastic_power[k] = 0.0
    pairs.overlap[k] = 0.0
    pairs.stored[k] = 0.0
    pairs.tangent[k] = 0.0
    pairs.wrung[k] = 0.0
    pairs.normal_force[k] = 0.0
    for i in range(3):
        pairs.slip[k, i] = 0.0
        pairs.force[k, i] = 0.0
        pairs.couple[k, i] = 0.0


@item
def _forget_nearest(k, solids, pairs, pa, arm):
    pass


@item
def _note_nearest(k, solids, pairs, pa, arm):
    store(pairs.point, k, pa)
    store(pairs.arm, k, arm)


#: note_nearest(k, solids, pairs, pa, arm): where bodies that bend are closest, for whoever asks how far they are bent there.
note_nearest = by_type(_forget_nearest, {ModalSolids: _note_nearest}, at=1)


@item
def gap_between(k, shapes, vertex, face_normal, position, pairs, contact, surroundings):
    """Gap of pair k [m], negative where surfaces overlap, for bodies at `position` (n, 3), turned as `vertex` and
    `face_normal` are.

    Returns with it: from the centroid of a to that of b, normal, point of a and of b from the centroid of a, of their cores, and
    the two radii there together.
    """
    a, b = pairs.a[k], pairs.b[k]
    offset = separation(position, a, b, surroundings)
    if shapes.kind[b] != 0:
        distance, normal, pa, pb = _meet_half_space(vertex, shapes, pairs, k, a, b, position)
        offset = sub(load(position, b), load(position, a))
    else:
        distance, normal, pa, pb = closest(vertex, face_normal, shapes, pairs, k, a, b, offset)
    radius_b = radius_at(shapes, vertex, b, sub(pb, offset))
    gap = distance - shapes.radius[a] - radius_b + worn(contact, k, pairs)
    return gap, offset, normal, pa, pb, shapes.radius[a] + radius_b


@item
def keep_apart(k, gap, normal, pa, arm, reach, solids, bodies, pairs, contact):
    """Have pair k, which does not touch, sleep until its gap [m] could be closed; pa, arm: nearest points from the centroids."""
    gap = remember(contact, k, gap, reach, bodies, pairs, pa)
    pairs.wake[k] = bodies.path[pairs.a[k]] + bodies.path[pairs.b[k]] + gap
    store(pairs.normal, k, normal)
    note_nearest(k, solids, pairs, pa, arm)


@item
def collide(k, dt, shapes, vertex, face_normal, solids, bodies, pairs, contact, surroundings, scratch):
    """Evaluate pair k at this instant; writes its rows of `pairs` and nothing else.

    vertex (v, 3), face_normal (f, 3): turned to world directions; dt [s]: the step that led here, 0 at the start;
    scratch (8, MOST_CORNERS, 3). A contact's force is repulsive: Liu 2015, Eq. (3), never below zero.
    """
    gap, offset, normal, pa, pb, reach = gap_between(k, shapes, vertex, face_normal, bodies.position, pairs, contact, surroundings)
    if gap >= 0.0:
        keep_apart(k, gap, normal, pa, sub(pb, offset), reach, solids, bodies, pairs, contact)
        if pairs.overlap[k] > 0.0:
            _end_contact(pairs, k, dt)
        return
    pressed = press(contact, k, dt, shapes, vertex, face_normal, solids, bodies, pairs, offset, normal, pa, pb, gap, scratch)
    store(pairs.normal, k, normal)
    arm = sub(pressed.point, offset)
    held = hold(contact, k, dt, solids, bodies, pairs, pressed, arm)
    _book(k, dt, pairs, pressed, held, arm)


@item
def _book(k, dt, pairs, pressed, held, arm):
    """Write what was found to the row of pair k.

    What the step cost, as trapezoids in time: the kinetic energy of the Verlet steps changes by these, up to dt^2/(4 m) |dF|^2.
    """
    pairs.cost[k, LOSS_DAMPING] = 0.5 * dt * (held.damping_power + pairs.damping_power[k])
    pairs.cost[k, LOSS_FRICTION] = held.lost
    pairs.cost[k, GAIN_LAW] = pressed.gain + held.made
    pairs.cost[k, LOSS_CRUSHING] = pressed.crumbled
    pairs.damping_power[k] = held.damping_power
    pairs.elastic_power[k] = pressed.elastic_power
    pairs.overlap[k] = pressed.overlap
    pairs.mode[k] = pressed.mode
    pairs.stored[k] = pressed.stored
    pairs.shear_stiffness[k] = pressed.shear_stiffness
    pairs.normal_force[k] = pressed.normal_force
    pairs.size[k] = pressed.size
    pairs.wrung[k] = held.wrung
    if held.torsion != 0.0:
        accumulate(pairs.couple, k, scale(-held.torsion * pairs.grip[k], pressed.direction))
    store(pairs.slip, k, held.slip)
    store(pairs.force, k, held.force)
    store(pairs.point, k, pressed.point)
    store(pairs.arm, k, arm)

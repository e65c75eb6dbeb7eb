"""One pair of bodies: gap, patch, forces, and the energy that the step cost. The result is written to the pair alone."""

from math import sqrt

from dilatedem.contact.consistent.press import press_consistent
from dilatedem.contact.friction import carried_over, length, rescaled, slide, viscous_share
from dilatedem.contact.kinematics import relative_velocity
from dilatedem.contact.liu2015.press import press_liu2015
from dilatedem.contact.search.closest import closest_points, farthest_vertex
from dilatedem.jit import by_type, device, item
from dilatedem.numerics.vector import accumulate, along, dot, load, norm, scale, store, sub
from dilatedem.state.ledger import GAIN_LAW, LOSS_DAMPING, LOSS_FRICTION
from dilatedem.state.setting import ConsistentSetting, ContactModel

CONSISTENT = int(ContactModel.CONSISTENT)


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


# both return what `press_liu2015` does, and how b moves against a: its velocity at the point of contact, its turning


@item
def _press_liu2015(contact, k, dt, shapes, vertex, face_normal, solids, bodies, pairs, offset, normal, pa, pb, gap, scratch):
    at_rest = (0.0, 0.0, 0.0)  # nothing asks for it where there is no dashpot beside the spring
    return (
        press_liu2015(k, dt, shapes, vertex, face_normal, solids, bodies, pairs, contact, offset, normal, pa, pb, gap, scratch),
        at_rest, at_rest,
    )  # fmt: skip


@item
def _press_consistent(contact, k, dt, shapes, vertex, face_normal, solids, bodies, pairs, offset, normal, pa, pb, gap, scratch):
    return press_consistent(k, shapes, vertex, face_normal, solids, bodies, pairs, contact, offset, normal, pa, pb, gap, scratch)


_press = by_type(_press_liu2015, {ConsistentSetting: _press_consistent})


@item
def collide(k, dt, shapes, vertex, face_normal, solids, bodies, pairs, contact, surroundings, scratch):
    """Evaluate pair k at this instant; writes its rows of `pairs` and nothing else.

    vertex (v, 3), face_normal (f, 3): turned to world directions; dt [s]: the step that led here, 0 at the start;
    scratch (6, MOST_CORNERS, 3). A contact's force is repulsive: Liu 2015, Eq. (3), never below zero.
    """
    a, b = pairs.a[k], pairs.b[k]
    offset = separation(bodies.position, a, b, surroundings)
    if shapes.kind[b] != 0:
        distance, normal, pa, pb = _meet_half_space(vertex, shapes, pairs, k, a, b, bodies.position)
        offset = sub(load(bodies.position, b), load(bodies.position, a))
    else:
        distance, normal, pa, pb = closest_points(vertex, face_normal, shapes, pairs, k, a, b, offset)
    store(pairs.normal, k, normal)
    gap = distance - shapes.radius[a] - shapes.radius[b]
    if gap >= 0.0:
        pairs.wake[k] = bodies.path[a] + bodies.path[b] + gap
        if pairs.overlap[k] > 0.0:
            _end_contact(pairs, k, dt)
        return
    pressed, sliding, turning = _press(
        contact, k, dt, shapes, vertex, face_normal, solids, bodies, pairs, offset, normal, pa, pb, gap, scratch
    )
    mode, size, overlap, point, direction, normal_force, elastic_power, damping_power, shear_stiffness, dashpot = pressed[:10]
    stored, gain = pressed[10], pressed[11]
    arm = sub(point, offset)

    # tangential: Eqs. (5), (6); the turning of a patch about its normal stretches the same spring, at the arm `grip`
    before, before_turned = carried_over(load(pairs.slip, k), direction), pairs.wrung[k]
    slid = relative_velocity(bodies.middle_velocity, bodies.middle_angular_velocity, a, b, point, arm)
    slid = along(slid, -dot(slid, direction), direction)
    grip, turned = pairs.grip[k], 0.0
    if grip > 0.0:
        spun = sub(load(bodies.middle_angular_velocity, b), load(bodies.middle_angular_velocity, a))
        turned = grip * dot(spun, direction)
    old_stiffness, opened = pairs.shear_stiffness[k], pairs.overlap[k] == 0.0
    shrink, stretch = 1.0, dt
    if contact.model == CONSISTENT and not opened:
        shrink, stretch = rescaled(old_stiffness, shear_stiffness)
        stretch *= dt
    slip, wrung, slipped = slide(
        scale(shrink, before), shrink * before_turned, scale(stretch, slid), stretch * turned, shear_stiffness,
        contact.friction * normal_force,
    )  # fmt: skip
    force = along(scale(normal_force, direction), -shear_stiffness, slip)
    torsion = shear_stiffness * wrung
    if dashpot > 0.0:
        dashpot *= sqrt(contact.stiffness_ratio)
        sliding = along(sliding, -dot(sliding, direction), direction)
        turned_now = grip * dot(turning, direction)
        share = viscous_share(slip, wrung, sliding, turned_now, shear_stiffness, dashpot, contact.friction * normal_force)
        force = along(force, -share * dashpot, sliding)
        torsion += share * dashpot * turned_now
        damping_power += share * dashpot * (dot(sliding, sliding) + turned_now * turned_now)

    # what the step cost, as trapezoids in time: the kinetic energy of the Verlet steps changes by these, up to dt^2/(4 m) |dF|^2
    if contact.model == CONSISTENT:
        # what the spring took up on the way, less what it has now
        taken = old_stiffness * (dot(before, slid) + before_turned * turned)
        taken += shear_stiffness * (dot(slip, slid) + wrung * turned)
        kept = shear_stiffness * (dot(slip, slip) + wrung * wrung)
        kept -= old_stiffness * (dot(before, before) + before_turned * before_turned)
        rubbed = 0.5 * (dt * taken - kept)
    else:
        held = shear_stiffness * norm(slip)
        held_before = held
        if not opened:
            gain += 0.5 * (shear_stiffness - old_stiffness) * dot(before, slip)
            held_before = old_stiffness * norm(before)
        rubbed = 0.5 * (held + held_before) * slipped
    pairs.cost[k, GAIN_LAW] = gain
    pairs.cost[k, LOSS_DAMPING] = 0.5 * dt * (damping_power + pairs.damping_power[k])
    pairs.cost[k, LOSS_FRICTION] = rubbed

    pairs.damping_power[k] = damping_power
    pairs.elastic_power[k] = elastic_power
    pairs.overlap[k] = overlap
    pairs.mode[k] = mode
    pairs.stored[k] = stored
    pairs.shear_stiffness[k] = shear_stiffness
    pairs.normal_force[k] = normal_force
    pairs.size[k] = size
    pairs.wrung[k] = wrung
    if torsion != 0.0:
        accumulate(pairs.couple, k, scale(-torsion * grip, direction))
    store(pairs.slip, k, slip)
    store(pairs.force, k, force)
    store(pairs.point, k, point)
    store(pairs.arm, k, arm)

"""One pair of bodies: gap, patch, forces, and the energy that the step cost. The result is written to the pair alone."""

from dilatedem.contact.closest import closest_points, farthest_vertex
from dilatedem.contact.friction import carried_over, slide
from dilatedem.contact.laws import damping_force, elastic_law, power, stored_energy
from dilatedem.contact.patch import EDGE_PARALLEL, contact_patch
from dilatedem.jit import device, item
from dilatedem.numerics.vector import add, along, cross, dot, load, norm, scale, store, sub


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
    pairs.corners[k] = 1
    pairs.corner_a[k, 0] = i
    pa = load(vertex, i)
    return distance, normal, pa, along(pa, distance, normal)


@item
def _relative_velocity(velocity, spin, a, b, point, arm):
    """Velocity of b against a at the contact point [m/s]."""
    va = add(load(velocity, a), cross(load(spin, a), point))
    vb = add(load(velocity, b), cross(load(spin, b), arm))
    return sub(vb, va)


@device
def _end_contact(pairs, k, dt):
    """No overlap, no spring, no force. What the spring still held is lost to friction."""
    slip = load(pairs.slip, k)
    pairs.loss_friction[k] = 0.5 * pairs.shear_stiffness[k] * dot(slip, slip)
    pairs.loss_damping[k] = 0.5 * dt * pairs.damping_power[k]
    pairs.gain_law[k] = 0.0
    pairs.damping_power[k] = 0.0
    pairs.elastic_power[k] = 0.0
    pairs.overlap[k] = 0.0
    pairs.normal_force[k] = 0.0
    for i in range(3):
        pairs.slip[k, i] = 0.0
        pairs.force[k, i] = 0.0


@item
def _law_gain(pairs, k, dt, mode, overlap, stiffness, exponent, elastic, elastic_power):
    """Energy that the normal law made in the last step [J]: more is stored than the bodies' approach has paid for.

    The stiffness may change at one overlap (mode, size of the patch), and the centroid of a patch may wander to where the overlap
    is another. For a contact at a point only the first can happen; its overlap is left to the approach, so that an error
    of the distance would show in the ledger's residual.
    """
    old, old_stiffness, old_exponent = pairs.overlap[k], pairs.stiffness[k], pairs.exponent[k]
    paid = 0.5 * dt * (elastic_power + pairs.elastic_power[k])
    if mode != pairs.mode[k]:
        # each mode measures the overlap at a place of its own
        return stored_energy(stiffness, exponent, overlap) - stored_energy(old_stiffness, old_exponent, old) - paid
    middle = 0.5 * (overlap + old)
    gain = stored_energy(stiffness, exponent, middle) - stored_energy(old_stiffness, old_exponent, middle)
    if mode >= EDGE_PARALLEL:  # a patch
        gain += 0.5 * (elastic + old_stiffness * power(old, old_exponent)) * (overlap - old) - paid
    return gain


@item
def collide(k, dt, shapes, vertex, face_normal, solids, bodies, pairs, contact, surroundings, scratch):
    """Evaluate pair k at this instant; writes its rows of `pairs` and nothing else.

    vertex (v, 3), face_normal (f, 3): turned to world directions; dt [s]: the step that led here, 0 at the start;
    scratch (2, MOST_CORNERS, 3). A contact's force is repulsive: Liu 2015, Eq. (3), never below zero.
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
    mode, a_lower, point, overlap, size, sine = contact_patch(
        vertex, face_normal, shapes, pairs.corners[k], pairs.corner_a[k], pairs.corner_b[k], a, b, offset, normal, pa, pb, -gap,
        scratch,
    )  # fmt: skip
    arm = sub(point, offset)
    modulus = 1.0 / (solids.compliance[a] + solids.compliance[b])
    first, second = shapes.radius[a], shapes.radius[b]
    if not a_lower:
        first, second = second, first
    stiffness, exponent = elastic_law(contact.model, mode, modulus, first, second, size, sine)

    # normal: Eq. (3)
    velocity = _relative_velocity(bodies.velocity, bodies.angular_velocity, a, b, point, arm)
    approach = -dot(velocity, normal)
    mass = 1.0 / (solids.inverse_mass[a] + solids.inverse_mass[b])
    elastic = stiffness * power(overlap, exponent)
    viscous = damping_force(contact.model, contact.damping, mass, stiffness, exponent, overlap, approach)
    normal_force = max(elastic + viscous, 0.0)

    # tangential: Eqs. (5), (6)
    shear_stiffness = contact.stiffness_ratio * stiffness * power(overlap, exponent - 1.0)
    before = carried_over(load(pairs.slip, k), normal)
    slid = _relative_velocity(bodies.middle_velocity, bodies.middle_angular_velocity, a, b, point, arm)
    slid = along(slid, -dot(slid, normal), normal)
    slip, slipped = slide(before, scale(dt, slid), shear_stiffness, contact.friction * normal_force)
    force = along(scale(normal_force, normal), -shear_stiffness, slip)

    # what the step cost, as trapezoids in time: the kinetic energy of the Verlet steps changes by these, up to dt^2/(4 m) |dF|^2
    elastic_power = elastic * approach
    damping_power = (normal_force - elastic) * approach
    held = shear_stiffness * norm(slip)
    gain, held_before = 0.0, held
    if pairs.overlap[k] > 0.0:
        gain = _law_gain(pairs, k, dt, mode, overlap, stiffness, exponent, elastic, elastic_power)
        gain += 0.5 * (shear_stiffness - pairs.shear_stiffness[k]) * dot(before, slip)
        held_before = pairs.shear_stiffness[k] * norm(before)
    pairs.gain_law[k] = gain
    pairs.loss_damping[k] = 0.5 * dt * (damping_power + pairs.damping_power[k])
    pairs.loss_friction[k] = 0.5 * (held + held_before) * slipped

    pairs.damping_power[k] = damping_power
    pairs.elastic_power[k] = elastic_power
    pairs.overlap[k] = overlap
    pairs.mode[k] = mode
    pairs.stiffness[k] = stiffness
    pairs.exponent[k] = exponent
    pairs.shear_stiffness[k] = shear_stiffness
    pairs.normal_force[k] = normal_force
    pairs.size[k] = size
    store(pairs.slip, k, slip)
    store(pairs.force, k, force)
    store(pairs.point, k, point)
    store(pairs.arm, k, arm)

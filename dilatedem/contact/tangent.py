"""Contacts of bodies that bend: each pair sees both bodies rigid, carried to where they are bent at the point of contact.

A body is looked at through the rigid motion that its bent shape has there, displacement and turning: x = Xc + d + R (X - Xc),
d = sum phi_i(Xc) xi_i, R the turning by 1/2 sum curl phi_i(Xc) xi_i. Geometry, laws and friction are then those of rigid bodies.
What a contact does to a mode is the work of its wrench on the rigid motion of the mode there, so that force, moment and modal force
are the gradient of one energy as long as Xc stays. Where a face lies on a face, that is in the middle of what the two have in
common; as far as this is all of a face, the body is carried by the rigid motion that fits the bent face best, on which a pressure
that varies linearly over it does the same work. Else Xc goes with the point of contact: the tangent bodies at two neighbouring
points differ by the strain between them, which across a free surface is none.
"""

from dilatedem.contact.collide import collide, gap_between, keep_apart, separation
from dilatedem.contact.shared_face import face_towards, shared_part
from dilatedem.contact.turning import turn_shape
from dilatedem.jit import by_type, item
from dilatedem.numerics.rotation import rotation_matrix, to_body, to_world, turned
from dilatedem.numerics.vector import add, along, cross, dot, load, scale, store, sub
from dilatedem.state.ledger import GAIN_LAW, LOSS_CRUSHING, LOSS_DAMPING, LOSS_FRICTION
from dilatedem.state.modal import ModalBodies, ModalSolids
from dilatedem.state.modes import Mode
from dilatedem.state.response import bulge

FACE_FACE = int(Mode.FACE_FACE)
#: what a pair's bodies are carried at, in `Pairs.seat`
AT_POINT, AT_FACES = 0, 1
#: how much more modes are taken to give way at a seat where nobody has looked yet than at the last one, whose lever may be
#: shorter: a dashpot made for the mass of the last one could be too strong
RESEATED = 4.0
NONE = (0.0, 0.0, 0.0)


@item
def _spline(u):
    """Weights of the places before, at and after the nearest one, u = -1/2 to 1/2 from it, and their slopes."""
    return (0.5 * (0.5 - u) ** 2, 0.75 - u * u, 0.5 * (0.5 + u) ** 2), (u - 0.5, -2.0 * u, u + 0.5)


@item
def _shapes_at(block, i, point, solids, workspace, side):
    """Write displacement and turning, 1/2 curl, of each mode of body i at a point of its frame to a side of `shape`."""
    modes, size, pace = solids.mode_count[i], solids.lattice_size, solids.lattice_pace
    sx, sy, sz = (
        (point[0] - solids.lattice_origin[i, 0]) * pace[i, 0],
        (point[1] - solids.lattice_origin[i, 1]) * pace[i, 1],
        (point[2] - solids.lattice_origin[i, 2]) * pace[i, 2],
    )
    jx = min(max(int(round(sx)), 1), size[i, 0] - 2)
    jy = min(max(int(round(sy)), 1), size[i, 1] - 2)
    jz = min(max(int(round(sz)), 1), size[i, 2] - 2)
    (wx, dx), (wy, dy), (wz, dz) = _spline(sx - jx), _spline(sy - jy), _spline(sz - jz)
    weight, shape, values = workspace.spline[block], workspace.shape[block], solids.lattice
    for p in range(3):
        for q in range(3):
            over, gx, gy = wx[p] * wy[q], 0.5 * pace[i, 0] * dx[p] * wy[q], 0.5 * pace[i, 1] * wx[p] * dy[q]
            for r in range(3):
                place = (p * 3 + q) * 3 + r
                weight[place, 0], weight[place, 1] = over * wz[r], gx * wz[r]
                weight[place, 2], weight[place, 3] = gy * wz[r], 0.5 * pace[i, 2] * over * dz[r]
    corner = solids.lattice_start[i] + (((jx - 1) * size[i, 1] + jy - 1) * size[i, 2] + jz - 1) * modes
    along_y, along_x = size[i, 2] * modes, size[i, 1] * size[i, 2] * modes
    for m in range(modes):
        ux = uy = uz = tx = ty = tz = 0.0
        for p in range(3):
            for q in range(3):
                row = corner + p * along_x + q * along_y + m
                for r in range(3):
                    place, at = (p * 3 + q) * 3 + r, row + r * modes
                    x, y, z = values[at, 0], values[at, 1], values[at, 2]
                    w, gx, gy, gz = weight[place, 0], weight[place, 1], weight[place, 2], weight[place, 3]
                    ux += w * x
                    uy += w * y
                    uz += w * z
                    tx += gy * z - gz * y
                    ty += gz * x - gx * z
                    tz += gx * y - gy * x
        shape[side, m, 0], shape[side, m, 1], shape[side, m, 2] = ux, uy, uz
        shape[side, m, 3], shape[side, m, 4], shape[side, m, 5] = tx, ty, tz


@item
def _summed(i, values, solids, shape, side, first):
    """sum over the modes of body i of values[i, m] times three components of their shapes."""
    total = NONE
    for m in range(solids.mode_count[i]):
        total = along(total, values[i, m], (shape[side, m, first], shape[side, m, first + 1], shape[side, m, first + 2]))
    return total


@item
def _seated(block, i, lever, face, covered, Q, solids, workspace, side):
    """The point of the frame of body i at `lever` from its centroid (world axes) [m], with what its modes do there.

    As far as the face is `covered`, from 0 to 1, that is the motion that fits the whole face best, else that of the point alone.
    """
    point, shape = to_body(Q, lever), workspace.shape[block]
    if covered < 1.0:
        _shapes_at(block, i, point, solids, workspace, side)
    if covered > 0.0:
        arm, whole = sub(point, load(solids.face_centre, face)), solids.face_shape
        for m in range(solids.mode_count[i]):
            turn = whole[face, m, 3], whole[face, m, 4], whole[face, m, 5]
            moved = add((whole[face, m, 0], whole[face, m, 1], whole[face, m, 2]), cross(turn, arm))
            for c in range(3):
                shape[side, m, c] = covered * moved[c] + (1.0 - covered) * shape[side, m, c] if covered < 1.0 else moved[c]
                shape[side, m, 3 + c] = covered * turn[c] + (1.0 - covered) * shape[side, m, 3 + c] if covered < 1.0 else turn[c]
    return point


@item
def _carry(block, side, i, lever, face, covered, solids, bodies, workspace):
    """Write the rigid body that body i is at a seat, as `_seated` has it, and how it moves."""
    q, shape, seat = bodies.orientation, workspace.shape[block], workspace.seat[block]
    Q = rotation_matrix(q[i, 0], q[i, 1], q[i, 2], q[i, 3])
    quaternion, shift, whirl, slower, middle, between = (q[i, 0], q[i, 1], q[i, 2], q[i, 3]), NONE, NONE, NONE, NONE, NONE
    if solids.mode_count[i] > 0:
        point = _seated(block, i, lever, face, covered, Q, solids, workspace, side)
        moved, turn = _summed(i, bodies.coordinate, solids, shape, side, 0), _summed(i, bodies.coordinate, solids, shape, side, 3)
        quaternion = turned(quaternion, turn, 1.0)
        carried = to_body(Q, to_world(rotation_matrix(quaternion[0], quaternion[1], quaternion[2], quaternion[3]), point))
        shift = to_world(Q, sub(add(point, moved), carried))
        # how R turns as a mode goes out: its turning, and what the turning so far does to it
        for m in range(solids.mode_count[i]):
            own = (shape[side, m, 3], shape[side, m, 4], shape[side, m, 5])
            own = along(own, 0.5, cross(turn, own))
            shape[side, m, 3], shape[side, m, 4], shape[side, m, 5] = own
        store(seat, side, carried)
        turning = _summed(i, bodies.rate, solids, shape, side, 3)
        whirl = to_world(Q, turning)
        slower = to_world(Q, sub(_summed(i, bodies.rate, solids, shape, side, 0), cross(turning, carried)))
        turning = _summed(i, bodies.middle_rate, solids, shape, side, 3)
        between = to_world(Q, turning)
        middle = to_world(Q, sub(_summed(i, bodies.middle_rate, solids, shape, side, 0), cross(turning, carried)))
    seat[side, 3], seat[side, 4], seat[side, 5] = shift
    store(workspace.bent_position[block], i, add(load(bodies.position, i), shift))
    orientation = workspace.bent_orientation[block]
    orientation[i, 0], orientation[i, 1], orientation[i, 2], orientation[i, 3] = quaternion
    spin = load(bodies.angular_velocity, i)
    store(workspace.bent_velocity[block], i, add(load(bodies.velocity, i), add(cross(spin, shift), slower)))
    store(workspace.bent_spin[block], i, add(spin, whirl))
    spin = load(bodies.middle_angular_velocity, i)
    store(workspace.bent_middle_velocity[block], i, add(load(bodies.middle_velocity, i), add(cross(spin, shift), middle)))
    store(workspace.bent_middle_spin[block], i, add(spin, between))


@item
def _softness(block, side, i, normal, solids, bodies, workspace):
    """1/m' [1/kg] with which the modes of body i give way to a push along the normal on its seat."""
    q, shape, total = bodies.orientation, workspace.shape[block], 0.0
    own = to_body(rotation_matrix(q[i, 0], q[i, 1], q[i, 2], q[i, 3]), normal)
    for m in range(solids.mode_count[i]):
        total += (shape[side, m, 0] * own[0] + shape[side, m, 1] * own[1] + shape[side, m, 2] * own[2]) ** 2
    return total


@item
def _push_modes(block, side, i, k, force, torque, solids, bodies, workspace):
    """What a wrench on the carried body i, at its centroid, does to its modes; returns the sum of its squares."""
    q, shape, push = bodies.orientation, workspace.shape[block], workspace.mode_push
    Q = rotation_matrix(q[i, 0], q[i, 1], q[i, 2], q[i, 3])
    own, moment = to_body(Q, force), to_body(Q, torque)
    moment, square = sub(moment, cross(load(workspace.seat[block], side), own)), 0.0  # about the point of contact
    for m in range(solids.mode_count[i]):
        work = shape[side, m, 0] * own[0] + shape[side, m, 1] * own[1] + shape[side, m, 2] * own[2]
        work += dot((shape[side, m, 3], shape[side, m, 4], shape[side, m, 5]), moment)
        push[k, side, m] = work
        square += work * work
    return square


@item
def _turn_shapes(block, k, shapes, orientation, pairs, workspace):
    """Have the shapes of pair k turned to this instant by this thread.

    Just before they are looked at, while they are in the processor's cache. A body that two threads look at is turned by both, and
    both write the same.
    """
    instant, turned = workspace.instant[0], workspace.turned
    for body in (pairs.a[k], pairs.b[k]):
        if turned[block, body] != instant:
            turned[block, body] = instant
            turn_shape(body, shapes, orientation, workspace.vertex, workspace.face_normal)


@item
def _meet(block, k, dt, shapes, solids, bodies, pairs, contact, surroundings, workspace):
    _turn_shapes(block, k, shapes, bodies.orientation, pairs, workspace)
    collide(
        k, dt, shapes, workspace.vertex, workspace.face_normal, solids, bodies, pairs, contact, surroundings, workspace.clip[block]
    )


@item
def _look(block, k, dt, shapes, solids, bodies, pairs, contact, surroundings, workspace):
    """Evaluate pair k for the rigid bodies that its bodies are at its seat."""
    a, b, normal, point, arm = pairs.a[k], pairs.b[k], load(pairs.normal, k), load(pairs.point, k), load(pairs.arm, k)
    face_a, face_b, covered_a, covered_b = -1, -1, 0.0, 0.0
    if pairs.seat[k] == AT_FACES:
        _turn_shapes(block, k, shapes, bodies.orientation, pairs, workspace)
        face_a = face_towards(a, normal, shapes, bodies.orientation)
        face_b = face_towards(b, scale(-1.0, normal), shapes, bodies.orientation)
        offset = separation(bodies.position, a, b, surroundings)
        if face_a >= 0:
            found, middle, covered_a, covered_b = shared_part(
                face_a, face_b, offset, normal, workspace.vertex, shapes, workspace.clip[block]
            )
            if found:
                point, arm = middle, sub(middle, offset)
    _carry(block, 0, a, point, face_a, covered_a, solids, bodies, workspace)
    _carry(block, 1, b, arm, face_b, covered_b, solids, bodies, workspace)
    if pairs.overlap[k] <= 0.0:  # a dashpot that meets modes for the first time must not be made for the whole mass
        pairs.yields[k] = _softness(block, 0, a, normal, solids, bodies, workspace)
        pairs.yields[k] += _softness(block, 1, b, normal, solids, bodies, workspace)
    vertex, face_normal, seat = workspace.bent_vertex[block], workspace.bent_face_normal[block], workspace.seat[block]
    seen = ModalBodies(
        workspace.bent_position[block], workspace.bent_orientation[block], workspace.bent_velocity[block],
        workspace.bent_spin[block], bodies.angular_momentum, workspace.bent_middle_velocity[block],
        workspace.bent_middle_spin[block], bodies.middle_angular_momentum, bodies.force, bodies.torque, bodies.contact_force,
        bodies.contact_torque, bodies.contact_count, bodies.path, bodies.power, bodies.work, bodies.coordinate, bodies.rate,
        bodies.middle_rate, bodies.mode_force, bodies.mode_load, bodies.mode_loss, bodies.bent_load, bodies.seen_coordinate,
        bodies.seen_tension, bodies.peak_tension, bodies.peak_time, bodies.peak_place, bodies.failed_at, bodies.failed_place,
    )  # fmt: skip
    turn_shape(a, shapes, seen.orientation, vertex, face_normal)
    turn_shape(b, shapes, seen.orientation, vertex, face_normal)
    collide(k, dt, shapes, vertex, face_normal, solids, seen, pairs, contact, surroundings, workspace.clip[block])
    if pairs.overlap[k] > 0.0:
        force, couple = load(pairs.force, k), load(pairs.couple, k)
        turn_a, turn_b = add(couple, cross(load(pairs.point, k), force)), add(couple, cross(load(pairs.arm, k), force))
        square = _push_modes(block, 0, a, k, scale(-1.0, force), scale(-1.0, turn_a), solids, bodies, workspace)
        square += _push_modes(block, 1, b, k, force, turn_b, solids, bodies, workspace)
        strength = dot(force, force)
        pairs.yields[k] = square / strength if strength > 0.0 else 0.0
    store(pairs.point, k, add(load(pairs.point, k), (seat[0, 3], seat[0, 4], seat[0, 5])))
    store(pairs.arm, k, add(load(pairs.arm, k), (seat[1, 3], seat[1, 4], seat[1, 5])))


@item
def _apart(block, k, shapes, solids, bodies, pairs, contact, surroundings, workspace):
    """Whether the bodies of pair k, which do not touch, cannot do so either as they are bent: as far as nothing of them reaches."""
    _turn_shapes(block, k, shapes, bodies.orientation, pairs, workspace)
    gap, offset, normal, pa, pb, reach = gap_between(
        k, shapes, workspace.vertex, workspace.face_normal, bodies.position, pairs, contact, surroundings
    )
    out = bulge(pairs.a[k], solids, bodies) + bulge(pairs.b[k], solids, bodies)
    if gap <= out:
        return False
    keep_apart(k, gap, normal, pa, sub(pb, offset), reach, solids, bodies, pairs, contact)
    pairs.wake[k] -= out
    return True


@item
def _meet_bent(block, k, dt, shapes, solids, bodies, pairs, contact, surroundings, workspace):
    """`_look`, and once more where the contact's mode asks for another seat; what that makes of its energy, the law has made."""
    if pairs.overlap[k] <= 0.0 and _apart(block, k, shapes, solids, bodies, pairs, contact, surroundings, workspace):
        pairs.seat[k] = AT_POINT
        return
    _look(block, k, dt, shapes, solids, bodies, pairs, contact, surroundings, workspace)
    seat = AT_FACES if pairs.overlap[k] > 0.0 and pairs.mode[k] == FACE_FACE else AT_POINT
    if pairs.overlap[k] <= 0.0:  # a tangent body is what it stands for where it was looked at, elsewhere as far off as that bends
        pairs.wake[k] -= 2.0 * (bulge(pairs.a[k], solids, bodies) + bulge(pairs.b[k], solids, bodies))
    elif seat != pairs.seat[k]:
        cost, stored = pairs.cost[k], pairs.stored[k]
        damping, friction, crushing, made = cost[LOSS_DAMPING], cost[LOSS_FRICTION], cost[LOSS_CRUSHING], cost[GAIN_LAW]
        pairs.seat[k], pairs.yields[k] = seat, RESEATED * pairs.yields[k]
        _look(block, k, 0.0, shapes, solids, bodies, pairs, contact, surroundings, workspace)
        made += (pairs.stored[k] if pairs.overlap[k] > 0.0 else 0.0) - stored
        cost[LOSS_DAMPING], cost[LOSS_FRICTION], cost[LOSS_CRUSHING], cost[GAIN_LAW] = damping, friction, crushing, made
    pairs.seat[k] = seat


#: meet(block, k, dt, shapes, solids, bodies, pairs, contact, surroundings, workspace): `collide` for pair k as its bodies are now.
meet = by_type(_meet, {ModalSolids: _meet_bent}, at=4)

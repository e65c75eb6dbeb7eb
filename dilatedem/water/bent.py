"""What water and wind do to bodies that bend: the change of buoyancy by the bent surface, and drags spread over what they reach.

A bent body has the buoyant energy of its unbent self, as `water.floating` has it, and that of the layer by which its faces have
moved outwards, d = n.sum phi_i xi_i at a point of height h,

    -rho g int int_0^d min(h + s n_z, 0) ds dA,

n_z how far up the face's normal looks. Force, torque and loads on modes are its gradient. Over a face all under water it is a
quadratic form of height and coordinates; only one that the waterline crosses is summed by points.
"""

from math import sqrt

from dilatedem.jit import by_type, item
from dilatedem.numerics.rotation import rotation_matrix, to_body, to_world
from dilatedem.numerics.vector import accumulate, add, along, cross, dot, load, scale, store
from dilatedem.state.modal import ModalSolids
from dilatedem.state.response import bulge
from dilatedem.water.loads import WORKS
from dilatedem.water.terms.drag import drag
from dilatedem.water.terms.wind import wind

DRAG, WIND = WORKS.index("work_drag"), WORKS.index("work_wind")
NONE = (0.0, 0.0, 0.0)


@item
def _under(i, f, z, up, facing, weight, solids, bodies, push, row):
    """Of face f, all under water: int (h + 1/2 d n_z) d dA, its slope by the height, and that by `up`.

    To each mode of row `row` of `push` goes `weight` times the slope by its coordinate.
    """
    out, modes, second = bodies.coordinate, solids.mode_count[i], solids.skin_second
    change, rise, slope, square = 0.0, 0.0, NONE, 0.0
    for m in range(modes):
        own, bent = out[i, m], 0.0
        for k in range(modes):
            bent += out[i, k] * second[f, m, k]
        level, shape = z * solids.skin_outward[f, m] + dot(up, load(solids.skin_moment[f], m)), solids.skin_outward[f, m]
        push[row, m] += weight * (level + facing * bent)
        change += own * (level + 0.5 * facing * bent)
        rise += own * shape
        square += own * bent
        slope = along(slope, own, load(solids.skin_moment[f], m))
    return change, rise, along(slope, 0.5 * square, load(solids.skin_normal, f))


@item
def _layer(flat, facing, out):
    """int_0^out min(flat + s facing, 0) ds of a layer, and what is under water of int ds and of int s ds."""
    high = flat + facing * out
    if flat <= 0.0 and high <= 0.0:
        return 0.5 * out * (flat + high), out, 0.5 * out * out
    if flat > 0.0 and high > 0.0:
        return 0.0, 0.0, 0.0
    edge = -flat / facing
    if flat <= 0.0:
        return 0.5 * flat * edge, edge, 0.5 * edge * edge
    return 0.5 * high * (out - edge), out - edge, 0.5 * (out * out - edge * edge)


@item
def _awash(i, f, z, up, facing, weight, solids, bodies, push, row, spread):
    """The same of face f which the waterline may cross, by its points; what is wet of it goes to `spread` and is returned, too."""
    out, modes, normal = bodies.coordinate, solids.mode_count[i], load(solids.skin_normal, f)
    area, shape = solids.skin_weight, solids.skin_shape
    change, rise, slope, square, wet = 0.0, 0.0, NONE, 0.0, 0.0
    for p in range(solids.skin_start[f], solids.skin_start[f + 1]):
        moved = NONE
        for m in range(modes):
            moved = along(moved, out[i, m], (shape[p, m, 0], shape[p, m, 1], shape[p, m, 2]))
        x, thick = load(solids.skin_point, p), dot(normal, moved)
        flat = z + dot(up, x)
        stored, under, turned = _layer(flat, facing, thick)
        change += area[p] * stored
        rise += area[p] * under
        slope = along(slope, area[p] * under, x)
        square += area[p] * turned
        low = flat + facing * thick
        if low < 0.0:
            wet += area[p]
            for m in range(modes):
                own = (shape[p, m, 0], shape[p, m, 1], shape[p, m, 2])
                push[row, m] += weight * area[p] * low * dot(normal, own)
                spread[m, 0] += area[p] * own[0]
                spread[m, 1] += area[p] * own[1]
                spread[m, 2] += area[p] * own[2]
    return change, rise, along(slope, square, normal), wet


@item
def _float(i, R, setting, solids, bodies, push, row, spread):
    """Energy [J], force upwards [N] and torque in the frame of body i [N m] by which its bent surface differs from the unbent one.

    Loads on modes are added to `push[row]`; to `spread` (m, 3) what of the shapes is wet. Returns the wet area [m2] with them.
    """
    up, z, weight = R[2], bodies.position[i, 2], setting.water_density * setting.gravity
    out, energy, lift, slope, wet = bulge(i, solids, bodies), 0.0, 0.0, NONE, 0.0
    for f in range(solids.skin_face[i], solids.skin_face[i + 1]):
        normal = load(solids.skin_normal, f)
        facing, level = dot(normal, up), z + dot(up, load(solids.skin_centre, f))
        swing = solids.skin_reach[f] * sqrt(max(0.0, 1.0 - facing * facing)) + out
        if level >= swing:
            continue
        if level <= -swing:
            change, rise, own = _under(i, f, z, up, facing, weight, solids, bodies, push, row)
            wet += solids.skin_area[f]
            for m in range(solids.mode_count[i]):
                accumulate(spread, m, load(solids.skin_first[f], m))
        else:
            change, rise, own, part = _awash(i, f, z, up, facing, weight, solids, bodies, push, row, spread)
            wet += part
        energy -= weight * change
        lift += weight * rise
        slope = along(slope, weight, own)
    return energy, lift, cross(slope, up), wet


@item
def _spread_over(i, column, force, spread, share, dt, R, solids, bodies):
    """Load the modes of body i by a force [N] spread evenly over what `spread` holds, of an area 1/share; its work is booked."""
    own, done, before = to_body(R, force), 0.0, bodies.bent_load
    for m in range(solids.mode_count[i]):
        now = share * dot(own, load(spread, m))
        bodies.mode_load[i, m] += now
        done += (now + before[i, column, m]) * bodies.middle_rate[i, m]
        before[i, column, m] = now
    bodies.work[i, column] += 0.5 * dt * done


@item
def _as_rigid(i, dt, time, setting, hulls, solids, bodies, workspace, force, torque):
    return force, torque


@item
def _bent(i, dt, time, setting, hulls, solids, bodies, workspace, force, torque):
    if solids.mode_count[i] == 0:
        return force, torque
    q, spread, wet = bodies.orientation, workspace.spread[i], 0.0
    R = rotation_matrix(q[i, 0], q[i, 1], q[i, 2], q[i, 3])
    for m in range(solids.mode_count[i]):
        store(spread, m, NONE)
    if setting.water:
        _, lift, turn, wet = _float(i, R, setting, solids, bodies, bodies.mode_load, i, spread)
        force, torque = add(force, (0.0, 0.0, lift)), add(torque, to_world(R, turn))
        dragged = drag(i, time, setting, hulls, solids, bodies, workspace.wet)[0]
        _spread_over(i, DRAG, dragged, spread, 1.0 / wet if wet > 0.0 else 0.0, dt, R, solids, bodies)
    blown = wind(i, time, setting, hulls, solids, bodies, workspace.wet)[0]
    if blown[0] != 0.0 or blown[1] != 0.0:
        area = -wet
        for m in range(solids.mode_count[i]):
            store(spread, m, scale(-1.0, load(spread, m)))
        for f in range(solids.skin_face[i], solids.skin_face[i + 1]):
            area += solids.skin_area[f]
            for m in range(solids.mode_count[i]):
                accumulate(spread, m, load(solids.skin_first[f], m))
        _spread_over(i, WIND, blown, spread, 1.0 / area if area > 0.0 else 0.0, dt, R, solids, bodies)
    return force, torque


@item
def _no_change(i, setting, solids, bodies, workspace):
    return 0.0


@item
def _change_of_buoyancy(i, setting, solids, bodies, workspace):
    if solids.mode_count[i] == 0:
        return 0.0
    q = bodies.orientation
    R = rotation_matrix(q[i, 0], q[i, 1], q[i, 2], q[i, 3])
    return _float(i, R, setting, solids, bodies, workspace.mode_idle, 0, workspace.spread[i])[0]


#: bent_loads(i, dt, time, setting, hulls, solids, bodies, workspace, force, torque): all loads on body i but contacts', as it is
#: bent, from those on the unbent one; its modes are loaded.
bent_loads = by_type(_as_rigid, {ModalSolids: _bent}, at=5)
#: bent_buoyancy(i, setting, solids, bodies, workspace): energy [J] of the water that body i displaces, less that of the unbent one.
bent_buoyancy = by_type(_no_change, {ModalSolids: _change_of_buoyancy}, at=2)

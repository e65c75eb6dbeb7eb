"""What water and wind do to bodies that bend: the change of buoyancy by the bent surface, and drags spread over what they reach.

The water that a body displaces holds the energy -1/2 rho g int min(h, 0)^2 n_z dA over its surface, h the height of its points. A
bent body has that of its unbent self, as `water.floating` has it, and the difference of both by points of its surface, whose
heights bend with it and whose areas turn with the body as a whole. Force, torque and loads on modes are its gradient. Over a face
all under water it is a quadratic form of height and coordinates; only one that the waterline crosses is summed by points.
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
def _products(n):
    """The components xx, yy, zz, yz, zx, xy of n n."""
    return n[0] * n[0], n[1] * n[1], n[2] * n[2], n[1] * n[2], n[2] * n[0], n[0] * n[1]


@item
def _six(rows, place, q):
    return (
        rows[place, 0] * q[0] + rows[place, 1] * q[1] + rows[place, 2] * q[2]
        + rows[place, 3] * q[3] + rows[place, 4] * q[4] + rows[place, 5] * q[5]
    )  # fmt: skip


@item
def _under(i, f, z, up, solids, bodies, push, row, strength):
    """Of face f, all under water: int h^2 dA less that of the unbent face, half its slopes by the height and by `up`.

    To each mode of row `row` of `push` goes `strength` times half the slope by its coordinate.
    """
    out, modes = bodies.coordinate, solids.mode_count[i]
    first, moment, second = solids.skin_first, solids.skin_moment, solids.skin_second
    q = _products(up)
    change, raised, xx, yy, zz, yz, zx, xy = 0.0, NONE, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for m in range(modes):
        a, b, c, d, e, g = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
        for k in range(modes):
            own = out[i, k]
            a += own * second[f, m, k, 0]
            b += own * second[f, m, k, 1]
            c += own * second[f, m, k, 2]
            d += own * second[f, m, k, 3]
            e += own * second[f, m, k, 4]
            g += own * second[f, m, k, 5]
        own, shape = out[i, m], load(first[f], m)
        linear = z * dot(up, shape) + _six(moment[f], m, q)
        bent = a * q[0] + b * q[1] + c * q[2] + d * q[3] + e * q[4] + g * q[5]
        push[row, m] += strength * (linear + bent)
        change += own * (2.0 * linear + bent)
        raised = along(raised, own, shape)
        xx += own * (2.0 * moment[f, m, 0] + a)
        yy += own * (2.0 * moment[f, m, 1] + b)
        zz += own * (2.0 * moment[f, m, 2] + c)
        yz += 0.5 * own * (2.0 * moment[f, m, 3] + d)
        zx += 0.5 * own * (2.0 * moment[f, m, 4] + e)
        xy += 0.5 * own * (2.0 * moment[f, m, 5] + g)
    slope = xx * up[0] + xy * up[1] + zx * up[2], xy * up[0] + yy * up[1] + yz * up[2], zx * up[0] + yz * up[1] + zz * up[2]
    return change, dot(up, raised), along(slope, z, raised)


@item
def _awash(i, f, z, up, solids, bodies, push, row, strength, spread):
    """The same of face f which the waterline may cross, by its points; what is wet of it goes to `spread` and is returned, too."""
    out, modes = bodies.coordinate, solids.mode_count[i]
    point, weight, shape = solids.skin_point, solids.skin_weight, solids.skin_shape
    change, rise, slope, wet = 0.0, 0.0, NONE, 0.0
    for p in range(solids.skin_start[f], solids.skin_start[f + 1]):
        moved = NONE
        for m in range(modes):
            moved = along(moved, out[i, m], (shape[p, m, 0], shape[p, m, 1], shape[p, m, 2]))
        x = load(point, p)
        flat = z + dot(up, x)
        high = flat + dot(up, moved)
        flat, low = min(flat, 0.0), min(high, 0.0)
        change += weight[p] * (low * low - flat * flat)
        rise += weight[p] * (low - flat)
        slope = add(slope, scale(weight[p], add(scale(low - flat, x), scale(low, moved))))
        if high < 0.0:
            wet += weight[p]
            for m in range(modes):
                own = (shape[p, m, 0], shape[p, m, 1], shape[p, m, 2])
                push[row, m] += strength * weight[p] * low * dot(up, own)
                spread[m, 0] += weight[p] * own[0]
                spread[m, 1] += weight[p] * own[1]
                spread[m, 2] += weight[p] * own[2]
    return change, rise, slope, wet


@item
def _float(i, setting, solids, bodies, push, row, spread):
    """Energy [J], force upwards [N] and torque in the frame of body i [N m] by which its bent surface differs from the unbent one.

    Loads on modes are added to `push[row]`; to `spread` (m, 3) what of the shapes is wet. Returns the wet area [m2] with them.
    """
    q, weight = bodies.orientation, setting.water_density * setting.gravity
    up, z = rotation_matrix(q[i, 0], q[i, 1], q[i, 2], q[i, 3])[2], bodies.position[i, 2]
    out, energy, lift, slope, wet = bulge(i, solids, bodies), 0.0, 0.0, NONE, 0.0
    for f in range(solids.skin_face[i], solids.skin_face[i + 1]):
        normal = load(solids.skin_normal, f)
        facing, level = dot(normal, up), z + dot(up, load(solids.skin_centre, f))
        swing = solids.skin_reach[f] * sqrt(max(0.0, 1.0 - facing * facing)) + out
        if level >= swing:
            continue
        if level <= -swing:
            change, rise, own = _under(i, f, z, up, solids, bodies, push, row, weight * facing)
            wet += solids.skin_area[f]
            for m in range(solids.mode_count[i]):
                accumulate(spread, m, load(solids.skin_first[f], m))
        else:
            change, rise, own, part = _awash(i, f, z, up, solids, bodies, push, row, weight * facing, spread)
            wet += part
        energy -= 0.5 * weight * facing * change
        lift += weight * facing * rise
        slope = add(slope, add(scale(0.5 * weight * change, normal), scale(weight * facing, own)))
    return energy, lift, cross(slope, up), wet


@item
def _spread_over(i, force, spread, share, R, solids, bodies):
    """Load the modes of body i by a force [N] spread evenly over what `spread` holds, of an area 1/share; returns its power [W]."""
    own, power = to_body(R, force), 0.0
    for m in range(solids.mode_count[i]):
        load_on = share * dot(own, load(spread, m))
        bodies.mode_load[i, m] += load_on
        power += load_on * bodies.rate[i, m]
    return power


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
        _, lift, turn, wet = _float(i, setting, solids, bodies, bodies.mode_load, i, spread)
        force, torque = add(force, (0.0, 0.0, lift)), add(torque, to_world(R, turn))
        if wet > 0.0:
            dragged = drag(i, time, setting, hulls, solids, bodies, workspace.wet)[0]
            _book(i, DRAG, _spread_over(i, dragged, spread, 1.0 / wet, R, solids, bodies), dt, bodies)
    blown = wind(i, time, setting, hulls, solids, bodies, workspace.wet)[0]
    if blown[0] != 0.0 or blown[1] != 0.0:
        area = -wet
        for m in range(solids.mode_count[i]):
            store(spread, m, scale(-1.0, load(spread, m)))
        for f in range(solids.skin_face[i], solids.skin_face[i + 1]):
            area += solids.skin_area[f]
            for m in range(solids.mode_count[i]):
                accumulate(spread, m, load(solids.skin_first[f], m))
        if area > 0.0:
            _book(i, WIND, _spread_over(i, blown, spread, 1.0 / area, R, solids, bodies), dt, bodies)
    return force, torque


@item
def _book(i, column, power, dt, bodies):
    """Book the work that a drag does on the modes of body i [W] like that on the body itself."""
    bodies.work[i, column] += 0.5 * dt * (power + bodies.bent_power[i, column])
    bodies.bent_power[i, column] = power


@item
def _no_change(i, setting, solids, bodies, workspace):
    return 0.0


@item
def _change_of_buoyancy(i, setting, solids, bodies, workspace):
    if solids.mode_count[i] == 0:
        return 0.0
    return _float(i, setting, solids, bodies, workspace.mode_idle, 0, workspace.spread[i])[0]


#: bent_loads(i, dt, time, setting, hulls, solids, bodies, workspace, force, torque): all loads on body i but contacts', as it is
#: bent, from those on the unbent one; its modes are loaded.
bent_loads = by_type(_as_rigid, {ModalSolids: _bent}, at=5)
#: bent_buoyancy(i, setting, solids, bodies, workspace): energy [J] of the water that body i displaces, less that of the unbent one.
bent_buoyancy = by_type(_no_change, {ModalSolids: _change_of_buoyancy}, at=2)

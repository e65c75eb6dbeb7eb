"""Loads on structures: summed in every step, gathered in windows and maps."""

from math import atan2, cos, pi, sin, sqrt

from dilatedem.jit import device, item
from dilatedem.numerics.vector import add, cross, load, scale, sub
from dilatedem.state.charts import Along
from dilatedem.state.loads import EXTREMES, HEIGHT_BINS, PLACE_BINS
from dilatedem.state.response import stride_of
from dilatedem.state.supports import Carried

ANGLE, LINE, HELD = int(Along.ANGLE), int(Along.LINE), int(Carried.HELD)
EXTREME_COUNT = len(EXTREMES)
#: columns of the extremes: of a pair the first, its lowest
FX, FY, FH, ALONG, ACROSS, MX, MY, MZ, MH = map(EXTREMES.index, (
    "fx_min_N", "fy_min_N", "fh_max_N", "along_min_N", "across_min_N", "mx_min_Nm", "my_min_Nm", "mz_min_Nm", "mh_max_Nm",
))  # fmt: skip


@item
def begin_strides(count, structure_of, bodies, excursions, pairs, workspace, loads):
    """What the loads of before add to the sums while strides of several steps go on that are about to end.

    In sums over steps a load counts for half of the stride that ends with it and half of the next one, as the kicks of the
    bodies do: here the latter, less the half step that it has been counted for.
    """
    for s in range(len(loads.step_contacts)):
        for m in range(6):
            loads.stride_load[s, m] = 0.0
    for w in range(count):
        k = workspace.at_structure[w]
        a, b = pairs.a[k], pairs.b[k]
        steps = stride_of(a, b, workspace)
        if steps > 1 and pairs.overlap[k] > 0.0:
            share, force, couple = 0.5 * (steps - 1), load(pairs.force, k), load(pairs.couple, k)
            if structure_of[b] >= 0:
                s, lever = structure_of[b], _lever(structure_of[b], load(bodies.position, b), load(pairs.arm, k), excursions)
                _add_to(loads.stride_load, s, share, force, couple, lever)
            if structure_of[a] >= 0:
                s, lever = structure_of[a], _lever(structure_of[a], load(bodies.position, a), load(pairs.point, k), excursions)
                _add_to(loads.stride_load, s, -share, force, couple, lever)


@item
def load_structures(count, dt, model, bodies, excursions, pairs, workspace, loads):
    """Loads of all records at this step, and what they add to the sums of the window.

    From the near pairs with a structure, `count` of them: of those that are not due at this step the load of the last one.
    """
    structure_of, charts, supports, records = model.structure_of, model.charts, model.supports, model.records
    for s in range(len(loads.step_contacts)):
        loads.step_contacts[s] = 0
        for m in range(6):
            loads.step_load[s, m] = 0.0
    for w in range(count):
        k = workspace.at_structure[w]
        if pairs.overlap[k] <= 0.0:
            continue
        a, b, steps = pairs.a[k], pairs.b[k], stride_of(pairs.a[k], pairs.b[k], workspace)
        force, couple, impulse = load(pairs.force, k), load(pairs.couple, k), pairs.normal_force[k] * (dt * steps)
        if structure_of[b] >= 0:
            _load_structure(
                structure_of[b], load(bodies.position, b), load(pairs.arm, k), force, couple, steps, impulse, charts, supports,
                excursions, loads,
            )  # fmt: skip
        if structure_of[a] >= 0:
            force, couple = scale(-1.0, force), scale(-1.0, couple)
            _load_structure(
                structure_of[a], load(bodies.position, a), load(pairs.point, k), force, couple, steps, impulse, charts, supports,
                excursions, loads,
            )  # fmt: skip
    for t in range(len(records.total)):
        row, first, last = records.total[t], records.start[t], records.start[t + 1]
        for w in range(first, last):
            loads.step_contacts[row] += loads.step_contacts[records.member[w]]
        _add_up(row, first, last, records.member, excursions.center, loads.step_load)
        _add_up(row, first, last, records.member, excursions.center, loads.stride_load)
    for s in range(len(loads.step_contacts)):
        for m in range(6):
            loads.window_sum[s, m] += loads.stride_load[s, m]


@item
def _add_up(row, first, last, member, center, sums):
    """The load of a row of `sums` (s, 6) as the sum of those of member[first:last], its moment about its own centre."""
    for w in range(first, last):
        s = member[w]
        force = load(sums, s)
        moment = cross(sub(load(center, s), load(center, row)), force)
        for m in range(3):
            sums[row, m] += force[m]
            sums[row, 3 + m] += sums[s, 3 + m] + moment[m]


@item
def _lever(s, position, arm, excursions):
    """From the centre of structure s, where it is now, to `arm` from one of its bodies, which is at `position`."""
    return add(arm, sub(position, load(excursions.center, s)))


@item
def _add_to(sums, s, share, force, couple, lever):
    """Add a share of a contact's force and of its moment to row s of `sums`."""
    moment = add(couple, cross(lever, force))
    for m in range(3):
        sums[s, m] += share * force[m]
        sums[s, 3 + m] += share * moment[m]


@item
def _load_structure(s, position, arm, force, couple, steps, impulse, charts, supports, excursions, loads):
    """Add a contact to the load and the map of structure s, at `arm` from one of its bodies, which is at `position`; steps: of the
    stride that has just ended, 0 for a contact that is in the middle of one."""
    lever = _lever(s, position, arm, excursions)
    loads.step_contacts[s] += 1
    _add_to(loads.step_load, s, 1.0, force, couple, lever)
    if steps == 0:
        return
    _add_to(loads.stride_load, s, 0.5 * (steps + 1), force, couple, lever)
    if charts.map[s] < 0:
        return
    height, axis = position[2] + arm[2], load(charts.axis, s)
    if supports.kind[s] == HELD:
        x, y, z = add(arm, sub(position, load(charts.origin, s)))
    else:  # a map goes with its structure
        lever = _unturned(excursions.displacement[s, 2], lever)
        x, y, z = add(lever, sub(load(charts.center, s), load(charts.origin, s)))
    along = charts.along[s]
    if along == LINE:
        place = (x * axis[0] + y * axis[1]) / charts.length[s]
    elif along == ANGLE:
        place = atan2(y - axis[1] * z, x - axis[0] * z) / pi
    else:
        first, last = charts.outline_start[s], charts.outline_start[s + 1]
        place = 2.0 * place_on_outline(charts.outline, first, last, x, y) / charts.length[s] - 1.0
    low, high = charts.heights[s, 0], charts.heights[s, 1]
    i = min(max(int((place + 1.0) * 0.5 * PLACE_BINS), 0), PLACE_BINS - 1)
    j = min(max(int((height - low) / (high - low) * HEIGHT_BINS), 0), HEIGHT_BINS - 1)
    loads.impulse_map[charts.map[s], i, j] += impulse


@device
def _unturned(angle, lever):
    """`lever` (3,) [m] in the axes of a structure that has turned by `angle` [rad] about z."""
    c, s = cos(angle), sin(angle)
    return c * lever[0] + s * lever[1], c * lever[1] - s * lever[0], lever[2]


@device
def place_on_outline(outline, first, last, x, y):
    """How far along the closed outline of corners first..last the place nearest to (x, y) lies, from its first corner [m]."""
    nearest, place, passed = 1e300, 0.0, 0.0
    for i in range(first, last):
        j = i + 1 if i + 1 < last else first
        ex, ey = outline[j, 0] - outline[i, 0], outline[j, 1] - outline[i, 1]
        length = sqrt(ex * ex + ey * ey)
        px, py = x - outline[i, 0], y - outline[i, 1]
        t = min(max((px * ex + py * ey) / (length * length), 0.0), 1.0)
        dx, dy = px - t * ex, py - t * ey
        away = dx * dx + dy * dy
        if away < nearest:
            nearest, place = away, passed + t * length
        passed += length
    return place


@item
def record_loads(records, loads):
    """Bring this step's loads into the extremes of the open window."""
    first = loads.steps[0] == 0
    loads.steps[0] += 1
    for s in range(len(loads.step_contacts)):
        loads.contact_sum[s] = loads.step_contacts[s] + (0 if first else loads.contact_sum[s])
        _widen(s, first, records.flow, loads.step_load, loads.window_extreme)


@item
def _widen(s, first, flow, step_load, extreme):
    """Bring the load of row s at this step into the extremes of its window (`state.loads.EXTREMES`); first: of its steps."""
    fx, fy, mx, my = step_load[s, 0], step_load[s, 1], step_load[s, 3], step_load[s, 4]
    _span(s, FX, first, fx, extreme)
    _span(s, FY, first, fy, extreme)
    _top(s, FH, first, sqrt(fx * fx + fy * fy), extreme)
    _span(s, ALONG, first, flow[0] * fx + flow[1] * fy, extreme)
    _span(s, ACROSS, first, flow[0] * fy - flow[1] * fx, extreme)
    _span(s, MX, first, mx, extreme)
    _span(s, MY, first, my, extreme)
    _span(s, MZ, first, step_load[s, 5], extreme)
    _top(s, MH, first, sqrt(mx * mx + my * my), extreme)


@device
def _span(s, m, first, value, extreme):
    """Lowest and highest of a value, in columns m and m + 1."""
    extreme[s, m] = value if first else min(extreme[s, m], value)
    extreme[s, m + 1] = value if first else max(extreme[s, m + 1], value)


@device
def _top(s, m, first, value, extreme):
    """Highest of a value that is never negative, in column m."""
    extreme[s, m] = value if first else max(extreme[s, m], value)


@item
def end_window(step, loads, windows):
    """Put the open window down if it is due to end at this step; then the next one is open."""
    w = windows.count[0]
    if windows.due[w] != step:
        return
    windows.steps[w] = loads.steps[0]
    for s in range(len(loads.step_contacts)):
        windows.contacts[w, s] = loads.contact_sum[s]
        for m in range(6):
            windows.sum[w, s, m] = loads.window_sum[s, m]
            loads.window_sum[s, m] = 0.0
        for m in range(EXTREME_COUNT):
            windows.extreme[w, s, m] = loads.window_extreme[s, m]
    windows.count[0] += 1
    loads.steps[0] = 0

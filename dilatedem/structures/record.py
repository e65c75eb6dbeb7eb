"""Loads on structures: summed in every step, gathered in windows and maps."""

from math import atan2, pi, sqrt

from dilatedem.jit import device, item
from dilatedem.numerics.vector import add, cross, load, scale, sub
from dilatedem.state.charts import Along
from dilatedem.state.loads import HEIGHT_BINS, PLACE_BINS

ANGLE, LINE = int(Along.ANGLE), int(Along.LINE)


@item
def load_structures(count, dt, structure_of, whole_of, charts, bodies, pairs, workspace, loads):
    """Loads on all structures at this step, from the awake pairs with one, `count` of them; then wholes by their parts."""
    for s in range(len(loads.step_contacts)):
        loads.step_contacts[s] = 0
        for m in range(6):
            loads.step_load[s, m] = 0.0
    for w in range(count):
        k = workspace.at_structure[w]
        if pairs.overlap[k] <= 0.0:
            continue
        a, b, impulse = pairs.a[k], pairs.b[k], pairs.normal_force[k] * dt
        force, couple = load(pairs.force, k), load(pairs.couple, k)
        if structure_of[b] >= 0:
            _load_structure(structure_of[b], load(bodies.position, b), load(pairs.arm, k), force, couple, impulse, charts, loads)
        if structure_of[a] >= 0:
            force, couple = scale(-1.0, force), scale(-1.0, couple)
            _load_structure(structure_of[a], load(bodies.position, a), load(pairs.point, k), force, couple, impulse, charts, loads)
    _load_wholes(whole_of, loads)


@item
def _load_structure(s, position, arm, force, couple, impulse, charts, loads):
    """Add a contact to the load and the map of structure s, at `arm` from one of its bodies, which is at `position`."""
    center = load(charts.center, s)
    # moments are about the structure's centre
    moment = add(couple, cross(add(arm, sub(position, center)), force))
    loads.step_contacts[s] += 1
    for m in range(3):
        loads.step_load[s, m] += force[m]
        loads.step_load[s, 3 + m] += moment[m]
    if charts.map[s] < 0:
        return
    height, axis = position[2] + arm[2], load(charts.axis, s)
    x, y, z = add(arm, sub(position, load(charts.origin, s)))
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


@item
def _load_wholes(whole_of, loads):
    """Add the load of each part to that of the structure that it is a part of."""
    for s in range(len(whole_of)):
        whole = whole_of[s]
        if whole >= 0:
            loads.step_contacts[whole] += loads.step_contacts[s]
            for m in range(6):
                loads.step_load[whole, m] += loads.step_load[s, m]


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
def record_loads(loads):
    """Add this step's structure loads to the open window: sums and extremes."""
    first = loads.steps[0] == 0
    loads.steps[0] += 1
    for s in range(len(loads.step_contacts)):
        fx, fy = loads.step_load[s, 0], loads.step_load[s, 1]
        fh = sqrt(fx * fx + fy * fy)
        for m in range(6):
            loads.window_sum[s, m] = loads.step_load[s, m] + (0.0 if first else loads.window_sum[s, m])
        loads.contact_sum[s] = loads.step_contacts[s] + (0 if first else loads.contact_sum[s])
        extreme = loads.window_extreme
        extreme[s, 0] = fx if first else min(extreme[s, 0], fx)
        extreme[s, 1] = fx if first else max(extreme[s, 1], fx)
        extreme[s, 2] = fy if first else min(extreme[s, 2], fy)
        extreme[s, 3] = fy if first else max(extreme[s, 3], fy)
        extreme[s, 4] = fh if first else max(extreme[s, 4], fh)


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
        for m in range(5):
            windows.extreme[w, s, m] = loads.window_extreme[s, m]
    windows.count[0] += 1
    loads.steps[0] = 0

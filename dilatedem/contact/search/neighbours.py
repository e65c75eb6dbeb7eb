"""Which pairs may touch soon: bodies sorted into a grid of cells, made anew only when some body has moved far enough.

Every body keeps a `path`, a bound on how far any of its points has moved in a frame that drifts with the ice (rigid drift
brings nothing closer). The list holds every pair closer than SKIN; half of that on either path leaves it complete. Within the
list a pair sleeps until the two paths have used up its gap.
"""

from math import sqrt

from dilatedem.jit import device, item
from dilatedem.numerics.vector import dot, load, sub
from dilatedem.state.pairs import KEPT, ROW
from dilatedem.state.response import are_joined, is_free, stride_of

#: distance at which pairs enter the list, in units of the largest reach of a floating body. Larger: fewer rebuilds, longer list
SKIN = 0.25
#: share of the skin that one path may use up before the list is made anew; half would be exact, the rest is for the step itself
USABLE = 0.45



@device
def _cell_axis(x, low, size, cells, period):
    """Cell number along one axis; outside bodies belong to the border cells (that can only bring them closer)."""
    if period > 0.0:
        x -= period * round(x / period)
    c = int((x - low) / size)
    return min(max(c, 0), cells - 1)


@device
def _grid(position, floating, cell_size, period, axis, most):
    """Lowest coordinate, cell size and cell count along one axis, at most `most` cells."""
    if period > 0.0:
        cells = max(1, min(most, int(period / cell_size)))
        return -0.5 * period, period / cells, cells
    low = high = position[0, axis] if floating > 0 else 0.0
    for i in range(floating):
        low, high = min(low, position[i, axis]), max(high, position[i, axis])
    cells = max(1, min(most, int((high - low) / cell_size)))
    return low, max((high - low) / cells, cell_size), cells


@device
def near_structure(shapes, position, a, s, surroundings, skin):
    """Whether body a may be within `skin` of structure s."""
    if shapes.kind[s] != 0:
        height = dot(load(shapes.plane_normal, s), sub(load(position, a), load(position, s)))
        return height - shapes.reach[a] < skin
    # it may reach far up and down: what counts is the distance in plan
    dx, dy = position[s, 0] - position[a, 0], position[s, 1] - position[a, 1]
    if surroundings.period_x > 0.0:
        dx -= surroundings.period_x * round(dx / surroundings.period_x)
    if surroundings.period_y > 0.0:
        dy -= surroundings.period_y * round(dy / surroundings.period_y)
    return sqrt(dx * dx + dy * dy) - shapes.reach[a] - shapes.plan_reach[s] < skin


@item
def find_pairs(model, bodies, pairs, spare, cells, clock):
    """Make the list of pairs anew; returns False, nothing changed, where it has no room.

    spare: a second `Pairs` of the same capacity; cells: `state.storage.Cells`. Pairs that were listed before keep their memory.
    """
    shapes, solids, surroundings, floating = model.shapes, model.solids, model.surroundings, model.floating
    position = bodies.position
    reach = 0.0
    for i in range(floating):
        reach = max(reach, shapes.reach[i])
    skin = SKIN * reach
    cell_size = 2.0 * reach + skin
    most = cells.most
    x0, sx, nx = _grid(position, floating, cell_size, surroundings.period_x, 0, most)
    y0, sy, ny = _grid(position, floating, cell_size, surroundings.period_y, 1, most)
    wrap_x, wrap_y = surroundings.period_x > 0.0, surroundings.period_y > 0.0

    # bodies in the order of cells (counting sort)
    start, member, cell_of = cells.start, cells.member, cells.cell_of
    for c in range(nx * ny + 1):
        start[c] = 0
    for i in range(floating):
        cx = _cell_axis(position[i, 0], x0, sx, nx, surroundings.period_x)
        cy = _cell_axis(position[i, 1], y0, sy, ny, surroundings.period_y)
        cell_of[i] = cx * ny + cy
        start[cell_of[i] + 1] += 1
    for c in range(nx * ny):
        start[c + 1] += start[c]
    for i in range(floating - 1, -1, -1):
        c = cell_of[i]
        start[c + 1] -= 1
        member[start[c + 1]] = i
    # every cell's bodies now begin at start[c + 1]; shift back
    for c in range(nx * ny):
        start[c] = start[c + 1]
    start[nx * ny] = floating

    structures = len(shapes.radius) - floating
    found = 0
    capacity = len(pairs.a)
    for a in range(floating):
        first = found
        cx, cy = cell_of[a] // ny, cell_of[a] % ny
        for ox in range(-1, 2):
            gx = cx + ox
            if gx < 0 or gx >= nx:
                # fewer than three cells along a periodic axis: the neighbour is a cell already seen
                if not wrap_x or nx < 3:
                    continue
                gx = (gx + nx) % nx
            for oy in range(-1, 2):
                gy = cy + oy
                if gy < 0 or gy >= ny:
                    if not wrap_y or ny < 3:
                        continue
                    gy = (gy + ny) % ny
                c = gx * ny + gy
                for m in range(start[c], start[c + 1]):
                    b = member[m]
                    if b <= a or not (is_free(a, solids) or is_free(b, solids)) or are_joined(a, b, solids):
                        continue
                    dx = position[b, 0] - position[a, 0]
                    dy = position[b, 1] - position[a, 1]
                    dz = position[b, 2] - position[a, 2]
                    if wrap_x:
                        dx -= surroundings.period_x * round(dx / surroundings.period_x)
                    if wrap_y:
                        dy -= surroundings.period_y * round(dy / surroundings.period_y)
                    limit = shapes.reach[a] + shapes.reach[b] + skin
                    if dx * dx + dy * dy + dz * dz < limit * limit:
                        if found == capacity:
                            return False
                        spare.b[found] = b
                        spare.a[found] = a
                        found += 1
        for s in range(floating, floating + structures):
            if is_free(a, solids) and near_structure(shapes, position, a, s, surroundings, skin):
                if found == capacity:
                    return False
                spare.b[found] = s
                spare.a[found] = a
                found += 1
        for i in range(first + 1, found):
            b = spare.b[i]
            j = i - 1
            while j >= first and spare.b[j] > b:
                spare.b[j + 1] = spare.b[j]
                j -= 1
            spare.b[j + 1] = b
    _exchange(pairs, spare, found)
    _start_paths(bodies, floating, pairs, surroundings, skin)
    clock.rebuilds[0] += 1
    return True


@item
def _exchange(pairs, spare, found):
    """Bring the new list (a, b of spare) into pairs, with the memory of those that were there."""
    before = pairs.count[0]
    # both lists are sorted by (a, b): one walk through both finds what stays
    old = 0
    for k in range(found):
        a, b = spare.a[k], spare.b[k]
        while old < before and (pairs.a[old] < a or (pairs.a[old] == a and pairs.b[old] < b)):
            old += 1
        same = old < before and pairs.a[old] == a and pairs.b[old] == b
        _copy(pairs, old if same else -1, spare, k)
    for k in range(found):
        pairs.a[k], pairs.b[k] = spare.a[k], spare.b[k]
        _copy(spare, k, pairs, k)
    pairs.count[0] = found


@device
def _copy(source, i, target, k):
    """Row of pair i (-1: none) to pair k, which is looked at afresh in the next step; what the last one cost stays behind."""
    for c in range(KEPT):
        target.row[k, c] = source.row[i, c] if i >= 0 else 0
    for c in range(KEPT, ROW):
        target.row[k, c] = 0
    target.wake[k] = -1.0


@item
def _start_paths(bodies, floating, pairs, surroundings, skin):
    """All paths start at zero, in the frame of the mean drift."""
    u = v = 0.0
    for i in range(floating):
        u += bodies.velocity[i, 0]
        v += bodies.velocity[i, 1]
    pairs.frame[0] = u / floating if floating > 0 else 0.0
    pairs.frame[1] = v / floating if floating > 0 else 0.0
    for i in range(len(bodies.path)):
        bodies.path[i] = 0.0
    pairs.limit[0] = USABLE * skin


@item
def pairs_at_structures(count, structure_of, pairs, workspace):
    """Numbers of those of the `count` near pairs that a structure is part of, to `workspace.at_structure`; returns how many."""
    found = 0
    for w in range(count):
        k = workspace.near[w]
        if structure_of[pairs.a[k]] >= 0 or structure_of[pairs.b[k]] >= 0:
            workspace.at_structure[found] = k
            found += 1
    return found


@item
def awake_pairs(count, bodies, pairs, workspace):
    """Numbers of those of the `count` near pairs that are due and may have closed, to `workspace.awake`; returns how many."""
    found = 0
    path, near, awake = bodies.path, workspace.near, workspace.awake
    for w in range(count):
        k = near[w]
        a, b = pairs.a[k], pairs.b[k]
        if path[a] + path[b] >= pairs.wake[k] and stride_of(a, b, workspace) > 0:
            awake[found] = k
            found += 1
    return found

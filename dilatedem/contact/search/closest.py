"""Distance of two convex cores and where it is attained: Gilbert-Johnson-Keerthi with the last step's corners as a start.

All vectors are relative to the centroid of body a, in world directions, so that coordinates stay as small as the bodies. In the
normal case of a contact the cores are *apart* (their dilations overlap), and last step's corners still hold: one look
confirms them. Cores that intersect are handed to `penetration`.
"""

from math import sqrt

from dilatedem.contact.search.penetration import core_penetration
from dilatedem.contact.search.simplex import closest_on_segment, closest_on_tetrahedron, closest_on_triangle
from dilatedem.jit import device, item
from dilatedem.numerics.vector import add, along, dot, load, scale, sub

#: relative gain in squared distance below which the search ends; effect: error of the distance 1e-13 of it, of the normal 3e-7 rad.
#: Round-off adds 1e-14 of the bodies' size, and more where edges are over a thousand times longer than the cores are apart
CONVERGED = 1e-13
#: core distance over that of the centroids, up to which the direction of the shortest line is noise and the separating-axis search
#: takes over
TOUCHING = 1e-9
#: error of a height along v, of the bodies' reach; effect: a search that comes no nearer goes on while some corner promises more
ROUND_OFF = 5e-16
#: searches that take longer cycle on round-off and have converged
MOST_ROUNDS = 64


@device
def farthest_vertex(vertex, first, last, d):
    """Number of the vertex farthest along d, and how far."""
    best = first
    reach = vertex[first, 0] * d[0] + vertex[first, 1] * d[1] + vertex[first, 2] * d[2]
    for i in range(first + 1, last):
        h = vertex[i, 0] * d[0] + vertex[i, 1] * d[1] + vertex[i, 2] * d[2]
        if h > reach:
            best, reach = i, h
    return best, reach


@device
def _height_uphill(vertex, shapes, start, d):
    """How far along d a convex core reaches, but for round-off: from one vertex along edges that lead farther."""
    best, here = start, -1
    reach = dot(load(vertex, start), d)
    while here != best:
        here = best
        for p in range(shapes.neighbour_start[here], shapes.neighbour_start[here + 1]):
            h = dot(load(vertex, shapes.neighbour[p]), d)
            if h > reach:
                best, reach = shapes.neighbour[p], h
    return reach


@item
def closest_points(vertex, face_normal, shapes, pairs, k, a, b, offset):
    """Signed distance of the cores of pair k, unit normal from a to b, and the witness points on a and b.

    `vertex`, `face_normal`: turned to world directions, relative to their own centroid. offset: centroid of b minus
    that of a, the shortest image [m]. Updates the pair's corners and normal. Negative distance: depth of the cores' intersection.
    """
    a0, a1 = shapes.vertex_start[a], shapes.vertex_start[a + 1]
    b0, b1 = shapes.vertex_start[b], shapes.vertex_start[b + 1]
    ca, cb = pairs.corner_a, pairs.corner_b
    n = pairs.corners[k]
    if n == 0:
        n = 1
        ca[k, 0] = a0
        cb[k, 0] = b0
    v = (0.0, 0.0, 0.0)
    l0, l1, l2, l3 = 1.0, 0.0, 0.0, 0.0
    last, nothing = 1e300, TOUCHING * TOUCHING * dot(offset, offset)
    newest_a = newest_b = -1
    for searched in range(MOST_ROUNDS):
        pairs.rounds[k] = searched + 1
        # corners of the Minkowski difference b - a
        w0 = add(offset, sub(load(vertex, cb[k, 0]), load(vertex, ca[k, 0])))
        l0, l1, l2, l3 = 1.0, 0.0, 0.0, 0.0
        if n == 1:
            v = w0
        else:
            w1 = add(offset, sub(load(vertex, cb[k, 1]), load(vertex, ca[k, 1])))
            if n == 2:
                v, l0, l1 = closest_on_segment(w0, w1)
            else:
                w2 = add(offset, sub(load(vertex, cb[k, 2]), load(vertex, ca[k, 2])))
                if n == 3:
                    v, l0, l1, l2 = closest_on_triangle(w0, w1, w2)
                else:
                    w3 = add(offset, sub(load(vertex, cb[k, 3]), load(vertex, ca[k, 3])))
                    v, l0, l1, l2, l3 = closest_on_tetrahedron(w0, w1, w2, w3)
        # keep the corners that matter
        m = 0
        if l0 > 0.0:
            m = 1
        if l1 > 0.0:
            ca[k, m], cb[k, m] = ca[k, 1], cb[k, 1]
            if m == 0:
                l0, l1 = l1, 0.0
            m += 1
        if l2 > 0.0:
            ca[k, m], cb[k, m] = ca[k, 2], cb[k, 2]
            if m == 0:
                l0, l2 = l2, 0.0
            elif m == 1:
                l1, l2 = l2, 0.0
            m += 1
        if l3 > 0.0:
            ca[k, m], cb[k, m] = ca[k, 3], cb[k, 3]
            if m == 0:
                l0, l3 = l3, 0.0
            elif m == 1:
                l1, l3 = l3, 0.0
            elif m == 2:
                l2, l3 = l3, 0.0
            m += 1
        n = m
        v2 = dot(v, v)
        if n == 4 or v2 <= nothing:
            depth, normal, pa, pb = core_penetration(vertex, face_normal, shapes, a, b, offset, load(pairs.normal, k))
            pairs.corners[k] = 0  # corners of an intersection are no start for a distance, but the patch wants to know the deepest
            ca[k, 0], _ = farthest_vertex(vertex, a0, a1, normal)
            cb[k, 0], _ = farthest_vertex(vertex, b0, b1, scale(-1.0, normal))
            return -depth, normal, pa, pb
        back, noise = (-v[0], -v[1], -v[2]), ROUND_OFF * (shapes.reach[a] + shapes.reach[b]) * sqrt(v2)
        ha, hb = _height_uphill(vertex, shapes, ca[k, 0], v), _height_uphill(vertex, shapes, cb[k, 0], back)
        if v2 - (dot(v, offset) - hb - ha) <= CONVERGED * v2 - noise:
            break
        i, ha = farthest_vertex(vertex, a0, a1, v)
        j, hb = farthest_vertex(vertex, b0, b1, back)
        before = v2 - (dot(v, offset) - hb - ha)
        if before <= CONVERGED * v2:
            break
        # no nearer, but perhaps turned: a corner that lies before the plane square to v by more than round-off is still to come
        if v2 >= last and before <= noise:
            break
        last = v2
        known = i == newest_a and j == newest_b
        for c in range(n):
            known = known or (ca[k, c] == i and cb[k, c] == j)
        if known:
            break
        ca[k, n], cb[k, n] = i, j
        newest_a, newest_b = i, j
        n += 1
    n = min(n, 3)
    pairs.corners[k] = n
    distance = sqrt(dot(v, v))
    normal = scale(1.0 / distance, v)
    pa = scale(l0, load(vertex, ca[k, 0]))
    if n > 1:
        pa = along(pa, l1, load(vertex, ca[k, 1]))
    if n > 2:
        pa = along(pa, l2, load(vertex, ca[k, 2]))
    return distance, normal, pa, add(pa, v)

"""How deep two intersecting cores are in each other: the shortest of all separating translations (exact for polyhedra).

The translation is normal to a face of a, a face of b, or to an edge of each. Rare (the overlap has passed both dilated radii),
so all axes are tried. The depth grows continuously from 0 where the cores touch. The normal goes on from that of the distance where
a face is involved; where corners or edges meet it may turn at once to the shortest axis.
"""

from math import sqrt

from dilatedem.jit import device
from dilatedem.numerics.vector import add, along, cross, dot, load, scale, sub

#: squared sine of the angle of two edges below which their common normal is not tried
PARALLEL_EDGES = 1e-16


@device
def _extent(vertex, first, last, d):
    """Largest and smallest height of vertices along d."""
    high = low = vertex[first, 0] * d[0] + vertex[first, 1] * d[1] + vertex[first, 2] * d[2]
    for i in range(first + 1, last):
        h = vertex[i, 0] * d[0] + vertex[i, 1] * d[1] + vertex[i, 2] * d[2]
        high, low = max(high, h), min(low, h)
    return high, low


@device
def _depth_along(vertex, a0, a1, b0, b1, offset, d):
    """How far b must move along d to be clear of a."""
    high, _ = _extent(vertex, a0, a1, d)
    _, low = _extent(vertex, b0, b1, d)
    return high - low - dot(offset, d)


@device
def _support_centre(vertex, first, last, d, slack):
    """Mean of the vertices within `slack` of the farthest along d."""
    high, _ = _extent(vertex, first, last, d)
    total = (0.0, 0.0, 0.0)
    count = 0
    for i in range(first, last):
        if dot(load(vertex, i), d) >= high - slack:
            total = add(total, load(vertex, i))
            count += 1
    return scale(1.0 / count, total)


@device
def core_penetration(vertex, face_normal, shapes, a, b, offset, previous):
    """Depth [m], unit normal from a to b, and points on a and b at that depth along the normal.

    Vectors relative to a's centroid. previous: the pair's last normal (zero if unknown); where both senses of an axis are equally
    short, or the cores are too thin to have any (points, segments in line), it decides, so that the normal never flips.
    """
    a0, a1 = shapes.vertex_start[a], shapes.vertex_start[a + 1]
    b0, b1 = shapes.vertex_start[b], shapes.vertex_start[b + 1]
    best = 1e300
    normal = (0.0, 0.0, 0.0)
    for f in range(shapes.face_start[a], shapes.face_start[a + 1]):
        d = load(face_normal, f)
        depth = _depth_along(vertex, a0, a1, b0, b1, offset, d)
        if depth < best:
            best, normal = depth, d
    for f in range(shapes.face_start[b], shapes.face_start[b + 1]):
        d = scale(-1.0, load(face_normal, f))
        depth = _depth_along(vertex, a0, a1, b0, b1, offset, d)
        if depth < best:
            best, normal = depth, d
    for i in range(a0, a1):
        for p in range(shapes.neighbour_start[i], shapes.neighbour_start[i + 1]):
            if shapes.neighbour[p] < i:
                continue
            e = sub(load(vertex, shapes.neighbour[p]), load(vertex, i))
            for j in range(b0, b1):
                for q in range(shapes.neighbour_start[j], shapes.neighbour_start[j + 1]):
                    if shapes.neighbour[q] < j:
                        continue
                    g = sub(load(vertex, shapes.neighbour[q]), load(vertex, j))
                    d = cross(e, g)
                    d2 = dot(d, d)
                    if d2 <= PARALLEL_EDGES * dot(e, e) * dot(g, g):
                        continue
                    d = scale(1.0 / sqrt(d2), d)
                    if dot(d, previous) < 0.0:
                        d = scale(-1.0, d)
                    depth = _depth_along(vertex, a0, a1, b0, b1, offset, d)
                    other = _depth_along(vertex, a0, a1, b0, b1, offset, scale(-1.0, d))
                    if other < depth:
                        d, depth = scale(-1.0, d), other
                    if depth < best:
                        best, normal = depth, d
    if best == 1e300:
        normal = any_normal(previous, offset)
        best = max(_depth_along(vertex, a0, a1, b0, b1, offset, normal), 0.0)
    slack = 1e-6 * (shapes.reach[a] + shapes.reach[b])
    pa = _support_centre(vertex, a0, a1, normal, slack)
    pb = add(offset, _support_centre(vertex, b0, b1, scale(-1.0, normal), slack))
    # the narrower support says where they meet
    if _support_size(vertex, a0, a1, normal, slack) <= _support_size(vertex, b0, b1, scale(-1.0, normal), slack):
        pb = along(pa, -best, normal)
    else:
        pa = along(pb, best, normal)
    return best, normal, pa, pb


@device
def _support_size(vertex, first, last, d, slack):
    """Number of vertices within `slack` of the farthest along d."""
    high, _ = _extent(vertex, first, last, d)
    count = 0
    for i in range(first, last):
        if dot(load(vertex, i), d) >= high - slack:
            count += 1
    return count


@device
def any_normal(previous, offset):
    """The last normal, else the line of centres, else up."""
    if dot(previous, previous) > 0.25:
        return previous
    length2 = dot(offset, offset)
    if length2 > 0.0:
        return scale(1.0 / sqrt(length2), offset)
    return (0.0, 0.0, 1.0)

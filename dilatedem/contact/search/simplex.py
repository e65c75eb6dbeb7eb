"""The point of a simplex closest to the origin: the inner step of the distance algorithm.

Every function returns the closest point and the weights of the corners (convex, zero where a corner does not matter). Corners are
3-vectors as tuples. Inner regions are tried first; anything else falls back on the best of the edges, which stays right for
slivers and repeated corners.
"""

from math import sqrt

from dilatedem.jit import device
from dilatedem.numerics.vector import along, cross, dot, scale, sub

#: squared sine below which three corners count as being in line; effect: such a triangle is treated as its edges
COLLINEAR = 1e-20
#: volume over product of edge lengths below which four corners count as coplanar; effect: it is treated as its faces
COPLANAR = 1e-14


@device
def closest_on_segment(p, q):
    """Closest point to the origin on the segment p q, weights of p and q."""
    d = sub(q, p)
    length2 = dot(d, d)
    if length2 == 0.0:
        return p, 1.0, 0.0
    t = -dot(p, d) / length2
    if t <= 0.0:
        return p, 1.0, 0.0
    if t >= 1.0:
        return q, 0.0, 1.0
    return along(p, t, d), 1.0 - t, t


@device
def closest_on_triangle(p, q, r):
    """Closest point to the origin on the triangle p q r, weights of its corners."""
    u, v = sub(q, p), sub(r, p)
    n = cross(u, v)
    n2 = dot(n, n)
    if n2 > COLLINEAR * dot(u, u) * dot(v, v):
        # barycentric coordinates of the origin's projection
        wr = -dot(cross(u, p), n)
        wq = -dot(cross(p, v), n)
        wp = n2 - wq - wr
        if wp >= 0.0 and wq >= 0.0 and wr >= 0.0:
            s = 1.0 / n2
            # along n, not by weights: the normal of a large face keeps full accuracy
            return scale(dot(p, n) * s, n), wp * s, wq * s, wr * s
    c, wp, wq = closest_on_segment(p, q)
    wr = 0.0
    best = dot(c, c)
    c2, s, t = closest_on_segment(q, r)
    d2 = dot(c2, c2)
    if d2 < best:
        c, best, wp, wq, wr = c2, d2, 0.0, s, t
    c2, s, t = closest_on_segment(p, r)
    d2 = dot(c2, c2)
    if d2 < best:
        c, best, wp, wq, wr = c2, d2, s, 0.0, t
    return c, wp, wq, wr


@device
def closest_on_tetrahedron(p, q, r, s):
    """Closest point to the origin of the tetrahedron p q r s, weights; four positive weights say that the origin is inside."""
    a, b, c = sub(p, s), sub(q, s), sub(r, s)
    volume = dot(a, cross(b, c))
    if abs(volume) > COPLANAR * sqrt(dot(a, a) * dot(b, b) * dot(c, c)):
        inverse = 1.0 / volume
        wp = -dot(s, cross(b, c)) * inverse
        wq = -dot(s, cross(c, a)) * inverse
        wr = -dot(s, cross(a, b)) * inverse
        ws = 1.0 - wp - wq - wr
        if wp > 0.0 and wq > 0.0 and wr > 0.0 and ws > 0.0:
            return (0.0, 0.0, 0.0), wp, wq, wr, ws
    x, wp, wq, wr = closest_on_triangle(p, q, r)
    ws = 0.0
    best = dot(x, x)
    y, i, j, k = closest_on_triangle(p, q, s)
    d2 = dot(y, y)
    if d2 < best:
        x, best, wp, wq, wr, ws = y, d2, i, j, 0.0, k
    y, i, j, k = closest_on_triangle(p, r, s)
    d2 = dot(y, y)
    if d2 < best:
        x, best, wp, wq, wr, ws = y, d2, i, 0.0, j, k
    y, i, j, k = closest_on_triangle(q, r, s)
    d2 = dot(y, y)
    if d2 < best:
        x, best, wp, wq, wr, ws = y, d2, 0.0, i, j, k
    return x, wp, wq, wr, ws

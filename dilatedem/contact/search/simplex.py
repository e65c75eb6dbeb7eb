"""The point of a simplex closest to the origin: the inner step of the distance algorithm.

Every function returns the closest point and the weights of the corners (convex, zero where a corner does not matter). Corners are
3-vectors as tuples. Inner regions are tried first; anything else falls back on the best of the edges, which stays right for
slivers and repeated corners.

The best of several edges or faces is the one whose point is closest with the corner that it leaves out, too. Distances alone cannot
tell: those of two faces that are t rad from parallel differ by some t^2 of their size, which round-off hides for t below 1e-8,
while the corner that the wrong one leaves out lies t times its size too near.
"""

from math import sqrt

from dilatedem.jit import device
from dilatedem.numerics.vector import along, cross, dot, scale, sub

#: squared sine below which three corners count as being in line; effect: such a triangle is treated as its edges
COLLINEAR = 1e-20
#: squared sine below which a triangle is a sliver; effect: above, the normal's error makes one of the distance of 1e-14 of the size
SLIVER = 1e-4
#: volume over product of edge lengths below which four corners count as coplanar; effect: it is treated as its faces
COPLANAR = 1e-14


@device
def _left_before(c, w):
    """How far corner w, which c's edge or face leaves out, lies before the plane through c square to c, times |c|; 0 behind."""
    return max(dot(c, sub(c, w)), 0.0)


@device
def _better(before, d2, least_before, best):
    """Whether a candidate is to be preferred: by what its left-out corner lies before it, then by its squared distance."""
    return before < least_before or (before == least_before and d2 < best)


@device
def _on_plane(p, u, v, n, n2):
    """The origin's projection on the plane through p with edges u, v of a triangle and normal n = u x v, of square n2."""
    u2, v2 = dot(u, u), dot(v, v)
    if n2 < SLIVER * u2 * v2:
        # round-off of u x v leaves a sliver's normal oblique to its long edge: take that part out
        if v2 > u2:
            u, u2 = v, v2
        n = along(n, -dot(n, u) / u2, u)
        n2 = dot(n, n)
    return scale(dot(p, n) * (1.0 / n2), n)


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
            return _on_plane(p, u, v, n, n2), wp * s, wq * s, wr * s
    c, wp, wq = closest_on_segment(p, q)
    wr = 0.0
    best, least = dot(c, c), _left_before(c, r)
    c2, s, t = closest_on_segment(q, r)
    d2, before = dot(c2, c2), _left_before(c2, p)
    if _better(before, d2, least, best):
        c, best, least, wp, wq, wr = c2, d2, before, 0.0, s, t
    c2, s, t = closest_on_segment(p, r)
    d2, before = dot(c2, c2), _left_before(c2, q)
    if _better(before, d2, least, best):
        c, best, least, wp, wq, wr = c2, d2, before, s, 0.0, t
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
    best, least = dot(x, x), _left_before(x, s)
    y, i, j, k = closest_on_triangle(p, q, s)
    d2, before = dot(y, y), _left_before(y, r)
    if _better(before, d2, least, best):
        x, best, least, wp, wq, wr, ws = y, d2, before, i, j, 0.0, k
    y, i, j, k = closest_on_triangle(p, r, s)
    d2, before = dot(y, y), _left_before(y, q)
    if _better(before, d2, least, best):
        x, best, least, wp, wq, wr, ws = y, d2, before, i, 0.0, j, k
    y, i, j, k = closest_on_triangle(q, r, s)
    d2, before = dot(y, y), _left_before(y, p)
    if _better(before, d2, least, best):
        x, best, least, wp, wq, wr, ws = y, d2, before, 0.0, i, j, k
    return x, wp, wq, wr, ws

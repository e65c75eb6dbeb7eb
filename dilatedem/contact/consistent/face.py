"""Energy of a face that presses on the other body's face: a punch with the area, the shape and the mean square of the overlap.

The overlap is linear over the patch, the part of face a (seen along b's normal) that lies over face b and below its dilated plane.
"""

from math import pi, sqrt

from dilatedem.contact.clip import clip_polygon
from dilatedem.contact.consistent.cap import corner_of
from dilatedem.contact.consistent.rim import FAR, bound_rims
from dilatedem.jit import device, item
from dilatedem.numerics.vector import add, along, cross, dot, scale, sub, tangents

#: shape factor of a square punch, F = 2 E* BETA sqrt(A/pi) overlap (physics: rectangles 1.018, 1.045, 1.184, 1.321 at aspect ratios
#: 1, 2, 5.6, 10; the fourth root below gives 1.018, 1.048, 1.202, 1.343)
BETA = 1.018
#: rows of `scratch` that hold the fences that cut and the corners of b in the contact plane, until the caps' sides are laid there
FENCES, BORDER = 4, 5
#: distance by which face b reaches beyond its own border in the clipping, over the sum of the radii: 0.1 mm for radii of 0.04 m.
#: Floes at one height have borders that coincide exactly; round-off would choose whose border cuts the patch, and with it the side
#: to which its pressure pushes
MARGIN = 1.25e-3
#: minus the cosine between two sides of face b beyond which the border moved out is cut off at their corner: 60 degrees, where it
#: reaches two margins, as far as at any sharper one then
SHARPEST = 0.5
#: distance, in margins, within which a corner of the clipped patch is on the side that cut it
ON = 1e-4
#: cosine of the angle between the faces beyond which they do not press face on face
STEEP = 0.1


@device
def add_triangle(sums, x1, y1, x2, y2):
    """Add a triangle with one corner at the origin to the integrals of `moments`, each but for its own factor."""
    m00, m10, m01, m20, m11, m02, m30, m21, m12, m03 = sums
    c = x1 * y2 - x2 * y1
    sx, sy, xx1, xx2, yy1, yy2 = x1 + x2, y1 + y2, x1 * x1, x2 * x2, y1 * y1, y2 * y2
    return (
        m00 + c,
        m10 + c * sx,
        m01 + c * sy,
        m20 + c * (sx * sx - x1 * x2),
        m11 + c * (sx * sy + x1 * y1 + x2 * y2),
        m02 + c * (sy * sy - y1 * y2),
        m30 + c * sx * (xx1 + xx2),
        m21 + c * (xx1 * (3.0 * y1 + y2) + 2.0 * x1 * x2 * sy + xx2 * (y1 + 3.0 * y2)),
        m12 + c * (yy1 * (3.0 * x1 + x2) + 2.0 * y1 * y2 * sx + yy2 * (x1 + 3.0 * x2)),
        m03 + c * sy * (yy1 + yy2),
    )


@device
def moments(sums):
    """Integrals of u^i v^j over a polygon about its first corner, i + j <= 3, from the sums over the triangles that meet there:
    1, u, v, uu, uv, vv, uuu, uuv, uvv, vvv."""
    m00, m10, m01, m20, m11, m02, m30, m21, m12, m03 = sums
    return (
        m00 * 0.5, m10 * (1.0 / 6.0), m01 * (1.0 / 6.0), m20 * (1.0 / 12.0), m11 * (1.0 / 24.0), m02 * (1.0 / 12.0),
        m30 * 0.05, m21 * (1.0 / 60.0), m12 * (1.0 / 60.0), m03 * 0.05,
    )  # fmt: skip


@device
def _moments(polygon, count):
    """`moments` of rows 0..count-1."""
    sums = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    u0, v0 = polygon[0, 0], polygon[0, 1]
    x2, y2 = polygon[1, 0] - u0, polygon[1, 1] - v0
    for i in range(2, count):
        x1, y1 = x2, y2
        x2, y2 = polygon[i, 0] - u0, polygon[i, 1] - v0
        sums = add_triangle(sums, x1, y1, x2, y2)
    return moments(sums)


@device
def _clip(scratch, now, count, fences, a, b, limit):
    """Clip the patch in buffer `now` by a u + b v <= limit, (a, b) a unit vector, and note it among the fences that cut; returns
    its corner count, its buffer and the number of fences."""
    scratch[FENCES, fences, 0], scratch[FENCES, fences, 1], scratch[FENCES, fences, 2] = a, b, limit
    return clip_polygon(scratch[now], count, scratch[1 - now], a, b, 0.0, limit), 1 - now, fences + 1


@item
def _outmost(scratch, now, count, a, b):
    """Largest a u + b v of the patch in buffer `now`."""
    most = a * scratch[now, 0, 0] + b * scratch[now, 0, 1]
    for i in range(1, count):
        most = max(most, a * scratch[now, i, 0] + b * scratch[now, i, 1])
    return most


@device
def _bevel(eu, ev, fu, fv):
    """Whether the corner between two sides (eu, ev) and (fu, fv) of face b is sharp, and the outward unit vector across it."""
    c = eu * fu + ev * fv
    ee, ff = eu * eu + ev * ev, fu * fu + fv * fv
    # one comparison: at a right angle round-off would choose between two
    if c * abs(c) >= -SHARPEST * SHARPEST * ee * ff:
        return False, 0.0, 0.0
    ee, ff = 1.0 / sqrt(ee), 1.0 / sqrt(ff)
    a, b = eu * ee - fu * ff, ev * ee - fv * ff
    unit = 1.0 / sqrt(a * a + b * b)
    return True, a * unit, b * unit


@item
def _patch(scratch, count_a, count_b, origin, t1, t2, normal, reach):
    """Clip face a by the sides of face b, then by where the overlap ends; returns the corner count, the buffer that holds the patch
    and the number of fences that cut it (a, b, limit in FENCES): sides of b moved out by the margin, bevels of its sharp corners.

    Rows: u, v and the overlap.
    """
    for i in range(count_a):
        d = sub(corner_of(scratch, 0, count_a - 1 - i), origin)  # seen from b's side a's loop runs clockwise
        scratch[0, i, 0], scratch[0, i, 1], scratch[0, i, 2] = dot(d, t1), dot(d, t2), reach - dot(d, normal)
    for i in range(count_b):
        d = sub(corner_of(scratch, 1, i), origin)
        scratch[BORDER, i, 0], scratch[BORDER, i, 1] = dot(d, t1), dot(d, t2)
    count, now, fences, margin = count_a, 0, 0, MARGIN * reach
    for k in range(count_b):
        j = k + 1 if k + 1 < count_b else 0
        p, q, u, v = scratch[BORDER, k, 0], scratch[BORDER, k, 1], scratch[BORDER, j, 0], scratch[BORDER, j, 1]
        eu, ev = u - p, v - q
        # how far out the patch reaches, times the length of the side: no root where it does not, and one comparison: where borders
        # coincide round-off would choose between two
        out, square = _outmost(scratch, now, count, ev, -eu) - (ev * p - eu * q), eu * eu + ev * ev
        if out * abs(out) > margin * margin * square:
            unit = 1.0 / sqrt(square)
            a, b = ev * unit, -eu * unit
            count, now, fences = _clip(scratch, now, count, fences, a, b, a * p + b * q + margin)
        j = j + 1 if j + 1 < count_b else 0
        sharp, a, b = _bevel(eu, ev, scratch[BORDER, j, 0] - u, scratch[BORDER, j, 1] - v)
        if sharp and count > 0:
            limit = a * u + b * v + margin / sqrt(0.5 * (1.0 - SHARPEST))
            if _outmost(scratch, now, count, a, b) > limit:
                count, now, fences = _clip(scratch, now, count, fences, a, b, limit)
        if count < 3:
            return 0, now, fences
    for i in range(count):
        if scratch[now, i, 2] < 0.0:
            count = clip_polygon(scratch[now], count, scratch[1 - now], 0.0, 0.0, -1.0, 0.0)
            now = 1 - now
            break
    return count, now, fences


@device
def punch(m, d, gu, gv, modulus):
    """Of a patch with the integrals m (`moments`) whose overlap is d at its first corner and has the slopes gu, gv: energy [J] (0:
    nothing presses), its centre and the overlap there, its pressure, the pressure's force and moments by u and v about the first
    corner, area, and the second moments of the overlap over its integral as two vectors (x, y) and (0, z) (Cholesky).

    The pressure is first + 2 overlap second + quu U^2 + quv U V + qvv V^2, (U, V) from the centre, `second` by the square.
    """
    nothing = 0.0, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0), 0.0, (0.0, 0.0, 0.0)
    first, first_u, first_v = d * m[0] + gu * m[1] + gv * m[2], d * m[1] + gu * m[3] + gv * m[4], d * m[2] + gu * m[4] + gv * m[5]
    if not first > 0.0:
        return nothing
    # each root and division takes as long as a dozen products, and waits for those before it: as few as there may be stand one
    # behind the other
    unit = 1.0 / first
    u, v = first_u * unit, first_v * unit
    overlap = d + gu * u + gv * v  # the overlap's mean, weighted by itself
    second = first * overlap
    juu = d * m[3] + gu * m[6] + gv * m[7] - first_u * u
    juv = d * m[4] + gu * m[7] + gv * m[8] - first_u * v
    jvv = d * m[5] + gu * m[8] + gv * m[9] - first_v * v
    determinant = juu * jvv - juv * juv
    if not (second > 0.0 and determinant > 0.0):
        return nothing
    root, inverse, per_overlap, share = sqrt(determinant), 1.0 / determinant, 1.0 / overlap, 1.0 / juu
    trace = juu + jvv
    whole = trace + 2.0 * root
    inverse *= root
    energy = modulus * (BETA / sqrt(pi)) * overlap * sqrt(second * sqrt(0.25 * whole * inverse))
    rise = 0.5 * energy * (1.0 / whole)
    bend = 0.5 * rise * trace * inverse * inverse
    rise *= 0.5
    by_first, by_second = -energy * unit, 1.5 * energy * unit * per_overlap
    quu, quv, qvv = rise - 0.5 * bend * jvv, bend * juv, rise - 0.5 * bend * juu
    # the same as a polynomial about the first corner
    lu, lv = 2.0 * quu * u + quv * v, 2.0 * qvv * v + quv * u
    c, twice = by_first + 0.5 * (lu * u + lv * v), 2.0 * by_second
    total = c * m[0] - lu * m[1] - lv * m[2] + quu * m[3] + quv * m[4] + qvv * m[5] + twice * first
    total_u = c * m[1] - lu * m[3] - lv * m[4] + quu * m[6] + quv * m[7] + qvv * m[8] + twice * first_u
    total_v = c * m[2] - lu * m[4] - lv * m[5] + quu * m[7] + quv * m[8] + qvv * m[9] + twice * first_v
    one = sqrt(juu * unit)
    return (
        energy, (u, v, overlap), (by_first, by_second, quu, quv, qvv), (total, total_u, total_v), first * per_overlap,
        (one, juv * share * one, sqrt(determinant * unit * share)),
    )  # fmt: skip


@device
def slopes(normal_a, normal_b, t1, t2):
    """Slopes along t1 and t2 of the overlap of two faces."""
    unit = 1.0 / dot(normal_a, normal_b)
    return dot(normal_a, t1) * unit, dot(normal_a, t2) * unit


@device
def in_space(wrench, spread, origin, t1, t2, normal):
    """Force, moment and spread from their parts along t1, t2 and the normal; spread as `punch` returns it.

    wrench: force along t1, t2 and the normal, moment along them about `origin`; as a vector, it is about where `origin` is from.
    """
    fu, fv, fn, mu, mv, mn = wrench
    one, aside, two = spread
    force = along(along(scale(fn, normal), fu, t1), fv, t2)
    moment = add(cross(origin, force), along(along(scale(mn, normal), mu, t1), mv, t2))
    return force, moment, (along(scale(one, t1), aside, t2), scale(two, t2))


@device
def press_face(scratch, count_a, normal_a, count_b, normal_b, reach, overlap, modulus):
    """Energy W [J] of face a on face b (or on a half space), force on a's body and its moment about the origin, area, spread as of
    `join.pose_energy`; the patch: its corner count, the row of `scratch` that holds it, the slope of the overlap and the bounds of
    `any_rim`.

    normal_a, normal_b: outward; overlap [m]: the deepest of the dilations. W = E* BETA sqrt(A/pi) shape I2/A with A = I1^2/I2, the
    integrals of the overlap and of its square, and shape = ((T + 1)/2)^(1/4), T from the overlap's second moments: (aspect ratio +
    its inverse)/2 for a rectangle.
    """
    none = (0.0, 0.0, 0.0)
    nothing = 0.0, none, none, 0.0, (none, none), (0, 0, 0.0, FAR, FAR)
    if dot(normal_a, normal_b) > -STEEP:
        return nothing
    t1, t2 = tangents(normal_b)
    origin = corner_of(scratch, 1, 0)
    count, now, fences = _patch(scratch, count_a, count_b, origin, t1, t2, normal_b, reach)
    if count < 3:
        return nothing
    polygon = scratch[now]
    gu, gv = slopes(normal_a, normal_b, t1, t2)
    u0, v0 = polygon[0, 0], polygon[0, 1]
    energy, (u, v, d), pressure, (total, total_u, total_v), area, spread = punch(
        _moments(polygon, count), polygon[0, 2], gu, gv, modulus
    )
    if energy == 0.0:
        return nothing
    # on a: along b's normal, at (u, v) of b's plane
    wrench = 0.0, 0.0, total, total_v + v0 * total, -total_u - u0 * total, 0.0
    plane = u0 + u, v0 + v, d, gu, gv
    for k in range(fences):
        wrench = _border(scratch, now, count, k, reach, wrench, plane, pressure)
    force, moment, spread = in_space(wrench, spread, origin, t1, t2, normal_b)
    tilt = sqrt(gu * gu + gv * gv)
    second, longest = bound_rims(polygon, count, sqrt(2.0 * reach * overlap), tilt, overlap)
    return energy, force, moment, area, spread, (count, now, tilt, second, longest)


@item
def _border(scratch, now, count, k, reach, wrench, plane, pressure):
    """Add the push along the contact plane where the patch ends at fence k."""
    a, b, limit = scratch[FENCES, k, 0], scratch[FENCES, k, 1], scratch[FENCES, k, 2]
    x, y = scratch[now, count - 1, 0], scratch[now, count - 1, 1]
    near = ON * MARGIN * reach
    on = abs(a * x + b * y - limit) <= near
    for i in range(count):
        x1, y1, on1 = x, y, on
        x, y = scratch[now, i, 0], scratch[now, i, 1]
        on = abs(a * x + b * y - limit) <= near
        if on and on1:
            wrench = push_out(wrench, x1, y1, x, y, a, b, reach, plane, pressure)
    return wrench


@device
def push_out(wrench, x1, y1, x, y, a, b, reach, plane, pressure):
    """Add to a wrench the push along (a, b) on a side of the patch from (x1, y1) to (x, y): moving out, face a loses contact there.

    wrench: force along u, v and the normal, moment along them about where u and v begin. plane: u, v and overlap of the centre of
    the patch, slopes of the overlap; pressure: as of `punch`.
    """
    fu, fv, fn, mu, mv, mn = wrench
    u0, v0, d0, gu, gv = plane
    p0, p1, quu, quv, qvv = pressure
    eu, ev = x - x1, y - y1
    half = 0.5 * sqrt(eu * eu + ev * ev)
    for g in range(2):
        t = 0.5 + (g - 0.5) * 0.5773502691896257
        u, v = x1 + t * eu - u0, y1 + t * ev - v0
        overlap = d0 + gu * u + gv * v
        push = half * overlap * (p0 + p1 * overlap + quu * u * u + quv * u * v + qvv * v * v)
        height = reach - overlap
        fu, fv = fu + push * a, fv + push * b
        mu, mv = mu - push * height * b, mv + push * height * a
        mn += push * ((u + u0) * b - (v + v0) * a)
    return fu, fv, fn, mu, mv, mn

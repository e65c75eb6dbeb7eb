"""Energy of a face that presses on the other body's face: a punch with the area, the shape and the mean square of the overlap.

The overlap is linear over the patch, the part of face a (seen along b's normal) that lies over face b and below its dilated plane.
"""

from math import pi, sqrt

from dilatedem.contact.clip import clip_polygon
from dilatedem.contact.consistent.cap import corner_of
from dilatedem.jit import device, item
from dilatedem.numerics.vector import add, along, cross, dot, scale, sub, tangents

#: shape factor of a square punch, F = 2 E* BETA sqrt(A/pi) overlap (physics: rectangles 1.018, 1.045, 1.184, 1.321 at aspect ratios
#: 1, 2, 5.6, 10; the fourth root below gives 1.018, 1.048, 1.202, 1.343)
BETA = 1.018
#: rows of `scratch` that hold the fences that cut and the corners of b in the contact plane, until the caps' sides are laid there
FENCES, BORDER = 4, 5
#: distance, m, by which face b reaches beyond its own border in the clipping. Floes at one height have borders that coincide
#: exactly; round-off would choose whose border cuts the patch, and with it the side to which its pressure pushes
MARGIN = 1e-4
#: minus the cosine between two sides of face b beyond which the border moved out is cut off at their corner: 60 degrees, where it
#: reaches 2 MARGIN, as far as at any sharper one then
SHARPEST = 0.5
#: distance, m, within which a corner of the clipped patch is on the side that cut it
ON = 1e-10
#: sine of the angle of two sides of a patch, and length of one, m, below which nothing is divided by them
NEEDLE = 1e-9
#: m4, the same of the squared product of two lengths
TINY = 1e-60
#: cosine of the angle between the faces beyond which they do not press face on face
STEEP = 0.1


@device
def _moments(polygon, count):
    """Integrals of u^i v^j over a polygon about its first corner, i + j <= 3: 1, u, v, uu, uv, vv, uuu, uuv, uvv, vvv."""
    m00 = m10 = m01 = m20 = m11 = m02 = m30 = m21 = m12 = m03 = 0.0
    u0, v0 = polygon[0, 0], polygon[0, 1]
    x2, y2 = polygon[1, 0] - u0, polygon[1, 1] - v0
    for i in range(2, count):
        x1, y1 = x2, y2
        x2, y2 = polygon[i, 0] - u0, polygon[i, 1] - v0
        c = x1 * y2 - x2 * y1
        sx, sy = x1 + x2, y1 + y2
        m00 += c
        m10 += c * sx
        m01 += c * sy
        m20 += c * (sx * sx - x1 * x2)
        m11 += c * (sx * sy + x1 * y1 + x2 * y2)
        m02 += c * (sy * sy - y1 * y2)
        m30 += c * sx * (x1 * x1 + x2 * x2)
        m03 += c * sy * (y1 * y1 + y2 * y2)
        m21 += c * (x1 * x1 * (3.0 * y1 + y2) + 2.0 * x1 * x2 * sy + x2 * x2 * (y1 + 3.0 * y2))
        m12 += c * (y1 * y1 * (3.0 * x1 + x2) + 2.0 * y1 * y2 * sx + y2 * y2 * (x1 + 3.0 * x2))
    return (
        m00 * 0.5, m10 * (1.0 / 6.0), m01 * (1.0 / 6.0), m20 * (1.0 / 12.0), m11 * (1.0 / 24.0), m02 * (1.0 / 12.0),
        m30 * 0.05, m21 * (1.0 / 60.0), m12 * (1.0 / 60.0), m03 * 0.05,
    )  # fmt: skip


@device
def _shifted(m, u, v):
    """Moments as of `_moments` about a point that lies at (u, v) from where they are taken about."""
    m0, m1, m2, m3, m4, m5, m6, m7, m8, m9 = m
    n1, n2 = m1 - u * m0, m2 - v * m0
    n3, n4, n5 = m3 - u * (m1 + n1), m4 - u * m2 - v * n1, m5 - v * (m2 + n2)
    n6 = m6 - u * (3.0 * (m3 - u * m1) + u * u * m0)
    n7 = m7 - u * (2.0 * m4 - u * m2) - v * n3
    n8 = m8 - v * (2.0 * m4 - v * m1) - u * n5
    n9 = m9 - v * (3.0 * (m5 - v * m2) + v * v * m0)
    return m0, n1, n2, n3, n4, n5, n6, n7, n8, n9


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
    and the number of fences that cut it (a, b, limit in FENCES): sides of b moved out by MARGIN, bevels of its sharp corners.

    Rows: u, v and the overlap.
    """
    for i in range(count_a):
        d = sub(corner_of(scratch, 0, count_a - 1 - i), origin)  # seen from b's side a's loop runs clockwise
        scratch[0, i, 0], scratch[0, i, 1], scratch[0, i, 2] = dot(d, t1), dot(d, t2), reach - dot(d, normal)
    for i in range(count_b):
        d = sub(corner_of(scratch, 1, i), origin)
        scratch[BORDER, i, 0], scratch[BORDER, i, 1] = dot(d, t1), dot(d, t2)
    count, now, fences = count_a, 0, 0
    for k in range(count_b):
        j = k + 1 if k + 1 < count_b else 0
        p, q, u, v = scratch[BORDER, k, 0], scratch[BORDER, k, 1], scratch[BORDER, j, 0], scratch[BORDER, j, 1]
        eu, ev = u - p, v - q
        # how far out the patch reaches, times the length of the side: no root where it does not, and one comparison: where borders
        # coincide round-off would choose between two
        out, square = _outmost(scratch, now, count, ev, -eu) - (ev * p - eu * q), eu * eu + ev * ev
        if out * abs(out) > MARGIN * MARGIN * square:
            unit = 1.0 / sqrt(square)
            a, b = ev * unit, -eu * unit
            count, now, fences = _clip(scratch, now, count, fences, a, b, a * p + b * q + MARGIN)
        j = j + 1 if j + 1 < count_b else 0
        sharp, a, b = _bevel(eu, ev, scratch[BORDER, j, 0] - u, scratch[BORDER, j, 1] - v)
        if sharp and count > 0:
            limit = a * u + b * v + MARGIN / sqrt(0.5 * (1.0 - SHARPEST))
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
def _punch(per_first, second, per_second, juu, juv, jvv, determinant, modulus):
    """Energy of a patch from the integrals of its overlap (its inverse) and of its square (and its inverse), and the overlap's
    second moments about its centre with their determinant; derivatives by them: first, second, juu, juv, jvv.
    """
    # each root and division waits for those before it: as few as there may be stand one behind the other
    root, inverse = sqrt(determinant), 1.0 / determinant
    trace = juu + jvv
    whole = trace + 2.0 * root
    inverse *= root
    energy = modulus * (BETA / sqrt(pi)) * second * per_first * sqrt(second * sqrt(0.25 * whole * inverse))
    rise = 0.5 * energy * (1.0 / whole)
    bend = 0.5 * rise * trace * inverse * inverse
    rise *= 0.5
    return energy, (-energy * per_first, 1.5 * energy * per_second, rise - 0.5 * bend * jvv, bend * juv, rise - 0.5 * bend * juu)


@device
def _resultant(pressure, m, d0, gu, gv):
    """Force of the pressure first + 2 overlap second + quu u^2 + quv u v + qvv v^2, and its moments by u and v; m: `_moments`."""
    first, second, quu, quv, qvv = pressure
    c0, cu, cv = first + 2.0 * second * d0, 2.0 * second * gu, 2.0 * second * gv
    total = c0 * m[0] + cu * m[1] + cv * m[2] + quu * m[3] + quv * m[4] + qvv * m[5]
    total_u = c0 * m[1] + cu * m[3] + cv * m[4] + quu * m[6] + quv * m[7] + qvv * m[8]
    total_v = c0 * m[2] + cu * m[4] + cv * m[5] + quu * m[7] + quv * m[8] + qvv * m[9]
    return total, total_u, total_v


@item
def any_rim(polygon, count, beyond, tilt, overlap):
    """Larger bounds than those of `strongest_rim`, for a fraction of its time: every side goes on as past the sharpest corner, at
    the deepest overlap. tilt: slope of the overlap."""
    lift, last = tilt * beyond, count - 1
    eu, ev = polygon[last, 0] - polygon[last - 1, 0], polygon[last, 1] - polygon[last - 1, 1]
    u, v, d = polygon[last, 0], polygon[last, 1], min(polygon[last, 2] + lift, overlap)
    before = eu * eu + ev * ev
    longest, strongest, sharpest, deepest = 0.0, 0.0, 1.0, 0.0
    for i in range(count):
        fu, fv = polygon[i, 0] - u, polygon[i, 1] - v
        u, v, e = polygon[i, 0], polygon[i, 1], min(polygon[i, 2] + lift, overlap)
        square, area, mean = fu * fu + fv * fv, eu * fv - ev * fu, d * d + d * e + e * e
        # squared sine; two corners in one place have no angle
        sharpest = min(sharpest, area * area / max(before * square, TINY))
        longest, strongest, deepest = max(longest, square), max(strongest, square * mean * mean), max(deepest, e)
        eu, ev, before, d = fu, fv, square, e
    way = beyond / max(sqrt(sharpest), NEEDLE)
    deepest = min(deepest + tilt * way, overlap)
    return sqrt(strongest) * (1.0 / 3.0) + 2.0 * way * deepest * deepest, sqrt(longest) + 2.0 * way


@device
def strongest_rim(polygon, count, beyond, lift, overlap):
    """Bounds for any edge that presses where a patch has its rim: integral of the squared overlap along it [m3], its length [m].

    Every edge of one face that lies over the other is a side of the patch, and one that runs past the other face by no more than
    `beyond` [m] has a side of the patch beside it, whose overlap is smaller by up to `lift` [m], the tilt times that way. It
    goes on past the side's ends until it is `beyond` past the border of the other face: the farther, the smaller its angle with
    the side that it meets there. Its overlap goes on as along the side, but never above `overlap` [m].
    """
    most, longest = 0.0, 0.0
    x, y, d = polygon[count - 1, 0], polygon[count - 1, 1], min(polygon[count - 1, 2] + lift, overlap)
    au, av = _direction(x - polygon[count - 2, 0], y - polygon[count - 2, 1])[:2]
    bu, bv, length = _direction(polygon[0, 0] - x, polygon[0, 1] - y)
    sine = abs(au * bv - av * bu)
    for i in range(count):
        e = min(polygon[i, 2] + lift, overlap)
        j = i + 1 if i + 1 < count else 0
        cu, cv, following = _direction(polygon[j, 0] - polygon[i, 0], polygon[j, 1] - polygon[i, 1])
        sine_after = abs(bu * cv - bv * cu)
        second, further = length * (d * d + d * e + e * e) / 3.0, 0.0
        for end in range(2):
            start, fall, sharp = (d, d - e, sine) if end == 0 else (e, e - d, sine_after)
            way = beyond / max(sharp, NEEDLE)
            if fall < 0.0:  # less and less, and then nothing
                way = min(way, -start * length / fall)
                deepest = start
            else:
                deepest = min(overlap, start + fall * way / max(length, NEEDLE))
            second += way * deepest * deepest
            further += way
        most, longest = max(most, second), max(longest, length + further)
        d, bu, bv, length, sine = e, cu, cv, following, sine_after
    return most, longest


@device
def _direction(u, v):
    """Unit vector and length; no direction for two corners in one place."""
    length = sqrt(u * u + v * v)
    if length == 0.0:
        return 0.0, 0.0, 0.0
    return u / length, v / length, length


@item
def press_face(scratch, count_a, normal_a, count_b, normal_b, reach, modulus):
    """Energy W [J] of face a on face b (or on a half space), force on a's body and its moment about the origin, area, spread as of
    `join.pose_energy`; the patch: its corner count, the row of `scratch` that holds it and the slope of the overlap.

    normal_a, normal_b: outward. W = E* BETA sqrt(A/pi) shape I2/A with A = I1^2/I2, the integrals of the overlap and of its square,
    and shape = ((T + 1)/2)^(1/4), T from the overlap's second moments: (aspect ratio + its inverse)/2 for a rectangle.
    """
    none = (0.0, 0.0, 0.0)
    nothing = 0.0, none, none, 0.0, (none, none), (0, 0, 0.0)
    slope = dot(normal_a, normal_b)
    if -slope < STEEP:
        return nothing
    t1, t2 = tangents(normal_b)
    origin = corner_of(scratch, 1, 0)
    count, now, fences = _patch(scratch, count_a, count_b, origin, t1, t2, normal_b, reach)
    if count < 3:
        return nothing
    polygon = scratch[now]
    # the overlap is linear: its slopes from a's plane
    slope = 1.0 / slope
    gu, gv = dot(normal_a, t1) * slope, dot(normal_a, t2) * slope
    d0 = polygon[0, 2]
    m = _moments(polygon, count)
    first = d0 * m[0] + gu * m[1] + gv * m[2]
    if not first > 0.0:
        return nothing
    unit = 1.0 / first  # one division for many: each takes as long as a dozen products, and all else waits for it
    du, dv = (d0 * m[1] + gu * m[3] + gv * m[4]) * unit, (d0 * m[2] + gu * m[4] + gv * m[5]) * unit
    m = _shifted(m, du, dv)
    d0 += gu * du + gv * dv
    u0, v0 = polygon[0, 0] + du, polygon[0, 1] + dv
    juu = d0 * m[3] + gu * m[6] + gv * m[7]
    juv = d0 * m[4] + gu * m[7] + gv * m[8]
    jvv = d0 * m[5] + gu * m[8] + gv * m[9]
    second = d0 * d0 * m[0] + 2.0 * d0 * (gu * m[1] + gv * m[2]) + gu * gu * m[3] + 2.0 * gu * gv * m[4] + gv * gv * m[5]
    determinant = juu * jvv - juv * juv
    if not (second > 0.0 and determinant > 0.0):
        return nothing
    per_second = 1.0 / second
    energy, pressure = _punch(unit, second, per_second, juu, juv, jvv, determinant, modulus)
    total, total_u, total_v = _resultant(pressure, m, d0, gu, gv)
    # on a: along b's normal, at (u, v) of b's plane
    wrench = 0.0, 0.0, total_v + v0 * total, -total_u - u0 * total, 0.0
    for k in range(fences):
        wrench = _border(scratch, now, count, k, reach, wrench, (u0, v0, d0, gu, gv), pressure)
    fu, fv, mu, mv, mn = wrench
    force = along(along(scale(total, normal_b), fu, t1), fv, t2)
    moment = add(cross(origin, force), along(along(scale(mn, normal_b), mu, t1), mv, t2))
    # the second moments as squares of two vectors (Cholesky)
    one, share = sqrt(juu * unit), 1.0 / juu
    spread = along(scale(one, t1), juv * share * one, t2), scale(sqrt(determinant * unit * share), t2)
    return energy, force, moment, first * first * per_second, spread, (count, now, sqrt(gu * gu + gv * gv))


@item
def _border(scratch, now, count, k, reach, wrench, plane, pressure):
    """Add the push along the contact plane where the patch ends at fence k: moving out, face a loses contact there.

    wrench: force along u and v, moment about b's first corner along u, v and the normal.
    """
    fu, fv, mu, mv, mn = wrench
    u0, v0, d0, gu, gv = plane
    p0, p1, quu, quv, qvv = pressure
    a, b, limit = scratch[FENCES, k, 0], scratch[FENCES, k, 1], scratch[FENCES, k, 2]
    x, y = scratch[now, count - 1, 0], scratch[now, count - 1, 1]
    on = abs(a * x + b * y - limit) <= ON
    for i in range(count):
        x1, y1, on1 = x, y, on
        x, y = scratch[now, i, 0], scratch[now, i, 1]
        on = abs(a * x + b * y - limit) <= ON
        if not (on and on1):
            continue
        eu, ev = x - x1, y - y1
        length = sqrt(eu * eu + ev * ev)
        for g in range(2):
            t = 0.5 + (g - 0.5) * 0.5773502691896257
            u, v = x1 + t * eu - u0, y1 + t * ev - v0
            overlap = d0 + gu * u + gv * v
            push = 0.5 * length * overlap * (p0 + p1 * overlap + quu * u * u + quv * u * v + qvv * v * v)
            height = reach - overlap
            fu, fv = fu + push * a, fv + push * b
            mu, mv = mu - push * height * b, mv + push * height * a
            mn += push * ((u + u0) * b - (v + v0) * a)
    return fu, fv, mu, mv, mn

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
#: cosine of the angle between the faces beyond which they do not press face on face
STEEP = 0.1


@device
def _centre(polygon, count, d0, gu, gv):
    """Centre of a linear overlap d0 + gu u + gv v over a polygon, and its integral; about the polygon's first corner."""
    m00 = m10 = m01 = m20 = m11 = m02 = 0.0
    x2, y2 = polygon[1, 0] - polygon[0, 0], polygon[1, 1] - polygon[0, 1]
    for i in range(2, count):
        x1, y1 = x2, y2
        x2, y2 = polygon[i, 0] - polygon[0, 0], polygon[i, 1] - polygon[0, 1]
        c = x1 * y2 - x2 * y1
        sx, sy = x1 + x2, y1 + y2
        m00 += c
        m10 += c * sx
        m01 += c * sy
        m20 += c * (sx * sx - x1 * x2)
        m11 += c * (sx * sy + x1 * y1 + x2 * y2)
        m02 += c * (sy * sy - y1 * y2)
    first = d0 * m00 / 2.0 + (gu * m10 + gv * m01) / 6.0
    if not first > 0.0:
        return 0.0, 0.0, 0.0
    u = (d0 * m10 / 6.0 + gu * m20 / 12.0 + gv * m11 / 24.0) / first
    v = (d0 * m01 / 6.0 + gu * m11 / 24.0 + gv * m02 / 12.0) / first
    return first, u, v


@device
def _moments(polygon, count, u0, v0):
    """Integrals of u^i v^j over a polygon about (u0, v0), i + j <= 3, in the order 1, u, v, uu, uv, vv, uuu, uuv, uvv, vvv."""
    m00 = m10 = m01 = m20 = m11 = m02 = m30 = m21 = m12 = m03 = 0.0
    x2, y2 = polygon[count - 1, 0] - u0, polygon[count - 1, 1] - v0
    for i in range(count):
        x1, y1 = x2, y2
        x2, y2 = polygon[i, 0] - u0, polygon[i, 1] - v0
        c = x1 * y2 - x2 * y1
        sx, sy = x1 + x2, y1 + y2
        xx, yy = x1 * x1 + x1 * x2 + x2 * x2, y1 * y1 + y1 * y2 + y2 * y2
        m00 += c
        m10 += c * sx
        m01 += c * sy
        m20 += c * xx
        m11 += c * (sx * sy + x1 * y1 + x2 * y2)
        m02 += c * yy
        m30 += c * sx * (x1 * x1 + x2 * x2)
        m03 += c * sy * (y1 * y1 + y2 * y2)
        m21 += c * (x1 * x1 * (3.0 * y1 + y2) + 2.0 * x1 * x2 * sy + x2 * x2 * (y1 + 3.0 * y2))
        m12 += c * (y1 * y1 * (3.0 * x1 + x2) + 2.0 * y1 * y2 * sx + y2 * y2 * (x1 + 3.0 * x2))
    return (
        m00 / 2.0, m10 / 6.0, m01 / 6.0, m20 / 12.0, m11 / 24.0, m02 / 12.0, m30 / 20.0, m21 / 60.0, m12 / 60.0, m03 / 20.0,
    )  # fmt: skip


@device
def _fence(scratch, k, count, origin, t1, t2, normal):
    """Side k of face b, moved out by MARGIN, as a u + b v = limit with the unit vector (a, b) pointing out."""
    p = corner_of(scratch, 1, k)
    e = sub(corner_of(scratch, 1, k + 1 if k + 1 < count else 0), p)
    out, d = cross(e, normal), sub(p, origin)
    a, b = dot(out, t1), dot(out, t2)
    unit = 1.0 / sqrt(a * a + b * b)
    a, b = a * unit, b * unit
    return a, b, a * dot(d, t1) + b * dot(d, t2) + MARGIN


@device
def _bevel(scratch, k, count, origin, t1, t2):
    """Whether the corner at the end of side k of face b is sharp, and the fence across it, as `_fence` gives it."""
    p, q = corner_of(scratch, 1, k), corner_of(scratch, 1, k + 1 if k + 1 < count else 0)
    e, f = sub(q, p), sub(corner_of(scratch, 1, (k + 2) % count), q)
    c = dot(e, f)
    if c >= 0.0 or c * c <= SHARPEST * SHARPEST * dot(e, e) * dot(f, f):
        return False, 0.0, 0.0, 0.0
    out = sub(scale(1.0 / sqrt(dot(e, e)), e), scale(1.0 / sqrt(dot(f, f)), f))
    unit = 1.0 / sqrt(dot(out, out))
    a, b, d = unit * dot(out, t1), unit * dot(out, t2), sub(q, origin)
    return True, a, b, a * dot(d, t1) + b * dot(d, t2) + MARGIN / sqrt(0.5 * (1.0 - SHARPEST))


@device
def _cut(scratch, now, count, a, b, limit):
    """Clip the patch in buffer `now` by a u + b v <= limit; returns its corner count, its buffer, and whether that cut anything."""
    for i in range(count):
        if a * scratch[now, i, 0] + b * scratch[now, i, 1] > limit:
            return clip_polygon(scratch[now], count, scratch[1 - now], a, b, 0.0, limit), 1 - now, True
    return count, now, False


@item
def _patch(scratch, count_a, count_b, origin, t1, t2, normal, reach):
    """Clip face a by the sides of face b, then by where the overlap ends; returns the corner count, the buffer that holds it and
    the sides of b that cut, as bits, and the sharp corners.

    Rows: u, v and the overlap.
    """
    for i in range(count_a):
        d = sub(corner_of(scratch, 0, count_a - 1 - i), origin)  # seen from b's side a's loop runs clockwise
        scratch[0, i, 0], scratch[0, i, 1], scratch[0, i, 2] = dot(d, t1), dot(d, t2), reach - dot(d, normal)
    count, now, cut, bevelled = count_a, 0, 0, 0
    for k in range(count_b):
        a, b, limit = _fence(scratch, k, count_b, origin, t1, t2, normal)
        count, now, outside = _cut(scratch, now, count, a, b, limit)
        if outside:
            cut |= 1 << (k & 63)
        sharp, a, b, limit = _bevel(scratch, k, count_b, origin, t1, t2)
        if sharp:
            count, now, outside = _cut(scratch, now, count, a, b, limit)
            if outside:
                bevelled |= 1 << (k & 63)
        if count < 3:
            return 0, now, cut, bevelled
    for i in range(count):
        if scratch[now, i, 2] < 0.0:
            count = clip_polygon(scratch[now], count, scratch[1 - now], 0.0, 0.0, -1.0, 0.0)
            now = 1 - now
            break
    return count, now, cut, bevelled


@device
def _punch(first, second, juu, juv, jvv, modulus):
    """Energy of a patch from the integrals of its overlap and of its square and the overlap's second moments about its centre;
    derivatives by them: first, second, juu, juv, jvv.
    """
    trace, determinant = juu + jvv, juu * jvv - juv * juv
    shape = 0.5 * trace / sqrt(determinant)
    energy = modulus * BETA / sqrt(pi) * sqrt(sqrt(0.5 * (shape + 1.0))) * second * sqrt(second) / first
    rise = 0.25 * energy * shape / (shape + 1.0)
    quu, qvv = rise * (1.0 / trace - 0.5 * jvv / determinant), rise * (1.0 / trace - 0.5 * juu / determinant)
    return energy, (-energy / first, 1.5 * energy / second, quu, rise * juv / determinant, qvv)


@device
def _resultant(pressure, m, d0, gu, gv):
    """Force of the pressure first + 2 overlap second + quu u^2 + quv u v + qvv v^2, and its moments by u and v; m: `_moments`."""
    first, second, quu, quv, qvv = pressure
    c0, cu, cv = first + 2.0 * second * d0, 2.0 * second * gu, 2.0 * second * gv
    total = c0 * m[0] + cu * m[1] + cv * m[2] + quu * m[3] + quv * m[4] + qvv * m[5]
    total_u = c0 * m[1] + cu * m[3] + cv * m[4] + quu * m[6] + quv * m[7] + qvv * m[8]
    total_v = c0 * m[2] + cu * m[4] + cv * m[5] + quu * m[7] + quv * m[8] + qvv * m[9]
    return total, total_u, total_v


@device
def _strongest_rim(polygon, count, beyond, lift, overlap):
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
def press_face(scratch, count_a, normal_a, count_b, normal_b, reach, overlap, modulus):
    """Energy W [J] of face a on face b (or on a half space), force on a's body and its moment about the origin, area,
    what its rims can press as edges (see `_strongest_rim`), spread as of `join.pose_energy`.

    normal_a, normal_b: outward. W = E* BETA sqrt(A/pi) shape I2/A with A = I1^2/I2, the integrals of the overlap and of its square,
    and shape = ((T + 1)/2)^(1/4), T from the overlap's second moments: (aspect ratio + its inverse)/2 for a rectangle.
    """
    none = (0.0, 0.0, 0.0)
    if -dot(normal_a, normal_b) < STEEP:
        return 0.0, none, none, 0.0, (0.0, 0.0), (none, none)
    t1, t2 = tangents(normal_b)
    origin = corner_of(scratch, 1, 0)
    count, now, cut, bevelled = _patch(scratch, count_a, count_b, origin, t1, t2, normal_b, reach)
    if count < 3:
        return 0.0, none, none, 0.0, (0.0, 0.0), (none, none)
    polygon = scratch[now]
    # the overlap is linear: its slopes from a's plane
    slope = dot(normal_a, normal_b)
    gu, gv = dot(normal_a, t1) / slope, dot(normal_a, t2) / slope
    d0 = polygon[0, 2]
    first, du, dv = _centre(polygon, count, d0, gu, gv)
    if first == 0.0:
        return 0.0, none, none, 0.0, (0.0, 0.0), (none, none)
    d0 += gu * du + gv * dv
    u0, v0 = polygon[0, 0] + du, polygon[0, 1] + dv
    beyond = sqrt(2.0 * reach * overlap)
    rims = _strongest_rim(polygon, count, beyond, sqrt(gu * gu + gv * gv) * beyond, overlap)
    m = _moments(polygon, count, u0, v0)
    first = d0 * m[0] + gu * m[1] + gv * m[2]
    second = d0 * d0 * m[0] + 2.0 * d0 * (gu * m[1] + gv * m[2]) + gu * gu * m[3] + 2.0 * gu * gv * m[4] + gv * gv * m[5]
    juu = d0 * m[3] + gu * m[6] + gv * m[7]
    juv = d0 * m[4] + gu * m[7] + gv * m[8]
    jvv = d0 * m[5] + gu * m[8] + gv * m[9]
    if not (second > 0.0 and juu * jvv - juv * juv > 0.0):
        return 0.0, none, none, 0.0, (0.0, 0.0), (none, none)
    energy, pressure = _punch(first, second, juu, juv, jvv, modulus)
    total, total_u, total_v = _resultant(pressure, m, d0, gu, gv)
    centre = add(origin, along(scale(u0, t1), v0, t2))
    # on a: along b's normal, at (u, v) of b's plane
    force = scale(total, normal_b)
    moment = add(cross(centre, force), cross(along(scale(total_u, t1), total_v, t2), normal_b))
    plane = u0, v0, d0, gu, gv
    for k in range(count_b):
        if cut >> (k & 63) & 1:
            fence = _fence(scratch, k, count_b, origin, t1, t2, normal_b)
            force, moment = _border(polygon, count, fence, origin, t1, t2, normal_b, reach, force, moment, plane, pressure)
        if bevelled >> (k & 63) & 1:
            sharp, across, along_it, limit = _bevel(scratch, k, count_b, origin, t1, t2)
            if sharp:
                fence = across, along_it, limit
                force, moment = _border(polygon, count, fence, origin, t1, t2, normal_b, reach, force, moment, plane, pressure)
    # the second moments as squares of two vectors (Cholesky)
    one = sqrt(juu / first)
    two = juv / (first * one)
    spread = along(scale(one, t1), two, t2), scale(sqrt(max(jvv / first - two * two, 0.0)), t2)
    return energy, force, moment, first * first / second, rims, spread


@item
def _border(polygon, count, fence, origin, t1, t2, normal, reach, force, moment, plane, pressure):
    """Add the push along the contact plane where the patch ends at a side of face b: moving out, face a loses contact there."""
    u0, v0, d0, gu, gv = plane
    p0, p1, quu, quv, qvv = pressure
    a, b, limit = fence
    out = along(scale(a, t1), b, t2)
    for i in range(count):
        j = i + 1 if i + 1 < count else 0
        if abs(a * polygon[i, 0] + b * polygon[i, 1] - limit) > ON or abs(a * polygon[j, 0] + b * polygon[j, 1] - limit) > ON:
            continue
        eu, ev = polygon[j, 0] - polygon[i, 0], polygon[j, 1] - polygon[i, 1]
        length = sqrt(eu * eu + ev * ev)
        for g in range(2):
            t = 0.5 + (g - 0.5) * 0.5773502691896257
            u, v = polygon[i, 0] + t * eu - u0, polygon[i, 1] + t * ev - v0
            overlap = d0 + gu * u + gv * v
            push = 0.5 * length * overlap * (p0 + p1 * overlap + quu * u * u + quv * u * v + qvv * v * v)
            at = along(along(add(origin, scale(u + u0, t1)), v + v0, t2), reach - overlap, normal)
            sideways = scale(push, out)
            force, moment = add(force, sideways), add(moment, cross(at, sideways))
    return force, moment

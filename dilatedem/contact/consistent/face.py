"""Energy of a face that presses on the other body's face: a punch with the area, the shape and the mean square of the overlap.

The overlap is linear over the patch, the part of face a (seen along b's normal) that lies over face b and below its dilated plane.
"""

from math import pi, sqrt

from dilatedem.contact.clip import clip_polygon
from dilatedem.contact.consistent.cap import corner_of, side_of
from dilatedem.jit import device, item
from dilatedem.numerics.vector import add, along, cross, dot, scale, sub, tangents

#: shape factor of a square punch, F = 2 E* BETA sqrt(A/pi) overlap (physics: rectangles 1.018, 1.045, 1.184, 1.321 at aspect ratios
#: 1, 2, 5.6, 10; the fourth root below gives 1.018, 1.048, 1.202, 1.343)
BETA = 1.018
#: distance, m, by which face b reaches beyond its own border in the clipping. Floes at one height have borders that coincide
#: exactly; round-off would choose whose border cuts the patch, and with it the side to which its pressure pushes
MARGIN = 1e-4
#: cosine of the angle between the faces beyond which they do not press face on face
STEEP = 0.1


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


@item
def _patch(scratch, count_a, count_b, origin, t1, t2, normal, reach):
    """Clip face a by the sides of face b, then by where the overlap ends; returns the corner count and the buffer that holds it.

    Rows: u, v and the overlap.
    """
    for i in range(count_a):
        d = sub(corner_of(scratch, 0, count_a - 1 - i), origin)  # seen from b's side a's loop runs clockwise
        scratch[0, i, 0], scratch[0, i, 1], scratch[0, i, 2] = dot(d, t1), dot(d, t2), reach - dot(d, normal)
    count, now = count_a, 0
    for k in range(count_b):
        out = cross(side_of(scratch, 1, k), normal)
        a, b = dot(out, t1), dot(out, t2)
        limit = dot(sub(corner_of(scratch, 1, k), origin), out) + MARGIN
        outside = False
        for i in range(count):
            if a * scratch[now, i, 0] + b * scratch[now, i, 1] > limit:
                outside = True
                break
        if outside:
            count = clip_polygon(scratch[now], count, scratch[1 - now], a, b, 0.0, limit)
            now = 1 - now
            if count < 3:
                return 0, now
    for i in range(count):
        if scratch[now, i, 2] < 0.0:
            count = clip_polygon(scratch[now], count, scratch[1 - now], 0.0, 0.0, -1.0, 0.0)
            now = 1 - now
            break
    return count, now


@item
def press_face(scratch, count_a, normal_a, count_b, normal_b, reach, modulus):
    """Energy W [J] of face a on face b (or on a half space), force on a's body and its moment about the origin, area, mean overlap.

    normal_a, normal_b: outward. W = E* BETA sqrt(A/pi) shape I2/A with A = I1^2/I2, the integrals of the overlap and of its square,
    and shape = ((T + 1)/2)^(1/4), T from the overlap's second moments: (aspect ratio + its inverse)/2 for a rectangle.
    """
    none = (0.0, 0.0, 0.0)
    if -dot(normal_a, normal_b) < STEEP:
        return 0.0, none, none, 0.0, 0.0
    t1, t2 = tangents(normal_b)
    origin = corner_of(scratch, 1, 0)
    count, now = _patch(scratch, count_a, count_b, origin, t1, t2, normal_b, reach)
    if count < 3:
        return 0.0, none, none, 0.0, 0.0
    polygon = scratch[now]
    # the overlap is linear: its slopes from a's plane
    slope = dot(normal_a, normal_b)
    gu, gv = dot(normal_a, t1) / slope, dot(normal_a, t2) / slope
    u0 = v0 = 0.0
    for i in range(count):
        u0 += polygon[i, 0]
        v0 += polygon[i, 1]
    u0, v0 = u0 / count, v0 / count
    d0 = polygon[0, 2] + gu * (u0 - polygon[0, 0]) + gv * (v0 - polygon[0, 1])
    m = _moments(polygon, count, u0, v0)
    first = d0 * m[0] + gu * m[1] + gv * m[2]
    if not first > 0.0:
        return 0.0, none, none, 0.0, 0.0
    # about the centre of the overlap
    du, dv = (d0 * m[1] + gu * m[3] + gv * m[4]) / first, (d0 * m[2] + gu * m[4] + gv * m[5]) / first
    d0 += gu * du + gv * dv
    u0, v0 = u0 + du, v0 + dv
    m = _moments(polygon, count, u0, v0)
    first = d0 * m[0] + gu * m[1] + gv * m[2]
    second = d0 * d0 * m[0] + 2.0 * d0 * (gu * m[1] + gv * m[2]) + gu * gu * m[3] + 2.0 * gu * gv * m[4] + gv * gv * m[5]
    juu = d0 * m[3] + gu * m[6] + gv * m[7]
    juv = d0 * m[4] + gu * m[7] + gv * m[8]
    jvv = d0 * m[5] + gu * m[8] + gv * m[9]
    trace, determinant = juu + jvv, juu * jvv - juv * juv
    if not (second > 0.0 and determinant > 0.0):
        return 0.0, none, none, 0.0, 0.0
    shape = 0.5 * trace / sqrt(determinant)
    energy = modulus * BETA / sqrt(pi) * sqrt(sqrt(0.5 * (shape + 1.0))) * second * sqrt(second) / first
    # pressure: first + 2 overlap second + quadratic form, as derivatives of the energy
    p0, p1 = -energy / first, 1.5 * energy / second
    rise = 0.25 * energy * shape / (shape + 1.0)
    quu, qvv = rise * (1.0 / trace - 0.5 * jvv / determinant), rise * (1.0 / trace - 0.5 * juu / determinant)
    quv = rise * juv / determinant
    c0, cu, cv = p0 + 2.0 * p1 * d0, 2.0 * p1 * gu, 2.0 * p1 * gv
    total = c0 * m[0] + cu * m[1] + cv * m[2] + quu * m[3] + quv * m[4] + qvv * m[5]
    total_u = c0 * m[1] + cu * m[3] + cv * m[4] + quu * m[6] + quv * m[7] + qvv * m[8]
    total_v = c0 * m[2] + cu * m[4] + cv * m[5] + quu * m[7] + quv * m[8] + qvv * m[9]
    centre = add(origin, along(scale(u0, t1), v0, t2))
    # on a: along b's normal, at (u, v) of b's plane
    force = scale(total, normal_b)
    moment = add(cross(centre, force), cross(along(scale(total_u, t1), total_v, t2), normal_b))
    plane, pressure = (u0, v0, d0, gu, gv), (p0, p1, quu, quv, qvv)
    for k in range(count_b):
        force, moment = _border(scratch, polygon, count, k, origin, t1, t2, normal_b, reach, force, moment, plane, pressure)
    return energy, force, moment, first * first / second, second / first


@item
def _border(scratch, polygon, count, k, origin, t1, t2, normal, reach, force, moment, plane, pressure):
    """Add the push along the contact plane where the patch ends at side k of face b: moving out, face a loses contact there."""
    u0, v0, d0, gu, gv = plane
    p0, p1, quu, quv, qvv = pressure
    out = cross(side_of(scratch, 1, k), normal)
    a, b = dot(out, t1), dot(out, t2)
    limit = dot(sub(corner_of(scratch, 1, k), origin), out) + MARGIN
    for i in range(count):
        j = i + 1 if i + 1 < count else 0
        if (
            abs(a * polygon[i, 0] + b * polygon[i, 1] - limit) > 1e-10
            or abs(a * polygon[j, 0] + b * polygon[j, 1] - limit) > 1e-10
        ):
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

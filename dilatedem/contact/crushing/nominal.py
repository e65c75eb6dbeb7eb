"""The nominal area of a contact: the cross-section that two bodies would share, had one been moved into the other by some depth.

Both bodies are seen along the normal of the contact. Every face of a core bounds in the contact plane what of its body lies less
than the depth under its tip: a half plane that moves out as the depth grows, first round the dilation (its rounded edge), then down
the face. Where both bodies recede in one direction, their depths add up there. The common part of all half planes is the area, less
what rounded corners lack of sharp ones. It is continuous in pose and depth, knows no contact modes, and grows with the depth.

Exact for a flat side on a pile, a wedge, a sphere and a face on a flat. Walls, faces almost at right angles to the contact plane,
bound it where the outer size of the body ends: the height of a floe's side is its thickness.
"""

from math import inf, sqrt

from dilatedem.contact.clip import reaches_past
from dilatedem.contact.crushing.section import ASKEW, DIRECTION, EDGE, OFFSET, cut, measure
from dilatedem.contact.search.closest import farthest_vertex
from dilatedem.contact.search.cone import radius_at
from dilatedem.geometry.shapes import TaperedShapes
from dilatedem.jit import by_type, device
from dilatedem.numerics.vector import add, along, cross, dot, load, norm, scale, sub, tangents
from dilatedem.state.storage import MOST_CORNERS

#: cosine of the angle to the normal below which a face looks away too far to bound anything
AWAY = -0.5
#: sine of that angle below which a face lies flush
FLUSH = 1e-12
#: cosines of that angle between which a face becomes a wall: 84 and 70 degrees
WALL, SLOPE = 0.1, 0.35
#: Newton steps for where two bodies that recede in one direction end: three are exact to 1e-5
STEPS = 3
#: half the side of the square that is cut, in units of the floating body's reach
WIDE = 4.0


@device
def _slope(tangent):
    """Cosine and sine of an angle by its tangent, which may be infinite."""
    if tangent == inf:
        return 0.0, 1.0
    cosine = 1.0 / sqrt(1.0 + tangent * tangent)
    return cosine, tangent * cosine


@device
def width_at(depth, tangent, radius):
    """How far [m] a rounded edge reaches out at a depth under its tip, and by how much more per depth; radius: of the rounding [m];
    tangent: of the slope that follows it."""
    if depth <= 0.0:
        return 0.0, inf
    cosine, sine = _slope(tangent)
    turned = radius * (1.0 - cosine)
    if depth < turned:
        width = sqrt(depth * (2.0 * radius - depth))
        return width, (radius - depth) / width
    if cosine == 0.0:
        return radius, 0.0
    return radius * sine + (depth - turned) / tangent, 1.0 / tangent


@device
def depth_at(width, tangent, radius):
    """The inverse of `width_at`: how deep under its tip a rounded edge is so far out, and its slope there."""
    if width <= 0.0:
        return 0.0, 0.0
    cosine, sine = _slope(tangent)
    if width < radius * sine:
        root = sqrt(radius * radius - width * width)
        return width * width / (radius + root), width / root
    if cosine == 0.0:
        return inf, inf
    return radius * (1.0 - cosine) + (width - radius * sine) * tangent, tangent


@device
def _note(scratch, which, count, u, v, share, start, tangent):
    """Note a half plane of body `which`, 0 or 1; returns the number of them."""
    scratch[DIRECTION + which, count, 0], scratch[DIRECTION + which, count, 1], scratch[DIRECTION + which, count, 2] = u, v, share
    scratch[EDGE + which, count, 0], scratch[EDGE + which, count, 1] = start, tangent
    return count + 1


@device
def _bounds(vertex, face_normal, shapes, body, tip, normal, t1, t2, scratch, which):
    """Note the half planes of a body; returns their number.

    tip: the point of the core farthest along `normal` (unit, out of the body), from the body's centroid.
    """
    count, first, last = 0, shapes.face_start[body], shapes.face_start[body + 1]
    for f in range(first, last):
        face = load(face_normal, f)
        cosine, sine = dot(face, normal), norm(cross(face, normal))
        if cosine > AWAY and sine > FLUSH:
            unit = 1.0 / sine
            start = unit * dot(face, sub(load(vertex, shapes.loop[shapes.loop_start[f]]), tip))
            share = min(max((cosine - WALL) * (1.0 / (SLOPE - WALL)), 0.0), 1.0)
            count = _note(
                scratch, which, count, unit * dot(face, t1), unit * dot(face, t2), share * share * (3.0 - 2.0 * share),
                max(start, 0.0), sine / cosine if cosine > 0.0 else inf,
            )  # fmt: skip
    if last - first == 2:
        return _flat_bounds(vertex, face_normal, shapes, first, tip, t1, t2, scratch, which, count)
    if last == first:
        return _round_bounds(vertex, shapes, body, tip, normal, t1, t2, scratch, which)
    return count


@device
def _flat_bounds(vertex, face_normal, shapes, face, tip, t1, t2, scratch, which, count):
    """The half planes at the edges of a flat polygon, which are walls."""
    first, last = shapes.loop_start[face], shapes.loop_start[face + 1]
    for i in range(first, last):
        p, q = load(vertex, shapes.loop[i]), load(vertex, shapes.loop[i + 1 if i + 1 < last else first])
        out = cross(sub(q, p), load(face_normal, face))
        u, v = dot(out, t1), dot(out, t2)
        length = sqrt(u * u + v * v)
        if length > 0.0:
            away = sub(p, tip)
            start = (u * dot(away, t1) + v * dot(away, t2)) / length
            count = _note(scratch, which, count, u / length, v / length, 0.0, max(start, 0.0), inf)
    return count


@device
def _never_tapers(shapes, body):
    return False


@device
def _may_taper(shapes, body):
    """Whether a body is a cone, whose side lies flush with the contact plane though its axis does not."""
    return shapes.taper[body] != 0.0


_tapers = by_type(_never_tapers, {TaperedShapes: _may_taper})


@device
def _round_bounds(vertex, shapes, body, tip, normal, t1, t2, scratch, which):
    """The half planes of a body without faces: a sphere, a capsule, such as a pile is, or a cone."""
    first, last, count = shapes.vertex_start[body], shapes.vertex_start[body + 1] - 1, 0
    axis = sub(load(vertex, last), load(vertex, first))
    u, v = dot(axis, t1), dot(axis, t2)
    length = sqrt(u * u + v * v)
    u, v = (u / length, v / length) if length > FLUSH else (1.0, 0.0)
    for turn in range(2):
        u, v = -u, -v
        count = _note(scratch, which, count, -v, u, 1.0, 0.0, inf)
        away = sub(load(vertex, first if turn == 0 else last), tip)
        start, fall = max(u * dot(away, t1) + v * dot(away, t2), 0.0), -dot(away, normal)
        if fall > FLUSH * start and start > 0.0 and not _tapers(shapes, body):  # down the side that slopes away from the tip
            count = _note(scratch, which, count, u, v, 1.0, 0.0, fall / start)
        count = _note(scratch, which, count, u, v, 1.0, start, inf)
    return count


@device
def _together(cosine):
    """0..1: how much of the one body recedes where the other does, by the cosine of their directions: at an angle it is flat
    farther along."""
    if cosine <= 0.0 or 1.0 - cosine * cosine >= ASKEW * ASKEW:
        return 0.0
    left = 1.0 - (1.0 - cosine * cosine) / (ASKEW * ASKEW)
    return left * left


@device
def _reach_alone(scratch, which, count, depth, radius):
    """Write how far the half planes of a body would reach at a depth [m], were the other flat, and how fast they would move."""
    for k in range(count):
        start, share = scratch[EDGE + which, k, 0], scratch[DIRECTION + which, k, 2]
        width, rate = radius, 0.0
        if share > 0.0:
            width, rate = width_at(depth, scratch[EDGE + which, k, 1], radius)
        scratch[OFFSET + which, k, 0], scratch[OFFSET + which, k, 1] = width, rate
        scratch[EDGE + which, k, 2] = start + width


@device
def _under(scratch, other, others, u, v, reach, alone, their):
    """How deep under its tip the other body is at `reach` [m] in a direction, and its slope there; `alone`: reach of the half plane
    that asks, by itself.

    Of two bodies that recede together, the narrower one says where they end. The wider heeds it the less, the wider it is: a
    face that lies flush bounds nothing.
    """
    deepest, slope = 0.0, 0.0
    for m in range(others):
        c = u * scratch[DIRECTION + other, m, 0] + v * scratch[DIRECTION + other, m, 1]
        heeded = scratch[DIRECTION + other, m, 2] * _together(c)
        if heeded > 0.0:
            if scratch[EDGE + other, m, 2] < alone:
                heeded *= scratch[EDGE + other, m, 2] / alone
            g, steep = depth_at(c * reach - scratch[EDGE + other, m, 0], scratch[EDGE + other, m, 1], their)
            if heeded * g > deepest:
                deepest, slope = heeded * g, heeded * steep * c
    return deepest, slope


@device
def _recede(scratch, which, count, others, depth, radius, their):
    """Write where the half planes of a body stand at a depth [m], how fast they move with it, and how they are rounded in plan.

    radius, their: of the dilation of this body and of the other, whose half planes are `others`. Where the other recedes in the
    direction of a half plane, too, its offset y solves f(y) + g(y) = depth, f and g the depths of the two bodies there: from
    beyond, by Newton's method on a convex function.
    """
    for k in range(count):
        u, v, share = scratch[DIRECTION + which, k, 0], scratch[DIRECTION + which, k, 1], scratch[DIRECTION + which, k, 2]
        start, tangent = scratch[EDGE + which, k, 0], scratch[EDGE + which, k, 1]
        width, rate = scratch[OFFSET + which, k, 0], scratch[OFFSET + which, k, 1]
        if share > 0.0:
            for _ in range(STEPS):
                deepest, slope = _under(scratch, 1 - which, others, u, v, start + width, scratch[EDGE + which, k, 2], their)
                if deepest == 0.0 or deepest == inf:  # the other is flat there, or ends before
                    break
                own, rise = depth_at(width, tangent, radius)
                rate = 1.0 / (rise + slope)
                width = max(width - (own + deepest - depth) * rate, 0.0)
        scratch[OFFSET + which, k, 0] = start + radius + share * (width - radius)
        scratch[OFFSET + which, k, 1], scratch[OFFSET + which, k, 2] = share * rate, share * min(width, radius)


@device
def _end_rounding(scratch, which, count):
    """Take the rounding off half planes that come near another of their body in the same direction, which has less: a flank that
    reaches the wall at its far end. Where the one gives way to the other nothing may jump."""
    for k in range(count):
        rounding, left = scratch[OFFSET + which, k, 2], 1.0
        if rounding > 0.0:
            u, v = scratch[DIRECTION + which, k, 0], scratch[DIRECTION + which, k, 1]
            for m in range(count):
                room = scratch[OFFSET + which, m, 0] - scratch[OFFSET + which, k, 0]
                if scratch[DIRECTION + which, m, 2] < scratch[DIRECTION + which, k, 2] and room < rounding:
                    same = _together(u * scratch[DIRECTION + which, m, 0] + v * scratch[DIRECTION + which, m, 1])
                    left = min(left, 1.0 - same * (1.0 - max(room, 0.0) / rounding))
            scratch[OFFSET + which, k, 2] = left * rounding


@device
def nominal_area(vertex, face_normal, shapes, a, b, offset, normal, pa, pb, depth, scratch):
    """Nominal area [m2] of the contact of a and b at a depth [m], its derivative by the depth [m], and how far it extends [m].

    vertex (v, 3), face_normal (f, 3): turned to world directions; offset, normal, pa, pb: centroid of b, unit normal from a to b,
    witness points on the cores, all relative to a's centroid; scratch (8, MOST_CORNERS, 3). b may be a half space.
    """
    t1, t2 = tangents(normal)
    ra, rb, back, others = shapes.radius[a], radius_at(shapes, vertex, b, sub(pb, offset)), scale(-1.0, normal), 0
    count = _bounds(vertex, face_normal, shapes, a, pa, normal, t1, t2, scratch, 0)
    if shapes.kind[b] == 0:
        others = _bounds(vertex, face_normal, shapes, b, sub(pb, offset), back, t1, t2, scratch, 1)
    _reach_alone(scratch, 0, count, depth, ra)
    _reach_alone(scratch, 1, others, depth, rb)
    _recede(scratch, 0, count, others, depth, ra, rb)
    _recede(scratch, 1, others, count, depth, rb, ra)
    _end_rounding(scratch, 0, count)
    _end_rounding(scratch, 1, others)
    wide = WIDE * shapes.reach[a]
    for i in range(4):
        scratch[0, i, 0], scratch[0, i, 1] = wide if i == 0 or i == 3 else -wide, wide if i < 2 else -wide
        scratch[0, i, 2] = -1.0
    corners, now = 4, 0
    for which in range(2):
        for k in range(count if which == 0 else others):
            u, v, out = scratch[DIRECTION + which, k, 0], scratch[DIRECTION + which, k, 1], scratch[OFFSET + which, k, 0]
            if reaches_past(scratch[now], corners, u, v, out):
                corners = cut(scratch[now], corners, scratch[1 - now], u, v, out, float(which * MOST_CORNERS + k))
                now = 1 - now
                if corners < 3:
                    return 0.0, 0.0, 0.0
    return measure(scratch[now], corners, scratch)


@device
def _over(vertex, shapes, body, point, normal):
    """The point of a core over a place of its surface; point: from the body's centroid, normal: out of the body."""
    first, last = shapes.vertex_start[body], shapes.vertex_start[body + 1] - 1
    if last - first > 1:
        _, height = farthest_vertex(vertex, first, last + 1, normal)
        return along(point, height - dot(point, normal), normal)
    start = load(vertex, first)
    axis, away = sub(load(vertex, last), start), sub(point, start)
    flat = along(axis, -dot(axis, normal), normal)
    square = dot(flat, flat)
    place = min(max(dot(away, flat) / square, 0.0), 1.0) if square > 0.0 else 0.0
    return along(start, place, axis)


@device
def contact_area(k, vertex, face_normal, shapes, pairs, scratch):
    """Nominal area [m2] of the open contact k as it stands: at the depth that has crushed, at its overlap where nothing has."""
    a, b, normal, point = pairs.a[k], pairs.b[k], load(pairs.normal, k), load(pairs.point, k)
    offset = sub(point, load(pairs.arm, k))
    pb = offset
    if shapes.kind[b] == 0:
        pb = add(offset, _over(vertex, shapes, b, sub(point, offset), scale(-1.0, normal)))
    pa, depth = _over(vertex, shapes, a, point, normal), pairs.crushed[k] if pairs.crushed[k] > 0.0 else pairs.overlap[k]
    return nominal_area(vertex, face_normal, shapes, a, b, offset, normal, pa, pb, depth, scratch)[0]

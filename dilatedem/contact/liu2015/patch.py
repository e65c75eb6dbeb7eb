"""One contact patch per pair: where two dilated cores press on each other, a point, a segment of length L or a polygon of area A.

The support features of both cores along the normal are projected on the contact plane and clipped by each other, then by the
line where their gap closes: only the *penetrating* part counts, and the force acts at its centroid. A part narrower than the
half-width of the Hertz contact of its own rounded rim is none: a sliver of a face is an edge, a stub of an edge is a corner.
"""

from math import sqrt

from dilatedem.contact.clip import clip_by_face, clip_interval, clip_polygon, polygon_centroid
from dilatedem.contact.support import EDGE, FACE, PARALLEL, VERTEX, corner_feature, support_feature
from dilatedem.jit import device, item
from dilatedem.numerics.vector import add, along, cross, dot, load, norm, scale, sub, tangents
from dilatedem.state.modes import Mode

VERTEX_VERTEX, VERTEX_EDGE, VERTEX_FACE = int(Mode.VERTEX_VERTEX), int(Mode.VERTEX_EDGE), int(Mode.VERTEX_FACE)
EDGE_CROSSING, EDGE_PARALLEL = int(Mode.EDGE_CROSSING), int(Mode.EDGE_PARALLEL)
EDGE_FACE, FACE_FACE = int(Mode.EDGE_FACE), int(Mode.FACE_FACE)


#: distance by which a feature may lie outside a face and still be on it, over the reach of the smaller body. Where the normal leans
#: a little from a face's own, the closest point is on the face's rim, *exactly* on the clipping line, and round-off would choose
#: the mode; a micrometre for a floe of 3 m is above the error of the distance search and below any detail of a floe.
RIM = 5e-7

ORIGIN = (0.0, 0.0, 0.0)


@device
def point_mode(kind_a, kind_b):
    """Mode of a contact at a point: the lower feature's corner on the other."""
    high = max(kind_a, kind_b)
    if min(kind_a, kind_b) == VERTEX:
        return VERTEX_VERTEX if high == VERTEX else (VERTEX_EDGE if high == EDGE else VERTEX_FACE)
    return VERTEX_FACE


@item
def face_plane(vertex, face_normal, shapes, face, origin, normal, t1, t2, radius):
    """Height along the normal of a face's dilated plane as h0 + hu u + hv v; radius < 0 for the face of b."""
    m = load(face_normal, face)
    mn = dot(m, normal)
    hu, hv = -dot(m, t1) / mn, -dot(m, t2) / mn
    p = add(origin, load(vertex, shapes.loop[shapes.loop_start[face]]))
    return dot(p, normal) + radius - hu * dot(p, t1) - hv * dot(p, t2), hu, hv


@item
def _face_on_face(vertex, shapes, face_a, face_b, offset, normal, t1, t2, ra, plane, rim, scratch):
    """Penetrating polygon of two faces: area, extent, centroid u, v, height of a there, and the polygon before the gap was looked
    at, with its corner count.

    plane: height of b's dilated surface h0, hu, hv; face_b < 0: it has no sides.
    """
    first = shapes.loop_start[face_a]
    count = shapes.loop_start[face_a + 1] - first
    source, target = scratch[0], scratch[1]
    for i in range(count):
        p = load(vertex, shapes.loop[first + i])
        source[i, 0], source[i, 1], source[i, 2] = dot(p, t1), dot(p, t2), dot(p, normal) + ra
    swapped = False
    if face_b >= 0:
        count, swapped = clip_by_face(vertex, shapes, face_b, offset, t1, t2, -1.0, rim, source, count, target)
    if swapped:
        source, target = target, source
    h0, hu, hv = plane
    kept = clip_polygon(source, count, target, hu, hv, -1.0, -h0)
    area, u, v, h, extent = polygon_centroid(target, kept)
    return area, extent, u, v, h, source, count


@device
def _is_narrow(polygon, count, narrow):
    """Whether a polygon is narrower than `narrow` [m]."""
    area, _, _, _, extent = polygon_centroid(polygon, count)
    return extent <= 0.0 or area / extent < narrow


@item
def edge_patch(vertex, shapes, p, q, rise, face, origin, side, normal, t1, t2, plane, rim, narrow, overlap):
    """Part of the edge p q that penetrates a face: mode (-1: none), point of application, overlap there, length [m].

    p, q: ends, relative to a's centroid; rise: height of the edge's dilated surface over its axis, along the normal; side: 1 where
    the edge is a's (b's surface lies above it), -1 where it is b's; plane: the face's dilated surface, `_surface`; face < 0: it has
    no sides.
    """
    pu, pv = dot(p, t1), dot(p, t2)
    du, dv = dot(q, t1) - pu, dot(q, t2) - pv
    low, high = 0.0, 1.0
    if face >= 0:
        first, last = shapes.loop_start[face], shapes.loop_start[face + 1]
        for i in range(first, last):
            s = add(origin, load(vertex, shapes.loop[i]))
            e = add(origin, load(vertex, shapes.loop[i + 1 if i + 1 < last else first]))
            su, sv = dot(s, t1), dot(s, t2)
            # seen along the normal a's faces run counter-clockwise, b's clockwise
            eu, ev = -side * (dot(e, t1) - su), -side * (dot(e, t2) - sv)
            out = ev * (pu - su) - eu * (pv - sv) - rim * (abs(eu) + abs(ev))
            low, high = clip_interval(low, high, ev * du - eu * dv, out)
    h0, hu, hv = plane
    gap_p = side * (h0 + hu * pu + hv * pv - dot(p, normal) - rise)
    gap_q = side * (h0 + hu * (pu + du) + hv * (pv + dv) - dot(q, normal) - rise)
    low, high = clip_interval(low, high, gap_q - gap_p, gap_p)
    if high <= low:
        return -1, ORIGIN, 0.0, 0.0
    middle = 0.5 * (low + high)
    centre = along(p, middle, sub(q, p))
    depth = -(gap_p + (gap_q - gap_p) * middle)
    # half-way between the edge's surface and the face's
    point = along(centre, rise - 0.5 * side * depth, normal)
    length = (high - low) * norm(sub(q, p))
    if length < narrow:
        return VERTEX_FACE, point, overlap, 1.0
    return EDGE_FACE, point, depth, length


@device
def _edge_along_edge(pa, qa, pb, qb, normal, ra, rb):
    """Common penetrating part of two near-parallel edges: interval of 0..1 along a's edge, and at its middle the height between the
    dilated surfaces and their overlap."""
    e = sub(qa, pa)
    length2 = dot(e, e)
    tp, tq = dot(sub(pb, pa), e) / length2, dot(sub(qb, pa), e) / length2
    low, high = max(0.0, min(tp, tq)), min(1.0, max(tp, tq))
    if high <= low:
        return 1.0, 0.0, 0.0, 0.0
    ha, sa = dot(pa, normal) + ra, dot(e, normal)
    sb = dot(sub(qb, pb), normal) / (tq - tp)
    hb = dot(pb, normal) - rb - sb * tp
    low, high = clip_interval(low, high, sb - sa, hb - ha)
    middle = 0.5 * (low + high)
    return low, high, 0.5 * (ha + hb + (sa + sb) * middle), ha - hb + (sa - sb) * middle


@item
def contact_patch(
    vertex, face_normal, shapes, corners, corner_a, corner_b, a, b, offset, normal, pa, pb, overlap, crushed, scratch
):  # fmt: skip
    """Mode of the contact of a and b, whether a has the lower feature, point of application, overlap, size, sine of two edges.

    vertex (v, 3), face_normal (f, 3): turned to world directions; corner_a, corner_b (4,): closest corners; offset, normal, pa, pb:
    centroid of b, unit normal, witness points on the cores, all relative to a's centroid [m]; overlap > 0 [m];
    crushed [m]: what a's dilation has lost; scratch (2, MOST_CORNERS, 3). Features rank corner, edge, face. overlap: the deepest;
    for a patch, what holds at its centroid is returned. size: length [m] or area [m2] of the penetrating part, 1 for a point. b may
    be a half space (`pb` is then on its plane). Liu 2015, section 2.
    """
    ra, rb = shapes.radius[a] - crushed, shapes.radius[b]
    middle = along(scale(0.5, add(pa, pb)), 0.5 * (ra - rb), normal)
    half_space, a_lower = shapes.kind[b] != 0, shapes.radius[a] <= rb
    rim = RIM * min(shapes.reach[a], shapes.reach[b])  # a half space, whose reach is 0, has none
    narrow = sqrt((shapes.radius[a] if half_space else min(shapes.radius[a], rb)) * overlap)
    t1, t2 = tangents(normal)
    kind_a, i, j = support_feature(vertex, face_normal, shapes, a, corner_a, max(corners, 1), normal)
    if half_space:
        kind_b, m, n = FACE, -1, -1
        plane = (dot(pb, normal), 0.0, 0.0)
    else:
        kind_b, m, n = support_feature(vertex, face_normal, shapes, b, corner_b, max(corners, 1), scale(-1.0, normal))
        plane = (0.0, 0.0, 0.0)
        if kind_b == FACE:
            plane = face_plane(vertex, face_normal, shapes, m, offset, normal, t1, t2, -rb)

    if kind_a == FACE and kind_b == FACE:
        area, extent, u, v, h, common, sides = _face_on_face(
            vertex, shapes, i, m, offset, normal, t1, t2, ra, plane, rim, scratch
        )
        if area > 0.0:
            hb = plane[0] + plane[1] * u + plane[2] * v
            point = along(along(scale(u, t1), v, t2), 0.5 * (h + hb), normal)
            if area >= narrow * extent:
                return FACE_FACE, True, point, h - hb, area, 0.0
            if extent >= narrow:
                mode = EDGE_PARALLEL if _is_narrow(common, sides, narrow) else EDGE_FACE
                return mode, a_lower, point, h - hb, extent, 0.0
            return VERTEX_FACE, a_lower, point, overlap, 1.0, 0.0
    elif kind_a == EDGE and kind_b == FACE:
        p, q = load(vertex, i), load(vertex, j)
        mode, point, depth, length = edge_patch(
            vertex, shapes, p, q, ra, m, offset, 1.0, normal, t1, t2, plane, rim, narrow, overlap
        )
        if mode >= 0:
            return mode, True, point, depth, length, 0.0
    elif kind_a == FACE and kind_b == EDGE:
        p, q = add(offset, load(vertex, m)), add(offset, load(vertex, n))
        plane = face_plane(vertex, face_normal, shapes, i, ORIGIN, normal, t1, t2, ra)
        mode, point, depth, length = edge_patch(
            vertex, shapes, p, q, -rb, i, ORIGIN, -1.0, normal, t1, t2, plane, rim, narrow, overlap
        )
        if mode >= 0:
            return mode, False, point, depth, length, 0.0
    elif kind_a == VERTEX and kind_b == FACE:
        if half_space or is_inside(vertex, shapes, pa, m, offset, t1, t2, -1.0, rim):
            return VERTEX_FACE, True, middle, overlap, 1.0, 0.0
    elif kind_a == FACE and kind_b == VERTEX:
        if is_inside(vertex, shapes, pb, i, ORIGIN, t1, t2, 1.0, rim):
            return VERTEX_FACE, False, middle, overlap, 1.0, 0.0
    elif kind_a == EDGE and kind_b == EDGE:
        mode, point, depth, size, sine = edges_patch(
            load(vertex, i), load(vertex, j), add(offset, load(vertex, m)), add(offset, load(vertex, n)), normal, ra, rb, narrow,
            middle, overlap, corners, corner_a, corner_b,
        )  # fmt: skip
        if mode >= 0:
            return mode, True, point, depth, size, sine
    elif kind_a == VERTEX and kind_b == VERTEX:
        return VERTEX_VERTEX, True, middle, overlap, 1.0, 0.0
    # the features along the normal do not face each other: what the closest corners span decides
    kind_a, i, j = corner_feature(corner_a, max(corners, 1))
    kind_b, m, n = corner_feature(corner_b, max(corners, 1))
    if kind_a == EDGE and kind_b == EDGE:
        mode, point, depth, size, sine = edges_patch(
            load(vertex, i), load(vertex, j), add(offset, load(vertex, m)), add(offset, load(vertex, n)), normal, ra, rb, narrow,
            middle, overlap, corners, corner_a, corner_b,
        )  # fmt: skip
        if mode >= 0:
            return mode, True, point, depth, size, sine
        return VERTEX_EDGE, True, middle, overlap, 1.0, 0.0
    return point_mode(kind_a, kind_b), kind_a <= kind_b, middle, overlap, 1.0, 1.0


@item
def is_inside(vertex, shapes, point, face, origin, t1, t2, turn, rim):
    """Whether a point projects into a face (turn and rim as in `clip_by_face`)."""
    first, last = shapes.loop_start[face], shapes.loop_start[face + 1]
    for i in range(first, last):
        p = add(origin, load(vertex, shapes.loop[i]))
        q = add(origin, load(vertex, shapes.loop[i + 1 if i + 1 < last else first]))
        e, s = sub(q, p), sub(point, p)
        eu, ev = dot(e, t1), dot(e, t2)
        if turn * (eu * dot(s, t2) - ev * dot(s, t1)) < -rim * (abs(eu) + abs(ev)):
            return False
    return True


@device
def edges_patch(pa, qa, pb, qb, normal, ra, rb, narrow, middle, overlap, corners, corner_a, corner_b):
    """Two edges pa qa and pb qb, crossing or along each other; mode -1 where neither holds (they only meet at an end)."""
    ea, eb = sub(qa, pa), sub(qb, pb)
    c = dot(cross(ea, eb), normal)
    sine = abs(c) / sqrt(dot(ea, ea) * dot(eb, eb))
    if sine > PARALLEL:
        spans_a, _, _ = corner_feature(corner_a, max(corners, 1))
        spans_b, _, _ = corner_feature(corner_b, max(corners, 1))
        if corners == 0 or (spans_a == EDGE and spans_b == EDGE):
            return EDGE_CROSSING, middle, overlap, 1.0, sine
        return -1, middle, overlap, 1.0, 0.0
    low, high, h, depth = _edge_along_edge(pa, qa, pb, qb, normal, ra, rb)
    if high <= low:
        return -1, middle, overlap, 1.0, 0.0
    length = (high - low) * norm(ea)
    centre = along(pa, 0.5 * (low + high), ea)
    point = along(centre, h - dot(centre, normal), normal)
    if length >= narrow:
        return EDGE_PARALLEL, point, depth, length, 0.0
    return VERTEX_EDGE, point, overlap, 1.0, 0.0

"""A face of four corners on another of four, as the sides of floes are: what `face.press_face` gives, without a loop.

Nearly all contacts of floes are such, and their patch has four corners as well, or three where one leans. Loops over so few corners
spend more time on counting than on sums; here corners are tuples, which live in registers. Where a patch has more corners, `face`
has to do.
"""

from math import sqrt

from dilatedem.contact.consistent.face import (
    MARGIN,
    SHARPEST,
    STEEP,
    add_triangle,
    in_space,
    moments,
    punch,
    push_out,
    slopes,
)
from dilatedem.contact.consistent.rim import FAR, any_rim, bound_rim
from dilatedem.jit import device, item
from dilatedem.numerics.vector import add, dot, load, sub, tangents

#: corners; nothing presses; as many corners as only `face` can tell
FOUR, THREE, NOTHING, UNTOLD = 4, 3, 0, -1
#: fence of a side where face a ends
END = (0.0, 0.0)


@device
def has_four(shapes, face):
    """Whether a face has four corners."""
    return shapes.loop_start[face + 1] - shapes.loop_start[face] == FOUR


@device
def corners_of(vertex, shapes, face):
    """The corners of a face that has four, from the centroid of its body."""
    i = shapes.loop_start[face]
    return (
        load(vertex, shapes.loop[i]), load(vertex, shapes.loop[i + 1]), load(vertex, shapes.loop[i + 2]),
        load(vertex, shapes.loop[i + 3]),
    )  # fmt: skip


@device
def _turned(four):
    return four[1], four[2], four[3], four[0]


@device
def _between(p, s, q, z):
    """The point between two corners p and q where a value that is s < 0 and z > 0 there is 0."""
    t = s / (s - z)
    return p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1]), p[2] + t * (q[2] - p[2])


@device
def _cut_to_three(patch, fence, s, way):
    """`_cut` of four corners where it does not leave four."""
    beyond = 0
    for value in s:
        beyond += 1 if value > 0.0 else 0
    if beyond < THREE or s[0] == 0.0 or s[1] == 0.0 or s[2] == 0.0 or s[3] == 0.0:
        return UNTOLD, patch, fence
    if beyond == FOUR:
        return NOTHING, patch, fence
    # turned such that the last corner stays
    for _ in range(3):
        if s[3] > 0.0:
            patch, fence, s = _turned(patch), _turned(fence), _turned(s)
    first, last = _between(patch[3], s[3], patch[2], s[2]), _between(patch[3], s[3], patch[0], s[0])
    return THREE, (patch[3], last, first, first), (fence[3], way, END, fence[2])


@device
def _cut_three(patch, fence, s, way):
    """`_cut` of three corners."""
    (p, q, r, _), (pq, qr, _, rp), (s0, s1, s2, _) = patch, fence, s
    if s0 == 0.0 or s1 == 0.0 or s2 == 0.0:
        return UNTOLD, patch, fence
    beyond = (1 if s0 > 0.0 else 0) + (1 if s1 > 0.0 else 0) + (1 if s2 > 0.0 else 0)
    if beyond == THREE:
        return NOTHING, patch, fence
    # turned such that the first corner is the one that goes, or that stays, alone
    for _ in range(2):
        if (s0 > 0.0) != (beyond == 1):
            p, q, r, pq, qr, rp, s0, s1, s2 = q, r, p, qr, rp, pq, s1, s2, s0
    first, last = _between(p, s0, q, s1), _between(r, s2, p, s0)
    if beyond == 1:
        return FOUR, (first, q, r, last), (pq, qr, rp, way)
    return THREE, (p, first, last, last), (pq, way, END, rp)


@device
def _cut(corners, patch, fence, s, way):
    """The part of a patch where a linear function, s at its corners, is negative: its corners (FOUR, THREE, NOTHING is left, or
    UNTOLD where there would be more), and that part with its fences.

    Three corners are four with the third twice. fence: of each side, from a corner to the next, the unit vector (a, b) that leads
    out over the border of b, or END where a ends; way: the same of the cut.
    """
    if corners == THREE:
        return _cut_three(patch, fence, s, way)
    # turned such that the first two corners go
    if s[2] > 0.0:
        if s[3] > 0.0:
            patch, fence, s = _turned(_turned(patch)), _turned(_turned(fence)), _turned(_turned(s))
        else:
            patch, fence, s = _turned(patch), _turned(fence), _turned(s)
    elif s[3] > 0.0:
        patch, fence, s = _turned(_turned(_turned(patch))), _turned(_turned(_turned(fence))), _turned(_turned(_turned(s)))
    if s[0] > 0.0 and s[1] > 0.0 and s[2] < 0.0 and s[3] < 0.0:
        first, second = _between(patch[3], s[3], patch[0], s[0]), _between(patch[2], s[2], patch[1], s[1])
        return FOUR, (first, second, patch[2], patch[3]), (way, fence[1], fence[2], fence[3])
    return _cut_to_three(patch, fence, s, way)


@device
def _flat(corner, origin, t1, t2, normal, reach):
    """A corner of face a as u, v and overlap."""
    d = sub(corner, origin)
    return dot(d, t1), dot(d, t2), reach - dot(d, normal)


@device
def _plan(corner, origin, t1, t2):
    """A corner of face b as u, v."""
    d = sub(corner, origin)
    return dot(d, t1), dot(d, t2)


@device
def _side(p, q, margin):
    """A side of b's border: its vector, how far out from the origin it is, moved by `margin`, times its length, and its length."""
    eu, ev = q[0] - p[0], q[1] - p[1]
    length = sqrt(eu * eu + ev * ev)
    return eu, ev, ev * p[0] - eu * p[1] + margin * length, length


@device
def _sharp(side, following):
    """Whether the border has to be cut off at the corner between two sides."""
    c, both = side[0] * following[0] + side[1] * following[1], side[3] * following[3]
    return c < -SHARPEST * both


@device
def _within(corners, patch, fence, side):
    """`_cut` by a side of the border."""
    eu, ev, limit, length = side
    p, q, r, s = patch
    s0, s1 = ev * p[0] - eu * p[1] - limit, ev * q[0] - eu * q[1] - limit
    s2, s3 = ev * r[0] - eu * r[1] - limit, ev * s[0] - eu * s[1] - limit
    if corners > NOTHING and max(max(s0, s1), max(s2, s3)) > 0.0:
        unit = 1.0 / length
        return _cut(corners, patch, fence, (s0, s1, s2, s3), (ev * unit, -eu * unit))
    return corners, patch, fence


@device
def _patch(patch, border, margin):
    """What of face a, `patch`, presses and lies over face b, `border`: its corners, as `_cut` tells, and fences."""
    fence, (p, q, r, s) = (END, END, END, END), border
    one, two, three, last = _side(p, q, margin), _side(q, r, margin), _side(r, s, margin), _side(s, p, margin)
    if _sharp(one, two) or _sharp(two, three) or _sharp(three, last) or _sharp(last, one):
        return UNTOLD, patch, fence
    corners, s0, s1, s2, s3 = FOUR, -patch[0][2], -patch[1][2], -patch[2][2], -patch[3][2]
    if max(max(s0, s1), max(s2, s3)) > 0.0:
        corners, patch, fence = _cut(corners, patch, fence, (s0, s1, s2, s3), END)
    corners, patch, fence = _within(corners, patch, fence, one)
    corners, patch, fence = _within(corners, patch, fence, two)
    corners, patch, fence = _within(corners, patch, fence, three)
    return _within(corners, patch, fence, last)


@device
def _moments(patch):
    """`face.moments` of four corners."""
    (u, v, _), p, q, r = patch
    x1, y1, x2, y2, x3, y3 = p[0] - u, p[1] - v, q[0] - u, q[1] - v, r[0] - u, r[1] - v
    sums = add_triangle((0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0), x1, y1, x2, y2)
    return moments(add_triangle(sums, x2, y2, x3, y3))


@device
def _bound_rims(corners, patch, beyond, tilt, overlap):
    """`rim.any_rim` of three or four corners."""
    p, q, r, s = patch
    lift = tilt * beyond
    d, e, f, g = min(p[2] + lift, overlap), min(q[2] + lift, overlap), min(r[2] + lift, overlap), min(s[2] + lift, overlap)
    eu, ev, fu, fv = q[0] - p[0], q[1] - p[1], r[0] - q[0], r[1] - q[1]
    gu, gv, hu, hv = s[0] - r[0], s[1] - r[1], p[0] - s[0], p[1] - s[1]
    bounds, square = bound_rim((0.0, 0.0, 0.0, False), hu, hv, hu * hu + hv * hv, eu, ev, d, e)
    bounds, square = bound_rim(bounds, eu, ev, square, fu, fv, e, f)
    if corners == THREE:
        return any_rim(bound_rim(bounds, fu, fv, square, hu, hv, f, d)[0], beyond, tilt, overlap)
    bounds, square = bound_rim(bounds, fu, fv, square, gu, gv, f, g)
    bounds, square = bound_rim(bounds, gu, gv, square, hu, hv, g, d)
    return any_rim(bounds, beyond, tilt, overlap)


@device
def _border(wrench, p, q, way, reach, plane, pressure):
    """`push_out` of a side of the patch that is a fence."""
    if way[0] == 0.0 and way[1] == 0.0:
        return wrench
    return push_out(wrench, p[0], p[1], q[0], q[1], way[0], way[1], reach, plane, pressure)


@item
def press_four(corners_a, normal_a, corners_b, normal_b, offset, reach, overlap, modulus, scratch):
    """Whether this can tell; then, as `face.press_face`: energy, force on a, its moment, area, spread and patch.

    corners_a, corners_b: as of `corners_of`; offset: from the centroid of a to that of b. Writes the patch to row 0 of `scratch`.
    """
    none = (0.0, 0.0, 0.0)
    nothing = False, 0.0, none, none, 0.0, (none, none), (0, 0, 0.0, FAR, FAR)
    if dot(normal_a, normal_b) > -STEEP:
        return nothing
    t1, t2 = tangents(normal_b)
    origin = add(offset, corners_b[0])
    (p, q, r, s), (k, l, m, n) = corners_a, corners_b
    corners, patch, fence = _patch(
        # seen from b's side a's loop runs clockwise
        (_flat(s, origin, t1, t2, normal_b, reach), _flat(r, origin, t1, t2, normal_b, reach),
         _flat(q, origin, t1, t2, normal_b, reach), _flat(p, origin, t1, t2, normal_b, reach)),
        ((0.0, 0.0), _plan(l, k, t1, t2), _plan(m, k, t1, t2), _plan(n, k, t1, t2)), MARGIN * reach,
    )  # fmt: skip
    if corners <= NOTHING:
        return corners == NOTHING, 0.0, none, none, 0.0, (none, none), (0, 0, 0.0, FAR, FAR)
    gu, gv = slopes(normal_a, normal_b, t1, t2)
    u0, v0, d0 = patch[0]
    energy, (u, v, d), pressure, (total, total_u, total_v), area, spread = punch(_moments(patch), d0, gu, gv, modulus)
    if energy == 0.0:
        return nothing
    # on a: along b's normal, at (u, v) of b's plane
    wrench = 0.0, 0.0, total, total_v + v0 * total, -total_u - u0 * total, 0.0
    plane = u0 + u, v0 + v, d, gu, gv
    wrench = _border(wrench, patch[0], patch[1], fence[0], reach, plane, pressure)
    wrench = _border(wrench, patch[1], patch[2], fence[1], reach, plane, pressure)
    wrench = _border(wrench, patch[2], patch[3], fence[2], reach, plane, pressure)
    wrench = _border(wrench, patch[3], patch[0], fence[3], reach, plane, pressure)
    force, moment, spread = in_space(wrench, spread, origin, t1, t2, normal_b)
    tilt = sqrt(gu * gu + gv * gv)
    second, longest = _bound_rims(corners, patch, sqrt(2.0 * reach * overlap), tilt, overlap)
    for m in range(3):
        scratch[0, 0, m], scratch[0, 1, m], scratch[0, 2, m], scratch[0, 3, m] = patch[0][m], patch[1][m], patch[2][m], patch[3][m]
    return True, energy, force, moment, area, spread, (corners, 0, tilt, second, longest)

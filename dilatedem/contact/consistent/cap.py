"""The cap of a core: its face that looks at the other body, or its one segment or vertex; and how far a point is from it.

The distance to a convex polygon is smooth wherever it is positive; nothing here asks which features are parallel.
Rows of `scratch` (8, MOST_CORNERS, 3): 0 and 1 clipping, 2 and 3 the corners of the caps of a and b, 4 and 5 the unit vectors of
their sides. All coordinates are relative to the centroid of body a.
"""

from math import sqrt

from dilatedem.jit import device, item
from dilatedem.numerics.vector import add, along, cross, dot, load, scale, sub

CORNERS, SIDES = 2, 4
#: regions of the space around a cap: over its interior, its sides, its corners
INTERIOR, SIDE, CORNER = 0, 1, 2
#: cosine of the angle between a face and the contact plane below which the face is taken without a look at its sides
FLUSH = 0.98
#: relative difference of squared distances below which a side goes before the corner at its end: the regions meet there
TIE = 1e-12
#: corner count that stands for a half space: no sides, and a point of its plane where the first corner would be
UNBOUNDED = 0


@item
def facing(vertex, face_normal, shapes, body, corners, corner, direction):
    """The face of a core that lies flattest against a unit direction and holds what is closest; -1: the core has no face.

    corner[:corners]: the vertices whose hull is closest (one may stand there twice). Of faces that are not flush: the smallest
    product of the slopes of their two sides at those vertices, so that the flattest side is always part of the cap.
    """
    flush, chosen = FLUSH, -1
    for f in range(shapes.face_start[body], shapes.face_start[body + 1]):
        c = dot(load(face_normal, f), direction)
        if c > flush and _holds(shapes, f, corners, corner):
            flush, chosen = c, f
    if chosen >= 0:
        return chosen
    least, most, behind = 1e300, -2.0, -1
    for f in range(shapes.face_start[body], shapes.face_start[body + 1]):
        c = dot(load(face_normal, f), direction)
        # exactly 0: a flat core that is met edge-on, whose two faces are equally good
        if c >= 0.0 and _holds(shapes, f, corners, corner):
            steep = _steepness(vertex, shapes, f, corners, corner, direction)
            if steep < least:
                least, chosen = steep, f
        # where round-off leaves no face that holds them all: one that holds the first
        if chosen < 0 and c > most and _holds(shapes, f, 1, corner):
            most, behind = c, f
    return chosen if chosen >= 0 else behind


@device
def _place(shapes, face, vertex):
    """Where a vertex stands in a face's loop; -1: nowhere."""
    for i in range(shapes.loop_start[face], shapes.loop_start[face + 1]):
        if shapes.loop[i] == vertex:
            return i
    return -1


@device
def _holds(shapes, face, corners, corner):
    for k in range(corners):
        if _place(shapes, face, corner[k]) < 0:
            return False
    return True


@device
def _steepness(vertex, shapes, face, corners, corner, direction):
    """Product of the slopes of a face's two sides at each of some vertices that it holds."""
    first, last = shapes.loop_start[face], shapes.loop_start[face + 1]
    steep = 1.0
    for k in range(corners):
        at = _place(shapes, face, corner[k])
        origin = load(vertex, corner[k])
        before = sub(load(vertex, shapes.loop[at - 1 if at > first else last - 1]), origin)
        after = sub(load(vertex, shapes.loop[at + 1 if at + 1 < last else first]), origin)
        steep *= _slope(before, direction) * _slope(after, direction)
    return steep


@device
def _slope(edge, direction):
    """Sine of the angle of an edge with the plane across a direction, and a little, so that two flat sides beat one."""
    return abs(dot(edge, direction)) / sqrt(dot(edge, edge)) + 1e-9


@item
def lay_out(vertex, shapes, body, face, origin, scratch, which):
    """Write the corners of a body's cap into `scratch`; returns their number. which: 0 for body a, 1 for body b.

    face: as `facing` returns it.
    """
    if face < 0:
        first = shapes.vertex_start[body]
        count = shapes.vertex_start[body + 1] - first
        for i in range(count):
            for m in range(3):
                scratch[CORNERS + which, i, m] = origin[m] + vertex[first + i, m]
        return count
    first = shapes.loop_start[face]
    count = shapes.loop_start[face + 1] - first
    for i in range(count):
        v = shapes.loop[first + i]
        for m in range(3):
            scratch[CORNERS + which, i, m] = origin[m] + vertex[v, m]
    return count


@item
def lay_sides(scratch, which, count):
    """Write the unit vectors of a cap's sides, side i from corner i to the next."""
    for i in range(count):
        e = sub(corner_of(scratch, which, i + 1 if i + 1 < count else 0), corner_of(scratch, which, i))
        length = sqrt(dot(e, e))
        unit = 1.0 / length if length > 0.0 else 0.0
        for m in range(3):
            scratch[SIDES + which, i, m] = e[m] * unit


@device
def corner_of(scratch, which, i):
    return scratch[CORNERS + which, i, 0], scratch[CORNERS + which, i, 1], scratch[CORNERS + which, i, 2]


@device
def side_of(scratch, which, i):
    return scratch[SIDES + which, i, 0], scratch[SIDES + which, i, 1], scratch[SIDES + which, i, 2]


@item
def nearest(scratch, which, count, normal, x):
    """Region of a point around a cap (INTERIOR, SIDE, CORNER), number of the side or corner, and the vector from the cap to it [m].

    normal: of the cap's plane, away from its body (unused for fewer than three corners).
    """
    if count == UNBOUNDED:
        return INTERIOR, 0, scale(dot(sub(x, corner_of(scratch, which, 0)), normal), normal)
    if count == 1:
        return CORNER, 0, sub(x, corner_of(scratch, which, 0))
    best, place, region, shortest = 1e300, 0, INTERIOR, (0.0, 0.0, 0.0)
    for k in range(count if count > 2 else 1):
        d, e = sub(x, corner_of(scratch, which, k)), side_of(scratch, which, k)
        if count > 2 and dot(d, cross(e, normal)) <= 0.0:
            continue
        end = sub(corner_of(scratch, which, k + 1 if k + 1 < count else 0), corner_of(scratch, which, k))
        t, length = dot(d, e), dot(end, e)
        w = along(d, -min(max(t, 0.0), length), e)
        square = dot(w, w)
        beside = 0.0 < t < length
        if square < best * (1.0 + TIE if beside else 1.0 - TIE):
            best, shortest = square, w
            if beside:
                place, region = k, SIDE
            else:
                region, place = CORNER, k if t <= 0.0 else (k + 1 if k + 1 < count else 0)
    if region == INTERIOR:
        return INTERIOR, 0, scale(dot(sub(x, corner_of(scratch, which, 0)), normal), normal)
    return region, place, shortest


@item
def overhang(scratch, which, count, normal, region, place, w, width):
    """How far a point is beyond the border of a cap: across its nearest side, and along that side too [m], with their gradients.

    region, place, w: from `nearest`; width: what stands for "far" where a cap has no face (or no side) to be beyond of. (0, 0)
    over the face, (> 0, 0) beside a side, (> 0, > 0) beyond a corner. Smooth away from the border.
    """
    none = (0.0, 0.0, 0.0)
    if region == INTERIOR:
        return 0.0, 0.0, none, none
    if count == 1:
        return width, width, none, none
    if count == 2:
        if region == SIDE:
            return width, 0.0, none, none
        e = side_of(scratch, which, 0)
        t = dot(w, e)
        return width, abs(t), none, (e if t > 0.0 else scale(-1.0, e))
    flat = along(w, -dot(w, normal), normal)
    across = sqrt(dot(flat, flat))
    out = scale(1.0 / across, flat) if across > 0.0 else none
    if region == SIDE:
        return across, 0.0, out, none
    before = side_of(scratch, which, place - 1 if place > 0 else count - 1)
    after = side_of(scratch, which, place)
    t1, t2 = dot(flat, before), -dot(flat, after)
    total = t1 + t2
    if total <= 0.0:
        return across, 0.0, out, none
    towards = add(scale(t2 * t2, before), scale(-t1 * t1, after))
    return across, t1 * t2 / total, out, scale(1.0 / (total * total), towards)


@device
def ramp(s):
    """Smooth step from 0 to 1 over s = 0..1, and its slope."""
    if s >= 1.0:
        return 1.0, 0.0
    return s * s * (3.0 - 2.0 * s), 6.0 * s * (1.0 - s)

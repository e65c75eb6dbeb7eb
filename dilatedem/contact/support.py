"""Which feature of a core faces the other body: its face, its edge or its vertex along the contact normal.

Real floes lie almost flat on each other, so "parallel" is a small angle, never an equality.
"""

from dilatedem.jit import device, item
from dilatedem.numerics.vector import cross, dot, load, sub
from dilatedem.state.modes import Feature

#: sine of the angle, rad, up to which a face or an edge counts as parallel to the contact plane (1.1 degrees). Effect: within
#: it a contact is a patch (Liu 2015, Eqs. (18), (19), (24)), beyond it a crossing or a corner; the paper prints cos = 1, cos = 0.
PARALLEL = 0.02

#: cosine of an angle well beyond it: most faces look elsewhere, and need no second look
NEARLY = 0.9

VERTEX, EDGE, FACE = int(Feature.VERTEX), int(Feature.EDGE), int(Feature.FACE)


@item
def support_feature(vertex, face_normal, shapes, body, corner, corners, direction):
    """The feature of a core that lies along a unit direction: kind, first and second number.

    corner (4,) with `corners` used: vertices known to be closest. FACE: number of the face, -1; EDGE: its two vertices; VERTEX:
    the vertex, -1.
    """
    best = PARALLEL * PARALLEL
    face = -1
    for f in range(shapes.face_start[body], shapes.face_start[body + 1]):
        d = load(face_normal, f)
        if dot(d, direction) > NEARLY:
            c = cross(d, direction)  # not the cosine: it cannot tell small angles apart
            sine2 = dot(c, c)
            if sine2 <= best:
                best, face = sine2, f
    if face >= 0:
        return FACE, face, -1
    best = PARALLEL * PARALLEL
    first, second = corner[0], -1
    for c in range(corners):
        i = corner[c]
        for p in range(shapes.neighbour_start[i], shapes.neighbour_start[i + 1]):
            e = sub(load(vertex, shapes.neighbour[p]), load(vertex, i))
            h = dot(e, direction)
            sine2 = h * h / dot(e, e)
            if sine2 <= best:
                best, first, second = sine2, i, shapes.neighbour[p]
    if second >= 0:
        return EDGE, first, second
    return VERTEX, first, -1


@device
def corner_feature(corner, corners):
    """The feature that the closest corners themselves span: kind, first and second vertex."""
    first, second = corner[0], -1
    for c in range(1, corners):
        if corner[c] != first:
            if second < 0:
                second = corner[c]
            elif corner[c] != second:
                return FACE, first, second
    if second >= 0:
        return EDGE, first, second
    return VERTEX, first, -1

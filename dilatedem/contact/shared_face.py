"""The part that two faces have in common, seen along the normal of their contact: where bodies that bend are carried."""

from dilatedem.contact.clip import clip_by_face, polygon_centroid
from dilatedem.jit import item
from dilatedem.numerics.rotation import rotation_matrix, to_body
from dilatedem.numerics.vector import add, along, dot, load, scale, tangents

NONE = (0.0, 0.0, 0.0)
#: shares of a face from which on the other one counts as lying on it at all, and on all of it: over more of a face than the latter
#: what bodies do at one point of it says too little
SOME, MOST = 0.1, 0.4


@item
def face_towards(i, direction, shapes, orientation):
    """The face of body i that looks in a direction; -1 where it has none."""
    R = rotation_matrix(orientation[i, 0], orientation[i, 1], orientation[i, 2], orientation[i, 3])
    own, most, chosen = to_body(R, direction), 0.0, -1
    for f in range(shapes.face_start[i], shapes.face_start[i + 1]):
        c = dot(own, load(shapes.face_normal, f))
        if c > most:
            most, chosen = c, f
    return chosen


@item
def _area(vertex, shapes, face, t1, t2, polygon):
    """Area of a face as seen along the normal [m2]; its corners go to `polygon`, counter-clockwise as seen from its outside."""
    first = shapes.loop_start[face]
    count = shapes.loop_start[face + 1] - first
    for i in range(count):
        p = load(vertex, shapes.loop[first + i])
        polygon[i, 0], polygon[i, 1], polygon[i, 2] = dot(p, t1), dot(p, t2), 0.0
    return polygon_centroid(polygon, count)[0], count


@item
def _covered(area, whole):
    """0 to 1, smoothly, by the part `area` of a face `whole` that the other covers."""
    x = min(max((area / whole - SOME) / (MOST - SOME), 0.0), 1.0)
    return x * x * (3.0 - 2.0 * x)


@item
def shared_part(face_a, face_b, offset, normal, vertex, shapes, scratch):
    """What the faces of two bodies have in common: whether there is any, its middle from the centroid of a [m], and how far it
    covers each face, from 0 to 1. offset: from the centroid of a to that of b; a face of -1 has no sides."""
    t1, t2 = tangents(normal)
    source, target = scratch[0], scratch[1]
    whole_b = _area(vertex, shapes, face_b, t2, t1, source)[0] if face_b >= 0 else 0.0
    whole_a, count = _area(vertex, shapes, face_a, t1, t2, source)
    swapped = False
    if face_b >= 0:
        count, swapped = clip_by_face(vertex, shapes, face_b, offset, t1, t2, -1.0, 0.0, source, count, target)
        if count == 0:
            return False, NONE, 0.0, 0.0
    area, u, v, _, _ = polygon_centroid(target, count) if swapped else polygon_centroid(source, count)
    if area <= 0.0 or whole_a <= 0.0:
        return False, NONE, 0.0, 0.0
    height = dot(load(vertex, shapes.loop[shapes.loop_start[face_a]]), normal)
    middle = along(add(scale(u, t1), scale(v, t2)), height, normal)
    return True, middle, _covered(area, whole_a), _covered(area, whole_b) if whole_b > 0.0 else 0.0

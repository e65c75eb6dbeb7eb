"""The patch of a body and a cone: to second order the cone is the cylinder that touches it along the generator.

Its axis runs under the generator, as deep as the side's radius of curvature, so that it is an edge like any other; faces lie
against the true generator, whatever the radius.
"""

from math import sqrt

from dilatedem.contact.liu2015.patch import (
    ORIGIN,
    RIM,
    VERTEX_EDGE,
    VERTEX_FACE,
    contact_patch,
    edge_patch,
    edges_patch,
    face_plane,
    is_inside,
    point_mode,
)
from dilatedem.contact.search.cone import cone_of, own_radius
from dilatedem.contact.support import EDGE, FACE, PARALLEL, VERTEX, corner_feature, support_feature
from dilatedem.geometry.shapes import TaperedShapes
from dilatedem.jit import by_type, device
from dilatedem.numerics.vector import add, along, dot, load, norm, scale, sub, tangents


@device
def _patch_at_cone(
    vertex, face_normal, shapes, corners, corner_a, corner_b, a, b, offset, normal, pa, pb, overlap, crushed, scratch
):  # fmt: skip
    """As `patch.contact_patch`, where b may be a cone."""
    if shapes.taper[b] == 0.0:
        return contact_patch(
            vertex, face_normal, shapes, corners, corner_a, corner_b, a, b, offset, normal, pa, pb, overlap, crushed, scratch
        )
    cone, ra = cone_of(shapes, vertex, b, offset), shapes.radius[a] - crushed
    place = dot(sub(pb, cone.middle), cone.axis)
    rb = cone.radius + cone.taper * place
    middle = along(scale(0.5, add(pa, pb)), 0.5 * (ra - rb), normal)
    narrow = sqrt(min(shapes.radius[a], rb) * overlap)
    kind_a, i, j = support_feature(vertex, face_normal, shapes, a, corner_a, corners, normal)
    spans_a, m, n = corner_feature(corner_a, corners)
    beside = abs(dot(cone.axis, normal) - cone.taper) <= PARALLEL
    if not beside:  # on the sphere at one end
        if kind_a == FACE:
            t1, t2 = tangents(normal)
            if is_inside(vertex, shapes, pb, i, ORIGIN, t1, t2, 1.0, RIM * shapes.reach[a]):
                return VERTEX_FACE, False, middle, overlap, 1.0, 0.0
        return point_mode(spans_a, VERTEX), spans_a == VERTEX, middle, overlap, 1.0, 1.0
    lies = along(cone.axis, -dot(cone.axis, normal), normal)
    lies = scale(cone.cosine / norm(lies), lies)
    p, q = along(pb, -cone.half - place, lies), along(pb, cone.half - place, lies)
    if kind_a == FACE:
        t1, t2 = tangents(normal)
        plane = face_plane(vertex, face_normal, shapes, i, ORIGIN, normal, t1, t2, ra)
        mode, point, depth, length = edge_patch(
            vertex, shapes, p, q, -rb, i, ORIGIN, -1.0, normal, t1, t2, plane, RIM * shapes.reach[a], narrow, overlap
        )
        if mode >= 0:
            return mode, False, point, depth, length, 0.0
    elif kind_a == EDGE:
        m, n = i, j
    elif spans_a == VERTEX:
        return VERTEX_EDGE, True, middle, overlap, 1.0, 0.0
    if kind_a == EDGE or spans_a == EDGE:
        mode, point, depth, size, sine = edges_patch(
            load(vertex, m), load(vertex, n), p, q, normal, ra, rb, narrow, middle, overlap, corners, corner_a, corner_b
        )
        if mode >= 0:
            return mode, True, point, depth, size, sine
    return VERTEX_EDGE, True, middle, overlap, 1.0, 0.0


@device
def _radius_under(shapes, vertex, body, place):
    if shapes.taper[body] == 0.0:
        return shapes.radius[body]
    cone = cone_of(shapes, vertex, body, ORIGIN)
    under = (cone.radius + cone.taper * dot(place, cone.axis)) / (cone.cosine * cone.cosine)
    most = abs(cone.taper) * cone.half
    return min(max(under, cone.radius - most), cone.radius + most)


#: The patch of a contact, as `patch.contact_patch`.
patch_of = by_type(contact_patch, {TaperedShapes: _patch_at_cone}, at=2)
#: Radius of a body's side under a place on it, from its centroid [m].
radius_under = by_type(own_radius, {TaperedShapes: _radius_under})

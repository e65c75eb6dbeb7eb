"""Energy of the pose of a body and a cone: its edges and vertices on the cone, the cone's side and ends on its cap."""

from math import copysign, exp, sqrt

from dilatedem.contact.consistent.cap import corner_of, facing, lay_out, lay_sides, side_of
from dilatedem.contact.consistent.cone_line import press_edge_on_cone, press_side
from dilatedem.contact.consistent.join import (
    EDGE_CROSSING,
    EDGE_FACE,
    EDGE_PARALLEL,
    NEGLECTED,
    SHARE,
    SHARP,
    VERTEX_EDGE,
    VERTEX_FACE,
    VERTEX_VERTEX,
    join_feature,
    mode_of_edges,
    pose_energy,
)
from dilatedem.contact.consistent.point import BLEND, elliptic, press_vertex, ramp
from dilatedem.contact.search.cone import cone_of, nearest_sphere
from dilatedem.contact.support import PARALLEL
from dilatedem.geometry.shapes import TaperedShapes
from dilatedem.jit import by_type, device
from dilatedem.numerics.vector import along, cross, dot, load, scale, sub

NONE = (0.0, 0.0, 0.0)


@device
def press_vertex_on_cone(cone, x, radius, kept, width, modulus):
    """Energy W [J] of a vertex at x on a cone and its force on the vertex's body [N]; 0..1, how far it is past the cone's end.

    radius: dilated radius of the vertex's body [m]; kept: what crushing has left of it [m].
    """
    sphere = nearest_sphere(cone, x)
    distance = sqrt(dot(sphere.way, sphere.way))
    overlap = kept + sphere.radius - distance
    if overlap <= 0.0 or distance == 0.0:
        return 0.0, NONE, 0.0
    beyond, slope = ramp(abs(sphere.past) * cone.cosine / width)
    own, their = 1.0 / radius, 1.0 / sphere.radius
    k1, k2 = own + beyond * their, own + their
    factor, by_trace, by_determinant = elliptic(k1 + k2, k1 * k2)
    energy = 8.0 / 15.0 * modulus * factor * overlap * overlap * sqrt(overlap) * exp(-SHARE * beyond)
    force = scale(2.5 * energy / (overlap * distance), sphere.way)
    by_k1, by_k2 = (by_trace + by_determinant * k2) / factor, (by_trace + by_determinant * k1) / factor
    if sphere.past == 0.0:
        falls = their * their * cone.taper / cone.cosine
        return energy, along(force, energy * by_k2 * falls, sphere.generator), 0.0
    turn = -energy * (their * by_k1 - SHARE) * slope / width * copysign(1.0, sphere.past)
    return energy, along(force, turn, sphere.generator), beyond


@device
def _join_body(cone, scratch, count, radius, kept, width, modulus, sums):
    """Add the edges and vertices of a body's cap that press on a cone to the sums of `join_feature`, the cone being body b; with
    mode, size and spread of the leading feature."""
    largest, total, force, moment, mode, size, spread = sums
    for i in range(count if count > 2 else count - 1):
        p, e = corner_of(scratch, 0, i), side_of(scratch, 0, i)
        length = dot(sub(corner_of(scratch, 0, i + 1 if i + 1 < count else 0), p), e)
        energy, more, turn, line = press_edge_on_cone(cone, p, e, length, radius, kept, width, modulus, SHARP)
        if energy > NEGLECTED * largest:
            if energy > largest:
                mode, size, spread = _mode_on_cone(cone, p, e, more, turn), line, (scale(line / sqrt(12.0), e), NONE)
            largest, total, force, moment = join_feature(
                largest, total, force, moment, energy, scale(-1.0, more), scale(-1.0, turn)
            )
    for i in range(count):
        x = corner_of(scratch, 0, i)
        energy, more, beyond = press_vertex_on_cone(cone, x, radius, kept, width, modulus)
        if energy > NEGLECTED * largest:
            if energy > largest:
                mode, size, spread = (VERTEX_EDGE if beyond < 0.5 else VERTEX_VERTEX), 1.0, (NONE, NONE)
            more = scale(-1.0, more)
            largest, total, force, moment = join_feature(largest, total, force, moment, energy, more, cross(x, more))
    return largest, total, force, moment, mode, size, spread


@device
def _mode_on_cone(cone, p, e, force, moment):
    """Mode of an edge p + t e on a cone: by its angle with the generator where the force acts."""
    arm = cross(e, force)
    square = dot(arm, arm)
    x = along(p, dot(sub(moment, cross(p, force)), arm) / square, e) if square > 0.0 else p
    c = dot(e, nearest_sphere(cone, x).generator)
    return EDGE_CROSSING if 1.0 - c * c > PARALLEL * PARALLEL else EDGE_PARALLEL


@device
def _join_cone(cone, scratch, count, normal, radius, kept, width, modulus, sums):
    """Add the cone's side and ends that press on a body's cap, as `_join_body` does."""
    largest, total, force, moment, mode, size, spread = sums
    energy, more, turn, line, across = press_side(cone, radius, kept, scratch, count, normal, width, modulus, SHARP)
    if energy > NEGLECTED * largest:
        if energy > largest:
            mode, size = EDGE_FACE, line
            if across >= 0.5:
                mode = mode_of_edges(scratch, 0, count, normal, cone.middle, cone.axis, more, turn)
            lies = along(cone.axis, -dot(cone.axis, more) / dot(more, more), more)
            spread = scale(line / sqrt(12.0 * dot(lies, lies)), lies), NONE
        largest, total, force, moment = join_feature(largest, total, force, moment, energy, more, turn)
    for end in (-cone.half, cone.half):
        x = along(cone.middle, end, cone.axis)
        own = cone.radius + cone.taper * end
        energy, more, across, beyond = press_vertex(x, own, scratch, 0, count, normal, radius, own + kept, modulus, SHARE)
        if energy > NEGLECTED * largest:
            if energy > largest:
                mode, size = VERTEX_FACE if across < 0.5 else (VERTEX_EDGE if beyond < 0.5 else VERTEX_VERTEX), 1.0
                spread = NONE, NONE
            largest, total, force, moment = join_feature(largest, total, force, moment, energy, more, cross(x, more))
    return largest, total, force, moment, mode, size, spread


@device
def _energy_at_cone(
    vertex, face_normal, shapes, a, b, corners, corner_a, corner_b, offset, normal, pb, crushed, overlap, modulus, scratch
):  # fmt: skip
    """As `join.pose_energy`, where b may be a cone."""
    if shapes.taper[b] == 0.0:
        return pose_energy(
            vertex, face_normal, shapes, a, b, corners, corner_a, corner_b, offset, normal, pb, crushed, overlap, modulus, scratch
        )
    cone, radius = cone_of(shapes, vertex, b, offset), shapes.radius[a]
    kept = radius - crushed
    width, face = BLEND * (radius + cone.radius), facing(vertex, face_normal, shapes, a, corners, corner_a, normal)
    if face >= 0:
        normal = load(face_normal, face)
    count = lay_out(vertex, shapes, a, face, NONE, scratch, 0)
    lay_sides(scratch, 0, count)
    sums = 0.0, 0.0, NONE, NONE, VERTEX_FACE, 1.0, (NONE, NONE)
    sums = _join_body(cone, scratch, count, radius, kept, width, modulus, sums)
    largest, total, force, moment, mode, size, spread = _join_cone(cone, scratch, count, normal, radius, kept, width, modulus, sums)
    if largest == 0.0:
        return 0.0, NONE, NONE, mode, size, spread
    root = sqrt(sqrt(sqrt(sqrt(total))))
    share = root / total
    return largest * root, scale(share, force), scale(share, moment), mode, size, spread


#: Energy of the pose of two bodies, as `join.pose_energy`.
energy_of_pose = by_type(pose_energy, {TaperedShapes: _energy_at_cone}, at=2)

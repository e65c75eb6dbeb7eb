"""All features of two caps together: one energy W of the pose, its force and its moment.

W is the 12-norm of the energies of all features that press: W^12 = sum W_i^12. It is smooth where they are, at most 6 % above the
largest where two are equal and equal to it where one leads; a feature of less than half the energy does not count.
"""

from math import log, pi, sqrt

from dilatedem.contact.consistent.cap import CORNERS, UNBOUNDED, corner_of, facing, lay_out, side_of
from dilatedem.contact.consistent.face import press_face
from dilatedem.contact.consistent.line import OFFSET, SHORT, press_edge
from dilatedem.contact.consistent.point import press_vertex
from dilatedem.jit import device, item
from dilatedem.numerics.vector import along, cross, dot, load, norm, scale, sub
from dilatedem.state.modes import Mode

#: exponent of the norm
SHARP = 12.0
SHARE = log(2.0) / SHARP
#: share of the largest energy below which a feature is left out: its force would be 0.4^11 = 4e-5 of its own
NEGLECTED = 0.4
#: sine of the angle of two edges below which a contact counts as parallel in the statistics (forces do not depend on it)
PARALLEL = 0.02

VERTEX_VERTEX, VERTEX_EDGE, VERTEX_FACE = int(Mode.VERTEX_VERTEX), int(Mode.VERTEX_EDGE), int(Mode.VERTEX_FACE)
EDGE_CROSSING, EDGE_PARALLEL = int(Mode.EDGE_CROSSING), int(Mode.EDGE_PARALLEL)
EDGE_FACE, FACE_FACE = int(Mode.EDGE_FACE), int(Mode.FACE_FACE)
NONE = (0.0, 0.0, 0.0)


@device
def _twelfth(x):
    square = x * x
    fourth = square * square
    return fourth * fourth * fourth


@device
def _join(largest, total, force, moment, energy, more, turn):
    """Add a feature to the sums, kept relative to the largest energy so far."""
    if energy <= largest:
        ratio = energy / largest
        power = _twelfth(ratio)
        share = power / ratio if ratio > 0.0 else 0.0
        return largest, total + power, along(force, share, more), along(moment, share, turn)
    ratio = largest / energy
    power = _twelfth(ratio)
    share = power / ratio if ratio > 0.0 else 0.0
    return energy, total * power + 1.0, along(more, share, force), along(turn, share, moment)


@device
def _line_bound(modulus, length, overlap, curvature):
    """Upper bound of the energy of an edge that presses over `length` by at most `overlap`."""
    lam = OFFSET + log(length * length * curvature / overlap + SHORT) + 1.5
    return 0.5 * pi * modulus * length * overlap * overlap / lam


@item
def pose_energy(vertex, face_normal, shapes, a, b, corner_a, corner_b, offset, normal, pb, modulus, scratch):
    """Energy W [J] of the pose of two bodies whose dilations overlap; force on b [N] and its moment about a's centroid [N m];
    mode and size (area, length or 1) of the leading feature.

    corner_a, corner_b: a closest vertex of each core; offset: centroid of b, normal: unit, from a to b; pb: witness point on b; all
    relative to a's centroid; scratch (6, MOST_CORNERS, 3). The cores must not intersect. b may be a half space.
    """
    ra, rb = shapes.radius[a], shapes.radius[b]
    half_space = shapes.kind[b] != 0
    fa = facing(vertex, face_normal, shapes, a, corner_a, normal)
    na = lay_out(vertex, shapes, a, fa, NONE, scratch, 0)
    normal_a, normal_b = normal, scale(-1.0, normal)
    if fa >= 0:
        normal_a = load(face_normal, fa)
    fb, nb = -1, UNBOUNDED
    if half_space:
        rb = 0.0
        for m in range(3):
            scratch[CORNERS + 1, 0, m] = pb[m]
    else:
        fb = facing(vertex, face_normal, shapes, b, corner_b, normal_b)
        nb = lay_out(vertex, shapes, b, fb, offset, scratch, 1)
        if fb >= 0:
            normal_b = load(face_normal, fb)
    reach = ra + rb
    largest, total, force, moment = 0.0, 0.0, NONE, NONE
    mode, size = VERTEX_FACE, 1.0
    if fa >= 0 and (fb >= 0 or half_space):
        energy, more, turn, area, _ = press_face(scratch, na, normal_a, nb, normal_b, reach, modulus)
        if energy > 0.0:
            largest, total, force, moment = energy, 1.0, more, turn
            mode, size = FACE_FACE, area
    for own in range(2):
        # the edges and the vertices of one cap on the other
        if own == 0:
            which, count, their, radius, other, n = 1, na, nb, ra, rb, normal_b
        else:
            which, count, their, radius, other, n = 0, nb, na, rb, ra, normal_a
        if count == UNBOUNDED:
            continue
        flat = their > 2 or their == UNBOUNDED
        for i in range(count if count > 2 else count - 1):
            p, e = corner_of(scratch, own, i), side_of(scratch, own, i)
            d = sub(corner_of(scratch, own, i + 1 if i + 1 < count else 0), p)
            length = norm(d)
            pressed, deepest = length, reach
            if flat:
                u = reach - dot(sub(p, corner_of(scratch, which, 0)), n)
                v = u - dot(d, n)
                deepest = max(u, v)
                if deepest <= 0.0:
                    continue
                if min(u, v) < 0.0:
                    pressed = length * deepest / abs(u - v)
                if _line_bound(modulus, pressed, deepest, 1.0 / radius) < NEGLECTED * largest:
                    continue
            energy, more, turn, line, mean, across, beyond = press_edge(
                p, e, length, radius, scratch, which, their, n, other, modulus, SHARE
            )
            if energy > NEGLECTED * largest:
                if energy > largest:
                    size = line
                    mode = EDGE_FACE if across < 0.5 else EDGE_PARALLEL
                largest, total, force, moment = _join(largest, total, force, moment, energy, more, turn)
        for i in range(count):
            x = corner_of(scratch, own, i)
            if flat:
                deepest = reach - dot(sub(x, corner_of(scratch, which, 0)), n)
                if deepest <= 0.0:
                    continue
                if 8.0 / 15.0 * modulus * deepest * deepest * sqrt(deepest * radius) < NEGLECTED * largest:
                    continue
            energy, more, _, across, beyond = press_vertex(x, radius, scratch, which, their, n, other, modulus, SHARE)
            if energy > NEGLECTED * largest:
                if energy > largest:
                    size = 1.0
                    mode = VERTEX_FACE if across < 0.5 else (VERTEX_EDGE if beyond < 0.5 else VERTEX_VERTEX)
                largest, total, force, moment = _join(largest, total, force, moment, energy, more, cross(x, more))
        if own == 0:
            # so far the force on a; what follows acts on b
            force, moment = scale(-1.0, force), scale(-1.0, moment)
    root = total ** (1.0 / SHARP) if total > 0.0 else 1.0
    share = root / total if total > 0.0 else 0.0
    return largest * root, scale(share, force), scale(share, moment), mode, size

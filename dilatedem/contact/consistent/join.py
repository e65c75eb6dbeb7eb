"""All features of two caps together: one energy W of the pose, its force and its moment.

W is the 16-norm of the energies of all features that press: W^16 = sum W_i^16. It is smooth where they are, at most 4.4 % above
the largest where two are equal and equal to it where one leads; a feature of less than half the energy does not count.
"""

from math import log, sqrt

from dilatedem.contact.consistent.bounds import bound_edges, edge_counts, line_bound, point_bound, surely_below
from dilatedem.contact.consistent.cap import CORNERS, UNBOUNDED, corner_of, facing, lay_out, lay_sides, nearest, side_of
from dilatedem.contact.consistent.face import press_face
from dilatedem.contact.consistent.four import corners_of, has_four, press_four
from dilatedem.contact.consistent.line import press_edge
from dilatedem.contact.consistent.point import press_vertex
from dilatedem.contact.consistent.rim import FAR, strongest_rim
from dilatedem.contact.support import PARALLEL
from dilatedem.jit import device, item
from dilatedem.numerics.vector import along, cross, dot, load, scale, store, sub
from dilatedem.state.modes import Mode

#: exponent of the norm
SHARP = 16.0
SHARE = log(2.0) / SHARP
#: share of the largest energy below which a feature is left out: its force would be 0.5^15 = 3e-5 of its own
NEGLECTED = 0.5

VERTEX_VERTEX, VERTEX_EDGE, VERTEX_FACE = int(Mode.VERTEX_VERTEX), int(Mode.VERTEX_EDGE), int(Mode.VERTEX_FACE)
EDGE_CROSSING, EDGE_PARALLEL = int(Mode.EDGE_CROSSING), int(Mode.EDGE_PARALLEL)
EDGE_FACE, FACE_FACE = int(Mode.EDGE_FACE), int(Mode.FACE_FACE)
NONE = (0.0, 0.0, 0.0)


@device
def _sharpened(x):
    """x^SHARP."""
    square = x * x
    fourth = square * square
    eighth = fourth * fourth
    return eighth * eighth


@device
def join_feature(largest, total, force, moment, energy, more, turn):
    """Add a feature to the sums, kept relative to the largest energy so far."""
    if energy <= largest:
        ratio = energy / largest
        power = _sharpened(ratio)
        share = power / ratio if ratio > 0.0 else 0.0
        return largest, total + power, along(force, share, more), along(moment, share, turn)
    ratio = largest / energy
    power = _sharpened(ratio)
    share = power / ratio if ratio > 0.0 else 0.0
    return energy, total * power + 1.0, along(more, share, force), along(turn, share, moment)


@item
def _rims_count(scratch, patch, reach, overlap, bluntest, modulus, least):
    """Whether an edge or a vertex beside a patch can have an energy of `least` [J].

    patch: as `press_face` returns it; reach [m]: of both dilations, less what has crushed; overlap [m]: the deepest there is;
    bluntest: the larger radius.
    """
    count, now, tilt, second, longest = patch
    if point_bound(modulus, overlap, bluntest) >= least:
        return True
    if surely_below(modulus, second, longest, overlap, bluntest, least):
        return False
    beyond = sqrt(2.0 * reach * overlap)
    second, longest = strongest_rim(scratch[now], count, beyond, tilt * beyond, overlap)
    return line_bound(modulus, second, longest, overlap, 1.0 / bluntest) >= least


@device
def mode_of_edges(scratch, which, count, normal, p, e, force, moment):
    """Mode of an edge p + s e that presses on an edge of cap `which`: by their angle where the force acts."""
    arm = cross(e, force)
    square = dot(arm, arm)
    x = along(p, dot(sub(moment, cross(p, force)), arm) / square, e) if square > 0.0 else p
    _, place, _ = nearest(scratch, which, count, normal, x)
    c = dot(e, side_of(scratch, which, place if count > 2 else 0))
    return EDGE_CROSSING if 1.0 - c * c > PARALLEL * PARALLEL else EDGE_PARALLEL


@device
def _press_rims(own, first, scratch, count, radius, their, other, normal, reach, overlap, modulus, sums):
    """Add the edges, from the `first` on around, and the vertices of cap `own` (0: of a, 1: of b) that press on the other cap to
    the sums of `join_feature`; returns those with the mode and size of the leading feature.

    count, radius: corners and dilated radius of cap `own`; their, other, normal: of the other cap; reach [m]: of both dilations,
    less what has crushed; overlap [m]: the deepest there is. `bounds.bound_edges` has been here.
    """
    largest, total, force, moment, mode, size, spread = sums
    which, sign = 1 - own, 2.0 * own - 1.0
    flat = their > 2 or their == UNBOUNDED
    edges = count if count > 2 else count - 1
    bluntest = radius if flat else radius * other / (radius + other)
    for k in range(edges):
        i = first + k if first + k < edges else first + k - edges
        if not edge_counts(own, scratch, i, bluntest, modulus, NEGLECTED * largest):
            continue
        p, e = corner_of(scratch, own, i), side_of(scratch, own, i)
        length = dot(sub(corner_of(scratch, own, i + 1 if i + 1 < count else 0), p), e)
        energy, more, turn, line, across = press_edge(
            p, e, length, radius, scratch, which, their, normal, other, reach, modulus, SHARP
        )
        if energy > NEGLECTED * largest:
            if energy > largest:
                mode, size = EDGE_FACE, line
                if across >= 0.5:
                    mode = mode_of_edges(scratch, which, their, normal, p, e, more, turn)
                spread = scale(line / sqrt(12.0), e), NONE
            more, turn = scale(sign, more), scale(sign, turn)
            largest, total, force, moment = join_feature(largest, total, force, moment, energy, more, turn)
    if point_bound(modulus, overlap, radius) < NEGLECTED * largest:
        return largest, total, force, moment, mode, size, spread
    for i in range(count):
        x = corner_of(scratch, own, i)
        if flat:
            deepest = min(reach - dot(sub(x, corner_of(scratch, which, 0)), normal), overlap)
            if deepest <= 0.0 or point_bound(modulus, deepest, radius) < NEGLECTED * largest:
                continue
        energy, more, across, beyond = press_vertex(x, radius, scratch, which, their, normal, other, reach, modulus, SHARE)
        if energy > NEGLECTED * largest:
            if energy > largest:
                mode, size = VERTEX_FACE if across < 0.5 else (VERTEX_EDGE if beyond < 0.5 else VERTEX_VERTEX), 1.0
                spread = NONE, NONE
            more = scale(sign, more)
            largest, total, force, moment = join_feature(largest, total, force, moment, energy, more, cross(x, more))
    return largest, total, force, moment, mode, size, spread


@device
def _lay_out(vertex, shapes, a, b, fa, fb, offset, pb, half_space, scratch):
    """Write the corners of both caps into `scratch`; returns their numbers."""
    na = lay_out(vertex, shapes, a, fa, NONE, scratch, 0)
    if not half_space:
        return na, lay_out(vertex, shapes, b, fb, offset, scratch, 1)
    store(scratch[CORNERS + 1], 0, pb)
    return na, UNBOUNDED


@item
def pose_energy(
    vertex, face_normal, shapes, a, b, corners, corner_a, corner_b, offset, normal, pb, crushed, overlap, modulus, scratch
):  # fmt: skip
    """Energy W [J] of the pose of two bodies whose dilations overlap; force on b [N] and its moment about a's centroid [N m];
    mode, size (area, length or 1) and spread of the leading feature: two vectors [m] whose squares add up to the second moments of
    its overlap.

    corner_a, corner_b: [:corners] the closest vertices of each core; offset: centroid of b, normal: unit, from a to b; pb: witness
    point on b; all relative to a's centroid; crushed [m]: what the reach of both dilations has lost; overlap [m]: of what is left,
    the deepest there is; scratch (8, MOST_CORNERS, 3). The cores must not intersect. b may be a half space.
    """
    ra, rb = shapes.radius[a], shapes.radius[b]
    half_space = shapes.kind[b] != 0
    normal_a, normal_b = normal, scale(-1.0, normal)
    fa, fb = facing(vertex, face_normal, shapes, a, corners, corner_a, normal_a), -1
    if fa >= 0:
        normal_a = load(face_normal, fa)
    if half_space:
        rb = 0.0
    else:
        fb = facing(vertex, face_normal, shapes, b, corners, corner_b, normal_b)
        if fb >= 0:
            normal_b = load(face_normal, fb)
    reach = ra + rb - crushed
    sums = 0.0, 0.0, NONE, NONE, VERTEX_FACE, 1.0, (NONE, NONE)
    needed, told, energy = True, False, 0.0
    more, turn, area, spread, patch = NONE, NONE, 0.0, (NONE, NONE), (0, 0, 0.0, FAR, FAR)
    if fa >= 0 and fb >= 0 and has_four(shapes, fa) and has_four(shapes, fb):
        told, energy, more, turn, area, spread, patch = press_four(
            corners_of(vertex, shapes, fa), normal_a, corners_of(vertex, shapes, fb), normal_b, offset, reach, overlap, modulus,
            scratch,
        )  # fmt: skip
    na, nb = 0, UNBOUNDED
    if not told:
        na, nb = _lay_out(vertex, shapes, a, b, fa, fb, offset, pb, half_space, scratch)
        if fa >= 0 and (fb >= 0 or half_space):
            energy, more, turn, area, spread, patch = press_face(scratch, na, normal_a, nb, normal_b, reach, overlap, modulus)
    if energy > 0.0:
        sums = energy, 1.0, scale(-1.0, more), scale(-1.0, turn), FACE_FACE, area, spread
        needed = _rims_count(scratch, patch, reach, overlap, max(ra, rb), modulus, NEGLECTED * energy)
    if needed:
        if told:
            na, nb = _lay_out(vertex, shapes, a, b, fa, fb, offset, pb, half_space, scratch)
        lay_sides(scratch, 0, na)
        lay_sides(scratch, 1, nb)
        most, first_a = bound_edges(0, scratch, na, nb, normal_b, reach, overlap)
        most_b, first_b = 0.0, 0
        if not half_space:
            most_b, first_b = bound_edges(1, scratch, nb, na, normal_a, reach, overlap)
        # the strongest edge first: beside it, the bounds of most others tell that they do not count
        lead = 0 if most >= most_b else 1
        for own in (lead, 1 - lead):
            if own == 0:
                sums = _press_rims(0, first_a, scratch, na, ra, nb, rb, normal_b, reach, overlap, modulus, sums)
            elif not half_space:
                sums = _press_rims(1, first_b, scratch, nb, rb, na, ra, normal_a, reach, overlap, modulus, sums)
    largest, total, force, moment, mode, size, spread = sums
    if largest == 0.0:
        return 0.0, NONE, NONE, mode, size, spread
    if total == 1.0:  # one feature
        return largest, force, moment, mode, size, spread
    root = sqrt(sqrt(sqrt(sqrt(total))))
    share = root / total
    return largest * root, scale(share, force), scale(share, moment), mode, size, spread

"""Compiled doors to functions of the package that Python cannot call (`device`, `item`)."""

from math import sqrt

import numba
import numpy as np

from dilatedem.contact.collide import separation
from dilatedem.contact.consistent.bounds import BOUNDS, bound_edges, edge_counts, line_bound
from dilatedem.contact.consistent.cap import CORNERS, corner_of, facing, lay_sides, nearest, overhang, side_of
from dilatedem.contact.consistent.cone import energy_of_pose
from dilatedem.contact.consistent.face import press_face
from dilatedem.contact.consistent.four import press_four
from dilatedem.contact.consistent.line import line_energy, press_edge
from dilatedem.contact.consistent.point import elliptic, press_vertex
from dilatedem.contact.consistent.rim import strongest_rim
from dilatedem.contact.crushing.nominal import nominal_area
from dilatedem.contact.liu2015.cone import patch_of
from dilatedem.contact.search.cone import closest
from dilatedem.contact.search.simplex import closest_on_triangle
from dilatedem.contact.shared_face import shared_part
from dilatedem.contact.spring import carried_over, rescaled, slide, viscous_share
from dilatedem.contact.turning import turn_shape
from dilatedem.jit import device, kernel
from dilatedem.numerics.vector import store
from dilatedem.state.storage import MOST_CORNERS
from dilatedem.step.hits import watch_hits
from dilatedem.water.floating import submerged_polyhedron, submerged_prism


def door(function):
    """A function of Python that calls a compiled one, whatever its arguments."""

    @numba.njit(error_model="numpy")
    def call(*arguments):
        return function(*arguments)

    return call


hertz_factor, line_law, triangle_point = door(elliptic), door(line_energy), door(closest_on_triangle)
carried_spring, rescaled_spring, slid_spring, share_of_dashpot = map(door, (carried_over, rescaled, slide, viscous_share))


@kernel
def distance_of_pair(shapes, surroundings, bodies, pairs, vertex, face_normal, k):
    """`closest` of pair k, its bodies turned: distance, normal, witness points, offset of b. The pair remembers its
    normal.
    """
    a, b = pairs.a[k], pairs.b[k]
    turn_shape(a, shapes, bodies.orientation, vertex, face_normal)
    turn_shape(b, shapes, bodies.orientation, vertex, face_normal)
    offset = separation(bodies.position, a, b, surroundings)
    distance, normal, pa, pb = closest(vertex, face_normal, shapes, pairs, k, a, b, offset)
    store(pairs.normal, k, normal)
    return distance, normal, pa, pb, offset


@kernel
def patch_of_pair(shapes, pairs, vertex, face_normal, k, offset, normal, pa, pb, overlap, scratch):
    """`patch_of` of pair k, its bodies turned and its corners known by `distance_of_pair`."""
    return patch_of(
        vertex, face_normal, shapes, pairs.corners[k], pairs.corner_a[k], pairs.corner_b[k], pairs.a[k], pairs.b[k],
        offset, normal, pa, pb, overlap, 0.0, scratch,
    )  # fmt: skip


@kernel
def energy_of_pair(shapes, pairs, vertex, face_normal, k, offset, normal, pb, overlap, modulus, scratch):
    """`energy_of_pose` of pair k, its bodies turned and its corners known by `distance_of_pair`."""
    return energy_of_pose(
        vertex, face_normal, shapes, pairs.a[k], pairs.b[k], pairs.corners[k], pairs.corner_a[k], pairs.corner_b[k], offset,
        normal, pb, 0.0, overlap, modulus, scratch,
    )  # fmt: skip


@kernel
def area_of_pair(shapes, pairs, vertex, face_normal, k, offset, normal, pa, pb, depth, scratch):
    """`nominal_area` of pair k, its bodies turned."""
    return nominal_area(vertex, face_normal, shapes, pairs.a[k], pairs.b[k], offset, normal, pa, pb, depth, scratch)


@kernel
def shared_by_pair(shapes, vertex, face_a, face_b, offset, normal, scratch):
    """`shared_part` of two faces, their bodies turned."""
    return shared_part(face_a, face_b, offset, normal, vertex, shapes, scratch)


@kernel
def wet_prism(z, nx, ny, nz, hulls, body):
    """`submerged_prism`."""
    return submerged_prism(z, nx, ny, nz, hulls.plan, hulls.height, body)


@kernel
def wet_polyhedron(z, nx, ny, nz, hulls, body, works):
    """`submerged_polyhedron` in the first workspace."""
    return submerged_polyhedron(z, nx, ny, nz, hulls, body, works, 0)


def workspace_of(cap_b, cap_a=()) -> np.ndarray:
    """The workspace of the consistent model with the corners (n, 3) [m] of both caps written; n = 0: as it comes."""
    scratch = np.zeros((8, MOST_CORNERS, 3))
    for which, corners in enumerate((cap_a, cap_b)):
        scratch[CORNERS + which, : len(corners)] = np.reshape(corners, (-1, 3))
    return scratch


@kernel
def face_towards(shapes, vertex, face_normal, body, corners, direction):
    """`facing`; corners (n,): the closest vertices."""
    return facing(vertex, face_normal, shapes, body, len(corners), corners, direction)


@kernel
def around_cap(scratch, count, normal, x, width):
    """`nearest` and `overhang` of the cap of b."""
    lay_sides(scratch, 1, count)
    region, place, w = nearest(scratch, 1, count, normal, x)
    return region, place, w, overhang(scratch, 1, count, normal, region, place, w, width)



@kernel
def point_on_cap(x, radius, scratch, count, normal, other, modulus, shares):
    """`press_vertex` on the cap of b."""
    lay_sides(scratch, 1, count)
    return press_vertex(x, radius, scratch, 1, count, normal, other, radius + other, modulus, shares)



@kernel
def edge_on_cap(p, e, length, radius, scratch, count, normal, other, modulus, sharp):
    """`press_edge` on the cap of b."""
    lay_sides(scratch, 1, count)
    return press_edge(p, e, length, radius, scratch, 1, count, normal, other, radius + other, modulus, sharp)


@kernel
def bound_on_cap(scratch, length, radius, count, normal, other, overlap, modulus, sharp):
    """Of the edge that is the cap of a, on the cap of b: `press_edge`'s energy, `line_bound` by `bound_edges`, and whether
    `edge_counts` says that it can have that energy."""
    lay_sides(scratch, 0, 2)
    lay_sides(scratch, 1, count)
    reach = radius + other
    bound_edges(0, scratch, 2, count, normal, reach, overlap)
    energy = press_edge(
        corner_of(scratch, 0, 0), side_of(scratch, 0, 0), length, radius, scratch, 1, count, normal, other, reach, modulus, sharp
    )[0]
    blunt = radius * other / reach if count == 1 or count == 2 else radius
    second, pressed, deepest = scratch[BOUNDS, 0, 0], scratch[BOUNDS, 0, 1], scratch[BOUNDS, 0, 2]
    most = line_bound(modulus, second, pressed, deepest, 1.0 / blunt) if second > 0.0 else 0.0
    return energy, most, edge_counts(0, scratch, 0, blunt, modulus, energy)


@kernel
def face_on_cap(scratch, count_a, normal_a, count_b, normal_b, reach, overlap, modulus):
    """`press_face`: energy, force, moment, area, spread; `strongest_rim` and `any_rim` of its patch."""
    energy, force, moment, area, spread, (count, now, tilt, second, longest) = press_face(
        scratch, count_a, normal_a, count_b, normal_b, reach, overlap, modulus
    )
    rims = 0.0, 0.0
    if energy > 0.0:
        beyond = sqrt(2.0 * reach * overlap)
        rims = strongest_rim(scratch[now], count, beyond, tilt * beyond, overlap)
    return energy, force, moment, area, spread, rims, (second, longest)


@device
def _four_corners(scratch, which):
    return corner_of(scratch, which, 0), corner_of(scratch, which, 1), corner_of(scratch, which, 2), corner_of(scratch, which, 3)


@kernel
def four_on_four(scratch, normal_a, normal_b, reach, overlap, modulus):
    """`press_four` of both caps: whether it can tell, energy, force, moment, area, spread, patch; `strongest_rim` of the patch."""
    found = press_four(
        _four_corners(scratch, 0), normal_a, _four_corners(scratch, 1), normal_b, (0.0, 0.0, 0.0), reach, overlap, modulus, scratch
    )
    beyond, (count, now, tilt, _, _) = sqrt(2.0 * reach * overlap), found[6]
    rims = strongest_rim(scratch[now], count, beyond, tilt * beyond, overlap) if found[0] else (0.0, 0.0)
    return found, rims


@kernel
def watch_history(force, dt, clock, model, ids, bodies, pairs, workspace, loads, hits, log):
    """`watch_hits` of structures that bear the forces (steps, w, 3) [N] one step after the other, from no contact."""
    for k in range(force.shape[0]):
        clock.step[0] += 1
        for h in range(force.shape[1]):
            for m in range(3):
                loads.step_load[h, m] = force[k, h, m]
        watch_hits(clock.step[0], 0, 0, dt, model, ids, bodies, pairs, workspace, loads, hits, log)



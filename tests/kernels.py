"""Compiled doors to functions of the package that Python cannot call (`device`, `item`): thin, one call each."""

from dilatedem.contact.closest import closest_points
from dilatedem.contact.collide import separation
from dilatedem.contact.consistent.join import pose_energy
from dilatedem.contact.patch import contact_patch
from dilatedem.contact.turning import turn_shape
from dilatedem.jit import kernel
from dilatedem.numerics.vector import store
from dilatedem.water.floating import submerged_polyhedron, submerged_prism


@kernel
def distance_of_pair(shapes, surroundings, bodies, pairs, vertex, face_normal, k):
    """`closest_points` of pair k, its bodies turned: distance, normal, witness points, offset of b. The pair remembers its
    normal.
    """
    a, b = pairs.a[k], pairs.b[k]
    turn_shape(a, shapes, bodies.orientation, vertex, face_normal)
    turn_shape(b, shapes, bodies.orientation, vertex, face_normal)
    offset = separation(bodies.position, a, b, surroundings)
    distance, normal, pa, pb = closest_points(vertex, face_normal, shapes, pairs, k, a, b, offset)
    store(pairs.normal, k, normal)
    return distance, normal, pa, pb, offset


@kernel
def patch_of_pair(shapes, pairs, vertex, face_normal, k, offset, normal, pa, pb, overlap, scratch):
    """`contact_patch` of pair k, its bodies turned and its corners known by `distance_of_pair`."""
    return contact_patch(
        vertex, face_normal, shapes, pairs.corners[k], pairs.corner_a[k], pairs.corner_b[k], pairs.a[k], pairs.b[k],
        offset, normal, pa, pb, overlap, scratch,
    )  # fmt: skip


@kernel
def energy_of_pair(shapes, pairs, vertex, face_normal, k, offset, normal, pb, overlap, modulus, scratch):
    """`pose_energy` of pair k, its bodies turned and its corners known by `distance_of_pair`."""
    return pose_energy(
        vertex, face_normal, shapes, pairs.a[k], pairs.b[k], pairs.corner_a[k, 0], pairs.corner_b[k, 0], offset, normal, pb,
        overlap, modulus, scratch,
    )  # fmt: skip


@kernel
def wet_prism(z, nx, ny, nz, hulls, body):
    """`submerged_prism`."""
    return submerged_prism(z, nx, ny, nz, hulls.plan, hulls.height, body)


@kernel
def wet_polyhedron(z, nx, ny, nz, hulls, body, works):
    """`submerged_polyhedron` in the first workspace."""
    return submerged_polyhedron(z, nx, ny, nz, hulls, body, works, 0)

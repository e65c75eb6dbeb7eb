"""Mass properties of a dilated core, in closed form.

The solid falls apart into the core, a slab on every face, a cylinder wedge on every edge and a ball sector on
every vertex (Liu 2015, section 1.1). Each part yields its volume, first and second moment exactly, for cores
of dimension 0 to 3 alike: a capsule has no faces and one wedge of 2 pi, a plate has two faces and wedges of
pi, a sphere one sector of 4 pi.

The ball sector over the normal cone of a vertex needs the moments of a spherical polygon. Its arcs belong to
the edges that leave the vertex: an arc's length is the edge's exterior dihedral angle, and its outward
conormal is the edge's direction. So the boundary integrals of Arvo (1995, "Applications of irradiance tensors
to the simulation of non-Lambertian phenomena", recurrence for T^n) come straight from the edges,

    int w dS   = -1/2 sum_e theta_e d_e
    int w w dS =  1/3 (Omega I - sum_e (int_arc w ds) d_e),

and by Gauss-Bonnet the solid angle Omega is 2 pi less the face angles at the vertex.

All bodies of a stack are worked together (see `geometry.polyhedron`): the arrays below have its axis in front, `...`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from dilatedem.geometry.polyhedron import Polyhedron, add_rows, edge_faces, rows, triangles, weighted
from dilatedem.numerics.plain import angle, determinant, dot, norm, sine_cosine

Moments = tuple[np.ndarray, np.ndarray, np.ndarray]  # int dV (...,) [m3], int x dV (..., 3) [m4], int x x dV (..., 3, 3) [m5]


@dataclass(frozen=True, eq=False)
class SolidProperties:
    """Volume [m3], centroid (3,) [m], inertia (3, 3) [m5] about it for unit density, in the core's axes; of a stack (m,), (m, 3),
    (m, 3, 3).
    """

    volume: float | np.ndarray
    centroid: np.ndarray
    inertia: np.ndarray


def dilated_solid(core: Polyhedron, radius: float) -> SolidProperties:
    """Mass properties of `core`, or of each core of a stack, dilated by a sphere of `radius` >= 0 [m]; exact up to round-off.

    V = V0 + S0 r + M r^2 + 4/3 pi r^3 (physics 2); centroid and inertia by the same decomposition.
    Raises ValueError when the solid has no volume.
    """
    if not radius >= 0.0:
        raise ValueError(f"dilated radius = {radius} m: must be at least 0")
    # moments about a point inside, so that a body far from the origin loses no digits
    reference = core.vertices.mean(axis=-2)
    local = core.translated(-reference)
    edges = edge_arcs(local)
    parts = (
        _core(local),
        _face_slabs(local, radius),
        _edge_wedges(local, radius, edges),
        _vertex_sectors(local, radius, edges),
    )
    volume = sum(part[0] for part in parts)
    if not (volume > 0.0).all():
        raise ValueError("the body has no volume: a core that is not solid needs a dilated radius above 0")
    centroid = sum(part[1] for part in parts) / volume[..., None]
    outer = centroid[..., :, None] * centroid[..., None, :]
    second = sum(part[2] for part in parts) - volume[..., None, None] * outer
    second = 0.5 * (second + np.swapaxes(second, -1, -2))
    inertia = np.trace(second, axis1=-2, axis2=-1)[..., None, None] * np.eye(3) - second
    return SolidProperties(volume[()], reference + centroid, inertia)


@dataclass(frozen=True, eq=False)
class EdgeArcs:
    """What the normals sweep over at each edge: an arc of `angle` (..., e) [rad] square to the edge's unit
    `direction` (..., e, 3), around the unit vector `middle` (..., e, 3).
    """

    angle: np.ndarray
    direction: np.ndarray
    middle: np.ndarray


def edge_arcs(core: Polyhedron) -> EdgeArcs:
    """The arc of outward normals at every edge of a core of dimension 1 to 3 (none for a point)."""
    start, end = _ends(core)
    direction = (end - start) / norm(end - start)[..., None]
    if core.dimension == 1:
        across = np.cross(direction, np.eye(3)[np.abs(direction).argmin(axis=-1)])
        return EdgeArcs(np.full(direction.shape[:-1], 2.0 * np.pi), direction, across / norm(across)[..., None])
    beside = edge_faces(core)
    left, right = rows(core.normals, beside[:, 0]), rows(core.normals, beside[:, 1])
    # The normals alone lose the bisector on a plate (opposite normals), the in-face outward directions lose
    # it where faces are nearly coplanar; their sum is safe in between too.
    middle = left + right + np.cross(direction, left) - np.cross(direction, right)
    return EdgeArcs(angle(norm(np.cross(left, right)), dot(left, right)), direction, middle / norm(middle)[..., None])


def _ends(core: Polyhedron) -> tuple[np.ndarray, np.ndarray]:
    """Start and end (..., e, 3) of every edge."""
    return rows(core.vertices, core.edges[:, 0]), rows(core.vertices, core.edges[:, 1])


def _nothing(core: Polyhedron) -> Moments:
    stack = core.vertices.shape[:-2]
    return np.zeros(stack), np.zeros((*stack, 3)), np.zeros((*stack, 3, 3))


def _products(weight: np.ndarray, u: np.ndarray, v: np.ndarray) -> np.ndarray:
    """(..., 3, 3) sum over k of weight (..., k) times u v^T of vectors (..., k, 3)."""
    return ((weight[..., None] * u)[..., :, None] * v[..., None, :]).sum(axis=-3)


def _corner_products(weight: np.ndarray, corner: np.ndarray) -> np.ndarray:
    """`_products` of the corners (..., k, 3, 3) of triangles with themselves."""
    return sum(_products(weight, corner[..., c, :], corner[..., c, :]) for c in range(3))


def _with_transpose(matrix: np.ndarray) -> np.ndarray:
    return matrix + np.swapaxes(matrix, -1, -2)


def _core(core: Polyhedron) -> Moments:
    if core.dimension < 3:
        return _nothing(core)
    corner = rows(core.vertices, triangles(core)[0])
    volume = determinant(corner) / 6.0  # tetrahedra from the reference point
    total = corner.sum(axis=-2)
    first = weighted(volume, total) / 4.0
    second = (_products(volume, total, total) + _corner_products(volume, corner)) / 20.0
    return volume.sum(axis=-1), first, second


def _face_slabs(core: Polyhedron, r: float) -> Moments:
    """Slabs x = p + s n, 0 <= s <= r, p on the face."""
    if not core.faces:
        return _nothing(core)
    index, face = triangles(core)
    corner, normal = rows(core.vertices, index), rows(core.normals, face)
    spanned = np.cross(corner[..., 1, :] - corner[..., 0, :], corner[..., 2, :] - corner[..., 0, :])
    area = 0.5 * dot(spanned, normal)
    total = corner.sum(axis=-2)
    second = _products(area, total, total) + _corner_products(area, corner)
    mixed = _products(area, total / 3.0, normal)
    upright = _products(area, normal, normal)
    return (
        area.sum(axis=-1) * r,
        weighted(r * area, total) / 3.0 + weighted(0.5 * r * r * area, normal),
        r * second / 12.0 + 0.5 * r * r * _with_transpose(mixed) + r * r * r / 3.0 * upright,
    )


def _edge_wedges(core: Polyhedron, r: float, arcs: EdgeArcs) -> Moments:
    """Wedges x = p + s e(phi), 0 <= s <= r, p on the edge, |phi| <= theta/2 from the bisector."""
    if len(core.edges) == 0:
        return _nothing(core)
    start, end = _ends(core)
    length, middle, side = norm(end - start), arcs.middle, np.cross(arcs.direction, arcs.middle)
    sine, half_sine = sine_cosine(arcs.angle)[0], sine_cosine(0.5 * arcs.angle)[0]
    total = start + end
    sector = length * arcs.angle * (r * r) / 2.0
    pull = length * 2.0 * half_sine * (r * r * r) / 3.0  # first moment of the sector, along the bisector
    along = _products(sector, total, total)
    along += _products(sector, start, start) + _products(sector, end, end)
    mixed = _products(pull, total / 2.0, middle)
    across = _products(length * (arcs.angle + sine), middle, middle)
    across += _products(length * (arcs.angle - sine), side, side)
    return (
        sector.sum(axis=-1),
        weighted(sector, total) / 2.0 + weighted(pull, middle),
        along / 6.0 + mixed + np.swapaxes(mixed, -1, -2) + r * r * r * r / 8.0 * across,
    )


def _vertex_sectors(core: Polyhedron, r: float, arcs: EdgeArcs) -> Moments:
    """Sectors x = v + s w, 0 <= s <= r, w in the normal cone of v; see the head of this module."""
    solid_angle = _solid_angles(core)
    first = vertex_directions(core, arcs)
    second = solid_angle[..., None, None] * np.eye(3)  # three times int w w dS
    flat = second.reshape(*second.shape[:-2], 9)
    chord = 2.0 * sine_cosine(0.5 * arcs.angle)[0][..., None] * arcs.middle  # int w ds over each arc
    for end, outward in ((0, arcs.direction), (1, -arcs.direction)):
        swept = chord[..., :, None] * outward[..., None, :]
        add_rows(flat, core.edges[:, end], -swept.reshape(*swept.shape[:-2], 9))
    x = core.vertices
    r3 = r * r * r
    mixed = r3 * r / 4.0 * (x[..., :, None] * first[..., None, :]).sum(axis=-3)
    volume = r3 / 3.0 * solid_angle
    return (
        volume.sum(axis=-1),
        weighted(volume, x) + r3 * r / 4.0 * first.sum(axis=-2),
        _products(volume, x, x) + mixed + np.swapaxes(mixed, -1, -2) + r3 * r * r / 15.0 * second.sum(axis=-3),
    )


def vertex_directions(core: Polyhedron, arcs: EdgeArcs) -> np.ndarray:
    """(..., n, 3) int w dS over the normal cone of every vertex: a vector well inside the cone."""
    direction = np.zeros_like(core.vertices)
    add_rows(direction, core.edges[:, 0], -0.5 * arcs.angle[..., None] * arcs.direction)
    add_rows(direction, core.edges[:, 1], 0.5 * arcs.angle[..., None] * arcs.direction)
    return direction


def _solid_angles(core: Polyhedron) -> np.ndarray:
    """(..., n) solid angle of the normal cone of every vertex; they sum to 4 pi."""
    *stack, count, _ = core.vertices.shape
    if count == 1:
        return np.full((*stack, 1), 4.0 * np.pi)
    solid_angle = np.full((*stack, count), 2.0 * np.pi)
    for loop in core.faces:
        corner = rows(core.vertices, loop)
        ahead, behind = np.roll(corner, -1, axis=-2) - corner, np.roll(corner, 1, axis=-2) - corner
        solid_angle[..., loop] -= angle(norm(np.cross(ahead, behind)), dot(ahead, behind))
    return solid_angle

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

Moments = tuple[np.ndarray, np.ndarray, np.ndarray]  # int dV (...,) [m3], int x dV (..., 3) [m4], int x x dV (..., 3, 3) [m5]

# Sums of products over k: of a weight and two vectors, of a weight and the corners c of triangles with themselves.
PRODUCTS = "...k,...ki,...kj->...ij"
CORNER_PRODUCTS = "...k,...kci,...kcj->...ij"


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
    direction = (end - start) / np.linalg.norm(end - start, axis=-1, keepdims=True)
    if core.dimension == 1:
        across = np.cross(direction, np.eye(3)[np.abs(direction).argmin(axis=-1)])
        angle = np.full(direction.shape[:-1], 2.0 * np.pi)
        return EdgeArcs(angle, direction, across / np.linalg.norm(across, axis=-1, keepdims=True))
    beside = edge_faces(core)
    left, right = rows(core.normals, beside[:, 0]), rows(core.normals, beside[:, 1])
    angle = np.arctan2(np.linalg.norm(np.cross(left, right), axis=-1), np.einsum("...i,...i->...", left, right))
    # The normals alone lose the bisector on a plate (opposite normals), the in-face outward directions lose
    # it where faces are nearly coplanar; their sum is safe in between too.
    middle = left + right + np.cross(direction, left) - np.cross(direction, right)
    length = np.linalg.norm(middle, axis=-1, keepdims=True)
    return EdgeArcs(angle, direction, middle / length)


def _ends(core: Polyhedron) -> tuple[np.ndarray, np.ndarray]:
    """Start and end (..., e, 3) of every edge."""
    return rows(core.vertices, core.edges[:, 0]), rows(core.vertices, core.edges[:, 1])


def _nothing(core: Polyhedron) -> Moments:
    stack = core.vertices.shape[:-2]
    return np.zeros(stack), np.zeros((*stack, 3)), np.zeros((*stack, 3, 3))


def _with_transpose(matrix: np.ndarray) -> np.ndarray:
    return matrix + np.swapaxes(matrix, -1, -2)


def _core(core: Polyhedron) -> Moments:
    if core.dimension < 3:
        return _nothing(core)
    corner = rows(core.vertices, triangles(core)[0])
    volume = np.linalg.det(corner) / 6.0  # tetrahedra from the reference point
    total = corner.sum(axis=-2)
    first = weighted(volume, total) / 4.0
    second = (np.einsum(PRODUCTS, volume, total, total) + np.einsum(CORNER_PRODUCTS, volume, corner, corner)) / 20.0
    return volume.sum(axis=-1), first, second


def _face_slabs(core: Polyhedron, r: float) -> Moments:
    """Slabs x = p + s n, 0 <= s <= r, p on the face."""
    if not core.faces:
        return _nothing(core)
    index, face = triangles(core)
    corner, normal = rows(core.vertices, index), rows(core.normals, face)
    spanned = np.cross(corner[..., 1, :] - corner[..., 0, :], corner[..., 2, :] - corner[..., 0, :])
    area = 0.5 * np.einsum("...i,...i->...", spanned, normal)
    total = corner.sum(axis=-2)
    second = np.einsum(PRODUCTS, area, total, total) + np.einsum(CORNER_PRODUCTS, area, corner, corner)
    mixed = np.einsum(PRODUCTS, area, total / 3.0, normal)
    upright = np.einsum(PRODUCTS, area, normal, normal)
    return (
        area.sum(axis=-1) * r,
        weighted(r * area, total) / 3.0 + weighted(0.5 * r**2 * area, normal),
        r * second / 12.0 + 0.5 * r**2 * _with_transpose(mixed) + r**3 / 3.0 * upright,
    )


def _edge_wedges(core: Polyhedron, r: float, arcs: EdgeArcs) -> Moments:
    """Wedges x = p + s e(phi), 0 <= s <= r, p on the edge, |phi| <= theta/2 from the bisector."""
    if len(core.edges) == 0:
        return _nothing(core)
    start, end = _ends(core)
    length = np.linalg.norm(end - start, axis=-1)
    middle, side, angle = arcs.middle, np.cross(arcs.direction, arcs.middle), arcs.angle
    total = start + end
    sector = length * angle * r**2 / 2.0
    pull = length * 2.0 * np.sin(0.5 * angle) * r**3 / 3.0  # first moment of the sector, along the bisector
    along = np.einsum(PRODUCTS, sector, total, total)
    along += np.einsum(PRODUCTS, sector, start, start) + np.einsum(PRODUCTS, sector, end, end)
    mixed = np.einsum(PRODUCTS, pull, total / 2.0, middle)
    across = np.einsum(PRODUCTS, length * (angle + np.sin(angle)), middle, middle)
    across += np.einsum(PRODUCTS, length * (angle - np.sin(angle)), side, side)
    return (
        sector.sum(axis=-1),
        weighted(sector, total) / 2.0 + weighted(pull, middle),
        along / 6.0 + mixed + np.swapaxes(mixed, -1, -2) + r**4 / 8.0 * across,
    )


def _vertex_sectors(core: Polyhedron, r: float, arcs: EdgeArcs) -> Moments:
    """Sectors x = v + s w, 0 <= s <= r, w in the normal cone of v; see the head of this module."""
    solid_angle = _solid_angles(core)
    first = vertex_directions(core, arcs)
    second = solid_angle[..., None, None] * np.eye(3)  # three times int w w dS
    flat = second.reshape(*second.shape[:-2], 9)
    chord = 2.0 * np.sin(0.5 * arcs.angle)[..., None] * arcs.middle  # int w ds over each arc
    for end, outward in ((0, arcs.direction), (1, -arcs.direction)):
        swept = chord[..., :, None] * outward[..., None, :]
        add_rows(flat, core.edges[:, end], -swept.reshape(*swept.shape[:-2], 9))
    x = core.vertices
    mixed = r**4 / 4.0 * np.einsum("...ki,...kj->...ij", x, first)
    volume = r**3 / 3.0 * solid_angle
    return (
        volume.sum(axis=-1),
        weighted(volume, x) + r**4 / 4.0 * first.sum(axis=-2),
        np.einsum(PRODUCTS, volume, x, x) + mixed + np.swapaxes(mixed, -1, -2) + r**5 / 15.0 * second.sum(axis=-3),
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
        sine = np.linalg.norm(np.cross(ahead, behind), axis=-1)
        solid_angle[..., loop] -= np.arctan2(sine, np.einsum("...i,...i->...", ahead, behind))
    return solid_angle

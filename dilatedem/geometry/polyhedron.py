"""Convex polyhedra: vertices, edges and faces of a core, down to the single vertex.

A core of dimension 3 is an ordinary convex polyhedron. The smaller ones share its form, so that whoever walks
over vertices, edges and faces needs no special case: a flat polygon has two faces (one loop, run in both
directions), a segment one edge and no face, a point one vertex and nothing else.

Many bodies of one topology can be worked together: a *stack* of m bodies is a polyhedron whose vertices and normals have a first
axis of length m, while edges and faces stand once for all. A field of 100 000 floes is some dozens of stacks.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from dilatedem.geometry.qhull import ConvexHull, QhullError
from dilatedem.numerics.plain import determinant, dot, norm

# Relative to the largest extent of the body: points closer than this are one point, a set thinner than this
# is flat (or straight), and facets whose vertices lie this near one plane are one face. 3e-8 m for a floe of
# 3 m: far above the round-off of the hull (1e-14), far below any overlap that carries a force (1e-6 m).
RESOLUTION = 1e-8


@dataclass(frozen=True, eq=False)
class Polyhedron:
    """A convex polyhedron of dimension 0 to 3, or a stack of m of them.

    vertices (n, 3) [m]; of a stack (m, n, 3)
    edges    (e, 2) vertex indices, smaller first, each edge once
    faces    vertex loops, counter-clockwise seen from outside
    normals  (f, 3) outward unit normals, one per face; of a stack (m, f, 3)
    """

    vertices: np.ndarray
    edges: np.ndarray
    faces: tuple[np.ndarray, ...]
    normals: np.ndarray

    @property
    def dimension(self) -> int:
        """0 for a point, 1 for a segment, 2 for a flat polygon, 3 for a solid."""
        if len(self.faces) > 2:
            return 3
        return 2 if self.faces else len(self.edges)

    def translated(self, shift: ArrayLike) -> Polyhedron:
        """The same body moved by `shift` (3,) [m]; of a stack each by its own, (m, 3), or all by one."""
        return replace(self, vertices=self.vertices + np.asarray(shift, dtype=float)[..., None, :])

    def scaled(self, factor: ArrayLike) -> Polyhedron:
        """The same body scaled by `factor` > 0 about the origin; of a stack each by its own, (m,), or all by one."""
        return replace(self, vertices=self.vertices * np.asarray(factor, dtype=float)[..., None, None])

    def stacked(self) -> Polyhedron:
        """A stack; a single body as a stack of one."""
        single = self.vertices.ndim == 2
        return replace(self, vertices=self.vertices[None], normals=self.normals[None]) if single else self

    def member(self, which) -> Polyhedron:
        """Of a stack: one body by its index, a smaller stack by a slice or an array of indices."""
        return replace(self, vertices=self.vertices[which], normals=self.normals[which])


def convex_hull(points: ArrayLike) -> Polyhedron:
    """Convex hull of `points` (n, 3) [m], of whatever dimension they span.

    Points inside the hull, inside a face or inside an edge are dropped; facets in one plane become one face.
    The vertices of a flat polygon come in the order of its loop, those of a solid in the order of `points`.
    Raises ValueError for anything but n >= 1 finite points in space.
    """
    points = np.asarray(points, dtype=float)
    if points.ndim != 2 or points.shape[1] != 3 or len(points) == 0:
        raise ValueError(f"points have shape {points.shape}: must be (n, 3) with at least one point")
    if not np.isfinite(points).all():
        raise ValueError("points hold a value that is not finite: every coordinate must be a number")

    centre = 0.5 * (points.min(axis=0) + points.max(axis=0))
    size = float(np.ptp(points, axis=0).max())
    if size == 0.0:
        return assemble(points[:1], ())
    points = _distinct(points, RESOLUTION * size)
    local = (points - centre) / size

    along = _axes(local)
    extent = np.ptp(along, axis=0)
    if extent[1] <= RESOLUTION:
        ends = np.sort([along[:, 0].argmin(), along[:, 0].argmax()])
        return assemble(points[ends], ())
    if extent[2] <= RESOLUTION:
        loop = _flat_loop(along[:, :2])
        ring = np.arange(len(loop))
        return assemble(points[loop], (ring, ring[::-1].copy()))
    return _solid_hull(points, local)


def prism(outline: ArrayLike, z_bottom: ArrayLike, z_top: ArrayLike) -> Polyhedron:
    """Vertical right prism over a convex counter-clockwise `outline` (n, 2) [m] between two heights [m].

    Vertices: bottom ring 0..n-1, then top ring n..2n-1. Faces: 0 the bottom, 1 the top, then one per side in
    the order of the outline. Equal heights give a flat polygon. Outlines (m, n, 2) give a stack,
    their heights being (m,) or common to all. Raises ValueError when the heights are in the wrong order.
    """
    outline = np.asarray(outline, dtype=float)
    if outline.ndim not in (2, 3) or outline.shape[-1] != 2 or outline.shape[-2] < 3:
        raise ValueError(f"outline has shape {outline.shape}: must be (n, 2) with at least three points")
    count = outline.shape[-2]
    ring = np.arange(count)
    # round-off in t/2 - r may put the top a hair below the bottom of a floe that is just two radii thick
    flat = RESOLUTION * float(np.ptp(outline, axis=-2).max())
    height = np.subtract(z_top, z_bottom)
    if not np.all(height >= -flat):
        raise ValueError(f"the top of a prism ({z_top} m) must not lie below its bottom ({z_bottom} m)")
    if np.all(height <= flat):
        return assemble(_at_height(outline, 0.5 * np.add(z_bottom, z_top)), (ring[::-1].copy(), ring))
    following = np.roll(ring, -1)
    sides = np.column_stack((ring, following, following + count, ring + count))
    rings = np.concatenate((_at_height(outline, z_bottom), _at_height(outline, z_top)), axis=-2)
    return assemble(rings, (ring[::-1].copy(), ring + count, *sides))


def _at_height(outline: np.ndarray, z: ArrayLike) -> np.ndarray:
    """Points (..., n, 2) in plan as points (..., n, 3) at a height, of its own for each body of a stack."""
    points = np.empty((*outline.shape[:-1], 3))
    points[..., :2] = outline
    points[..., 2] = np.asarray(z, dtype=float)[..., None]
    return points


def assemble(vertices: ArrayLike, faces: Sequence[np.ndarray]) -> Polyhedron:
    """A polyhedron of known faces: vertices (n, 3) [m] and loops, counter-clockwise seen from outside; (m, n, 3) for a stack.

    One vertex or two need no faces, a flat polygon two. Raises ValueError unless the loops close into one
    surface.
    """
    vertices = np.array(vertices, dtype=float)
    *stack, count, _ = vertices.shape
    if not faces:
        edges = np.array([[0, 1]], dtype=np.int64) if count == 2 else np.empty((0, 2), dtype=np.int64)
        return Polyhedron(vertices, edges, (), np.empty((*stack, 0, 3)))
    loops = tuple(np.asarray(f, dtype=np.int64) for f in faces)
    start, end, face = _directed_edges(loops)
    forward = np.sort((start * count + end)[start < end])
    backward = np.sort((end * count + start)[start > end])
    closed = len(forward) == len(backward) and (forward == backward).all() and (np.diff(forward) > 0).all()
    if not closed or (len(loops) > 2 and count - len(forward) + len(loops) != 2):
        raise ValueError("the faces do not close into one surface: the points are too close to degenerate")
    edges = np.column_stack(np.divmod(forward, count))

    # Newell's normal: twice the area vector of the loop, taken about its first vertex to keep the digits
    base = rows(vertices, np.array([f[0] for f in loops])[face])
    area_vector = np.zeros((*stack, len(loops), 3))
    add_rows(area_vector, face, np.cross(rows(vertices, start) - base, rows(vertices, end) - base))
    length = norm(area_vector)[..., None]
    if not (length > 0.0).all():
        raise ValueError("a face has no area: the points are too close to degenerate")
    return Polyhedron(vertices, edges, loops, area_vector / length)


def rows(values: np.ndarray, which: np.ndarray) -> np.ndarray:
    """values[..., which, :], laid out in this order in memory; indexing itself may put the stack last, which is slower and rounds
    sums in another order than for a single body.
    """
    return np.take(values, which, axis=-2)


def add_rows(total: np.ndarray, row: np.ndarray, added: np.ndarray) -> None:
    """total[..., row[k], :] += added[..., k, :] for one k after the other, in place: `np.add.at` for all bodies of a stack."""
    for k, r in enumerate(row):
        total[..., r, :] += added[..., k, :]


def edge_faces(body: Polyhedron) -> np.ndarray:
    """(m, 2) the faces beside each edge: first the one whose loop runs along it, then the one that runs
    against.

    -1 where there is no face (the edge of a capsule).
    """
    beside = np.full((len(body.edges), 2), -1, dtype=np.int64)
    if body.faces:
        start, end, face = _directed_edges(body.faces)
        forward = start < end
        # edges are sorted by (first, second), so sorting the directed ones likewise lines them up
        beside[:, 0] = face[forward][np.lexsort((end[forward], start[forward]))]
        beside[:, 1] = face[~forward][np.lexsort((start[~forward], end[~forward]))]
    return beside


def triangles(body: Polyhedron) -> tuple[np.ndarray, np.ndarray]:
    """The faces as fans: vertex indices (k, 3), outward counter-clockwise, and the face (k,) of each."""
    if not body.faces:
        return np.empty((0, 3), dtype=np.int64), np.empty(0, dtype=np.int64)
    fans = [np.column_stack((np.full(len(f) - 2, f[0]), f[1:-1], f[2:])) for f in body.faces]
    return np.concatenate(fans), np.repeat(np.arange(len(fans)), [len(fan) for fan in fans])


def volume(body: Polyhedron) -> float | np.ndarray:
    """Volume [m3]; zero for a body of dimension below 3. Of a stack (m,)."""
    if body.dimension < 3:
        return np.zeros(body.vertices.shape[:-2])[()]
    corner = rows(body.vertices - body.vertices.mean(axis=-2, keepdims=True), triangles(body)[0])
    return determinant(corner).sum(axis=-1) / 6.0


def centroid(body: Polyhedron) -> np.ndarray:
    """Centroid (3,) [m] of a body of dimension 3; of a stack (m, 3)."""
    reference = body.vertices.mean(axis=-2)
    corner = rows(body.translated(-reference).vertices, triangles(body)[0])
    weight = determinant(corner)
    return reference + weighted(weight, corner.sum(axis=-2)) / (4.0 * weight.sum(axis=-1))[..., None]


def weighted(weight: np.ndarray, vectors: np.ndarray) -> np.ndarray:
    """Sum over k of weight (..., k) times vectors (..., k, 3), for each body of a stack."""
    return (weight[..., None] * vectors).sum(axis=-2)


def _directed_edges(faces: tuple[np.ndarray, ...]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Start, end and face of every side of every face loop, each (k,)."""
    start = np.concatenate(faces)
    end = np.concatenate([np.roll(f, -1) for f in faces])
    face = np.repeat(np.arange(len(faces)), [len(f) for f in faces])
    return start, end, face


def _distinct(points: np.ndarray, distance: float) -> np.ndarray:
    """The points without those within `distance` of an earlier one."""
    keep = np.ones(len(points), dtype=bool)
    for i in range(len(points) - 1):
        keep[i + 1 :] &= norm(points[i + 1 :] - points[i]) > distance
    return points[keep]


def _axes(points: np.ndarray) -> np.ndarray:
    """(n, 3) points in a frame of their own: the first axis along their length, the second along what is widest across it.

    The extent along the last axes vanishes for a straight or a flat set.
    """
    first = points[norm(points - points[0]).argmax()]
    span = points[norm(points - first).argmax()] - first
    ahead = span / norm(span)
    beside = points - first - dot(points - first, ahead)[:, None] * ahead
    widest = beside[norm(beside).argmax()]
    if norm(widest) <= RESOLUTION:  # a straight set: any direction across will do
        widest = np.cross(ahead, np.eye(3)[np.abs(ahead).argmin()])
    across = widest - dot(widest, ahead) * ahead
    across = across / norm(across)
    return np.stack([dot(points, axis) for axis in (ahead, across, np.cross(ahead, across))], axis=-1)


def _flat_loop(plane_points: np.ndarray) -> np.ndarray:
    """Indices of the corners of the convex hull in the plane, counter-clockwise, none within an edge."""
    loop = ConvexHull(plane_points).vertices
    removed = True
    while removed and len(loop) > 3:
        removed = False
        for i in range(len(loop)):
            before, at, after = plane_points[loop[[i - 1, i, (i + 1) % len(loop)]]]
            chord, arm = after - before, at - before
            if abs(chord[0] * arm[1] - chord[1] * arm[0]) <= RESOLUTION * norm(chord):
                loop = np.delete(loop, i)
                removed = True
                break
    return loop


def _solid_hull(points: np.ndarray, local: np.ndarray) -> Polyhedron:
    """Hull of points that span space; `local` are the same points scaled to unit size about their middle."""
    try:
        hull = ConvexHull(local, qhull_options="Qt")
    except QhullError as fault:
        raise ValueError("the points have no convex hull: they are too close to degenerate") from fault
    facets = _outward(hull)
    group = _coplanar_groups(hull, facets, local)
    loops = [_boundary(facets[group == g]) for g in range(group.max() + 1)]

    # A vertex that only two faces share lies within an edge.
    visits = np.bincount(np.concatenate(loops), minlength=len(points))
    loops = [loop[visits[loop] > 2] for loop in loops]
    kept = np.unique(np.concatenate(loops))
    if any(len(loop) < 3 for loop in loops):
        raise ValueError("the points have no convex hull: they are too close to degenerate")
    return assemble(points[kept], tuple(np.searchsorted(kept, loop) for loop in loops))


def _outward(hull: ConvexHull) -> np.ndarray:
    """The hull's triangles (k, 3), counter-clockwise seen from outside."""
    facets = hull.simplices.astype(np.int64)
    a, b, c = (hull.points[facets[:, k]] for k in range(3))
    inward = dot(np.cross(b - a, c - a), hull.equations[:, :3]) < 0.0
    facets[inward] = facets[inward][:, ::-1]
    return facets


def _coplanar_groups(hull: ConvexHull, facets: np.ndarray, local: np.ndarray) -> np.ndarray:
    """(k,) the face each triangle belongs to.

    Faces grow from their largest triangle, whose plane is the best known: every neighbour that lies in *that*
    plane joins, so that slightly bent surfaces cannot drift together, and slivers of no clear normal follow
    their neighbour.
    """
    corner = local[facets]
    area_vector = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    group = np.full(len(facets), -1, dtype=np.int64)
    face = 0
    for seed in np.argsort(-norm(area_vector), kind="stable"):
        if group[seed] >= 0:
            continue
        normal = area_vector[seed] / norm(area_vector[seed])
        in_plane = (np.abs(dot(corner - corner[seed, 0], normal)) <= RESOLUTION).all(axis=1)
        group[seed] = face
        front = [seed]
        while front:
            for neighbour in hull.neighbors[front.pop()]:
                if group[neighbour] < 0 and in_plane[neighbour]:
                    group[neighbour] = face
                    front.append(neighbour)
        face += 1
    return group


def _boundary(facets: np.ndarray) -> np.ndarray:
    """The loop around a patch of triangles (k, 3): the sides that no second triangle runs against."""
    start = facets.ravel()
    end = np.roll(facets, -1, axis=1).ravel()
    sides = set(zip(start.tolist(), end.tolist(), strict=True))
    following = {a: b for a, b in sides if (b, a) not in sides}
    first = min(following)
    loop = [first]
    while following[loop[-1]] != first:
        loop.append(following[loop[-1]])
        if len(loop) > len(following):
            raise ValueError("the points have no convex hull: they are too close to degenerate")
    return np.array(loop, dtype=np.int64)

"""A convex polyhedron cut into tetrahedra: a prism by layers over its plan, any other from points on its faces and within."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import Delaunay, cKDTree

from dilatedem.deformation.plan import between, triangulated
from dilatedem.geometry.polyhedron import Polyhedron, volume

#: distance over the extent by which a corner of a prism may be off the one below it
UPRIGHT = 1e-9
#: distance from the faces, in sizes of an element, within which no point is put into a body that is no prism
CLEAR = 0.5
#: sizes that such a body is tried with, each so much smaller than the one before, until the worst tetrahedron has this quality
TRIES, SMALLER, FAIR = 8, 0.96, 0.02
#: volume of a tetrahedron over the cube of the size, below which it lies within a face
FLAT = 1e-7
#: quality of the worst tetrahedron, below which a mesh is not used
POOR = 1e-3


@dataclass(frozen=True, eq=False)
class Mesh:
    """Tetrahedra that fill a body: points (n, 3) [m] and corners (t, 4), numbered so that volumes are positive."""

    points: np.ndarray
    tetrahedra: np.ndarray

    @property
    def volumes(self) -> np.ndarray:
        """(t,) [m3], all positive."""
        return _volumes(self.points, self.tetrahedra)

    @property
    def quality(self) -> float:
        """Of the worst tetrahedron: 6 sqrt(2) times its volume over the cube of its mean edge; 1 where it is regular."""
        corner = self.points[self.tetrahedra]
        edges = corner[:, [0, 0, 0, 1, 1, 2]] - corner[:, [1, 2, 3, 2, 3, 3]]
        length = np.sqrt((edges**2).sum(axis=-1)).mean(axis=1)
        return float((6.0 * np.sqrt(2.0) * self.volumes / length**3).min())

    def surface(self) -> np.ndarray:
        """(s, 3) the triangles that belong to one tetrahedron alone, counter-clockwise seen from outside."""
        facets = self.tetrahedra[:, [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]]].reshape(-1, 3)
        _, first, count = np.unique(np.sort(facets, axis=1), axis=0, return_index=True, return_counts=True)
        return facets[np.sort(first[count == 1])]


def meshed(body: Polyhedron, size: float) -> Mesh:
    """Tetrahedra of edges about `size` [m] that fill a convex body of dimension 3.

    Raises ValueError where the body is no solid, or so thin that no tetrahedra of fair shape fill it.
    """
    if body.dimension < 3:
        raise ValueError("only a solid can deform: a point, a segment or a flat polygon has no mesh")
    base = _base(body)
    mesh = _filled(body, size) if base is None else _layered(body, base, size)
    whole = float(volume(body))
    if mesh.quality < POOR or abs(mesh.volumes.sum() - whole) > 1e-9 * whole:
        raise ValueError(f"has no mesh of fair shape with elements of {size:g} m: make deformation.mesh_size smaller")
    return mesh


def _base(body: Polyhedron) -> tuple[int, np.ndarray] | None:
    """The face over which a body is a right prism, and what leads from there across, (3,) [m]; of several the shortest one's."""
    best, least = None, np.inf
    for number, face in enumerate(body.faces):
        if 2 * len(face) != len(body.vertices):
            continue
        rest = np.setdiff1d(np.arange(len(body.vertices)), face)
        height = ((body.vertices[face[0]] - body.vertices[rest]) @ body.normals[number]).mean()
        across = -height * body.normals[number]
        off, _ = cKDTree(body.vertices[rest]).query(body.vertices[face] + across)
        if off.max() <= UPRIGHT * np.ptp(body.vertices, axis=0).max() and height < least:
            best, least = (number, across), height
    return best


def _layered(body: Polyhedron, base: tuple[int, np.ndarray], size: float) -> Mesh:
    """Layers of a prism, each triangle of its plan a column of wedges, each wedge three tetrahedra."""
    number, across = base
    ahead, beside = _across(body.normals[number])
    corners = body.vertices[body.faces[number]]
    origin = corners[0]
    outline = np.stack(((corners - origin) @ ahead, (corners - origin) @ beside), axis=-1)
    plan, triangles = triangulated(outline, size)
    layers = max(1, round(float(np.sqrt(across @ across)) / size))
    floor = origin + plan[:, :1] * ahead + plan[:, 1:] * beside
    points = np.concatenate([floor + across * (k / layers) for k in range(layers + 1)])
    a, b, c = np.sort(triangles, axis=1).T  # the same diagonal from both sides of a side
    above_a, above_b, above_c = a + len(plan), b + len(plan), c + len(plan)
    wedge = np.array([(a, b, c, above_c), (a, b, above_b, above_c), (a, above_a, above_b, above_c)])
    wedge = wedge.transpose(2, 0, 1).reshape(-1, 4)
    return _oriented(points, np.concatenate([wedge + k * len(plan) for k in range(layers)]))


def _across(normal: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Two unit vectors across a unit normal, such that the three are right-handed."""
    ahead = np.cross(np.eye(3)[np.abs(normal).argmin()], normal)
    ahead = ahead / np.sqrt(ahead @ ahead)
    return ahead, np.cross(normal, ahead)


def _filled(body: Polyhedron, size: float) -> Mesh:
    """The Delaunay tetrahedra of points on the faces and of a lattice within, of the first size that makes no thin ones."""
    best = None
    for _ in range(TRIES):
        mesh = _delaunay(np.concatenate((_skin(body, size), _within(body, size))), size)
        if best is None or mesh.quality > best.quality:
            best = mesh
        if best.quality >= FAIR:
            break
        size *= SMALLER
    return best


def _skin(body: Polyhedron, size: float) -> np.ndarray:
    """Points on the faces of a body, those on its edges and at its corners once."""
    rim = [between(*body.vertices[edge], size)[1:-1] for edge in body.edges]
    inner = []
    for face, normal in zip(body.faces, body.normals, strict=True):
        ahead, beside = _across(normal)
        origin, corners = body.vertices[face[0]], body.vertices[face]
        plan, _ = triangulated(np.stack(((corners - origin) @ ahead, (corners - origin) @ beside), axis=-1), size)
        sides = sum(len(between(a, b, size)) - 1 for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True))
        inner.append(origin + plan[sides:, :1] * ahead + plan[sides:, 1:] * beside)
    return np.concatenate((body.vertices, *rim, *inner))


def _within(body: Polyhedron, size: float) -> np.ndarray:
    """Points of a body-centred cubic lattice that are clear of the faces."""
    step = size * 2.0 / np.sqrt(3.0)
    low, high = body.vertices.min(axis=0), body.vertices.max(axis=0)
    axes = [np.arange(np.floor((high - low)[k] / step) + 2) for k in range(3)]
    cubes = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    points = low + step * np.concatenate((cubes, cubes + 0.5))
    heights = np.stack([(points - body.vertices[face[0]]) @ normal for face, normal in zip(body.faces, body.normals, strict=True)])
    return points[heights.max(axis=0) < -CLEAR * size]


def _delaunay(points: np.ndarray, size: float) -> Mesh:
    corners = Delaunay(points).simplices.astype(np.int64)
    solid = np.abs(_volumes(points, corners)) > FLAT * size**3
    corners = corners[solid]
    return _oriented(points, corners[np.lexsort(np.sort(corners, axis=1).T[::-1])])


def _oriented(points: np.ndarray, corners: np.ndarray) -> Mesh:
    inverted = _volumes(points, corners) < 0.0
    corners[inverted] = corners[inverted][:, [1, 0, 2, 3]]
    return Mesh(points, corners)


def _volumes(points: np.ndarray, corners: np.ndarray) -> np.ndarray:
    a, b, c, d = (points[corners[:, k]] for k in range(4))
    return ((b - a) * np.cross(c - a, d - a)).sum(axis=-1) / 6.0

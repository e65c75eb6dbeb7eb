"""Mass properties of a dilated core by cutting it into tetrahedra: slow, obvious, not by the closed form.

The surface is triangulated piece by piece (offset faces, cylinder strips, spherical patches), every triangle
makes a tetrahedron with a point inside, and the sums are extrapolated over three refinements. Only for cores
with faces (solid or flat): spheres and capsules have their textbook formulas.
"""

from __future__ import annotations

import numpy as np

from dilatedem.geometry.polyhedron import Polyhedron


def mass_by_tetrahedra(
    core: Polyhedron, radius: float, steps: int = 6
) -> tuple[float, np.ndarray, np.ndarray]:
    """Volume [m3], centroid (3,) [m] and inertia (3, 3) [m5] for unit density, error of order steps**-6."""
    coarse, middle, fine = (_moments(core, radius, steps * 2**level) for level in range(3))
    # chords leave out an error in even powers of the step: Richardson, twice
    first, second = (4 * middle - coarse) / 3, (4 * fine - middle) / 3
    moments = (16 * second - first) / 15
    volume, centroid = moments[0], moments[1:4] / moments[0]
    about_centroid = moments[4:].reshape(3, 3) - volume * np.outer(centroid, centroid)
    return volume, centroid, np.trace(about_centroid) * np.eye(3) - about_centroid


def _moments(core: Polyhedron, radius: float, steps: int) -> np.ndarray:
    """(13,) volume, first and second moments about the origin of the triangulated solid."""
    inside = core.vertices.mean(axis=0)
    pieces = [_face_triangles(core, radius)] + [
        _around_edge(core, edge, radius, steps) for edge in core.edges
    ]
    corners = np.concatenate([triangles for triangles, _ in pieces]) - inside
    outward = np.concatenate([directions for _, directions in pieces])
    facing = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    volume = np.sign((facing * outward).sum(axis=1)) * np.linalg.det(corners) / 6.0
    total = corners.sum(axis=1)
    first = volume @ total / 4.0
    squares = np.einsum("kci,kcj->kij", corners, corners) + np.einsum("ki,kj->kij", total, total)
    second = np.einsum("k,kij->ij", volume, squares) / 20.0
    v = volume.sum()
    second += np.outer(inside, first) + np.outer(first, inside) + v * np.outer(inside, inside)
    return np.concatenate(([v], first + v * inside, second.ravel()))


def _face_triangles(core: Polyhedron, radius: float) -> tuple[np.ndarray, np.ndarray]:
    """Triangles (k, 3, 3) of the faces moved outwards, and their outward directions (k, 3)."""
    triangles, outward = [], []
    for loop, normal in zip(core.faces, core.normals, strict=True):
        corner = core.vertices[loop] + radius * normal
        triangles += [(corner[0], corner[i], corner[i + 1]) for i in range(1, len(loop) - 1)]
        outward += [normal] * (len(loop) - 2)
    return np.array(triangles), np.array(outward)


def _around_edge(
    core: Polyhedron, edge: np.ndarray, radius: float, steps: int
) -> tuple[np.ndarray, np.ndarray]:
    """The cylinder strip of an edge and, at both its ends, the fans from the vertex's middle to its arc."""
    a, b = core.vertices[edge]
    arc = _arc(core, edge, steps)
    here, ahead = arc[:-1], arc[1:]
    strip = [
        np.stack((a + radius * here, b + radius * here, b + radius * ahead), axis=1),
        np.stack((a + radius * here, b + radius * ahead, a + radius * ahead), axis=1),
    ]
    fans = [_fan(_cone_middle(core, vertex), arc, steps) for vertex in edge]
    spheres = [core.vertices[vertex] + radius * fan for vertex, fan in zip(edge, fans, strict=True)]
    outward = [here + ahead, here + ahead] + [fan.sum(axis=1) for fan in fans]
    return np.concatenate(strip + spheres), np.concatenate(outward)


def _arc(core: Polyhedron, edge: np.ndarray, steps: int) -> np.ndarray:
    """(steps + 1, 3) unit vectors from the normal of one face at the edge to that of the other."""
    one, other = (i for i, loop in enumerate(core.faces) if edge[0] in loop and edge[1] in loop)
    a, b = core.vertices[edge]
    along = (b - a) / np.linalg.norm(b - a)
    # in the plane of the first face, square to the edge, away from the face
    away = np.cross(along, core.normals[one])
    away *= -np.sign(away @ (core.vertices[core.faces[one]].mean(axis=0) - a))
    angle = np.arctan2(core.normals[other] @ away, core.normals[one] @ core.normals[other])
    if angle < 0.0:  # a flat core: the opposite normal, with a zero of the wrong sign
        angle += 2.0 * np.pi
    turn = np.linspace(0.0, angle, steps + 1)[:, None]
    return np.cos(turn) * core.normals[one] + np.sin(turn) * away


def _cone_middle(core: Polyhedron, vertex: int) -> np.ndarray:
    """A unit vector well inside the normal cone of a vertex."""
    arcs = [_arc(core, edge, 8) for edge in core.edges if vertex in edge]
    lengths = [np.linalg.norm(np.diff(arc, axis=0), axis=1).sum() for arc in arcs]
    middle = sum(length * arc.mean(axis=0) for length, arc in zip(lengths, arcs, strict=True))
    return middle / np.linalg.norm(middle)


def _fan(middle: np.ndarray, arc: np.ndarray, steps: int) -> np.ndarray:
    """(k, 3, 3) triangles on the unit sphere between `middle` and an arc, in bands along great circles."""
    angle = np.arctan2(np.linalg.norm(np.cross(middle, arc), axis=1), arc @ middle)[None, :, None]
    part = np.linspace(0.0, 1.0, steps + 1)[:, None, None]
    grid = (np.sin((1.0 - part) * angle) * middle + np.sin(part * angle) * arc) / np.sin(angle)
    here, ahead, inner, inner_ahead = grid[1:, :-1], grid[1:, 1:], grid[:-1, :-1], grid[:-1, 1:]
    pairs = [np.stack((inner, here, ahead), axis=2), np.stack((inner, ahead, inner_ahead), axis=2)]
    return np.concatenate([pair.reshape(-1, 3, 3) for pair in pairs])

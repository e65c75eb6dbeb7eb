"""The surface of a body that bends, as water and wind see it: points of each face, and sums of the modes' shapes over them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_matrix

from dilatedem.deformation.elements import EDGES
from dilatedem.deformation.lattice import Lattice
from dilatedem.deformation.mesh import Mesh
from dilatedem.deformation.modes import Modes
from dilatedem.deformation.stress import in_plane
from dilatedem.geometry.polyhedron import Polyhedron
from dilatedem.numerics.blocks import offsets

#: triangles that a face which lies on another is cut into, at least
FACE_TRIANGLES = 64
#: thickness over the smaller extent in plan, below which a body is a plate
THIN = 0.3
#: how far up the normal of a side may look
UPRIGHT = 1e-6
#: distance over the extent of a body, up to which a corner of its mesh is on a face
ON_FACE = 1e-7


@dataclass(frozen=True, eq=False)
class Skin:
    """f flat faces of normals n (f, 3), with m modes of shapes phi.

    centre  (f, 3) [m], reach (f,) [m] from there to the farthest corner, area (f,) [m2]
    first   (f, m, 3) [m2/sqrt(kg)]: int phi_i dA
    outward (f, m) [m2/sqrt(kg)]: int n.phi_i dA;  moment (f, m, 3): int x n.phi_i dA;  second (f, m, m): int n.phi_i n.phi_j dA
    start   (f+1,) of each face's points (p, 3) [m], of areas weight (p,) [m2] and shapes shape (p, m, 3)
    """

    normal: np.ndarray
    centre: np.ndarray
    reach: np.ndarray
    area: np.ndarray
    first: np.ndarray
    outward: np.ndarray
    moment: np.ndarray
    second: np.ndarray
    start: np.ndarray
    point: np.ndarray
    weight: np.ndarray
    shape: np.ndarray


def skin_of(body: Polyhedron, modes: Modes) -> Skin:
    """The surface of a convex body about its centroid, which bends by its modes: all faces, or top and bottom of a plate.

    Points are the middles of the edges of its elements, where modes are known, and which integrate what is quadratic over each
    triangle exactly.
    """
    surface, middle = _surface(modes)
    corner = modes.nodes[surface]
    near = ON_FACE * np.ptp(body.vertices, axis=0).max()
    faces = [f for f in range(len(body.faces)) if not _is_side(body, f)]
    points, weights, shapes = [], [], []
    for f in faces:
        on = (np.abs((corner - body.vertices[body.faces[f][0]]) @ body.normals[f]) < near).all(axis=1)
        node, group = np.unique(middle[on], return_inverse=True)
        points.append(modes.nodes[node])
        weights.append(np.bincount(group.ravel(), np.repeat(_areas(corner[on]) / 3.0, 3)))
        shapes.append(modes.shape[:, node].transpose(1, 0, 2))
    area = np.array([weight.sum() for weight in weights])
    centre = np.stack([weight @ point for weight, point in zip(weights, points, strict=True)]) / area[:, None]
    loops = [body.vertices[body.faces[f]] for f in faces]
    reach = np.array([np.sqrt(((loop - c) ** 2).sum(axis=1).max()) for loop, c in zip(loops, centre, strict=True)])
    first = np.stack([np.einsum("p,pmc->mc", weight, shape) for weight, shape in zip(weights, shapes, strict=True)])
    each = list(zip(weights, points, shapes, strict=True))
    out = [shape @ body.normals[f] for f, shape in zip(faces, shapes, strict=True)]
    moment = np.stack([np.einsum("p,pm,pc->mc", weight, own, point) for own, (weight, point, _) in zip(out, each, strict=True)])
    second = np.stack([np.einsum("p,pm,pk->mk", weight, own, own) for own, (weight, _, _) in zip(out, each, strict=True)])
    outward = np.stack([weight @ own for own, (weight, _, _) in zip(out, each, strict=True)])
    return Skin(
        body.normals[faces], centre, reach, area, first, outward, moment, second, offsets([len(weight) for weight in weights]),
        np.concatenate(points), np.concatenate(weights), np.concatenate(shapes),
    )  # fmt: skip


def _surface(modes: Modes) -> tuple[np.ndarray, np.ndarray]:
    """Corners (s, 3) of the triangles of the surface, and the nodes (s, 3) in the middles of their edges."""
    surface = Mesh(modes.nodes, modes.elements[:, :4]).surface()
    ends = np.sort(modes.elements[:, np.transpose(EDGES)].transpose(0, 2, 1), axis=2).reshape(-1, 2)
    between = csr_matrix((modes.elements[:, 4:].ravel() + 1.0, (ends[:, 0], ends[:, 1])), shape=(len(modes.nodes),) * 2)
    times = csr_matrix((np.ones(len(ends)), (ends[:, 0], ends[:, 1])), shape=between.shape)  # edges of several elements
    edges = np.sort(np.stack((surface, np.roll(surface, -1, axis=1)), axis=-1), axis=-1).reshape(-1, 2)
    total, count = (np.asarray(matrix[edges[:, 0], edges[:, 1]]).ravel() for matrix in (between, times))
    return surface, np.rint(total / count).astype(np.int64).reshape(-1, 3) - 1


def _is_side(body: Polyhedron, face: int) -> bool:
    """Whether a face is upright and the body a plate, whose sides the water pushes sideways alone."""
    extent = np.ptp(body.vertices, axis=0)
    return bool(extent[2] < THIN * extent[:2].min() and abs(body.normals[face, 2]) < UPRIGHT)


def surface_stress(modes: Modes, body: Polyhedron) -> tuple[np.ndarray, np.ndarray]:
    """Corners (q, 3) [m] of the mesh on the faces of a body, those of several faces for each, and the stress there of each mode in
    the plane of the face (q, m, 3) [Pa/(m sqrt(kg))]: see `stress.in_plane`."""
    corner, stress = modes.nodes[: modes.stress.shape[1]], modes.stress.transpose(1, 0, 2)
    near, points, found = ON_FACE * np.ptp(body.vertices, axis=0).max(), [], []
    for face, normal in zip(body.faces, body.normals, strict=True):
        on = np.abs((corner - body.vertices[face[0]]) @ normal) < near
        points.append(corner[on])
        found.append(in_plane(stress[on], normal))
    return np.concatenate(points), np.concatenate(found)


def face_motion(loop: np.ndarray, lattice: Lattice) -> tuple[np.ndarray, np.ndarray]:
    """The middle (3,) [m] of a flat face of corners (k, 3) [m], and displacement [1/sqrt(kg)] and turning [1/m/sqrt(kg)] (m, 6) of
    the rigid motion that each mode of a lattice moves it by, but for the least squares over the face."""
    fan = _fan(loop)
    point, weight = _points(fan, float(_areas(fan).sum()) / FACE_TRIANGLES)
    shape, total = lattice.at(point), weight.sum()
    centre = weight @ point / total
    arm, moved = point - centre, np.einsum("p,mpc->mc", weight, shape) / total
    inertia = (weight @ (arm**2).sum(axis=1)) * np.eye(3) - np.einsum("p,pa,pb->ab", weight, arm, arm)
    turned = np.linalg.solve(inertia, np.einsum("p,mpc->cm", weight, np.cross(arm, shape))).T
    return centre, np.concatenate((moved, turned), axis=1)


def _fan(loop: np.ndarray) -> np.ndarray:
    """(k, 3, 3) triangles from the middle of a face's corners (k, 3) to its edges."""
    middle = np.broadcast_to(loop.mean(axis=0), loop.shape)
    return np.stack((middle, loop, np.roll(loop, -1, axis=0)), axis=1)


def _areas(triangles: np.ndarray) -> np.ndarray:
    return 0.5 * np.sqrt((np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]) ** 2).sum(axis=1))


def _points(triangles: np.ndarray, largest: float) -> tuple[np.ndarray, np.ndarray]:
    """Middles of the edges of triangles no larger than `largest` [m2], and their areas; those of two triangles once."""
    points, areas = [], []
    for triangle, area in zip(triangles, _areas(triangles), strict=True):
        parts = int(np.ceil(np.sqrt(area / largest)))
        for a, b, c in _parts(triangle, parts):
            points += [0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)]
            areas += [area / (3.0 * parts * parts)] * 3
    points, digits = np.array(points), np.sqrt(largest) * 1e-6
    _, chosen, group = np.unique(np.round(points / digits), axis=0, return_index=True, return_inverse=True)
    return points[chosen], np.bincount(group.ravel(), areas)


def _parts(triangle: np.ndarray, parts: int):
    """The corners of each of parts^2 equal triangles."""
    origin, u, v = triangle[0], (triangle[1] - triangle[0]) / parts, (triangle[2] - triangle[0]) / parts
    for i in range(parts):
        for j in range(parts - i):
            corner = origin + i * u + j * v
            yield corner, corner + u, corner + v
            if i + j < parts - 1:
                yield corner + u, corner + u + v, corner + v

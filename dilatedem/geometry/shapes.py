"""All bodies' shapes packed into flat arrays: what never changes during a run.

A contact sees the *core* of a body (vertices, edges, faces) and subtracts the dilated radius at the end; water and pictures see
the sharp outer polyhedron. Vertices, faces and loops of all bodies stand one after the other; `*_start` says where a body's begin.
"""

from dataclasses import dataclass
from enum import IntEnum
from typing import NamedTuple

import numpy as np

from dilatedem.geometry.mass import SolidProperties, dilated_solid
from dilatedem.geometry.outer import outer_polyhedron
from dilatedem.geometry.polyhedron import Polyhedron


class Kind(IntEnum):
    """How a body is met by others."""

    CONVEX = 0  # dilated convex core
    HALF_SPACE = 1  # everything below a plane; only as a structure


@dataclass(frozen=True)
class BodyShape:
    """One body's shape in its own frame, origin at the centroid of the dilated solid."""

    core: Polyhedron
    radius: float  # dilated radius, m
    outer: Polyhedron  # sharp outer polyhedron of the same volume, m
    properties: SolidProperties  # of the dilated solid, unit density

    @classmethod
    def of_core(cls, core: Polyhedron, radius: float) -> tuple["BodyShape", np.ndarray]:
        """The shape of a core given in any frame, and the centroid (3,) of its dilated solid in that frame [m]."""
        properties = dilated_solid(core, radius)
        centroid = properties.centroid
        centred = core.translated(-centroid)
        properties = SolidProperties(properties.volume, np.zeros(3), properties.inertia)
        return cls(centred, radius, outer_polyhedron(centred, radius, properties.volume), properties), centroid


class Shapes(NamedTuple):
    """Cores of all bodies; n bodies, structures last."""

    kind: np.ndarray  # (n,) Kind
    radius: np.ndarray  # (n,) dilated radius, m
    reach: np.ndarray  # (n,) largest distance of the dilated surface from the centroid, m
    vertex_start: np.ndarray  # (n+1,)
    vertex: np.ndarray  # (v, 3) core vertices, body frame, m
    neighbour_start: np.ndarray  # (v+1,)
    neighbour: np.ndarray  # vertices that share an edge with a vertex
    face_start: np.ndarray  # (n+1,)
    face_normal: np.ndarray  # (f, 3) outward, body frame
    loop_start: np.ndarray  # (f+1,)
    loop: np.ndarray  # vertices around a face, counter-clockwise from outside
    plane_normal: np.ndarray  # (n, 3) outward normal of a half space, zero for others


class Hulls(NamedTuple):
    """Sharp outer polyhedra of all bodies, for water loads; m bodies that float (structures have none)."""

    vertex_start: np.ndarray  # (m+1,)
    vertex: np.ndarray  # (v, 3) body frame, m
    face_start: np.ndarray  # (m+1,)
    loop_start: np.ndarray  # (f+1,)
    loop: np.ndarray
    prism: np.ndarray  # (m,) whether the hull is a right prism along its z axis
    plan: np.ndarray  # (m, 8) of a prism: area, its second moments Ixx, Iyy, Ixy, perimeter, its first moments Sx, Sy, reach
    height: np.ndarray  # (m, 2) z of the prism's bottom and top, m
    effective_radius: np.ndarray  # (m,) mean distance of the outer vertices from the centroid, m: r_eff of Liu 2015, Eq. (27)


def _offsets(counts) -> np.ndarray:
    return np.concatenate([[0], np.cumsum(counts)]).astype(np.int64)


def _loops(polyhedra: list[Polyhedron], vertex_start: np.ndarray):
    """face_start, loop_start and loop (with packed vertex numbers) of a list of polyhedra."""
    face_start = _offsets([len(p.faces) for p in polyhedra])
    loops = [np.asarray(face) + start for p, start in zip(polyhedra, vertex_start, strict=False) for face in p.faces]
    loop = np.concatenate(loops).astype(np.int64) if loops else np.zeros(0, np.int64)
    return face_start, _offsets([len(face) for face in loops]), loop


def pack_shapes(shapes: list[BodyShape], planes: list[np.ndarray]) -> Shapes:
    """Pack the convex bodies, then half spaces with the given outward normals (3,) behind them."""
    cores = [shape.core for shape in shapes]
    count = len(cores) + len(planes)
    vertex_start = _offsets([len(core.vertices) for core in cores] + [0] * len(planes))
    face_start, loop_start, loop = _loops(cores, vertex_start)
    neighbours: list[list[int]] = [[] for _ in range(vertex_start[-1])]
    for core, start in zip(cores, vertex_start, strict=False):
        for i, j in core.edges:
            neighbours[start + i].append(start + j)
            neighbours[start + j].append(start + i)
    normals = [core.normals.reshape(-1, 3) for core in cores]
    reach = [np.linalg.norm(shape.core.vertices, axis=1).max() + shape.radius for shape in shapes]
    plane_normal = np.zeros((count, 3))
    plane_normal[len(cores):] = np.reshape(planes, (-1, 3))
    return Shapes(
        kind=np.array([Kind.CONVEX] * len(cores) + [Kind.HALF_SPACE] * len(planes), np.int64),
        radius=np.array([shape.radius for shape in shapes] + [0.0] * len(planes)),
        reach=np.array(reach + [0.0] * len(planes)),
        vertex_start=vertex_start,
        vertex=np.concatenate([core.vertices for core in cores] + [np.zeros((0, 3))]),
        neighbour_start=_offsets([len(near) for near in neighbours]),
        neighbour=np.array([j for near in neighbours for j in near], np.int64),
        face_start=np.concatenate([face_start, np.full(len(planes), face_start[-1])]),
        face_normal=np.concatenate(normals + [np.zeros((0, 3))]),
        loop_start=loop_start,
        loop=loop,
        plane_normal=plane_normal,
    )


def pack_hulls(shapes: list[BodyShape]) -> Hulls:
    """Pack the outer polyhedra of the bodies that float."""
    outers = [shape.outer for shape in shapes]
    vertex_start = _offsets([len(p.vertices) for p in outers])
    face_start, loop_start, loop = _loops(outers, vertex_start)
    count = len(outers)
    prism = np.zeros(count, np.bool_)
    plan = np.zeros((count, 8))
    height = np.zeros((count, 2))
    effective_radius = np.zeros(count)
    for i, outer in enumerate(outers):
        effective_radius[i] = np.linalg.norm(outer.vertices, axis=1).mean()
        outline = _prism_outline(outer)
        if outline is not None:
            prism[i] = True
            plan[i] = _plan_moments(outline)
            height[i] = outer.vertices[:, 2].min(), outer.vertices[:, 2].max()
    return Hulls(
        vertex_start, np.concatenate([p.vertices for p in outers] + [np.zeros((0, 3))]), face_start, loop_start, loop,
        prism, plan, height, effective_radius,
    )  # fmt: skip


def _prism_outline(outer: Polyhedron):
    """The plan outline (k, 2) of a right prism along z, None for any other polyhedron."""
    if outer.dimension != 3:
        return None
    z = outer.vertices[:, 2]
    flat = 1e-9 * (z.max() - z.min())
    low, high = z < z.min() + flat, z > z.max() - flat
    if not np.all(low | high) or low.sum() != high.sum():
        return None
    base = next(face for face, normal in zip(outer.faces, outer.normals, strict=True) if normal[2] > 0.999999999)
    top = outer.vertices[base, :2]
    gap = np.linalg.norm(outer.vertices[low][:, None, :2] - top[None], axis=2).min(axis=0)
    return top if gap.max() <= flat else None


def _plan_moments(outline: np.ndarray) -> np.ndarray:
    """Area, second moments about the origin, perimeter with its first moments, and reach of an outline (k, 2) around the origin."""
    x, y = outline.T
    x1, y1 = np.roll(x, -1), np.roll(y, -1)
    twice = x * y1 - x1 * y
    length = np.hypot(x1 - x, y1 - y)
    return np.array([
        twice.sum() / 2,
        (twice * (x * x + x * x1 + x1 * x1)).sum() / 12,
        (twice * (y * y + y * y1 + y1 * y1)).sum() / 12,
        (twice * (x * y1 + 2 * x * y + 2 * x1 * y1 + x1 * y)).sum() / 24,
        length.sum(),
        (length * (x + x1)).sum() / 2,
        (length * (y + y1)).sum() / 2,
        np.hypot(x, y).max(),
    ])  # fmt: skip

"""All bodies' shapes packed into flat arrays: what never changes during a run.

A contact sees the *core* of a body (vertices, edges, faces) and subtracts the dilated radius at the end; water and pictures see
the sharp outer polyhedron. Vertices, faces and loops of all bodies stand one after the other; `*_start` says where a body's begin.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from enum import IntEnum
from typing import NamedTuple

import numpy as np

from dilatedem.geometry.mass import SolidProperties, dilated_solid
from dilatedem.geometry.outer import outer_polyhedron
from dilatedem.geometry.packing import numbered, pack_neighbours, pack_polyhedra
from dilatedem.geometry.polyhedron import Polyhedron, rows
from dilatedem.numerics.plain import norm


class Kind(IntEnum):
    """How a body is met by others."""

    CONVEX = 0  # dilated convex core
    HALF_SPACE = 1  # everything below a plane; only as a structure


@dataclass(frozen=True)
class BodyShape:
    """Shape of one body in its own frame, origin at the centroid of the dilated solid; or of a stack of bodies of one topology."""

    core: Polyhedron
    radius: float  # dilated radius, m
    outer: Polyhedron  # sharp outer polyhedron of the same volume, m
    properties: SolidProperties  # of the dilated solid, unit density

    @property
    def count(self) -> int:
        """Bodies of this shape: 1, or those of the stack."""
        return len(self.core.stacked().vertices)

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
    plan_reach: np.ndarray  # (n,) radius of the upright cylinder about the centroid that holds the body: no more than its reach, m
    vertex_start: np.ndarray  # (n+1,)
    vertex: np.ndarray  # (v, 3) core vertices, body frame, m
    neighbour_start: np.ndarray  # (v+1,)
    neighbour: np.ndarray  # vertices that share an edge with a vertex
    face_start: np.ndarray  # (n+1,)
    face_normal: np.ndarray  # (f, 3) outward, body frame
    loop_start: np.ndarray  # (f+1,)
    loop: np.ndarray  # vertices around a face, counter-clockwise from outside
    plane_normal: np.ndarray  # (n, 3) outward normal of a half space, zero for others


#: `Shapes`, of which some are hulls of spheres that grow along a core of two corners, with a circular cone for a side. taper (n,):
#: growth of the radius per metre from the first corner to the second, 0 for others; `radius` is that in the middle, the origin of
#: the body. A class of its own, so that kernels know nothing of it where no shape has any.
TaperedShapes = NamedTuple("TaperedShapes", [*Shapes.__annotations__.items(), ("taper", np.ndarray)])


class Hulls(NamedTuple):
    """Sharp outer polyhedra of all bodies, for water loads; m bodies that float (structures have none)."""

    vertex_start: np.ndarray  # (m+1,)
    vertex: np.ndarray  # (v, 3) body frame, m
    face_start: np.ndarray  # (m+1,)
    loop_start: np.ndarray  # (f+1,)
    loop: np.ndarray
    prism: np.ndarray  # (m,) whether the hull is a right prism along its z axis
    plan: np.ndarray  # (m, 10) of a prism: area, its second moments Ixx, Iyy, Ixy, perimeter, its first moments Sx, Sy, reach, and
    # the area's first moments, zero unless it is part of a floe of several
    height: np.ndarray  # (m, 2) z of the prism's bottom and top, m
    effective_radius: np.ndarray  # (m,) mean distance of the outer vertices from the centroid, m: r_eff of Liu 2015, Eq. (27)


def pack_shapes(shapes: Sequence[BodyShape], planes: Sequence[np.ndarray], order: np.ndarray | None = None) -> Shapes:
    """Pack the convex bodies, then half spaces with the given outward normals (3,) behind them.

    order  number of each convex body, shape by shape, of a stack one after the other; as they come unless given
    """
    cores = [shape.core for shape in shapes]
    packed = pack_polyhedra(cores, order)
    neighbour_start, neighbour = pack_neighbours(cores, packed.vertex_start, order)
    convex, count = len(packed.vertex_start) - 1, len(packed.vertex_start) - 1 + len(planes)
    radius, reach, plane_normal = np.zeros(count), np.zeros(count), np.zeros((count, 3))
    for shape, number in _numbered_shapes(shapes, order):
        radius[number] = shape.radius
        reach[number] = norm(shape.core.stacked().vertices).max(axis=-1) + shape.radius
    plane_normal[convex:] = np.reshape(planes, (-1, 3))
    return Shapes(
        kind=np.array([Kind.CONVEX] * convex + [Kind.HALF_SPACE] * len(planes), np.int64),
        radius=radius,
        reach=reach,
        plan_reach=reach.copy(),
        vertex_start=_with_empty(packed.vertex_start, len(planes)),
        vertex=packed.vertex,
        neighbour_start=neighbour_start,
        neighbour=neighbour,
        face_start=_with_empty(packed.face_start, len(planes)),
        face_normal=packed.face_normal,
        loop_start=packed.loop_start,
        loop=packed.loop,
        plane_normal=plane_normal,
    )


def tapered(shapes: Shapes, taper: np.ndarray) -> Shapes | TaperedShapes:
    """The same shapes with the taper (n,) of their dilations; `shapes` itself where none has any."""
    if not taper.any():
        return shapes
    first, last = shapes.vertex_start[:-1][taper != 0.0], shapes.vertex_start[1:][taper != 0.0] - 1
    shapes.reach[taper != 0.0] += 0.5 * np.abs(taper[taper != 0.0]) * norm(shapes.vertex[last] - shapes.vertex[first])
    return TaperedShapes(*shapes, taper)


def tapers(shapes: Shapes | TaperedShapes) -> np.ndarray:
    """(n,) taper of each body's dilation."""
    return getattr(shapes, "taper", np.zeros(len(shapes.radius)))


def _with_empty(start: np.ndarray, count: int) -> np.ndarray:
    """Where rows begin, with `count` empty ones behind them."""
    return np.concatenate([start, np.full(count, start[-1])])


def _numbered_shapes(shapes: Sequence[BodyShape], order: np.ndarray | None) -> Iterator[tuple[BodyShape, np.ndarray]]:
    return zip(shapes, numbered([shape.count for shape in shapes], order), strict=True)


def pack_hulls(shapes: Sequence[BodyShape], order: np.ndarray | None = None) -> Hulls:
    """Pack the outer polyhedra of the bodies that float; `order` as in pack_shapes."""
    packed = pack_polyhedra([shape.outer for shape in shapes], order)
    count = len(packed.vertex_start) - 1
    prism, plan = np.zeros(count, np.bool_), np.zeros((count, 10))
    height, effective_radius = np.zeros((count, 2)), np.zeros(count)
    for shape, number in _numbered_shapes(shapes, order):
        outer = shape.outer.stacked()
        effective_radius[number] = norm(outer.vertices).mean(axis=-1)
        outline = _prism_outlines(outer)
        if outline is not None:
            z = outer.vertices[..., 2]
            prism[number] = True
            plan[number, :8] = _plan_moments(outline)
            height[number] = np.column_stack((z.min(axis=1), z.max(axis=1)))
    return Hulls(
        packed.vertex_start, packed.vertex, packed.face_start, packed.loop_start, packed.loop, prism, plan, height, effective_radius
    )


def _prism_outlines(outer: Polyhedron) -> np.ndarray | None:
    """Plan outlines (m, k, 2) of a stack of right prisms along z, None for any other polyhedra."""
    if outer.dimension != 3:
        return None
    z = outer.vertices[..., 2]
    bottom, top = z.min(axis=1, keepdims=True), z.max(axis=1, keepdims=True)
    flat = 1e-9 * (top - bottom)
    low, high = z < bottom + flat, z > top - flat
    if (low != low[0]).any() or not np.all(low | high) or 2 * low[0].sum() != low.shape[1]:
        return None
    level = np.flatnonzero((outer.normals[..., 2] > 0.999999999).all(axis=0))
    if len(level) == 0:
        return None
    above = rows(outer.vertices, outer.faces[level[0]])[..., :2]
    gap = norm(outer.vertices[:, low[0]][:, :, None, :2] - above[:, None]).min(axis=1)
    return above if (gap <= flat).all() else None


def _plan_moments(outline: np.ndarray) -> np.ndarray:
    """Area, second moments about the origin, perimeter with its first moments, reach; of outlines (m, k, 2) around the origin."""
    x, y = outline[..., 0], outline[..., 1]
    x1, y1 = np.roll(x, -1, axis=1), np.roll(y, -1, axis=1)
    twice = x * y1 - x1 * y
    length = norm(np.roll(outline, -1, axis=1) - outline)
    return np.column_stack([
        twice.sum(axis=1) / 2,
        (twice * (x * x + x * x1 + x1 * x1)).sum(axis=1) / 12,
        (twice * (y * y + y * y1 + y1 * y1)).sum(axis=1) / 12,
        (twice * (x * y1 + 2 * x * y + 2 * x1 * y1 + x1 * y)).sum(axis=1) / 24,
        length.sum(axis=1),
        (length * (x + x1)).sum(axis=1) / 2,
        (length * (y + y1)).sum(axis=1) / 2,
        norm(outline).max(axis=1),
    ])  # fmt: skip

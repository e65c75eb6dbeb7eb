"""The outer shape of a dilated core: a sharp polyhedron of the dilated body's volume and centroid.

Water loads and pictures use it in place of the rounded solid (physics 5): its faces are the core's moved
outwards by the dilated radius, and the volume that sharp edges add is taken back by one uniform scaling.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import ArrayLike

from dilatedem.geometry import outline as plan
from dilatedem.geometry.mass import edge_arcs, vertex_directions
from dilatedem.geometry.polyhedron import Polyhedron, assemble, centroid, convex_hull, prism
from dilatedem.geometry.polyhedron import volume as polyhedron_volume
from dilatedem.geometry.qhull import HalfspaceIntersection, QhullError
from dilatedem.numerics.plain import dot, norm, nth_root, sine_cosine, turned

# Sides of the polygon that stands for a circle in the outer shape of spheres and capsules, a multiple of 4:
# 266 vertices on a sphere, its facets 0.9 % of the radius off before the volume is put right.
CIRCLE_SIDES = 24
# Edges and corners that would reach further than this many radii from the core are bevelled there.
SPIKE_LIMIT = plan.MITRE_LIMIT
# Cosine between normals below which two faces count as square, so that the core is worked as a prism.
SQUARE = 1e-12


def outer_polyhedron(core: Polyhedron, radius: float, volume: float, *, centre: ArrayLike = (0.0, 0.0, 0.0)) -> Polyhedron:
    """Sharp outer shape of `core` dilated by `radius` [m], of exactly the given `volume` [m3].

    Its centroid is put at `centre` (3,) [m], the centroid of the dilated body (the origin in body
    coordinates): a floe's centre of buoyancy then lies straight over its centre of mass when it floats flat.
    """
    if core.dimension < 2:
        sharp = _round_hull(core, radius)
    elif radius == 0.0:
        sharp = core
    elif _is_prism(core):
        ((_, sharp),) = _offset_prisms(core.stacked(), radius)
        sharp = sharp.member(0)
    else:
        sharp = _offset_solid(core, radius)
    return _of_volume(sharp, volume).translated(centre)


def outer_prisms(cores: Polyhedron, radius: float, volume: np.ndarray) -> Iterator[tuple[np.ndarray, Polyhedron]]:
    """`outer_polyhedron` about the origin for a stack of m prisms, by the topology of what comes out (acute corners are bevelled).

    volume (m,) [m3]. Yields which of the cores (l,), and their outer shapes, a stack of l.
    """
    offset = [(np.arange(len(volume)), cores)] if radius == 0.0 else _offset_prisms(cores, radius)
    for which, sharp in offset:
        yield which, _of_volume(sharp, volume[which])


def _of_volume(sharp: Polyhedron, volume: float | np.ndarray) -> Polyhedron:
    """Moved to have its centroid at the origin, then scaled to the given volume."""
    sharp = sharp.translated(-centroid(sharp))
    ratio = np.asarray(volume / polyhedron_volume(sharp))
    factor = np.array([nth_root(x, 3) for x in ratio.ravel().tolist()])
    return sharp.scaled(factor.reshape(ratio.shape))


def _round_hull(core: Polyhedron, radius: float) -> Polyhedron:
    """A sphere or a capsule as two poles with rings of CIRCLE_SIDES points stacked between them."""
    first, last = core.vertices[0], core.vertices[-1]
    axis = last - first if core.dimension == 1 else np.array([0.0, 0.0, 1.0])
    axis = axis / norm(axis)
    across = np.cross(axis, np.eye(3)[np.abs(axis).argmin()])
    across /= norm(across)
    step = 2.0 * np.pi / CIRCLE_SIDES
    sine, cosine = sine_cosine(step * np.arange(CIRCLE_SIDES))
    circle = cosine[:, None] * across + sine[:, None] * np.cross(axis, across)

    latitudes = step * np.arange(1 - CIRCLE_SIDES // 4, CIRCLE_SIDES // 4)
    rings = [(first, latitude) for latitude in latitudes if latitude <= 0.0]
    upper = latitudes >= 0.0 if core.dimension == 1 else latitudes > 0.0  # a sphere has one equator
    rings += [(last, latitude) for latitude in latitudes[upper]]
    heights = [(at, *sine_cosine(latitude)) for at, latitude in rings]
    points = [at + radius * (sine * axis + cosine * circle) for at, sine, cosine in heights]
    vertices = np.concatenate([(first - radius * axis)[None], *points, (last + radius * axis)[None]])

    here = np.arange(CIRCLE_SIDES)
    following = np.roll(here, -1)
    start = 1 + CIRCLE_SIDES * np.arange(len(rings))
    top = np.full(CIRCLE_SIDES, len(vertices) - 1)
    faces = list(np.column_stack((np.zeros_like(here), 1 + following, 1 + here)))
    for low in start[:-1]:
        high = low + CIRCLE_SIDES
        faces += list(np.column_stack((low + here, low + following, high + following, high + here)))
    faces += list(np.column_stack((start[-1] + here, start[-1] + following, top)))
    return assemble(vertices, faces)


def _is_prism(core: Polyhedron) -> bool:
    """Whether a core is a plate or a right prism: its first two faces opposite, and all others square to them."""
    up = core.normals[1]
    if dot(core.normals[0], up) > SQUARE - 1.0 or (np.abs(dot(core.normals[2:], up)) > SQUARE).any():
        return False
    return core.dimension == 2 or len(core.faces) == len(core.faces[0]) + 2


def _offset_prisms(cores: Polyhedron, radius: float) -> Iterator[tuple[np.ndarray, Polyhedron]]:
    """A stack of plates or right prisms (every floe) by their outlines; which of them, and their offset shapes."""
    up = cores.normals[:, 1]
    across = np.cross(np.eye(3)[np.abs(up).argmin(axis=1)], up)
    across /= norm(across)[:, None]
    frame = np.stack((across, np.cross(up, across), up), axis=1)
    local = turned(frame[:, None], cores.vertices)
    low, high = local[..., 2].min(axis=1) - radius, local[..., 2].max(axis=1) + radius
    for which, loop in plan.mitred_together(local[:, cores.faces[1], :2], radius):
        offset, back = prism(loop, low[which], high[which]), np.swapaxes(frame[which], 1, 2)[:, None]
        yield which, Polyhedron(turned(back, offset.vertices), offset.edges, offset.faces, turned(back, offset.normals))


def _offset_solid(core: Polyhedron, radius: float) -> Polyhedron:
    """Any other core, by the intersection of its half-spaces moved outwards."""
    inside = core.vertices.mean(axis=0)
    on_face = np.array([core.vertices[loop[0]] for loop in core.faces])
    normals = [core.normals]
    points = [on_face + radius * core.normals]

    # Bevels: planes square to the middle of an edge's normals, or of a vertex's; blunt ones never feel them.
    arcs = edge_arcs(core)
    middles = ((arcs.middle, core.vertices[core.edges[:, 0]]), (vertex_directions(core, arcs), core.vertices))
    for middle, at in middles:
        direction = middle / norm(middle)[:, None]
        normals.append(direction)
        points.append(at + SPIKE_LIMIT * radius * direction)
    normal = np.concatenate(normals)
    offset = dot(np.concatenate(points) - inside, normal)
    size = offset.max()
    try:
        corners = HalfspaceIntersection(np.column_stack((normal, -offset / size)), np.zeros(3)).intersections
    except QhullError as fault:
        raise ValueError("the body has no outer shape: its core is too close to degenerate") from fault
    return convex_hull(inside + size * corners)

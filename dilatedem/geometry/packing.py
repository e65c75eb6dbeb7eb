"""Polyhedra of many bodies in flat arrays, one body after the other; stacks are written as a whole."""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from dilatedem.geometry.polyhedron import Polyhedron
from dilatedem.numerics.blocks import offsets, place


class PackedPolyhedra(NamedTuple):
    """n bodies with v vertices and f faces in all."""

    vertex_start: np.ndarray  # (n+1,)
    vertex: np.ndarray  # (v, 3) m
    face_start: np.ndarray  # (n+1,)
    face_normal: np.ndarray  # (f, 3) outward
    loop_start: np.ndarray  # (f+1,)
    loop: np.ndarray  # packed vertices around a face, counter-clockwise from outside


def numbered(counts: Sequence[int], order: np.ndarray | None) -> Iterator[np.ndarray]:
    """The numbers of the bodies of each stack, `counts` in size, out of `order` (n,); 0, 1, 2, ... where that is None."""
    end = offsets(counts)
    order = np.arange(end[-1]) if order is None else order
    return (order[a:b] for a, b in zip(end[:-1], end[1:], strict=True))


def pack_polyhedra(polyhedra: Sequence[Polyhedron], order: np.ndarray | None = None) -> PackedPolyhedra:
    """Pack single polyhedra and stacks; order (n,): the number of each body, stack by stack, as they come unless given."""
    parts = _numbered_stacks(polyhedra, order)
    count = sum(len(number) for _, number in parts)
    vertices, faces, entries = np.zeros(count, np.int64), np.zeros(count, np.int64), np.zeros(count, np.int64)
    for stack, number in parts:
        vertices[number], faces[number] = stack.vertices.shape[1], len(stack.faces)
        entries[number] = sum(len(face) for face in stack.faces)
    vertex_start, face_start, entry_start = offsets(vertices), offsets(faces), offsets(entries)
    vertex, face_normal = np.empty((vertex_start[-1], 3)), np.empty((face_start[-1], 3))
    corners, loop = np.empty(face_start[-1], np.int64), np.empty(entry_start[-1], np.int32)
    for stack, number in parts:
        place(vertex, vertex_start[number], stack.vertices)
        if stack.faces:
            place(face_normal, face_start[number], stack.normals)
            place(corners, face_start[number], [len(face) for face in stack.faces])
            place(loop, entry_start[number], np.concatenate(stack.faces) + vertex_start[number][:, None])
    return PackedPolyhedra(vertex_start, vertex, face_start, face_normal, offsets(corners), loop)


def pack_neighbours(
    polyhedra: Sequence[Polyhedron], vertex_start: np.ndarray, order: np.ndarray | None = None
) -> tuple[np.ndarray, np.ndarray]:
    """Which packed vertices share an edge with each, in the order of the edges: where those of a vertex begin (v+1,), and they."""
    parts = _numbered_stacks(polyhedra, order)
    entries = np.zeros(len(vertex_start) - 1, np.int64)
    for stack, number in parts:
        entries[number] = 2 * len(stack.edges)
    entry_start = offsets(entries)
    degree, neighbour = np.zeros(vertex_start[-1], np.int64), np.empty(entry_start[-1], np.int64)
    for stack, number in parts:
        if len(stack.edges):
            owner, other = stack.edges.ravel(), stack.edges[:, ::-1].ravel()
            place(degree, vertex_start[number], np.bincount(owner, minlength=stack.vertices.shape[1]))
            place(neighbour, entry_start[number], other[np.argsort(owner, kind="stable")] + vertex_start[number][:, None])
    return offsets(degree), neighbour


def _numbered_stacks(polyhedra: Sequence[Polyhedron], order: np.ndarray | None) -> list[tuple[Polyhedron, np.ndarray]]:
    stacks = [body.stacked() for body in polyhedra]
    return list(zip(stacks, numbered([len(stack.vertices) for stack in stacks], order), strict=True))


def selected(packed, bodies: np.ndarray):
    """Packed arrays with the bodies `bodies` (k,) of others, in this order; one that is named twice is there twice.

    packed: a `PackedPolyhedra`, `shapes.Shapes` or `shapes.Hulls`; the same kind is returned.
    """
    vertices, vertex_start = entries(packed.vertex_start, bodies)
    faces, face_start = entries(packed.face_start, bodies)
    loops, loop_start = entries(packed.loop_start, faces)
    moved = vertex_start[:-1] - packed.vertex_start[bodies]  # of a body's vertices
    rows = {"vertex": vertices, "face_normal": faces}
    made = {"vertex_start": vertex_start, "face_start": face_start, "loop_start": loop_start}
    made["loop"] = packed.loop[loops] + np.repeat(moved, np.diff(loop_start[face_start]))
    if hasattr(packed, "neighbour_start"):
        neighbours, made["neighbour_start"] = entries(packed.neighbour_start, vertices)
        made["neighbour"] = packed.neighbour[neighbours] + np.repeat(moved, np.diff(made["neighbour_start"][vertex_start]))
    for name, array in packed._asdict().items():
        made[name] = made[name].astype(array.dtype) if name in made else array[rows.get(name, bodies)]
    return type(packed)(**made)


def together(first, second):
    """Packed arrays with the bodies of two others, those of the first before those of the second; the same kind is returned.

    first, second: two `PackedPolyhedra`, `shapes.Shapes` or `shapes.Hulls`.
    """
    starts = {"vertex_start": first.vertex, "face_start": first.loop_start[1:], "loop_start": first.loop}
    numbers = {"loop": len(first.vertex)}
    if hasattr(first, "neighbour_start"):
        starts["neighbour_start"], numbers["neighbour"] = first.neighbour, len(first.vertex)
    made = {}
    for name, values in first._asdict().items():
        others = getattr(second, name)
        if name in starts:
            others = others[1:] + len(starts[name])
        elif name in numbers:
            others = others + numbers[name]
        made[name] = np.concatenate([values, others]).astype(values.dtype)
    return type(first)(**made)


def entries(start: np.ndarray, rows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Which entries of a flat array belong to some of its rows, and where those rows begin when only they are left."""
    counts = (start[1:] - start[:-1])[rows]
    begin = offsets(counts)
    return np.arange(begin[-1]) + np.repeat(start[:-1][rows] - begin[:-1], counts), begin

"""Floes of several convex parts as one rigid body each: a common origin, one mass and inertia, no water at the cuts between."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from dilatedem.field.placement import Parts
from dilatedem.geometry.shapes import BodyShape, Hulls
from dilatedem.numerics.plain import dot, inverse
from dilatedem.state.bodies import joined_rows


@dataclass(frozen=True, eq=False)
class Joints:
    """Which of n bodies are parts of one floe.

    floe (n,): the floe that a body is part of, -1 = it is one by itself; the parts of a floe are numbered one after another
    seat (n, 3) [m]: from the floe's centroid to that of the part
    inner (n, 3): length [m] of a part's sides that lie within the floe, and its first moments about the floe's centroid [m2]
    """

    floe: np.ndarray
    seat: np.ndarray
    inner: np.ndarray

    def first(self) -> np.ndarray:
        """(n,) the first part of the floe that each body is part of: itself where it is one alone."""
        numbers = np.arange(len(self.floe))
        for first, last in joined_rows(self.floe):
            numbers[first:last] = first
        return numbers


def joined(
    first: int,
    parts: Parts | None,
    shapes: Sequence[BodyShape],
    numbers: Sequence[np.ndarray],
    density: np.ndarray,
    position: np.ndarray,
) -> tuple[Joints, np.ndarray]:
    """The joints of n bodies, the floes among them from `first` on, and the place (n, 3) [m] of the floe that each is part of.

    numbers: of the bodies of each shape; density (n,) [kg/m3]; position (n, 3) [m]: of their own centroids.
    """
    floe, inner, place = np.full(len(density), -1), np.zeros((len(density), 3)), position.copy()
    if parts:
        several = np.bincount(parts.floe, minlength=1)[parts.floe] > 1
        floe[first:], inner[first:] = np.where(several, parts.floe, -1), parts.inner
    mass = np.zeros(len(density))
    for shape, own in zip(shapes, numbers, strict=True):
        mass[own] = np.reshape(shape.properties.volume, -1) * density[own]
    for begin, end in joined_rows(floe):
        own = slice(begin, end)
        place[own] = (mass[own, None] * position[own]).sum(axis=0) / mass[own].sum()
        inner[own, 1:] -= inner[own, :1] * place[own, :2]
    return Joints(floe, position - place, inner), place


def moved_shapes(shapes: Sequence[BodyShape], numbers: Sequence[np.ndarray], joints: Joints) -> list[BodyShape]:
    """The shapes with those of parts about the centroid of their floe; numbers: of the bodies of each stack."""
    moved = []
    for shape, own in zip(shapes, numbers, strict=True):
        if (joints.floe[own] < 0).all():
            moved.append(shape)
            continue
        seat = joints.seat[own]
        moved.append(replace(shape, core=shape.core.translated(seat), outer=shape.outer.translated(seat)))
    return moved


def join_inertia(
    joints: Joints, mass: np.ndarray, inertia: np.ndarray, inverse_mass: np.ndarray, inverse_inertia: np.ndarray
) -> None:
    """Have each part oppose what the whole does, in place: rows of masses (n,), of inertias (n, 3, 3) about own centroids on entry.

    Steiner: I = sum of I_k + m_k (|d|^2 E - d d^T), d the seat. The mass of a part stays its own: weight adds up to the whole's.
    """
    for first, last in joined_rows(joints.floe):
        own, d = slice(first, last), joints.seat[first:last]
        beside = dot(d, d)[:, None, None] * np.eye(3) - d[:, :, None] * d[:, None, :]
        inertia[own] = (inertia[own] + mass[own, None, None] * beside).sum(axis=0)
        inverse_mass[own] = 1.0 / mass[own].sum()
        inverse_inertia[own] = inverse(inertia[first])


def join_hulls(joints: Joints, hulls: Hulls) -> None:
    """Have water loads know, in place, that parts lie off the origin, and that no water is at the cuts between them."""
    parts = np.flatnonzero(joints.floe >= 0)
    hulls.plan[parts, 8:10] = hulls.plan[parts, :1] * joints.seat[parts, :2]
    hulls.plan[parts, 4:7] -= joints.inner[parts]

"""Overlap profiles: undeformed interpenetration of two dilated bodies over the contact plane.

A core dilated by r has the overlap sup over core points c of [depth of c - (r - sqrt(r^2 - |x - c|^2))]; `parabolic` replaces the
sphere by |x - c|^2 / (2 r), as Hertz does. The tilt is a slope: small rotations, positions along the core as in the plane.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

Field = Callable[[np.ndarray, np.ndarray], np.ndarray]


@dataclass(frozen=True)
class Profile:
    """overlap(x, y) [m]; box (x0, x1, y0, y1) [m] holding all that overlaps; arm(x, y) [m] with d overlap/d tilt = -arm about the
    reference point (None: reference at the origin, arm = x); reference: x of the reference point [m]; cut: sides end sharply."""

    overlap: Field
    box: tuple[float, float, float, float]
    reference: float = 0.0
    arm: Field | None = None
    cut: bool = False


def rounded_core(
    length: float, width: float, radius: float, deepest: float, *, tilt: float = 0.0, circular: bool = False
) -> Profile:
    """Rectangular core [0, length] x [-width/2, width/2] dilated by `radius` against a flat.

    Its depth falls from `deepest` at x = 0 by the slope `tilt`; width 0 is an edge, length 0 too a corner. Reference point: the
    middle of the core. Lengths [m], tilt [-].
    """

    def foot(x, y):  # the core point that makes the surface at (x, y), for the parabola and for the circle
        across = np.maximum(abs(y) - width / 2, 0.0)
        if not circular:
            return np.clip(x - radius * tilt, 0.0, length), across
        return np.clip(x - tilt / np.hypot(1.0, tilt) * np.sqrt(np.maximum(radius**2 - across**2, 0.0)), 0.0, length), across

    def overlap(x, y):
        core, across = foot(x, y)
        square = (x - core) ** 2 + across**2
        if not circular:
            return deepest - tilt * core - square / (2 * radius)
        drop = square / (radius + np.sqrt(np.maximum(radius**2 - square, 0.0)))
        return np.where(square < radius**2, deepest - tilt * core - drop, -radius)

    reach = np.sqrt(2 * radius * deepest)
    end = length + reach
    if tilt > 0:
        end = min(end, deepest / tilt + radius * tilt / 2)
    box = (-reach, max(end, reach), -width / 2 - reach, width / 2 + reach)
    return Profile(overlap, box, length / 2, lambda x, y: foot(x, y)[0] - length / 2)


def cylinder(length: float, radius: float, end_radius: float | None, deepest: float) -> Profile:
    """Parallel line contact along x, |x| <= length/2, of relative radius `radius` across; beyond its ends the overlap drops as
    s^2/(2 end_radius), or (None) the body is cut off there. Lengths [m]."""
    reach = 0.0 if end_radius is None else np.sqrt(2 * end_radius * deepest)
    across = np.sqrt(2 * radius * deepest)

    def overlap(x, y):
        beyond = np.maximum(abs(x) - length / 2, 0.0)
        return deepest - y**2 / (2 * radius) - (beyond**2 / (2 * end_radius) if end_radius else 0.0)

    return Profile(overlap, (-length / 2 - reach, length / 2 + reach, -across, across), cut=end_radius is None)


def curvatures(first: float, second: float, angle: float) -> tuple[float, float, float]:
    """Small and large principal curvature of the sum d1^2/(2 first) + d2^2/(2 second) [1/m] of two cylinders whose axes cross at
    `angle` [rad], and the angle [rad] from the first axis to the direction of the small one."""
    form = np.zeros((2, 2))
    for radius, turn in ((first, 0.0), (second, angle)):
        normal = np.array([-np.sin(turn), np.cos(turn)])
        form += np.outer(normal, normal) / radius
    values, vectors = np.linalg.eigh(form)
    return float(values[0]), float(values[1]), float(np.arctan2(vectors[1, 0], vectors[0, 0]))


def crossing(first: tuple[float, float], second: tuple[float, float], angle: float, deepest: float) -> Profile:
    """Two cylinders, (radius, length) [m] each, crossing at their middles at `angle` [rad]; x runs along the contact's long axis.

    Beyond the end of an axis its cylinder goes on as a sphere (a dilated segment); an infinite length is allowed.
    """
    small, large, turn = curvatures(first[0], second[0], angle)
    axes = [(first, -turn), (second, angle - turn)]

    def overlap(x, y):
        result = deepest
        for (radius, length), turned in axes:
            along = x * np.cos(turned) + y * np.sin(turned)
            across = -x * np.sin(turned) + y * np.cos(turned)
            result = result - (across**2 + np.maximum(abs(along) - length / 2, 0.0) ** 2) / (2 * radius)
        return result

    end = min(length / 2 + np.sqrt(2 * radius * deepest) for radius, length in (first, second))
    x, y = min(np.sqrt(2 * deepest / small), end), np.sqrt(2 * deepest / large)
    return Profile(overlap, (-x, x, -y, y))


def paraboloid(small: float, large: float, deepest: float) -> Profile:
    """Overlap deepest - (small x^2 + large y^2)/2, curvatures [1/m]: the contact of Hertz."""
    x, y = np.sqrt(2 * deepest / small), np.sqrt(2 * deepest / large)
    return Profile(lambda u, v: deepest - (small * u**2 + large * v**2) / 2, (-x, x, -y, y))


def punch(length: float, width: float, deepest: float, *, round_plan: bool = False) -> Profile:
    """Flat punch with sharp rims, rectangular or (round_plan) elliptic in plan."""

    def overlap(x, y):
        inside = (2 * x / length) ** 2 + (2 * y / width) ** 2 <= 1 if round_plan else np.ones(np.broadcast(x, y).shape, bool)
        return np.where(inside, deepest, -deepest)

    return Profile(overlap, (-length / 2, length / 2, -width / 2, width / 2), cut=True)

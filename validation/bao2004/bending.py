"""A beam on two end supports, and a rigid floe on water: loads at the nodes of a mesh, and what they bend it into."""

from dataclasses import dataclass

import numpy as np

from dilatedem.deformation.elements import interpolation
from dilatedem.deformation.statics import Flexibility, point_loads, static_coordinates, surface_points, weight
from dilatedem.deformation.stress import corner_stress
from validation.bao2004.bodies import Meshed
from validation.bao2004.reference import GRAVITY, LENGTH, THICKNESS, WIDTH, second_moment

UP = np.array([0.0, 0.0, 1.0])
#: share of the largest by which a mode must be loaded to count as symmetric
LOADED = 1e-6


@dataclass(frozen=True, eq=False)
class Bent:
    """A beam on its ends: middle deflection by the mesh itself [m], by so many symmetric modes, stress of the middle [Pa]."""

    whole: float
    by_modes: np.ndarray
    stress: float


def sagging(body: Meshed) -> Bent:
    """The beam under its weight; its supports push it up by shear spread over its end faces."""
    points, areas = surface_points(body.mesh)
    ends = np.abs(areas[:, 0]) > 0.0
    support = np.abs(areas[ends, 0])
    whole = GRAVITY * body.elements.scalar_mass.sum()
    force = point_loads(body.elements, points[ends], np.outer(support * whole / support.sum(), UP))
    force += weight(body.elements, -GRAVITY * UP)
    moved = Flexibility.of(body.elements).displacement(force)
    coordinate = static_coordinates(body.modes, force)
    share = np.array([-_sag(body, shape) for shape in body.modes.shape]) * coordinate
    symmetric = np.abs(share) > LOADED * np.abs(share).max()
    stress = corner_stress(body.elements, moved)
    return Bent(-_sag(body, moved), np.concatenate(([0.0], np.cumsum(share[symmetric]))), surface_stress(body, stress, 0.0))


def _sag(body: Meshed, displacement: np.ndarray) -> float:
    """How far the middle of the middle line has risen over its ends [m]."""
    half = 0.5 * LENGTH
    line = np.array([[0.0, 0.0, 0.0], [-half, 0.0, 0.0], [half, 0.0, 0.0]])
    middle, *ends = (interpolation(body.elements.nodes, body.elements.elements, line) @ displacement)[:, 2]
    return float(middle - np.mean(ends))


def surface_stress(body: Meshed, stress: np.ndarray, x: float) -> float:
    """Bending stress along the beam at its surfaces, over x [m]: half the difference of below and above, mean over the width."""
    corners = body.mesh.points
    found = []
    for side in (-0.5, 0.5):
        skin = np.abs(corners[:, 2] - side * THICKNESS) < 1e-9
        place, value = corners[skin, 0], stress[skin, 0]
        near = np.abs(place - x) < 1.0
        slope = np.polynomial.Polynomial.fit(place[near], value[near], 2)
        found.append(slope(x))
    return float(0.5 * (found[0] - found[1]))


def floating(body: Meshed, load: float) -> np.ndarray:
    """Forces (n, 3) [N] at the nodes of a rigid floe on water that a load [N] pushes down along the upper edge of one end.

    The water's answer is its pressure on the underside of the floe that has sunk and tilted: rho g (a + b x), in balance.
    """
    points, areas = surface_points(body.mesh)
    under = areas[:, 2] < 0.0
    below, patch = points[under], -areas[under, 2]
    wide = np.linspace(-0.5, 0.5, 9) * WIDTH
    edge = np.column_stack((np.full(9, -0.5 * LENGTH), wide, np.full(9, 0.5 * THICKNESS)))
    share = np.array([0.5, *np.ones(7), 0.5]) / 8.0
    sums = np.array([[patch.sum(), patch @ below[:, 0]], [patch @ below[:, 0], patch @ below[:, 0] ** 2]])
    sunk, tilt = np.linalg.solve(sums, [load, -0.5 * LENGTH * load])
    pressed = np.outer((sunk + tilt * below[:, 0]) * patch, UP)
    return point_loads(body.elements, below, pressed) + point_loads(body.elements, edge, np.outer(-load * share, UP))


def recovered_moment(body: Meshed, force: np.ndarray, x: float) -> float:
    """Bending moment [N m] at x [m] from the loaded end, positive where the upper side is pulled, from the recovered stress."""
    stress = corner_stress(body.elements, Flexibility.of(body.elements).displacement(force))
    return -surface_stress(body, stress, x - 0.5 * LENGTH) * second_moment() / (0.5 * THICKNESS)

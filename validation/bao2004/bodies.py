"""The bodies of the closed forms, meshed, and their modes."""

from dataclasses import dataclass

import numpy as np

from dilatedem.deformation.elements import Elements, assembled
from dilatedem.deformation.mesh import Mesh, meshed
from dilatedem.deformation.modes import Modes, free_modes
from dilatedem.geometry.polyhedron import Polyhedron, prism
from validation.bao2004.reference import BEAM, ICE

#: side and thickness of the plate [m]
SIDE, THIN = 1.0, 0.02


@dataclass(frozen=True, eq=False)
class Meshed:
    mesh: Mesh
    elements: Elements
    modes: Modes


def block(length: float, width: float, height: float) -> Polyhedron:
    """A box about the origin."""
    x, y = 0.5 * length, 0.5 * width
    return prism([[-x, -y], [x, -y], [x, y], [-x, y]], -0.5 * height, 0.5 * height)


def deformable(body: Polyhedron, size: float, count: int) -> Meshed:
    """A body of ice with its lowest modes."""
    mesh = meshed(body, size)
    elements = assembled(mesh, ICE)
    return Meshed(mesh, elements, free_modes(elements, count))


def beam(size: float, count: int) -> Meshed:
    return deformable(block(*BEAM), size, count)


def plate(size: float, count: int) -> Meshed:
    return deformable(block(SIDE, SIDE, THIN), size, count)


def upright(modes: Modes) -> np.ndarray:
    """Numbers of the modes that bend a beam up and down: they move its middle line along z more than otherwise."""
    line = np.abs(modes.nodes[:, 1:]).max(axis=1) < 1e-9
    motion = (modes.shape[:, line] ** 2).sum(axis=1)
    return np.flatnonzero((motion[:, 2] > 10.0 * motion[:, :2].sum(axis=1)) & (motion[:, 2] > 1e-6 * motion.sum(axis=1).max()))

"""A body that bends, with all that its modes tell."""

from typing import NamedTuple

from dilatedem.deformation.lattice import Lattice
from dilatedem.deformation.modes import Modes
from dilatedem.geometry.polyhedron import Polyhedron


class Bent(NamedTuple):
    """Outer polyhedron, modes, and their shapes as fields."""

    outer: Polyhedron
    modes: Modes
    lattice: Lattice

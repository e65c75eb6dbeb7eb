"""From a case to bodies that bend: the modes of each, as the arrays that kernels work on."""

import numpy as np

from dilatedem.case.schema import Case
from dilatedem.deformation.elements import Material
from dilatedem.deformation.kept import modes_of
from dilatedem.deformation.lattice import Lattice, lattice_of
from dilatedem.deformation.modes import Modes
from dilatedem.errors import CaseError
from dilatedem.geometry.polyhedron import Polyhedron
from dilatedem.scene.place import Scene
from dilatedem.state.bodies import Solids
from dilatedem.state.modal import ModalSolids

#: step of the lattice over which modes are smooth fields, over the size of the elements
LATTICE = 0.5


def bent_solids(case: Case, scene: Scene, solids: Solids) -> Solids | ModalSolids:
    """The same bodies with their modes; `solids` itself where none has any. Raises CaseError for one that has none to have."""
    counts = _counts(case, scene, solids)
    if not counts.any():
        return solids
    most, found = int(counts.max()), {}
    for number, outer in _outers(scene):
        if counts[number]:
            found[number] = _modes(case, scene, number, outer, int(counts[number]))
    square, damping, reach = (np.zeros((len(counts), most)) for _ in range(3))
    gradient, lattices = np.zeros((len(counts), most, 3, 3)), []
    start, size = np.zeros(len(counts), np.int64), np.full((len(counts), 3), 3)
    origin, pace, row = np.zeros((len(counts), 3)), np.ones((len(counts), 3)), 0
    for number, (modes, lattice) in sorted(found.items()):
        k = modes.count
        square[number, :k] = modes.frequency**2
        damping[number, :k] = 2.0 * case.deformation.damping * modes.frequency
        reach[number, :k] = np.sqrt((modes.shape**2).sum(axis=2).max(axis=1))
        gradient[number, :k] = modes.inertia_gradient
        start[number], size[number] = row, lattice.coefficients.shape[:3]
        origin[number], pace[number] = lattice.origin, 1.0 / lattice.step
        lattices.append(lattice.coefficients.reshape(-1, 3))
        row += len(lattices[-1])
    return ModalSolids(*solids, counts, square, damping, reach, gradient, start, size, origin, pace, np.concatenate(lattices))


def _counts(case: Case, scene: Scene, solids: Solids) -> np.ndarray:
    """(n,) modes of each body; none of what is held."""
    counts = np.zeros(len(solids.mass), np.int64)
    counts[: scene.count] = case.deformation.modes
    for number, body in enumerate(case.body[: scene.explicit]):
        counts[number] = case.deformation.modes if body.modes is None else body.modes
    counts[solids.inverse_mass == 0.0] = 0
    return counts


def _outers(scene: Scene):
    """Number and outer polyhedron of every body."""
    first = 0
    for shape in scene.shapes:
        outer = shape.outer.stacked()
        for k in range(shape.count):
            yield int(scene.order[first + k]), outer.member(k)
        first += shape.count


def _modes(case: Case, scene: Scene, number: int, outer: Polyhedron, count: int) -> tuple[Modes, Lattice]:
    about = case.body[number] if number < scene.explicit else case.ice
    material = Material(about.elastic_modulus, about.poisson_ratio, float(scene.density[number]))
    try:
        modes = modes_of(outer, material, case.deformation.mesh_size, count)
    except ValueError as fault:
        raise CaseError(f"body {number} cannot bend: it {fault}") from fault
    return modes, lattice_of(modes, LATTICE * case.deformation.mesh_size)

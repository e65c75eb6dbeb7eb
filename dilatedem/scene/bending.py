"""From a case to bodies that bend: the modes of each, as the arrays that kernels work on."""

from dataclasses import fields

import numpy as np

from dilatedem.case.schema import Case
from dilatedem.deformation.bent import Bent
from dilatedem.deformation.elements import Material
from dilatedem.deformation.kept import modes_of
from dilatedem.deformation.lattice import lattice_of
from dilatedem.deformation.modes import STRAINS
from dilatedem.deformation.skin import Skin, face_motion, skin_of, surface_stress
from dilatedem.deformation.stress import COLUMN, ROW
from dilatedem.errors import CaseError
from dilatedem.geometry.polyhedron import Polyhedron
from dilatedem.geometry.shapes import Shapes
from dilatedem.numerics.blocks import offsets
from dilatedem.numerics.plain import dot, turned
from dilatedem.scene.place import Scene
from dilatedem.state.bodies import Solids
from dilatedem.state.modal import ModalSolids

#: step of the lattice over which modes are smooth fields, over the size of the elements
LATTICE = 0.5
#: sizes that a body is meshed with, each so much smaller than the one before, until its elements are of fair shape
TRIES, SMALLER = 4, 0.7


def bent_bodies(case: Case, scene: Scene, counts: np.ndarray) -> dict[int, Bent]:
    """The bodies that bend, by number, in order; counts (n,): modes of each.

    Raises CaseError for a listed body that has none to have; a floe of a field that no elements of fair shape fill stays rigid.
    """
    found = {number: _bent(case, scene, number, outer, int(counts[number])) for number, outer in _outers(scene) if counts[number]}
    return {number: bent for number, bent in sorted(found.items()) if bent}


def bent_again(case: Case, scene: Scene, solids: ModalSolids) -> dict[int, Bent]:
    """The bodies that bend, as `bent_solids` found them."""
    return bent_bodies(case, scene, np.maximum(solids.mode_count - (STRAINS if case.deformation.strains else 0), 0))


def bent_solids(case: Case, scene: Scene, solids: Solids, shapes: Shapes) -> Solids | ModalSolids:
    """The same bodies with their modes; `solids` itself where none has any. Raises CaseError for one that has none to have."""
    counts = _counts(case, scene, solids)
    if not counts.any():
        if case.bends:
            raise CaseError("deformation.modes: no body can bend: each is held, or has modes = 0 of its own")
        return solids
    bent = bent_bodies(case, scene, counts)
    counts[:] = 0
    for number, found in bent.items():
        counts[number] = found.modes.count
    most = int(counts.max())
    if not bent:
        raise CaseError("no floe can bend: make deformation.mesh_size smaller")
    frequency, damping, reach = (np.zeros((len(counts), most)) for _ in range(3))
    change = np.zeros((len(counts), most, 6))
    for number, (_, modes, _) in bent.items():
        k = modes.count
        frequency[number, :k] = modes.frequency
        damping[number, :k] = 2.0 * case.deformation.damping * modes.frequency
        reach[number, :k] = np.sqrt((modes.shape**2).sum(axis=2).max(axis=1))
        turn = solids.inverse_inertia[number]
        change[number, :k] = -turned(turn, turned(turn, modes.inertia_gradient).transpose(0, 2, 1))[:, ROW, COLUMN]
    arrays = {"mode_count": counts, "mode_frequency": frequency, "mode_square": frequency**2, "mode_damping": damping}
    faces = _faces(shapes, bent, most)
    arrays |= {"mode_reach": reach, "mode_mobility": _mobility(shapes, faces, bent, len(counts))}
    arrays |= {"rest_inertia": np.ascontiguousarray(solids.inverse_inertia[:, ROW, COLUMN]), "inertia_change": change}
    arrays |= {"swing": np.zeros((len(counts), 8, most)), "swing_time": np.zeros(len(counts))}
    arrays |= _lattices(bent, len(counts)) | faces | _skins(bent, len(counts), most)
    arrays |= _stresses(bent, len(counts), most)
    return ModalSolids(*solids, **arrays, strength=np.full(len(counts), case.ice.flexural_strength))


def _mobility(shapes: Shapes, faces: dict[str, np.ndarray], bent: dict[int, Bent], count: int) -> np.ndarray:
    """(count,) 1/kg: how modes give way at most to a push on a face at one of its corners, smaller faces by as much less as
    they are softer."""
    most = np.zeros(count)
    for number in bent:
        found = []
        for face in range(shapes.face_start[number], shapes.face_start[number + 1]):
            loop = shapes.vertex[shapes.loop[shapes.loop_start[face] : shapes.loop_start[face + 1]]]
            arm, own = loop - loop.mean(axis=0), faces["face_shape"][face]
            moved = own[:, None, :3] + np.cross(own[:, None, 3:], arm)
            wide = np.cross(loop - loop[0], np.roll(loop, -1, axis=0) - loop[0]).sum(axis=0)
            found.append((dot(moved, shapes.face_normal[face]) ** 2).sum(axis=0).max() * np.array([1.0, (wide**2).sum() ** 0.25]))
        if found:
            found = np.array(found)
            largest = (found[:, 1] / found[:, 0]).max()
            most[number] = (found[:, 1] / largest).max()
    return most


def _lattices(bent: dict[int, Bent], count: int) -> dict[str, np.ndarray]:
    """The modes' fields, one body's after the other's."""
    start, size = np.zeros(count, np.int64), np.full((count, 3), 3)
    origin, pace, rows = np.zeros((count, 3)), np.ones((count, 3)), []
    for number, (_, _, lattice) in bent.items():
        start[number], size[number] = sum(map(len, rows)), lattice.coefficients.shape[:3]
        origin[number], pace[number] = lattice.origin, 1.0 / lattice.step
        rows.append(lattice.coefficients.reshape(-1, 3))
    return {
        "lattice_start": start,
        "lattice_size": size,
        "lattice_origin": origin,
        "lattice_pace": pace,
        "lattice": np.ascontiguousarray(np.concatenate(rows)),
    }


def _faces(shapes: Shapes, bent: dict[int, Bent], most: int) -> dict[str, np.ndarray]:
    """Middle of each face, and how it moves with each of up to `most` modes: those of the cores, moved out to the surface."""
    centre, moved = np.zeros((len(shapes.face_normal), 3)), np.zeros((len(shapes.face_normal), most, 6))
    for number, (_, _, lattice) in bent.items():
        for face in range(shapes.face_start[number], shapes.face_start[number + 1]):
            loop = shapes.vertex[shapes.loop[shapes.loop_start[face] : shapes.loop_start[face + 1]]]
            centre[face], own = face_motion(loop + shapes.radius[number] * shapes.face_normal[face], lattice)
            moved[face, : len(own)] = own
    return {"face_centre": centre, "face_shape": moved}


def _skins(bent: dict[int, Bent], count: int, most: int) -> dict[str, np.ndarray]:
    """The surfaces of `count` bodies of up to `most` modes, one after the other."""
    skins = [skin_of(outer, modes) for outer, modes, _ in bent.values()]
    faces = np.zeros(count, np.int64)
    faces[list(bent)] = [len(skin.area) for skin in skins]
    columns = {field.name: [_widened(getattr(skin, field.name), most, field.name) for skin in skins] for field in fields(Skin)}
    columns["start"] = [offsets(np.concatenate([np.diff(start) for start in columns["start"]]))]
    packed = {f"skin_{name}": np.concatenate(rows) for name, rows in columns.items()}
    return packed | {"skin_face": offsets(faces)}


def _stresses(bent: dict[int, Bent], count: int, most: int) -> dict[str, np.ndarray]:
    """The stress of the modes at points of the surfaces of `count` bodies, and what bounds it."""
    found = {number: surface_stress(modes, outer) for number, (outer, modes, _) in bent.items()}
    bound, points = np.zeros(count), np.zeros(count, np.int64)
    for number, (point, stress) in found.items():
        points[number] = len(point)
        unit = stress / bent[number].modes.frequency[:, None]
        bound[number] = np.sqrt((unit[..., 0] ** 2 + unit[..., 1] ** 2 + 2.0 * unit[..., 2] ** 2).sum(axis=1).max())
    return {
        "stress_start": offsets(points),
        "stress_point": np.concatenate([point for point, _ in found.values()]),
        "stress_shape": np.concatenate([_widened(stress, most, "shape") for _, stress in found.values()]),
        "stress_bound": bound,
    }


def _widened(values: np.ndarray, most: int, name: str) -> np.ndarray:
    """Values of the modes of a body, with zeros for those that others have."""
    axes = {"first": (1,), "outward": (1,), "moment": (1,), "second": (1, 2), "shape": (1,)}.get(name, ())
    return np.pad(values, [(0, most - size if axis in axes else 0) for axis, size in enumerate(values.shape)])


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


def _bent(case: Case, scene: Scene, number: int, outer: Polyhedron, count: int) -> Bent | None:
    about = case.body[number] if number < scene.explicit else case.ice
    material = Material(about.elastic_modulus, about.poisson_ratio, float(scene.density[number]))
    sizes = case.deformation.mesh_size * SMALLER ** np.arange(TRIES)
    for size in sizes.tolist():
        try:
            modes = modes_of(outer, material, size, count, case.deformation.strains)
            break
        except ValueError as fault:
            if size > sizes[-1]:
                continue
            if number < scene.explicit:
                raise CaseError(f"body {number} cannot bend: it {fault}") from fault
            return None
    return Bent(outer, modes, lattice_of(modes, LATTICE * size))

"""From the supports of a scene to arrays: what carries its structures, and how their parts hang together."""

import numpy as np

from dilatedem.numerics.blocks import offsets
from dilatedem.scene.place import PlacedStructure, Scene
from dilatedem.state.supports import Carried, ModalSupports, Supports
from dilatedem.structures.support import Carriage


def pack_supports(scene: Scene) -> Supports | ModalSupports:
    """Of all records of a scene, in their order; a class of its own where some are beams."""
    sums = len(scene.records) - len(scene.structures)
    carriages = [*(_carriage(structure) for structure in scene.structures), *[Carriage(Carried.HELD)] * sums]
    parts, own = [part for structure in scene.structures for part in structure.parts], np.arange(len(scene.structures))
    whole_of, place = scene.whole_of(), places(scene)
    owner = np.repeat(np.where(whole_of < 0, own, whole_of), [len(structure.parts) for structure in scene.structures])
    moving = np.flatnonzero([structure.whole is None and structure.support.moves for structure in scene.structures])
    chosen = np.concatenate([np.zeros(0, np.int64), *(np.flatnonzero(owner == s) for s in moving)])

    def rows(name: str, width: int) -> np.ndarray:
        return np.reshape([getattr(carriage, name) for carriage in carriages], (-1, width))

    supports = Supports(
        moving=moving,
        kind=np.array([carriage.kind for carriage in carriages], np.int64),
        place=place,
        inverse_mass=rows("inverse_mass", 3),
        stiffness=rows("stiffness", 3),
        damping=rows("damping", 3),
        part_start=offsets([np.count_nonzero(owner == s) for s in moving]),
        part=chosen,
        seat=np.reshape([part.position for part in parts], (-1, 3))[chosen] - place[owner[chosen]],
        upright=np.reshape([part.orientation for part in parts], (-1, 4))[chosen],
        knot_start=offsets([len(carriage.times) for carriage in carriages]),
        knot_time=np.concatenate([np.zeros(0), *(carriage.times for carriage in carriages)]),
        knot=np.concatenate([np.zeros((0, 3)), *(carriage.displacement for carriage in carriages)]),
        slope=np.concatenate([np.zeros((0, 3)), *(carriage.slope for carriage in carriages)]),
    )
    return _with_beams(supports, carriages) if any(carriage.modes for carriage in carriages) else supports


def _with_beams(supports: Supports, carriages: list[Carriage]) -> ModalSupports:
    """The same with the modes of beams, along x and along y in columns."""
    beams = [carriage for carriage in carriages if carriage.modes]

    def columns(name: str) -> np.ndarray:
        return np.concatenate([np.column_stack([getattr(modes, name) for modes in beam.modes]) for beam in beams])

    frequency = columns("frequency")
    counts = [len(carriage.modes[0].frequency) if carriage.modes else 0 for carriage in carriages]
    ratio = np.repeat([carriage.damping_ratio for carriage in carriages], counts)[:, None]
    return ModalSupports(
        *supports,
        mode_start=offsets(counts),
        mode_shape=columns("shape"),
        mode_square=frequency * frequency,
        mode_damping=2.0 * ratio * frequency,
        mode_shear=columns("shear"),
        mode_moment=columns("moment"),
        push_height=np.array([carriage.push_height for carriage in carriages]),
    )


def _carriage(structure: PlacedStructure) -> Carriage:
    """How a structure moves; one that is a part of another goes with it, and has no table of time, mass or springs itself."""
    carriage = structure.support.carriage()
    return Carriage(carriage.kind) if structure.whole else carriage


def places(scene: Scene) -> np.ndarray:
    """(s, 3) [m] about which the moments of each record are stated, with all structures at rest."""
    return np.reshape([record.place for record in scene.records], (-1, 3))


def velocities_at_start(scene: Scene) -> np.ndarray:
    """(s, 3) m/s, m/s, rad/s of each record: of structures that are driven."""
    found = np.zeros((len(scene.records), 3))
    for s, structure in enumerate(scene.structures):
        found[s] = structure.support.carriage().at(np.zeros(1))[1][0]
    return found

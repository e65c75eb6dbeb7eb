"""snapshots/structures_NNNNNN.vtu and structures.pvd: structures that move, for ParaView."""

import numpy as np

from dilatedem.numerics.frames import quaternion_from_rotation_vector
from dilatedem.numerics.plain import norm
from dilatedem.output import folder
from dilatedem.output.snapshots.collection import Collection, snapshots_of
from dilatedem.output.snapshots.vtu import write_shapes
from dilatedem.output.structures import moving
from dilatedem.state.supports import Carried

#: bytes of a structure in a snapshot, about
SHAPE = 4e3


class StructureSnapshots(Collection):
    """Structures that move at each snapshot of the ice, for ParaView; those that are held stand in structures.vtu."""

    name, listing = "structure_snapshots", folder.STRUCTURE_COLLECTION

    @classmethod
    def interval(cls, case) -> float:
        return case.output.snapshot_interval if moving(case) else 0.0

    @classmethod
    def size(cls, case, floes: int, structures: int) -> float:
        return SHAPE * moving(case) * snapshots_of(case, cls.interval(case))

    def open(self, kept: dict | None, since: int) -> None:
        super().open(kept, since)
        simulation, extent = self.simulation, float(norm(self.simulation.case.domain.size))
        structures, supports = simulation.scene.structures, simulation.model.supports
        which = np.flatnonzero(supports.kind != Carried.HELD)
        drawings = [structures[s].about.drawing(extent) for s in which]
        self._owner = np.repeat(which, [len(pieces) for pieces in drawings])
        places = supports.place[self._owner]
        self._pieces = [piece.translated(-place) for piece, place in zip(sum(drawings, []), places, strict=True)]

    def note(self, step: int) -> None:
        excursions, which = self.simulation.state.excursions, self._owner
        rows = (getattr(excursions, kept)[which] for kept in ("center", "displacement", "velocity"))
        self.put(folder.structures_name(self.number(step)), *rows)

    def _write(self, name: str, center: np.ndarray, displacement: np.ndarray, velocity: np.ndarray) -> None:
        yaw = np.reshape([quaternion_from_rotation_vector([0.0, 0.0, angle]) for angle in displacement[:, 2]], (-1, 4))
        flat = np.array([1.0, 1.0, 0.0])
        cell_data = {"structure": self._owner, "displacement": displacement * flat, "velocity": velocity * flat}
        write_shapes(self.out / name, self._pieces, self.at_home(center), yaw, cell_data)

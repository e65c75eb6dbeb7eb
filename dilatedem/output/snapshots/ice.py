"""snapshots/ice_NNNNNN.vtu and ice.pvd: the floes in their true shape, for ParaView."""

import numpy as np

from dilatedem.numerics.plain import norm
from dilatedem.output import folder
from dilatedem.output.snapshots.collection import Collection, snapshots_of
from dilatedem.output.snapshots.vtu import SnapshotWriter

#: bytes of a snapshot, about: of itself, and of every floe
FILE, FLOE = 3e3, 350.0


class Snapshots(Collection):
    """The floes at each snapshot."""

    name, listing = "snapshots", folder.ICE_COLLECTION

    @classmethod
    def interval(cls, case) -> float:
        return case.output.snapshot_interval

    @classmethod
    def size(cls, case, floes: int, structures: int) -> float:
        return snapshots_of(case, cls.interval(case)) * (FILE + FLOE * floes)

    def open(self, kept: dict | None, since: int) -> None:
        super().open(kept, since)
        (self.out / folder.SNAPSHOTS).mkdir(parents=True, exist_ok=True)
        self.repacked()

    def repacked(self) -> None:
        self._writer = SnapshotWriter.of_hulls(self.simulation.model.hulls)

    def note(self, step: int) -> None:
        simulation = self.simulation
        bodies, ids = simulation.state.bodies, simulation.state.ids.body
        count = len(ids)
        pose = (bodies.position[:count].copy(), bodies.orientation[:count].copy())
        self.put(folder.snapshot_name(self.number(step)), self._writer, *pose, {
            "body": ids,
            "velocity": bodies.velocity[:count].copy(),
            "angular_velocity": bodies.angular_velocity[:count].copy(),
            "contact_force": bodies.contact_force[:count].copy(),
            "contacts": bodies.contact_count[:count].copy(),
        })  # fmt: skip

    def _write(self, name: str, writer: SnapshotWriter, position: np.ndarray, orientation: np.ndarray, cell_data: dict) -> None:
        cell_data |= {"speed": norm(cell_data["velocity"])}
        writer.write(self.out / name, self.at_home(position), orientation, cell_data)

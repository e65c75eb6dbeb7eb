"""snapshots/ice_NNNNNN.vtu and ice.pvd: the floes in their true shape, for ParaView."""

import numpy as np

from dilatedem.numerics.plain import norm
from dilatedem.output import folder
from dilatedem.output.observer import Observer
from dilatedem.output.vtu import SnapshotWriter, wrapped, write_pvd

#: bytes of a snapshot, about: of itself, and of every floe
FILE, FLOE = 3e3, 350.0


class Snapshots(Observer):
    """A file a snapshot, and the list of all of them."""

    name = "snapshots"

    @classmethod
    def interval(cls, case) -> float:
        return case.output.snapshot_interval

    @classmethod
    def size(cls, case, floes: int, structures: int) -> float:
        interval = case.output.snapshot_interval
        return (case.time.duration / interval + 1) * (FILE + FLOE * floes) if interval else 0.0

    def open(self, kept: dict | None, since: int) -> None:
        self.written: list[list] = kept["written"] if kept else []  # time [s], file
        self._listed = 0
        (self.out / folder.SNAPSHOTS).mkdir(parents=True, exist_ok=True)
        self.repacked()

    def repacked(self) -> None:
        self._writer = SnapshotWriter.of_hulls(self.simulation.model.hulls)

    def note(self, step: int) -> None:
        simulation = self.simulation
        bodies, ids = simulation.state.bodies, simulation.state.ids.body
        count, number = len(ids), self.schedule.events_until(step) - 1
        pose = (bodies.position[:count].copy(), bodies.orientation[:count].copy())
        self.background.put(self._write, self._writer, folder.snapshot_name(number), *pose, {
            "body": ids,
            "velocity": bodies.velocity[:count].copy(),
            "angular_velocity": bodies.angular_velocity[:count].copy(),
            "contact_force": bodies.contact_force[:count].copy(),
            "contacts": bodies.contact_count[:count].copy(),
        })  # fmt: skip
        self.written.append([simulation.time_s, folder.snapshot_name(number)])

    def _write(self, writer: SnapshotWriter, name: str, position: np.ndarray, orientation: np.ndarray, cell_data: dict) -> None:
        """In the background."""
        domain = self.simulation.case.domain
        periodic = (domain.x_boundary == "periodic", domain.y_boundary == "periodic")
        cell_data |= {"speed": norm(cell_data["velocity"])}
        writer.write(self.out / name, wrapped(position, domain.size, periodic), orientation, cell_data)

    def refresh(self) -> None:
        if self._listed < len(self.written):
            self.background.put(write_pvd, self.out / folder.ICE_COLLECTION, list(self.written))
            self._listed = len(self.written)

    def kept(self) -> dict:
        return {"written": list(self.written)}

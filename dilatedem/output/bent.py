"""flexure.csv: what pulls each floe that bends most; bent.pvd with its files: the shapes of floes as they are bent, and stress."""

import numpy as np

from dilatedem.deformation.bent import Bent
from dilatedem.deformation.mesh import Mesh
from dilatedem.deformation.stress import tension, von_mises
from dilatedem.files.atomic import write_text
from dilatedem.numerics.frames import matrix_from_quaternion
from dilatedem.numerics.plain import turned
from dilatedem.output import folder
from dilatedem.output.observer import Observer
from dilatedem.output.tables import FLEXURE_COLUMNS, whole
from dilatedem.output.vtu import wrapped, write_pvd, write_surfaces

#: bytes of a row, and of a floe in a snapshot, about
ROW, SHAPE = 120.0, 2e4
MEANING = (
    "largest principal stress of the modes at the surface, at every step; floes whose was above ice.flexural_strength would have "
    "broken and go on whole; flexure.csv has each floe's, with time and place"
)


class Flexure(Observer):
    """A row a floe that bends, rewritten where the state is saved; no file where none does."""

    name = "flexure"

    @classmethod
    def size(cls, case, floes: int, structures: int) -> float:
        return ROW * floes if case.bends else 0.0

    def refresh(self) -> None:
        if self.simulation.case.bends:
            self.background.put(write_text, self.out / folder.FLEXURE, whole(FLEXURE_COLUMNS, self._rows()))

    def _rows(self) -> list[tuple]:
        bodies, solids, rows = self.simulation.state.bodies, self.simulation.model.solids, []
        for i in np.flatnonzero(solids.mode_count).tolist():
            place = solids.stress_point[bodies.peak_place[i]].tolist() if bodies.peak_tension[i] > 0.0 else ["", "", ""]
            failed = bodies.failed_at[i] < np.inf
            where = [float(bodies.failed_at[i]), *bodies.failed_place[i].tolist()] if failed else ["", "", "", ""]
            rows.append((i, float(bodies.peak_tension[i]), float(bodies.peak_time[i]), *place, int(failed), *where))
        return rows

    def summary(self) -> dict:
        simulation = self.simulation
        if not simulation.case.bends:
            return {}
        bodies, bend = simulation.state.bodies, np.flatnonzero(simulation.model.solids.mode_count)
        most = int(bend[bodies.peak_tension[bend].argmax()])
        failed = np.flatnonzero(bodies.failed_at < np.inf)
        return {
            "flexure": {
                "strength_Pa": simulation.case.ice.flexural_strength,
                "floes": len(bend),
                "above_strength": len(failed),
                "first_above_s": float(bodies.failed_at[failed].min()) if len(failed) else None,
                "largest_Pa": float(bodies.peak_tension[most]),
                "largest_time_s": float(bodies.peak_time[most]),
                "largest_body": most,
                "meaning": MEANING,
            }
        }


class BentSnapshots(Observer):
    """The floes that bend at each snapshot of the ice, for ParaView, which has them all unbent in ice.pvd."""

    name = "bent_snapshots"

    @classmethod
    def interval(cls, case) -> float:
        return case.output.snapshot_interval if case.bends else 0.0

    @classmethod
    def size(cls, case, floes: int, structures: int) -> float:
        interval = cls.interval(case)
        return SHAPE * floes * (case.time.duration / interval + 1) if interval else 0.0

    def open(self, kept: dict | None, since: int) -> None:
        self.written: list[list] = kept["written"] if kept else []  # time [s], file
        self._listed, self._skins = 0, {}
        if self.interval(self.simulation.case):
            self._skins = {number: Skin(bent) for number, bent in self.simulation.bent.items()}

    def note(self, step: int) -> None:
        bodies, name = self.simulation.state.bodies, folder.bent_name(self.schedule.events_until(step) - 1)
        rows = (getattr(bodies, kept).copy() for kept in ("position", "orientation", "coordinate", "failed_at"))
        self.background.put(self._write, name, *rows)
        self.written.append([self.simulation.time_s, name])

    def _write(self, name: str, position: np.ndarray, orientation: np.ndarray, out: np.ndarray, failed_at: np.ndarray) -> None:
        """In the background."""
        domain, which = self.simulation.case.domain, list(self._skins)
        place = wrapped(position, domain.size, (domain.x_boundary == "periodic", domain.y_boundary == "periodic"))
        turn, parts = matrix_from_quaternion(orientation), []
        for number, skin in self._skins.items():
            shape, moved, mises, pull = skin.bent(out[number])
            parts.append((turned(turn[number], shape) + place[number], turned(turn[number], moved), mises, pull))
        points, moved, mises, pull = (np.concatenate(column) for column in zip(*parts, strict=True))
        write_surfaces(
            self.out / name, points, [skin.triangles for skin in self._skins.values()],
            {"displacement": moved, "von_mises": mises, "tension": pull},
            {"body": np.array(which, np.int64), "above_strength": (failed_at[which] < np.inf).astype(np.int64)},
        )  # fmt: skip

    def refresh(self) -> None:
        if self._listed < len(self.written):
            self.background.put(write_pvd, self.out / folder.BENT_COLLECTION, list(self.written))
            self._listed = len(self.written)

    def kept(self) -> dict:
        return {"written": list(self.written)}


class Skin:
    """The surface of a body's mesh: its corners and what each mode does there."""

    def __init__(self, body: Bent):
        modes = body.modes
        surface = Mesh(modes.nodes, modes.elements[:, :4]).surface()
        corner, self.triangles = np.unique(surface, return_inverse=True)
        self.triangles = self.triangles.reshape(surface.shape)
        self._points, self._shape, self._stress = modes.nodes[corner], modes.shape[:, corner], modes.stress[:, corner]

    def bent(self, out: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Places (c, 3) and displacements (c, 3) [m] in the body's frame, von Mises' stress (c,) and tension (c,) [Pa]."""
        moved, stress = np.zeros_like(self._points), np.zeros((len(self._points), 6))
        for own, shape, unit in zip(out, self._shape, self._stress, strict=False):  # in a fixed order
            moved, stress = moved + own * shape, stress + own * unit
        return self._points + moved, moved, von_mises(stress), tension(stress)

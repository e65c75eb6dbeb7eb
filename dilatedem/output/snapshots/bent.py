"""snapshots/bent_NNNNNN.vtu and bent.pvd: floes that bend, as they are bent, with their stress, for ParaView."""

import numpy as np

from dilatedem.numerics.frames import matrix_from_quaternion
from dilatedem.numerics.plain import turned
from dilatedem.output import folder
from dilatedem.output.snapshots.collection import Collection, snapshots_of
from dilatedem.output.snapshots.vtu import write_surfaces

#: bytes of a floe in a snapshot, about
SHAPE = 2e4


class BentSnapshots(Collection):
    """The floes that bend at each snapshot of the ice, for ParaView, which has them all unbent in ice.pvd."""

    name, listing = "bent_snapshots", folder.BENT_COLLECTION

    @classmethod
    def interval(cls, case) -> float:
        return case.output.snapshot_interval if case.bends else 0.0

    @classmethod
    def size(cls, case, floes: int, structures: int) -> float:
        return SHAPE * floes * snapshots_of(case, cls.interval(case))

    def open(self, kept: dict | None, since: int) -> None:
        super().open(kept, since)
        self._surfaces = {}
        if self.interval(self.simulation.case):
            from dilatedem.deformation.surface import Surface  # it loads half of SciPy

            self._surfaces = {number: Surface(bent) for number, bent in self.simulation.bent.items()}

    def note(self, step: int) -> None:
        bodies = self.simulation.state.bodies
        rows = (getattr(bodies, kept).copy() for kept in ("position", "orientation", "coordinate", "failed_at"))
        self.put(folder.bent_name(self.number(step)), *rows)

    def _write(self, name: str, position: np.ndarray, orientation: np.ndarray, out: np.ndarray, failed_at: np.ndarray) -> None:
        which, place = list(self._surfaces), self.at_home(position)
        turn, parts = matrix_from_quaternion(orientation), []
        for number, surface in self._surfaces.items():
            shape, moved, mises, pull = surface.bent(out[number])
            parts.append((turned(turn[number], shape) + place[number], turned(turn[number], moved), mises, pull))
        points, moved, mises, pull = (np.concatenate(column) for column in zip(*parts, strict=True))
        write_surfaces(
            self.out / name, points, [surface.triangles for surface in self._surfaces.values()],
            {"displacement": moved, "von_mises": mises, "tension": pull},
            {"body": np.array(which, np.int64), "above_strength": (failed_at[which] < np.inf).astype(np.int64)},
        )  # fmt: skip

"""snapshots/bent_NNNNNN.vtu and bent.pvd: floes that bend, as they are bent, with their stress, for ParaView."""

import numpy as np

from dilatedem.deformation.bent import Bent
from dilatedem.deformation.mesh import Mesh
from dilatedem.deformation.stress import tension, von_mises
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
        self._surfaces: dict[int, Surface] = {}
        if self.interval(self.simulation.case):
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


class Surface:
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

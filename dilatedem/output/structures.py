"""structures.csv: where structures that move are, how fast, and what their bases bear."""

import numpy as np

from dilatedem.numerics.plain import norm
from dilatedem.output import folder
from dilatedem.output.observer import TableObserver
from dilatedem.output.tables import BEAM_COLUMNS, STRUCTURES_COLUMNS, Table
from dilatedem.state.supports import Carried, ModalSupports, beam_loads, reaction

#: what summary.json tells of the motion of a structure, each with its time; of one on a beam with the loads of its foot
MOST_OF_BEAMS = ("base_force_max_N", "base_force_max_time_s", "base_moment_max_Nm", "base_moment_max_time_s")
MOST = ("displacement_max_m", "displacement_max_time_s", "reaction_max_N", "reaction_max_time_s", *MOST_OF_BEAMS)
#: bytes of a row, about
ROW = 110.0


def moving(case) -> int:
    """How many structures of a case are not held."""
    return sum(structure.support.moves for structure in case.structure)


class StructureMotion(TableObserver):
    """A row a structure that moves, where a window of forces.csv ends; no file where none does."""

    name, file, columns = "structures", folder.STRUCTURE_MOTION, STRUCTURES_COLUMNS

    @classmethod
    def interval(cls, case) -> float:
        return case.output.force_interval if moving(case) else 0.0

    @classmethod
    def size(cls, case, floes: int, structures: int) -> float:
        return ROW * moving(case) * case.time.duration / case.output.force_interval

    def open(self, kept: dict | None, since: int) -> None:
        simulation = self.simulation
        self._which = simulation.model.supports.moving
        self._names = [simulation.scene.structures[s].name for s in self._which]
        self._rows: list[tuple[float, np.ndarray]] = []  # time [s], columns (moving, 7 or, with beams, 11)
        supports, usual = simulation.model.supports, len(MOST) - len(MOST_OF_BEAMS)
        if isinstance(supports, ModalSupports):
            self.columns = (*STRUCTURES_COLUMNS, *BEAM_COLUMNS)
        told = [len(MOST) if supports.kind[s] == Carried.MODAL else usual for s in self._which]
        self._most = kept["most"] if kept else {name: [0.0] * count for name, count in zip(self._names, told, strict=True)}
        if self._names:
            super().open(kept, since)

    def look(self, step: int, last: bool) -> None:
        if self._names and (last or self.schedule.is_due(step)):
            self.note(step)

    def note(self, step: int) -> None:
        simulation, which, time_s = self.simulation, self._which, self.simulation.time_s
        supports, excursions = simulation.model.supports, simulation.state.excursions
        borne, beams = reaction(supports, excursions)[which, :2], beam_loads(supports, excursions)[which]
        # + 0.0: a moment of -0 is one of 0
        columns = np.column_stack([excursions.displacement[which], excursions.velocity[which, :2], borne, beams + 0.0])
        self._rows.append((time_s, columns))
        sizes = np.column_stack([norm(columns[:, :2]), norm(borne), beams[:, 2:]])
        for name, row in zip(self._names, sizes.tolist(), strict=True):
            most = self._most[name]
            for k, size in zip(range(0, len(most), 2), row, strict=False):
                most[k : k + 2] = (size, time_s) if size > most[k] else most[k : k + 2]

    def refresh(self) -> None:
        if not self._names:
            return
        kept, self._rows = self._rows, []

        def rows(table: Table) -> None:
            if kept:
                times = [time for time, _ in kept for _ in self._names]
                table.append_columns([times, self._names * len(kept), *np.concatenate([columns for _, columns in kept]).T.tolist()])

        self.put(rows)

    def kept(self) -> dict:
        return {"most": {name: list(most) for name, most in self._most.items()}}

    def settle(self) -> dict:
        return super().settle() if self._names else {}

    def summary(self) -> dict:
        if not self._names:
            return {}
        told = {"motion": {name: dict(zip(MOST, most, strict=False)) for name, most in self._most.items()}}
        return told | self._frequencies()

    def _frequencies(self) -> dict:
        """Natural frequencies of beams [Hz], along x and along y."""
        supports, found = self.simulation.model.supports, {}
        if isinstance(supports, ModalSupports):
            for s, name in zip(self._which, self._names, strict=True):
                modes = slice(supports.mode_start[s], supports.mode_start[s + 1])
                along_x, along_y = (np.sqrt(supports.mode_square[modes]) / (2.0 * np.pi)).T.tolist()
                found |= {name: {"along_x_Hz": along_x, "along_y_Hz": along_y}} if along_x else {}
        return {"natural_frequencies": found} if found else {}

    def close(self) -> None:
        if self._names:
            super().close()

"""bodies.csv: how tracked bodies move."""

import numpy as np

from dilatedem.output import folder
from dilatedem.output.observer import TableObserver
from dilatedem.output.tables import BODIES_COLUMNS, Table

#: bytes of a row, about
ROW = 130.0


class TrackedBodies(TableObserver):
    """A row a tracked body, as long as it is there."""

    name, file, columns = "bodies", folder.BODIES, BODIES_COLUMNS

    @classmethod
    def interval(cls, case) -> float:
        return case.output.track_interval if case.output.track else 0.0

    @classmethod
    def size(cls, case, floes: int, structures: int) -> float:
        tracked = floes if case.output.track == "all" else len(case.output.track)
        return ROW * tracked * case.time.duration / case.output.track_interval

    def open(self, kept: dict | None, since: int) -> None:
        super().open(kept, since)
        self._rows: list[np.ndarray] = []

    def note(self, step: int) -> None:
        simulation, track = self.simulation, self.simulation.case.output.track
        ids, bodies = simulation.state.ids.body, simulation.state.bodies
        i = np.arange(len(ids)) if track == "all" else np.flatnonzero(np.isin(ids, track))
        if track != "all":
            i = i[np.argsort([track.index(number) for number in ids[i]], kind="stable")]
        if len(i):
            time_s = np.full(len(i), simulation.time_s)
            columns = [time_s, ids[i], bodies.position[i], bodies.orientation[i], bodies.velocity[i], bodies.angular_velocity[i]]
            self._rows.append(np.column_stack(columns))

    def refresh(self) -> None:
        kept, self._rows = self._rows, []

        def rows(table: Table) -> None:
            for some in kept:
                table.append(some)

        self.put(rows)

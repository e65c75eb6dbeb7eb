"""forces.csv: the load on every structure, window by window."""

from dilatedem.output import folder
from dilatedem.output.observer import TableObserver
from dilatedem.output.tables import FORCES_COLUMNS, Table
from dilatedem.output.windows import append, end_open_window, headline_loads, schedule_windows, work_up
from dilatedem.state.loads import DEPTH, VOLUME

#: bytes of a row, about
ROW = 270.0


class Forces(TableObserver):
    """Windows end within the kernels, so that a run need not come back at each of them; they are written many at once."""

    name, file, columns = "forces", folder.FORCES, FORCES_COLUMNS

    @classmethod
    def interval(cls, case) -> float:
        return case.output.force_interval

    @classmethod
    def size(cls, case, floes: int, structures: int) -> float:
        return ROW * structures * case.time.duration / case.output.force_interval

    def open(self, kept: dict | None, since: int) -> None:
        super().open(kept, since)
        self.peaks: dict[str, dict] = kept["peaks"] if kept else {}  # structure -> headline loads
        self.records = [record.name for record in self.simulation.scene.records]
        self.flow = self.simulation.model.records.flow.tolist()
        self._schedule(max(since, 0))

    def _schedule(self, step: int) -> None:
        self._full = schedule_windows(self.simulation.windows, self.schedule, step)

    def next_due(self, step: int) -> int:
        return self._full

    def is_full(self, step: int) -> bool:
        return step == self._full

    def look(self, step: int, last: bool) -> None:
        if last:
            end_open_window(self.simulation.windows, self.simulation.state.loads, step)

    def refresh(self) -> None:
        simulation, names = self.simulation, self.records
        ended = work_up(simulation.windows, names, simulation.dt, self.peaks, self.flow)
        self._schedule(int(simulation.state.clock.step[0]))
        rows = None
        if ended:

            def rows(table: Table) -> None:
                append(ended, names, table)

        self.put(rows)

    def kept(self) -> dict:
        return {"peaks": {name: dict(peak) for name, peak in self.peaks.items()}}

    def summary(self) -> dict:
        return {"loads": {name: headline_loads(self.peaks.get(name)) for name in self.records}} | self._crushed()

    def _crushed(self) -> dict:
        """What has crushed on each structure, where ice does."""
        simulation = self.simulation
        if not simulation.case.laws["crushing"]:
            return {}
        crushed = simulation.state.loads.crushed.tolist()
        told = {name: {"volume_m3": row[VOLUME], "depth_m": row[DEPTH]} for name, row in zip(self.records, crushed, strict=True)}
        return {"crushed": told}

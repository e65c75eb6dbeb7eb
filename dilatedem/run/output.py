"""What a run writes, and when: the observers of `output` wired to one simulation."""

import time
from collections.abc import Callable
from dataclasses import asdict, dataclass, field
from pathlib import Path

import numpy as np

from dilatedem import __version__
from dilatedem.case import write
from dilatedem.errors import Interrupted
from dilatedem.geometry.polyhedron import Polyhedron
from dilatedem.output import checkpoint, folder
from dilatedem.output.archive import ContactStatistics, FloeTable, LoadMap, RunArchive
from dilatedem.output.atomic import write_text
from dilatedem.output.background import Background
from dilatedem.output.energies import work_up as work_up_energies
from dilatedem.output.schedule import Schedule
from dilatedem.output.summary import versions, write_summary
from dilatedem.output.tables import BODIES_COLUMNS, ENERGY_COLUMNS, FORCES_COLUMNS, Table
from dilatedem.output.vtu import SnapshotWriter, pile_column, plane_plate, wrapped, write_pvd, write_structures
from dilatedem.output.windows import Ended, append, end_open_window, headline_loads, schedule_windows, work_up
from dilatedem.run import error_check
from dilatedem.scene.place import ordered_structures
from dilatedem.state.loads import ANGLE_BINS, HEIGHT_BINS

#: s of wall time after which, at the latest, new rows and snapshots are in the tables and in ice.pvd (or at the next thing due)
REFRESH_S = 1.0


@dataclass
class Totals:
    """Figures of a run that live outside the kernels' arrays; JSON-able, part of every checkpoint."""

    initial_energy: float | None = None  # J
    largest_residual: float = 0.0  # J, over all rows of energy.csv
    largest_step_ratio: float = 0.0  # dt over the critical step of the open contacts, over all rows of energy.csv
    wall_s: float = 0.0  # compiling included; both add up over the parts of a resumed run
    compile_s: float = 0.0
    peaks: dict = field(default_factory=dict)  # structure -> headline loads
    snapshots: list = field(default_factory=list)  # [time, file]


class RunOutput:
    """The run folder of one simulation, kept up to date from step to step; a thread in the background writes its files."""

    def __init__(self, simulation, out: Path, saved: dict):
        """Go on writing a run from the checkpoint whose meta is `saved`."""
        self._prepare(simulation, out, int(simulation.state.clock.step[0]))
        self._tables = {
            name: Table.reopen(out / name, columns, saved["offsets"][name]) for name, columns in self._columns().items()
        }

    @classmethod
    def fresh(cls, simulation, out: Path) -> "RunOutput":
        """Start a run folder; what an earlier run left there is removed."""
        self = cls.__new__(cls)
        self._prepare(simulation, out, -1)
        folder.clear(out)
        (out / "snapshots").mkdir(parents=True, exist_ok=True)
        case = simulation.case
        header = f"# dilatedem {__version__}, seed {case.field.seed}\n\n"
        write_text(out / folder.CASE, header + write.dump(case))
        write_structures(out / folder.STRUCTURES, [_drawn(s, case) for s in self._structures])
        self._tables = {name: Table(out / name, columns) for name, columns in self._columns().items()}
        self._write_summary("running", "")
        return self

    def _prepare(self, simulation, out: Path, since: int) -> None:
        """since: the last step that was observed."""
        self._simulation, self._out = simulation, out
        self._structures = ordered_structures(simulation.scene)
        self._writer = SnapshotWriter([shape.outer for shape in simulation.scene.shapes], simulation.scene.order)
        self._began = time.perf_counter()
        self._archive: RunArchive | None = None  # until it is written first
        self._checked: dict = {}  # what the check of the time step found
        output, pace = simulation.case.output, (simulation.dt, simulation.span)
        self._forces = Schedule(output.force_interval, *pace)
        self._energy = Schedule(output.energy_interval, *pace)
        self._snapshots = Schedule(output.snapshot_interval, *pace)
        self._checkpoints = Schedule(output.checkpoint_interval, *pace)
        count = simulation.model.floating
        self._tracked = np.arange(count) if output.track == "all" else np.array(output.track, np.int64)
        self._track = Schedule(output.track_interval if len(self._tracked) else 0.0, *pace)
        self._look_ahead(since)
        self._schedule_windows(max(since, 0))
        self._noted: list[list[float]] = []  # time, step ratio and energies, since the last refresh
        self._body_rows: list[np.ndarray] = []  # of bodies.csv
        self._listed, self._refreshed = 0, time.monotonic()
        self._background = Background()

    @staticmethod
    def _columns() -> dict:
        return {folder.FORCES: FORCES_COLUMNS, folder.ENERGY: ENERGY_COLUMNS, folder.BODIES: BODIES_COLUMNS}

    @property
    def totals(self) -> Totals:
        return self._simulation.state.totals

    def __enter__(self) -> "RunOutput":
        return self

    def __exit__(self, *exception) -> None:
        self._refresh()
        self._background.close()
        for table in self._tables.values():
            table.close()
        if self._archive:
            self._archive.close()

    def _schedule_windows(self, step: int) -> None:
        """Windows of forces.csv end after `step` as its interval says; none waits to be written."""
        self._windows_full, self._looked_at = schedule_windows(self._simulation.windows, self._forces, step), 0

    def _look_ahead(self, step: int) -> None:
        """Find out when anything but a window of forces.csv is due after `step`."""
        watch = self._simulation.state.watch
        rest = (self._energy, self._track, self._snapshots, self._checkpoints, *([watch.windows] if watch else []))
        self._rest_due = min(schedule.next_due(step) for schedule in rest)

    @property
    def next_due(self) -> int:
        """The next step at which something is written."""
        return min(self._windows_full, self._rest_due)

    def observe(self, *, last: bool = False) -> None:
        """Write what is due at the present step (`last`: the run's last, which closes every window)."""
        state, windows = self._simulation.state, self._simulation.windows
        step = int(state.clock.step[0])
        if last:
            end_open_window(windows, state.loads, step)
        if state.watch:
            state.watch.look(state, windows, self._looked_at)
            self._looked_at = int(windows.count[0])
        if last or step == self._rest_due:
            self._observe_rest(step, last)
        if step == self._windows_full or time.monotonic() - self._refreshed >= REFRESH_S:
            self._refresh()

    def _observe_rest(self, step: int, last: bool) -> None:
        """Write what is due besides windows of forces.csv."""
        if last or self._energy.is_due(step):
            self._note_energy()
        if self._track.is_due(step):
            self._note_bodies()
        if self._snapshots.is_due(step):
            self._write_snapshot()
        if not last and self._checkpoints.is_due(step):
            self._save("running")
        self._look_ahead(step)

    def complete(self, asked: Callable[[], bool] = lambda: False) -> str:
        """The run is at its end: check its time step, if the case wants it. Returns what that found, in a sentence.

        asked  whether the user wants to end; then Interrupted is raised
        """
        if not self._simulation.state.watch:
            self._save("completed")
            self._background.wait()
            return ""
        self._save("running")  # a kill during the check costs the check alone
        try:
            self._checked = error_check.check(self._simulation, [structure.name for structure in self._structures], asked)
        except Interrupted:
            self.interrupt()
            raise
        self._checked["wall_s"] = time.perf_counter() - self._began
        self._note_wall_time()
        self._write_summary("completed", "")
        self._background.wait()
        return self._checked["message"]

    def interrupt(self) -> None:
        self._save("interrupted", "stopped by the user; --resume goes on")
        self._background.wait()

    def stop(self, message: str) -> None:
        """The simulation cannot go on: keep the last checkpoint, and the state that failed beside it."""
        self._refresh()
        self._note_wall_time()
        self._background.put(self._write_checkpoint, "stopped.h5", self._simulation.state.copies(), self._meta())
        self._background.put(self._write_archive, *self._contact_record())
        self._write_summary("stopped", message)
        self._background.wait()

    def _save(self, status: str, message: str = "") -> None:
        """Everything up to now, in files that a later run can go on from."""
        self._refresh()
        self._background.put(self._write_archive, *self._contact_record())
        self._note_wall_time()
        self._background.put(self._write_checkpoint, folder.CHECKPOINT, self._simulation.state.copies(), self._meta())
        self._write_summary(status, message)

    def note_compiling(self, seconds: float) -> None:
        """Count the time that was spent on the kernels before this output was opened."""
        self.totals.wall_s += seconds
        self.totals.compile_s += seconds

    def _note_wall_time(self) -> None:
        now = time.perf_counter()
        self.totals.wall_s += now - self._began
        self._began = now

    def _refresh(self) -> None:
        """Bring the tables, the totals and the list of snapshots up to this moment."""
        simulation, names = self._simulation, [structure.name for structure in self._structures]
        ended = work_up(simulation.windows, names, simulation.dt, self.totals.peaks)
        self._schedule_windows(int(simulation.state.clock.step[0]))
        energies = work_up_energies(self._noted, list(simulation.energies()), self.totals)
        self._background.put(self._write_rows, names, ended, energies, self._body_rows)
        self._noted, self._body_rows = [], []
        if self._listed < len(self.totals.snapshots):
            self._background.put(write_pvd, self._out / folder.ICE_COLLECTION, list(self.totals.snapshots))
            self._listed = len(self.totals.snapshots)
        self._refreshed = time.monotonic()

    def _write_rows(self, names: list[str], ended: Ended | None, energies: np.ndarray, bodies: list[np.ndarray]) -> None:
        """In the background, which alone touches the tables."""
        if ended:
            append(ended, names, self._tables[folder.FORCES])
        self._tables[folder.ENERGY].append(energies)
        for rows in bodies:
            self._tables[folder.BODIES].append(rows)
        for table in self._tables.values():
            table.flush()

    def _write_checkpoint(self, file: str, groups: dict, meta: dict) -> None:
        """In the background. The rows that it counts on are on the disk before it."""
        for table in self._tables.values():
            table.flush(durable=True)
        offsets = {name: table.offset for name, table in self._tables.items()}
        checkpoint.save(self._out / file, groups, meta | {"offsets": offsets})

    def _meta(self) -> dict:
        """What the checkpoint of this moment holds besides the state and the places in the tables."""
        watch = self._simulation.state.watch
        return {
            "version": __version__,
            "dt": self._simulation.dt,
            "totals": asdict(self.totals),
        } | ({"watch": watch.figures()} if watch else {})

    def _note_energy(self) -> None:
        simulation = self._simulation
        self._noted.append([simulation.time_s, simulation.assembled_step_ratio(), *simulation.energies().values()])

    def _note_bodies(self) -> None:
        bodies, i = self._simulation.state.bodies, self._tracked
        if len(i):
            time_s = np.full(len(i), self._simulation.time_s)
            columns = [time_s, i, bodies.position[i], bodies.orientation[i], bodies.velocity[i], bodies.angular_velocity[i]]
            self._body_rows.append(np.column_stack(columns))

    def _write_snapshot(self) -> None:
        simulation, totals = self._simulation, self.totals
        bodies, count = simulation.state.bodies, simulation.model.floating
        number = self._snapshots.events_until(int(simulation.state.clock.step[0])) - 1
        pose = (bodies.position[:count].copy(), bodies.orientation[:count].copy())
        self._background.put(self._write_floes, folder.snapshot_name(number), *pose, {
            "velocity": bodies.velocity[:count].copy(),
            "angular_velocity": bodies.angular_velocity[:count].copy(),
            "contact_force": bodies.contact_force[:count].copy(),
            "contacts": bodies.contact_count[:count].copy(),
        })  # fmt: skip
        totals.snapshots.append([simulation.time_s, folder.snapshot_name(number)])

    def _write_floes(self, name: str, position: np.ndarray, orientation: np.ndarray, cell_data: dict[str, np.ndarray]) -> None:
        """In the background: a snapshot."""
        domain = self._simulation.case.domain
        periodic = (domain.x_boundary == "periodic", domain.y_boundary == "periodic")
        cell_data |= {"body": np.arange(len(position)), "speed": np.linalg.norm(cell_data["velocity"], axis=1)}
        self._writer.write(self._out / name, wrapped(position, domain.size, periodic), orientation, cell_data)

    def _floe_table(self) -> FloeTable:
        model, scene = self._simulation.model, self._simulation.scene
        count = model.floating
        return FloeTable(
            body=np.arange(count), x0=scene.position[:, 0], y0=scene.position[:, 1], plan_area=scene.plan_area,
            mass=model.solids.mass[:count], volume=scene.volume(),
            vertices=np.diff(model.shapes.vertex_start)[:count], outlines=scene.outlines,
        )  # fmt: skip

    def _contact_record(self) -> tuple[list[LoadMap], dict[str, ContactStatistics]]:
        """Load maps and contact statistics of this moment, in copies."""
        simulation, loads = self._simulation, self._simulation.state.loads
        maps = []
        for s, structure in enumerate(self._structures):
            half, low, high = loads.map_span[s]
            pile = structure.kind == "pile"
            edges = np.linspace(-180.0, 180.0, ANGLE_BINS + 1) if pile else np.linspace(-half, half, ANGLE_BINS + 1)
            maps.append(LoadMap(
                structure=structure.name, kind=structure.kind, impulse=loads.impulse_map[s].copy(), edges=edges,
                height_edges=np.linspace(low, high, HEIGHT_BINS + 1), duration_s=simulation.time_s,
                center=structure.center if pile else structure.point, radius=structure.radius if pile else None,
                axis=None if pile else loads.map_origin[s, 3:],
            ))  # fmt: skip
        statistics = {
            partners: ContactStatistics(*(
                values[p].copy() for values in (loads.mode_steps, loads.mode_impulse, loads.mode_force, loads.mode_overlap)
            ))
            for p, partners in enumerate(("ice_ice", "ice_structure"))
        }  # fmt: skip
        return maps, statistics

    def _write_archive(self, maps: list[LoadMap], statistics: dict[str, ContactStatistics]) -> None:
        """In the background, as laying it out takes a while, too."""
        if self._archive:
            self._archive.update(maps, statistics)
        else:
            case = self._simulation.case
            current = case.water.velocity if case.water.enabled else (0.0, 0.0)
            about = {"title": case.title, "seed": case.field.seed, "current_velocity_m_s": current}
            self._archive = RunArchive(maps, statistics, self._floe_table(), about=about)
        self._archive.write(self._out / folder.RUN_ARCHIVE)

    def _write_summary(self, status: str, message: str) -> None:
        simulation, totals = self._simulation, self.totals
        case, step = simulation.case, int(simulation.state.clock.step[0])
        terms = {f"{name}_J": value for name, value in simulation.energies().items()} if step else {}
        work = abs(terms.get("work_drag_J", 0.0))
        stepping_s = totals.wall_s - totals.compile_s - self._checked.get("wall_s", 0.0)
        self._background.put(write_summary, self._out / folder.SUMMARY, {
            "status": status, "message": message, "title": case.title, "version": __version__, "versions": versions,
            "seed": case.field.seed, "floes": simulation.model.floating, "steps": step, "dt_s": simulation.dt,
            "dt_critical_s": simulation.critical, "dt_over_critical": simulation.dt / simulation.critical,
            "dt_over_critical_of_open_contacts": totals.largest_step_ratio, "simulated_s": simulation.time_s,
            "duration_s": case.time.duration, "wall_s": totals.wall_s, "compile_s": totals.compile_s,
            "steps_per_s": step / stepping_s if stepping_s > 0.0 else None, "threads": simulation.threads,
            "loads": {structure.name: headline_loads(totals.peaks.get(structure.name)) for structure in self._structures},
            "energy": terms | {
                "residual_J": totals.largest_residual, "residual_over_work": totals.largest_residual / work if work else None,
            },
            "contact": {
                "model": case.contact.model, "open": simulation.contacts,
                "largest_overlap_m": float(simulation.state.loads.mode_overlap.max()),
            },
        } | ({"error_check": self._checked} if self._checked else {}))  # fmt: skip


def _drawn(structure, case) -> Polyhedron:
    """A structure as ParaView sees it."""
    if structure.kind == "pile":
        return pile_column(structure.center, structure.radius)
    return plane_plate(structure.point, structure.normal, 1.2 * float(np.hypot(*case.domain.size)))

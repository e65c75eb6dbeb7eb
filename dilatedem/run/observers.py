"""The run folder of one simulation, kept up to date from step to step by a list of observers."""

import math
import time
from collections.abc import Callable
from pathlib import Path

from dilatedem import __version__
from dilatedem.case import write
from dilatedem.case.schema import Case
from dilatedem.errors import Interrupted
from dilatedem.files.atomic import write_text
from dilatedem.garbage import hand_back
from dilatedem.output import checkpoint, folder
from dilatedem.output.background import Background
from dilatedem.output.energies import Energies
from dilatedem.output.flexure import Flexure
from dilatedem.output.forces import Forces
from dilatedem.output.hits import Hits
from dilatedem.output.motion import TrackedBodies
from dilatedem.output.observer import Observer
from dilatedem.output.origin import now, origin
from dilatedem.output.record import Record
from dilatedem.output.snapshots.bent import BentSnapshots
from dilatedem.output.snapshots.ice import Snapshots
from dilatedem.output.snapshots.structures import StructureSnapshots
from dilatedem.output.snapshots.vtu import write_structures
from dilatedem.output.structures import StructureMotion
from dilatedem.output.summary import versions, write_summary
from dilatedem.run import error_check
from dilatedem.run.ending import Ending
from dilatedem.run.error_check import LoadWatch
from dilatedem.scene.facts import file_facts

#: s of wall time after which, at the latest, new rows and snapshots are in the tables and in ice.pvd (or at the next thing due)
REFRESH_S = 1.0
#: bytes of a saved state, about: of itself and of every floe; how many times as large it is with the states of a check of the step
STATE, STATE_FLOE, CHECKED = 2.7e5, 5.6e3, 1.5
#: message of a run that is complete, where there was something to touch
NOTHING_TOUCHED = "no ice touched any structure"


class Checkpoints(Observer):
    """When the state is saved on the way."""

    name = "checkpoints"

    @classmethod
    def interval(cls, case: Case) -> float:
        return case.output.checkpoint_interval

    @classmethod
    def size(cls, case: Case, floes: int, structures: int) -> float:
        """Of two states: the last one, and that from before the end."""
        return 2.0 * (STATE + STATE_FLOE * floes) * (CHECKED if case.time.error_check else 1.0)

    def must_save(self, step: int) -> bool:
        return self.schedule.is_due(step)


#: all observers, in the order in which they look; the first one's interval is that of the windows of loads
OBSERVERS: tuple[type[Observer], ...] = (
    Forces, LoadWatch, Hits, Energies, StructureMotion, TrackedBodies, Snapshots, StructureSnapshots, BentSnapshots, Flexure,
    Record, Ending, Checkpoints,
)  # fmt: skip


def intervals(case: Case) -> list[float]:
    """Simulated times [s] between two looks of every observer that has one; that of the loads' windows comes first."""
    return [interval for interval in (kind.interval(case) for kind in OBSERVERS) if interval > 0.0]


def expected_size(case: Case, floes: int, structures: int) -> float:
    """What a run will write, about [bytes]."""
    return sum(kind.size(case, floes, structures) for kind in OBSERVERS)


class RunFolder:
    """All observers of a simulation, and what is written when its state is saved; a thread in the background writes the files."""

    def __init__(self, simulation, out: Path, saved: dict | None = None, *, compile_s: float = 0.0):
        """Start a run folder, or go on with it from the checkpoint whose meta is `saved`.

        Of an earlier run nothing is left where it starts. compile_s: time [s] that was spent on the kernels before.
        """
        self._simulation, self._out = simulation, Path(out)
        self._digest = write.digest(simulation.case.endless)
        self._began, self._checked = time.perf_counter(), {}
        kept = saved["observers"] if saved else {}
        self._wall_s, self._compile_s = (saved["wall_s"], saved["compile_s"]) if saved else (0.0, 0.0)
        self._wall_s, self._compile_s = self._wall_s + compile_s, self._compile_s + compile_s
        self._started = (saved or {}).get("started") or now()
        if not saved:
            self._start_folder()
        elif self._case_text() != (self._out / folder.CASE).read_text(encoding="utf-8"):  # a longer run than before
            write_text(self._out / folder.CASE, self._case_text())
        self._background = Background()
        self._observers = [kind(simulation, self._out, self._background) for kind in OBSERVERS]
        step = int(simulation.state.clock.step[0])
        for observer in self._observers:
            observer.open(kept.get(observer.name, {}) if saved else None, step if saved else -1)
        self._ending, self._over = self._of(Ending), bool(saved and saved["over"])
        self._ending.attach(self._of(Forces))
        self._refreshed = time.monotonic()
        self._look_ahead(step if saved else -1)
        if not saved:
            self._write_summary("running", "")

    def _start_folder(self) -> None:
        self._out.mkdir(parents=True, exist_ok=True)
        folder.clear(self._out)
        case, scene = self._simulation.case, self._simulation.scene
        write_text(self._out / folder.CASE, self._case_text())
        extent = math.hypot(*case.domain.size)
        drawings = [[] if each.support.moves else each.about.drawing(extent) for each in scene.structures]
        write_structures(self._out / folder.STRUCTURES, drawings)

    def _case_text(self) -> str:
        case = self._simulation.case
        return f"# dilatedem {__version__}, seed {case.field.seed}\n\n{write.dump(case)}"

    def _of(self, kind: type[Observer]) -> Observer:
        return next(observer for observer in self._observers if isinstance(observer, kind))

    def __enter__(self) -> "RunFolder":
        return self

    def __exit__(self, kind, *exception) -> None:
        """Bring all files up to this moment and close them; after a fault as far as the disk lets it: the fault is what is told."""
        faults: list[OSError] = []
        for call in (self._refresh, self._background.close, *(observer.close for observer in self._observers)):
            try:
                call()
            except OSError as fault:
                faults.append(fault)
        if faults and kind is None:
            raise faults[0]

    @property
    def next_due(self) -> int:
        """The next step that some observer must see."""
        return self._next_due

    @property
    def end(self) -> int:
        """The step with which the run ends, as far as is known."""
        return self._ending.end

    @property
    def last_span(self) -> int:
        """The step from which on the end of the run makes a difference: the start of its last span."""
        return (self.end - 1) // self._simulation.span * self._simulation.span

    def remark(self) -> str:
        """Why the run ends before its duration is over, if it does."""
        return self._ending.remark()

    def keep_last_span(self) -> None:
        """Save the state before the end makes a difference: a longer run goes on from it."""
        self._refresh()
        for observer in self._observers:
            observer.save()
        self._put_checkpoint(folder.BEFORE_END)

    def _look_ahead(self, step: int) -> None:
        self._next_due = min(observer.next_due(step) for observer in self._observers)

    def observe(self, *, last: bool = False) -> None:
        """Have the present step looked at (`last`: the run's last, which closes every window)."""
        step, self._over = int(self._simulation.state.clock.step[0]), last
        for observer in self._observers:
            observer.look(step, last)
        if not last and any(observer.must_save(step) for observer in self._observers):
            self._save("running")
        full = any(observer.is_full(step) for observer in self._observers)
        if full or time.monotonic() - self._refreshed >= REFRESH_S:
            self._refresh()
        self._look_ahead(step)

    def repacked(self) -> None:
        """Other bodies are there than before."""
        for observer in self._observers:
            observer.repacked()

    def complete(self, asked: Callable[[], bool] = lambda: False) -> str:
        """The run is at its end: check its time step, if the case wants it. Returns what that found, in a sentence.

        asked  whether the user wants to end; then Interrupted is raised
        """
        simulation = self._simulation
        if not simulation.state.watch:
            self._save("completed")
            self._background.wait()
            return ""
        self._save("running")  # a kill during the check costs the check alone
        try:
            self._checked = error_check.check(simulation, [structure.name for structure in simulation.scene.structures], asked)
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
        self._put_checkpoint(folder.STOPPED)
        for observer in self._observers:
            observer.save()
        self._write_summary("stopped", message)
        self._background.wait()

    def _save(self, status: str, message: str = "") -> None:
        """Everything up to now, in files that a later run can go on from."""
        self._refresh()
        for observer in self._observers:
            observer.save()
        self._note_wall_time()
        self._put_checkpoint(folder.CHECKPOINT)
        self._write_summary(status, message)

    def _refresh(self) -> None:
        """Bring all files up to this moment."""
        for observer in self._observers:
            observer.refresh()
        self._refreshed = time.monotonic()

    def _note_wall_time(self) -> None:
        now = time.perf_counter()
        self._wall_s += now - self._began
        self._began = now

    def _put_checkpoint(self, file: str) -> None:
        """Have the state of this moment saved."""
        watch = self._simulation.state.watch
        meta = {"version": __version__, "case": self._digest, "dt": self._simulation.dt, "over": self._over}
        meta |= {"wall_s": self._wall_s, "compile_s": self._compile_s, "started": self._started}
        meta |= {"watch": watch.figures()} if watch else {}
        kept = {observer.name: observer.kept() for observer in self._observers}
        groups = self._simulation.state.copies() | self._simulation.remodelled_groups()
        self._background.put(self._write_checkpoint, file, groups, meta, kept)

    def _write_checkpoint(self, file: str, groups: dict, meta: dict, kept: dict) -> None:
        """In the background. What it counts on is on the disk before it."""
        kept = {observer.name: kept[observer.name] | observer.settle() for observer in self._observers}
        checkpoint.save(self._out / file, groups, meta | {"observers": kept})
        hand_back()

    def _write_summary(self, status: str, message: str) -> None:
        simulation, told = self._simulation, {}
        case, step = simulation.case, int(simulation.state.clock.step[0])
        for observer in self._observers:
            told |= observer.summary()
        for event in simulation.events:
            told |= event.summary(simulation)
        loads = told["loads"]
        if status == "completed" and loads and not any(load["touched"] for load in loads.values()):
            message = NOTHING_TOUCHED
        stepping_s = self._wall_s - self._compile_s - self._checked.get("wall_s", 0.0)
        self._background.put(write_summary, self._out / folder.SUMMARY, {
            "status": status, "message": message, "title": case.title, "version": __version__, "versions": versions,
            "origin": origin(self._started),
            "seed": case.field.seed, "floes": simulation.model.floes, "steps": step, "dt_s": simulation.dt,
            "dt_critical_s": simulation.critical, "dt_over_critical": simulation.dt / simulation.critical,
            "dt_over_critical_of_open_contacts": told["dt_over_critical_of_open_contacts"], "simulated_s": simulation.time_s,
            "duration_s": case.time.duration, "wall_s": self._wall_s, "compile_s": self._compile_s,
            "steps_per_s": step / stepping_s if stepping_s > 0.0 else None, "threads": simulation.threads,
            "threads_at_work": simulation.crew.mean,
        } | ({"field": file_facts(case, simulation.scene)} if simulation.scene.report else {}) | told | {
            "contact": {
                "model": case.contact.model, "open": simulation.contacts,
                "largest_overlap_m": float(simulation.state.loads.mode_overlap.max()),
            },
        } | ({"error_check": self._checked} if self._checked else {}))  # fmt: skip

"""From one due step to the next until the end of a run, an interruption or a fault."""

import os
import time
from collections.abc import Callable
from pathlib import Path

from dilatedem.case.load import case_from
from dilatedem.case.schema import Case
from dilatedem.errors import CaseError, Interrupted, SimulationStopped
from dilatedem.events.relaxation import unsettled
from dilatedem.files.faults import FULL, told_as
from dilatedem.files.lock import Lock
from dilatedem.jit import start_threads
from dilatedem.output import folder
from dilatedem.output.progress import Progress
from dilatedem.processes.interruption import Interruption
from dilatedem.results.files import read_summary
from dilatedem.results.run import Run
from dilatedem.run.ending import total_steps
from dilatedem.run.faults import fault
from dilatedem.run.observers import RunFolder
from dilatedem.run.restore import load_checkpoint, require_same_run
from dilatedem.run.simulation import Simulation
from dilatedem.scene.place import Scene
from dilatedem.state.clock import Status

#: steps between two looks at the keyboard and the progress bar, where no output is due earlier
LONGEST_CHUNK = 2000
#: kinds of runs whose kernels this process has, as arguments of `compile_kernels`
_READY: set[tuple] = set()


def run(
    case: Case, out: Path, *, threads: int = 1, resume: bool = False, overwrite: bool = False, quiet: bool = False,
    progress: Progress | None = None, interruption: Interruption | None = None, scene: Scene | None = None,
) -> Path:
    """Simulate a case into the run folder `out`; returns it. A run of the same case that the folder holds goes on.

    progress, interruption: those of the run, unless it has its own (a bar unless `quiet`, signals). scene: that of the case, where
    it was made before.
    Raises CaseError (nothing written), SimulationStopped or Interrupted (state saved).
    """
    out = Path(out)
    with told_as(CaseError):
        if folder.is_run(out) and not (resume or overwrite):
            require_same_run(out, case)
            resume = True
        folder.check(out, resume=resume, overwrite=overwrite)
        try:
            layer = start_threads(threads)
        except ValueError as fault:
            raise CaseError(f"--{fault}") from fault
        simulation = Simulation.of_case(case, threads=threads, scene=scene)
        if not resume:
            simulation.require_apart()
        with Lock(out) as lock:
            folder.check(out, resume=resume, overwrite=overwrite)  # again: another run may have ended here in between
            saved = load_checkpoint(out, case, simulation) if resume else None
            progress = progress or Progress(case.time.duration, quiet)
            if saved and saved["over"] and _is_complete(out, simulation):
                progress.message("nothing to do: the run is complete")
            else:
                _simulate(simulation, out, lock, saved, layer, progress, interruption or Interruption())
    return out


def _is_complete(out: Path, simulation: Simulation) -> bool:
    """Whether nothing is left to do, the state being that of the end: the summary says that all that follows was done."""
    summary = read_summary(out / folder.SUMMARY)
    return int(simulation.state.clock.step[0]) == summary.get("steps") and summary.get("status") == "completed"


def _simulate(
    simulation: Simulation, out: Path, lock: Lock, saved: dict | None, layer: str, progress: Progress, interruption: Interruption
) -> None:
    """From t = 0, or from a checkpoint whose meta is `saved`, to the end. From now on files are written."""
    case = simulation.case
    steps = total_steps(case, simulation.dt)
    with progress:
        for sentence in [] if saved else simulation.advice():
            progress.message(f"warning: {sentence}")
        for sentence in simulation.scene.report.sentences() if simulation.scene.report and not saved else []:
            progress.message(f"{Path(case.field.file).name}: {sentence}")
        progress.message(_headline(simulation, steps, layer))
        if saved:
            progress.message(f"goes on from t = {simulation.time_s:.6g} s")
        compile_s = _compile(simulation, progress)
        with interruption, told_as(SimulationStopped, lambda error: _way_on(out, error)):
            lock.keep()
            with RunFolder(simulation, out, saved, compile_s=compile_s) as files:
                if not saved:
                    _stop_on_fault(simulation, files, simulation.evaluate())
                    files.observe()
                _loop(simulation, files, progress, interruption)


def _way_on(out: Path, error: OSError) -> str:
    """What to do after a fault of the disk."""
    room = "make room and " if error.errno in FULL else ""
    if (out / folder.CHECKPOINT).exists():
        return f"; {room}go on with --resume, from the state saved last"
    return f"; {room}start anew with --overwrite: no state was saved yet"


def run_case(
    case, out=None, *, threads: int = 1, resume: bool = False, overwrite: bool = False, quiet: bool = True, **overrides
) -> Run:
    """Simulate a case into a run folder and open its results; what `dilatedem run` does.

    case: path of a case file, a dictionary laid out like one, or a `Case`; out: the folder, runs/NAME for NAME.toml unless given;
    overrides: values by dotted key, `**{"water.velocity": [0.5, 0.0]}`, or tables, `water={"velocity": [0.5, 0.0]}`.
    Raises CaseError (nothing written), SimulationStopped or Interrupted (state saved).
    """
    named = isinstance(case, str | os.PathLike)
    folder = Path(out) if out is not None else Path("runs", Path(case).stem if named else "case")
    return Run(run(case_from(case, overrides), folder, threads=threads, resume=resume, overwrite=overwrite, quiet=quiet))


#: a body that bends, of few elements
BENDS = {
    "body": [{"outline": [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]}], "water": {"enabled": False},
    "deformation": {"modes": 1, "mesh_size": 1.0},
}  # fmt: skip


def compile_kernels(
    threads: int = 1, model: str = "liu2015", crushing: bool = False, tapers: bool = False, sea: bool = False,
    bends: bool = False, *,
    announce: Callable[[str], None] = lambda said: None,
) -> None:
    """Compile what a run with such `Case.laws` needs, or load it from the cache; once a process, which keeps it.

    announce: told of what takes long
    """
    kind = (threads, model, crushing, tapers, sea, bends)
    if kind in _READY:
        return
    case = Case.model_validate({
        "field": {"source": "bodies"}, "body": [{"vertices": [[0.0, 0.0, 0.0]], "dilated_radius": 0.1}],
        "contact": {"model": model}, "ice": {"crushing_pressure": 1.0e6} if crushing else {}, "water": {"added_mass": sea},
        "structure": [{"kind": "cone"}] if tapers else [],
        **(BENDS if bends else {}),
    })  # fmt: skip
    simulation = Simulation.of_case(case, threads=threads)
    if not simulation.is_compiled():
        announce("compiling, once (one to two minutes)")
    simulation.advance(1)
    _READY.add(kind)


def _compile(simulation: Simulation, progress: Progress) -> float:
    """Have the kernels ready before any file is touched: Ctrl-C ends this at once, with nothing to save. Returns the time, s."""
    started = time.perf_counter()
    try:
        compile_kernels(simulation.threads, **simulation.case.laws, announce=progress.message)
    except KeyboardInterrupt:
        raise Interrupted("interrupted while compiling; no file was touched") from None
    return time.perf_counter() - started


def _loop(simulation: Simulation, files: RunFolder, progress: Progress, interruption: Interruption) -> None:
    clock, longest = simulation.state.clock, -(-LONGEST_CHUNK // simulation.span) * simulation.span
    now = int(clock.step[0])
    progress.update(simulation.time_s, now, lambda: simulation.contacts)
    while now < files.end:
        if now == files.last_span:
            files.keep_last_span()
        goal = files.last_span if now < files.last_span else files.end
        status = simulation.advance(min(files.next_due, simulation.next_event(now), goal, now + longest) - now)
        _stop_on_fault(simulation, files, status)
        now = int(clock.step[0])
        if simulation.let_happen():
            files.repacked()
        files.observe(last=now == files.end)
        progress.update(simulation.time_s, now, lambda: simulation.contacts)
        if interruption.asked and now < files.end:
            files.interrupt()
            raise Interrupted(f"interrupted at t = {simulation.time_s:.4f} s; the state is saved, --resume goes on from it")
    if sentence := unsettled(simulation):
        files.stop(f"{sentence}; the state is saved")
        raise SimulationStopped(f"{sentence}; the state is saved")
    remarks = [files.remark(), simulation.crew.remark(), *(event.remark(simulation) for event in simulation.events)]
    for said in (*remarks, files.complete(lambda: interruption.asked)):
        if said:
            progress.message(said)


def _stop_on_fault(simulation: Simulation, files: RunFolder, status: Status) -> None:
    if status != Status.DONE:
        sentence = f"{fault(simulation, status)}; the state is saved; try a smaller time.step or check the case"
        files.stop(sentence)
        raise SimulationStopped(sentence)


def _headline(simulation: Simulation, steps: int, layer: str) -> str:
    ratio = simulation.dt / simulation.critical
    return (
        f"{simulation.scene.count} bodies, {steps} steps of {simulation.dt:.3g} s = {ratio:.3g} of the critical step "
        f"({simulation.critical:.3g} s); {f'{simulation.threads} threads ({layer})' if layer else '1 thread'}"
    )

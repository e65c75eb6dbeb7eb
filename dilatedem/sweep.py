"""A grid of cases, each run by a process of its own into its own folder, and one table of what came out.

A process that dies takes only its own case with it, and the table names it. All cases are checked before
anything is written, the kernels are compiled once before the first case starts, and every process works on
one thread.
"""

import csv
import io
import json
import os
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from dilatedem.case import grid, load, write
from dilatedem.case.overrides import Override, parse
from dilatedem.case.schema import Case
from dilatedem.errors import CaseError, Interrupted, SimulationStopped, printable
from dilatedem.results.files import read_summary

TABLE = "sweep.csv"

# Of summary.json's loads, these go to the table, as <structure>_<load>.
LOADS = ("fx_max_N", "fx_mean_N", "fy_max_N", "fy_min_N", "fh_max_N")

# As many faults of the cases are listed; a wrong key is wrong in every case of a grid.
MOST_FAULTS = 20


@dataclass
class Job:
    """One case of the grid, where it runs, and how it fares.

    status : waiting, completed, stopped (the simulation could not go on), interrupted, or failed.
    """

    point: list[Override]
    case: Case
    folder: Path
    status: str = "waiting"
    message: str = ""


def sweep(
    path: str | Path,
    *,
    vary: Sequence[str] = (),
    seeds: int | None = None,
    jobs: int | None = None,
    scheduler: str | None = None,
    out: Path,
    resume: bool = False,
    overrides: Sequence[str] = (),
) -> Path:
    """Runs the grid of cases and returns the path of its table, `out`/sweep.csv.

    vary : KEY=V1,V2,.. or KEY=START:STOP:STEP, each an axis of the grid.
    seeds : run every point with this many seeds, from that of the case on.
    jobs : processes at a time; one per core unless given.
    resume : leave out what is finished and go on with what is not.

    Fails with CaseError before anything is written; with SimulationStopped, naming the cases, once all others
    are done; with Interrupted when the user stops it, the state of the running cases being saved.
    """
    if scheduler is not None:
        raise CaseError(f"--scheduler {scheduler}: sweeps over a cluster are not available yet; use --jobs")
    todo = plan(path, vary=vary, seeds=seeds, out=out, overrides=overrides)
    _look_for_earlier_runs(todo, out, resume)
    waiting = [job for job in todo if job.status == "waiting"]
    workers = min(jobs or _core_count(), max(len(waiting), 1))
    _say(f"{len(todo)} cases in {out}, {len(todo) - len(waiting)} of them done before, {workers} at a time")
    out.mkdir(parents=True, exist_ok=True)
    _write_table(todo, out)
    if waiting:
        _compile_once({job.case.contact.model for job in waiting})
        _run_all(todo, waiting, workers, out)
    unfinished = [job for job in todo if job.status != "completed"]
    if unfinished:
        names = "\n".join(f"  {job.folder.name}: {job.status}: {job.message}" for job in unfinished)
        raise SimulationStopped(f"{out}: {len(unfinished)} of {len(todo)} cases did not finish:\n{names}")
    return out / TABLE


def plan(
    path: str | Path,
    *,
    vary: Sequence[str] = (),
    seeds: int | None = None,
    out: Path,
    overrides: Sequence[str] = (),
) -> list[Job]:
    """The cases of the grid in its order, the last axis (seeds, if any) changing fastest; all are checked."""
    if not vary and seeds is None:
        raise CaseError("nothing varies: give --vary KEY=V1,V2,.. or --seeds N")
    source = load.read(path)
    common = [parse(text) for text in overrides]
    axes = [grid.axis(text) for text in vary]
    if seeds is not None:
        if grid.SEED_KEY in [axis.key for axis in axes]:
            raise CaseError(f"give either --vary {grid.SEED_KEY} or --seeds, not both")
        axes.append(grid.seed_axis(load.build(source, common).field.seed, seeds))
    todo: list[Job] = []
    faults: dict[str, None] = {}  # a set that keeps its order
    for point in grid.cases(axes):
        try:
            case = load.build(source, [*common, *point])
        except CaseError as error:
            faults.update(dict.fromkeys(str(error).splitlines()))
        else:
            todo.append(Job(point, case, out / grid.folder_name(point)))
    if faults:
        more = f"\n... and {len(faults) - MOST_FAULTS} more" if len(faults) > MOST_FAULTS else ""
        raise CaseError("\n".join(list(faults)[:MOST_FAULTS]) + more)
    names: set[str] = set()
    for job in todo:
        if job.folder.name in names:
            raise CaseError(f"two cases would share the folder {job.folder.name}; give their values in simpler words")
        names.add(job.folder.name)
    return todo


def _look_for_earlier_runs(todo: list[Job], out: Path, resume: bool) -> None:
    """Refuses to overwrite; when resuming, marks what is finished and refuses to mix different cases."""
    if (out / "summary.json").exists():
        raise CaseError(f"{out}: holds a single run; choose another --out")
    if not resume:
        if (out / TABLE).exists() or any(job.folder.exists() for job in todo):
            raise CaseError(f"{out}: holds a sweep already; go on with --resume or choose another --out")
        return
    for job in todo:
        written = job.folder / "case.toml"
        if not written.exists():
            continue
        if load.load(written) != job.case:
            raise CaseError(f"{written}: is not the case of this sweep; choose another --out")
        if _summary(job).get("status") == "completed":
            job.status = "completed"


def _core_count() -> int:
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _compile_once(models: set[str]) -> None:
    """Fills Numba's cache for some contact models, or every case would compile the same kernels at the same time.

    Done by a process of its own, so that an interrupt ends it and its memory is given back. Its failure is
    left to the cases, which meet the same fault and report it.
    """
    for model in sorted(models):
        command = [sys.executable, "-c", f"from dilatedem.run.loop import compile_kernels; compile_kernels(model={model!r})"]
        subprocess.run(command, stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL, check=False)


def _command(job: Job) -> list[str]:
    """The command of one case, which it reads from its standard input."""
    command = [sys.executable, "-m", "dilatedem.cli", "run", "-", "--out", str(job.folder), "--quiet"]
    if (job.folder / "restart.h5").exists():
        command.append("--resume")
    elif job.folder.exists():
        command.append("--overwrite")  # killed before its first saved state
    return command


def _run_all(todo: list[Job], waiting: list[Job], workers: int, out: Path) -> None:
    """Runs the waiting cases, `workers` at a time; the table is up to date after each."""
    processes = _Processes()
    with _terminated_like_interrupted(), ThreadPoolExecutor(workers) as pool:
        futures = {pool.submit(processes.run, job): job for job in waiting}
        try:
            for done, future in enumerate(as_completed(futures), start=1):
                future.result()
                job = futures[future]
                _write_table(todo, out)
                message = f": {job.message}" if job.message else ""
                _say(f"[{done}/{len(waiting)}] {job.folder.name}: {job.status}{message}")
        except KeyboardInterrupt:
            _say("stopping; the running cases save their state (Ctrl-C again: without saving)")
            processes.interrupt()
            try:
                pool.shutdown(cancel_futures=True)
            except KeyboardInterrupt:
                processes.kill()
                pool.shutdown(cancel_futures=True)
            _write_table(todo, out)
            finished = sum(job.status == "completed" for job in todo)
            text = f"{out}: interrupted with {finished} of {len(todo)} cases completed; --resume goes on"
            raise Interrupted(text) from None


@contextmanager
def _terminated_like_interrupted() -> Iterator[None]:
    """Batch systems end a job with SIGTERM: then, too, the running cases shall save their state."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return

    def interrupt(*_: Any) -> None:
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGTERM, interrupt)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)


@dataclass
class _Processes:
    """The cases that are running now, so that they can be told to stop."""

    lock: threading.Lock = field(default_factory=threading.Lock)
    running: set[subprocess.Popen] = field(default_factory=set)
    stopping: bool = False

    def run(self, job: Job) -> None:
        """Runs one case to its end and notes on the job how it ended."""
        environment = {**os.environ, "NUMBA_NUM_THREADS": "1"}
        with self.lock:
            if self.stopping:
                return
            # A session of its own: a Ctrl-C in the terminal reaches the children through us, and once only.
            process = subprocess.Popen(
                _command(job),
                stdin=subprocess.PIPE,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.PIPE,
                text=True,
                env=environment,
                start_new_session=True,
            )
            self.running.add(process)
        _, said = process.communicate(write.dump(job.case))
        with self.lock:
            self.running.discard(process)
            stopped_by_us = self.stopping
        job.status, job.message = _outcome(process.returncode, said, stopped_by_us)
        if job.status == "failed":
            job.folder.with_name(f"{job.folder.name}.log").write_text(said, encoding="utf-8")

    def interrupt(self) -> None:
        with self.lock:
            self.stopping = True
            for process in self.running:
                process.send_signal(signal.SIGINT)

    def kill(self) -> None:
        with self.lock:
            for process in self.running:
                process.kill()


def _outcome(code: int, said: str, stopped_by_us: bool) -> tuple[str, str]:
    """Status and message from what a process returned and wrote to standard error."""
    lines = [line.strip() for line in said.splitlines() if line.strip()]
    if code == 0:
        return "completed", ""
    if code == 130 or stopped_by_us:
        return "interrupted", "--resume goes on"
    if code == 3:
        return "stopped", "; ".join(lines)
    if code == 2:
        return "failed", "; ".join(lines)
    if code < 0:
        return "failed", f"killed by signal {-code}"
    return "failed", lines[-1] if lines else f"exit code {code}"


def _summary(job: Job) -> dict[str, Any]:
    """summary.json of a run, empty where there is none that can be read."""
    try:
        return read_summary(job.folder / "summary.json")
    except CaseError:  # damaged
        return {}


def _write_table(todo: list[Job], out: Path) -> None:
    """Rewrites the table atomically, one row a case in the order of the grid.

    The columns left of `seed` are the keys that vary; `run` is the folder, relative to that of the table.
    """
    rows = [_row(job) for job in todo]
    columns = list(dict.fromkeys(name for row in rows for name in row))
    columns.remove("message")
    text = io.StringIO(newline="")
    table = csv.DictWriter(text, [*columns, "message"], restval="", lineterminator="\n")
    table.writeheader()
    table.writerows(rows)
    path = out / TABLE
    partial = path.with_name(f"{TABLE}.partial")
    partial.write_text(text.getvalue(), encoding="utf-8")
    os.replace(partial, path)


def _row(job: Job) -> dict[str, Any]:
    row = {override.key: _cell(override.value) for override in job.point if override.origin != "--seeds"}
    row |= {"seed": job.case.field.seed, "run": job.folder.name, "status": job.status}
    summary = _summary(job)
    loads = summary.get("loads", {})
    row |= {"steps": summary.get("steps", ""), "wall_s": summary.get("wall_s", "")}
    # The structures of the case first, so that the columns stand before anything has run; walls follow.
    for name in dict.fromkeys([structure.name for structure in job.case.structure] + list(loads)):
        row |= {f"{name}_{load}": loads.get(name, {}).get(load, "") for load in LOADS}
    row["residual_over_work"] = summary.get("energy", {}).get("residual_over_work", "")
    return row | {"message": job.message}


def _cell(value: Any) -> str:
    return value if isinstance(value, str) else json.dumps(value, default=str)


def _say(text: str) -> None:
    print(printable(text, keep="\n"), file=sys.stderr, flush=True)

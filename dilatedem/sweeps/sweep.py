"""A grid of cases, each run into its own folder, and one table of what came out.

All cases are checked before anything is written, and as many of their ice fields as a few seconds allow. A run that dies takes none
but its own case with it, and the table names that.
"""

import os
import sys
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path

from dilatedem.errors import CaseError, Interrupted, SimulationStopped, printable
from dilatedem.files.atomic import write_text
from dilatedem.files.faults import told_as
from dilatedem.files.lock import Lock
from dilatedem.processes.children import heard
from dilatedem.sweeps.earlier import look_for_earlier_runs
from dilatedem.sweeps.local import Local
from dilatedem.sweeps.orders import Executor, order_of, outcome
from dilatedem.sweeps.plan import Job, plan
from dilatedem.sweeps.progress import Progress
from dilatedem.sweeps.table import TABLE, Table


def sweep(
    path: str | Path,
    *,
    vary: Sequence[str] = (),
    seeds: int | None = None,
    jobs: int | None = None,
    scheduler: str | None = None,
    out: Path,
    resume: bool = False,
    check_all: bool = False,
    overrides: Sequence[str] = (),
) -> Path:
    """Runs the grid of cases and returns the path of its table, `out`/sweep.csv; what is completed already is left as it is.

    vary : KEY=V1,V2,.. or KEY=START:STOP:STEP, each an axis of the grid.
    seeds : run every point with this many seeds, from that of the case on.
    jobs : processes at a time; one per core unless given.
    scheduler : address of a Dask scheduler, whose workers run the cases instead.
    resume : go on with a sweep of other cases, too, and with cases that end later than they did.
    check_all : make the ice fields of all cases before the first run, not of as many as a few seconds allow.

    Fails with CaseError before anything is written; with SimulationStopped, naming the cases, once all others
    are done; with Interrupted when the user stops it, the state of the running cases being saved.
    """
    if scheduler is not None and jobs is not None:
        raise CaseError("give either --jobs or --scheduler: a cluster runs as many cases at a time as it has workers")
    todo, lock = plan(path, vary=vary, seeds=seeds, out=out, overrides=overrides), Lock(out)
    with told_as(CaseError):
        look_for_earlier_runs(todo, out, resume)
        from dilatedem.sweeps.fields import require_fields  # loads what builds cases: once their keys are known to be fine

        if note := require_fields(todo, every=check_all):
            print(printable(f"note: {note}"), file=sys.stderr)
        with lock:
            look_for_earlier_runs(todo, out, resume)  # again: another sweep may have ended here in between
            with _executor(todo, jobs, scheduler, lock) as executor, told_as(SimulationStopped, lambda error: "; --resume goes on"):
                lock.keep()
                return _sweep(todo, out, executor)


def _executor(todo: list[Job], jobs: int | None, scheduler: str | None, lock: Lock) -> Executor:
    """Who runs the cases that wait; a cluster is not asked where none does."""
    waiting = sum(job.status == "waiting" for job in todo)
    if scheduler and waiting:
        from dilatedem.sweeps.cluster import Cluster  # no other sweep needs Dask

        return Cluster(scheduler)
    return Local(min(jobs or core_count(), max(waiting, 1)), leave=lock.leave)


def _sweep(todo: list[Job], out: Path, executor: Executor) -> Path:
    """The cases that wait, in a folder that nobody else works in."""
    waiting, table = [job for job in todo if job.status == "waiting"], Table(todo, out)
    with Progress(len(waiting)) as progress:
        progress.message(f"{len(todo)} cases in {out}, {_done_before(len(todo) - len(waiting), len(todo))}")
        table.write()
        if waiting:
            with heard(executor, progress.later):
                _run_all(waiting, executor, table, progress)
    finished = f"with {sum(job.status == 'completed' for job in todo)} of {len(todo)} cases completed; --resume goes on"
    if executor.stopping:
        raise Interrupted(f"{out}: interrupted {finished}")
    if executor.fault:
        raise SimulationStopped(f"{out}: {executor.fault} {finished}")
    if unfinished := [job for job in todo if job.status != "completed"]:
        names = "\n".join(f"  {job.folder.name}: {job.status}: {job.message}" for job in unfinished)
        raise SimulationStopped(f"{out}: {len(unfinished)} of {len(todo)} cases did not finish:\n{names}")
    return out / TABLE


def _run_all(waiting: list[Job], executor: Executor, table: Table, progress: Progress) -> None:
    """The table is up to date after each case."""
    for number, answer in executor.carry_out([order_of(job) for job in waiting], progress):
        job = waiting[number]
        job.status, job.message = outcome(answer, executor.stopping)
        if job.status == "failed":
            with suppress(OSError):  # its last line is in the table, and a full disk meets that as well
                write_text(job.log, answer.said)
        table.write()
        message = f": {job.message}" if job.message else ""
        progress.ended(number, f"{job.folder.name}: {job.status}{message}", failed=job.status != "completed")


def _done_before(count: int, of: int) -> str:
    if count == of:
        return "all of them were completed before: nothing to do"
    return f"{count} of them were completed before" if count else "none of them begun"


def core_count() -> int:
    """Cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1

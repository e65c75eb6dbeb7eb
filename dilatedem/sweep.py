"""A grid of cases, each run into its own folder by one of several processes, and one table of what came out.

A process runs one case after another (`worker`), on one thread; one that dies takes only its present case with it, and the table
names that. All cases are checked before anything is written, and the kernels are compiled once before the first case starts.
"""

import csv
import io
import json
import os
import sys
import time
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from dilatedem.case import grid, load, write
from dilatedem.case.overrides import Override, parse
from dilatedem.case.schema import Case
from dilatedem.errors import CaseError, Interrupted, SimulationStopped
from dilatedem.files.atomic import write_text
from dilatedem.files.faults import told_as
from dilatedem.files.lock import Lock, in_use
from dilatedem.files.whose import refuse_foreign, refuse_links
from dilatedem.output import folder
from dilatedem.processes import lifeline
from dilatedem.processes.children import Children, heard, say
from dilatedem.results.files import read_summary

TABLE = "sweep.csv"

# Of summary.json's loads, these go to the table, as <structure>_<load>.
LOADS = (
    "fx_max_N", "fx_mean_N", "fy_max_N", "fy_min_N", "fh_max_N", "along_max_N", "along_mean_N", "across_max_N", "across_min_N",
    "mh_max_Nm", "mz_max_Nm", "mz_min_Nm",
)  # fmt: skip

# How a process is started that runs cases.
WORKER = [sys.executable, "-m", "dilatedem.worker"]

# So long a resumed sweep waits for cases that still save their state [s].
PATIENCE_S = 10.0

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
    with told_as(CaseError):
        _look_for_earlier_runs(todo, out, resume)
        with Lock(out) as lock:
            _look_for_earlier_runs(todo, out, resume)  # again: another sweep may have ended here in between
            with told_as(SimulationStopped, lambda error: "; --resume goes on"):
                return _sweep(todo, out, jobs, lock)


def _sweep(todo: list[Job], out: Path, jobs: int | None, lock: Lock) -> Path:
    """The cases that wait, in a folder that nobody else works in."""
    waiting = [job for job in todo if job.status == "waiting"]
    workers = min(jobs or _core_count(), max(len(waiting), 1))
    say(f"{len(todo)} cases in {out}, {len(todo) - len(waiting)} of them done before, {workers} at a time")
    lock.keep()
    _write_table(todo, out)
    if waiting:
        with lifeline.held() as line:
            _run_all(todo, waiting, workers, out, Children(WORKER, line))
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
    for remark in (remark for axis in axes for remark in axis.remarks):
        say(f"note: {remark}")
    return todo


def _look_for_earlier_runs(todo: list[Job], out: Path, resume: bool) -> None:
    """Refuses to overwrite; when resuming, marks what is finished and refuses to mix different cases."""
    if (out / "summary.json").exists():
        raise CaseError(f"{out}: holds a single run; choose another --out")
    refuse_links([out / TABLE, *(place for job in todo for place in (job.folder, _log(job)))])
    if not resume:
        if (out / TABLE).exists() or any(job.folder.exists() for job in todo):
            raise CaseError(f"{out}: holds a sweep already; go on with --resume or choose another --out")
        refuse_foreign(out, [out / TABLE, *map(_log, todo)], "sweep")
        return
    if (out / TABLE).exists() and not _is_ours(out / TABLE):
        raise CaseError(f"{out / TABLE}: stands in the way: it is no table of a sweep; move it away or choose another --out")
    _wait_for_their_end(todo)
    for job in todo:
        written = job.folder / "case.toml"
        if written.exists() and load.load(written) != job.case:
            raise CaseError(f"{written}: is not the case of this sweep; choose another --out")
        if written.exists() and _summary(job).get("status") == "completed":
            job.status = "completed"
        else:
            folder.check(job.folder, resume=(job.folder / folder.CHECKPOINT).exists(), overwrite=True)


def _is_ours(table: Path) -> bool:
    with open(table, encoding="utf-8", errors="replace") as file:
        return {"seed", "run", "status"} <= set(file.readline().rstrip("\n").split(","))


def _wait_for_their_end(todo: list[Job]) -> None:
    """Cases of a sweep that was killed save their state and end: they are waited for. Raises CaseError for one that goes on."""
    given_up = time.monotonic() + PATIENCE_S
    while running := [job.folder for job in todo if in_use(job.folder)]:
        if time.monotonic() > given_up:
            raise CaseError(f"{running[0]}: another process is at work in it; wait for its end, then go on with --resume")
        time.sleep(0.1)


def _log(job: Job) -> Path:
    """Where the last words of a case go that failed."""
    return job.folder.with_name(f"{job.folder.name}.log")


def _core_count() -> int:
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _order(job: Job) -> dict[str, Any]:
    """What a worker is asked to run."""
    resume = (job.folder / "restart.h5").exists()
    overwrite = not resume and job.folder.exists()  # killed before its first saved state
    return {"case": write.dump(job.case), "out": str(job.folder), "resume": resume, "overwrite": overwrite}


def _run_all(todo: list[Job], waiting: list[Job], workers: int, out: Path, children: Children) -> None:
    """Runs the waiting cases, `workers` at a time; the table is up to date after each."""
    with heard(children), ThreadPoolExecutor(workers) as pool:
        try:
            children.prepare(workers)
            for kind in sorted({tuple(job.case.laws.items()) for job in waiting}):
                # by one, or all would compile the same kernels; its failure is left to the cases, which meet and report it
                children.run({"compile": dict(kind)})
            futures = {pool.submit(_run, job, children): job for job in waiting}
            for done, future in enumerate(as_completed(futures), start=1):
                future.result()
                job = futures[future]
                _write_table(todo, out)
                message = f": {job.message}" if job.message else ""
                if job.status != "waiting":
                    say(f"[{done}/{len(waiting)}] {job.folder.name}: {job.status}{message}")
        except BaseException:  # the disk refused something: what cannot be noted is not gone on with
            children.interrupt()
            raise
        finally:
            children.dismiss()
    if children.stopping:
        finished = sum(job.status == "completed" for job in todo)
        raise Interrupted(f"{out}: interrupted with {finished} of {len(todo)} cases completed; --resume goes on")


def _run(job: Job, children: Children) -> None:
    """Runs one case to its end and notes on the job how it ended."""
    ended = children.run(_order(job))
    if ended:
        job.status, job.message, said = ended
        if job.status == "failed":
            with suppress(OSError):  # its last line is in the table, and a full disk meets that as well
                write_text(_log(job), said)


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
    write_text(out / TABLE, text.getvalue())


def _row(job: Job) -> dict[str, Any]:
    row = {override.key: _cell(override.value) for override in job.point if override.origin != "--seeds"}
    row |= {"seed": job.case.field.seed, "run": job.folder.name, "status": job.status}
    summary = _summary(job)
    loads = summary.get("loads", {})
    row |= {"steps": summary.get("steps", ""), "wall_s": summary.get("wall_s", "")}
    # The structures of the case first, so that the columns stand before anything has run; walls and the total follow.
    for name in dict.fromkeys([name for structure in job.case.structure for name in structure.names()] + list(loads)):
        row |= {f"{name}_{load}": loads.get(name, {}).get(load, "") for load in LOADS}
    row["residual_over_work"] = summary.get("energy", {}).get("residual_over_work", "")
    return row | {"message": job.message}


def _cell(value: Any) -> str:
    return value if isinstance(value, str) else json.dumps(value, default=str)

"""What lies in the folder of a sweep already: the same sweep, to be gone on with, or something that is left alone."""

import time
from pathlib import Path

from dilatedem.case import write
from dilatedem.case.differences import differences
from dilatedem.case.load import load
from dilatedem.case.schema import Case
from dilatedem.errors import CaseError
from dilatedem.files.lock import in_use
from dilatedem.files.whose import refuse_foreign, refuse_links
from dilatedem.output import folder
from dilatedem.results.files import read_summary
from dilatedem.results.sweep import read_rows
from dilatedem.sweeps.plan import Job
from dilatedem.sweeps.table import TABLE

#: s that a sweep waits for cases of an earlier one that still save their state
PATIENCE_S = 10.0


def look_for_earlier_runs(todo: list[Job], out: Path, resume: bool) -> None:
    """Marks what is completed of the same cases; raises CaseError for what must be neither replaced nor mixed.

    A sweep goes on with one of no other cases than its own; `resume` allows for others, and for cases that end later.
    """
    if (out / folder.SUMMARY).exists():
        raise CaseError(f"{out}: holds a single run; choose another --out")
    refuse_links([out / TABLE, *(place for job in todo for place in (job.folder, job.log))])
    if not resume and not (out / TABLE).exists() and not any(job.folder.exists() for job in todo):
        refuse_foreign(out, [out / TABLE, *(job.log for job in todo)], "sweep")
        return
    if (out / TABLE).exists() and not _is_ours(out / TABLE):
        raise CaseError(f"{out / TABLE}: stands in the way: it is no table of a sweep; move it away or choose another --out")
    if not (resume or _told_runs(out) <= {job.folder.name for job in todo}):
        raise CaseError(f"{out}: holds a sweep already; go on with --resume or choose another --out")
    _wait_for_their_end(todo)
    for job in todo:
        if _same_as_before(job, resume) and _is_completed(job):
            job.status = "completed"
        else:
            folder.check(job.folder, resume=(job.folder / folder.CHECKPOINT).exists(), overwrite=True)


def _same_as_before(job: Job, resume: bool) -> bool:
    """Whether the folder of a case holds that case, False where it holds none. Raises CaseError where it holds another.

    With `resume`, one that ends otherwise is no other case: the run itself knows whether it can go on.
    """
    written = job.folder / folder.CASE
    if not written.exists():
        return False
    if written.read_text(encoding="utf-8", errors="replace").partition("\n\n")[2] == write.dump(job.case):
        return True
    before = load(written)
    if before == job.case:
        return True
    if resume and before.endless == job.case.endless:
        return False
    raise CaseError(f"{written}: is not the case of this sweep: it has another {_names(before, job.case)}; choose another --out")


def _names(before: Case, now: Case) -> str:
    found = differences(before.model_dump(), now.model_dump())
    return ", ".join(found[:3]) + (f" and {len(found) - 3} more" if len(found) > 3 else "")


def _is_completed(job: Job) -> bool:
    try:
        return read_summary(job.folder / folder.SUMMARY).get("status") == "completed"
    except CaseError:  # damaged
        return False


def _is_ours(table: Path) -> bool:
    with open(table, encoding="utf-8", errors="replace") as file:
        return {"seed", "run", "status"} <= set(file.readline().rstrip("\n").split(","))


def _told_runs(out: Path) -> set[str]:
    """Folders of the runs that the table tells of; the empty name, which no case has, where there is no table."""
    return {row["run"] for row in read_rows(out)[1]} if (out / TABLE).exists() else {""}


def _wait_for_their_end(todo: list[Job]) -> None:
    """Cases of a sweep that was killed save their state and end: they are waited for. Raises CaseError for one that goes on."""
    given_up = time.monotonic() + PATIENCE_S
    while running := [job.folder for job in todo if in_use(job.folder)]:
        if time.monotonic() > given_up:
            raise CaseError(f"{running[0]}: another process is at work in it; wait for its end, then go on with --resume")
        time.sleep(0.1)

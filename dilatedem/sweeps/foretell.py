"""What a sweep will take: cases, floes, wall time, memory and disk. Nothing is run, and nothing written."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from dilatedem.errors import CaseError
from dilatedem.run.foretell import check, duration
from dilatedem.sweeps.earlier import look_for_earlier_runs
from dilatedem.sweeps.plan import Job, plan
from dilatedem.sweeps.sweep import core_count

#: cases that are looked at, at most, evenly spread over the grid; the others are taken to be like them
MOST_LOOKS = 8
#: s of wall time for which each of them is tried
TRIAL_S = 0.25
#: facts of a case, as `check` calls them
FLOES, STEPS, SECONDS, JAMMED, MEMORY, DISK = (
    "floes", "steps", "wall time, s, about", "wall time in a jam, s, about", "memory, MB, about", "output, MB, about"
)  # fmt: skip


def foretell(
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
) -> dict[str, str | int]:
    """Labels and values, of the sweep that these arguments of `sweep.sweep` stand for. Raises CaseError as that does.

    check_all : look at all cases, and not at some that stand for the others.
    """
    todo = plan(path, vary=vary, seeds=seeds, out=out, overrides=overrides)
    look_for_earlier_runs(todo, out, resume)
    waiting = [job for job in todo if job.status == "waiting"]
    told: dict[str, str | int] = {"cases": len(todo), "completed before": len(todo) - len(waiting)}
    if not waiting:
        return told
    chosen = waiting if check_all else spread(waiting)
    looked = [_facts(job) for job in chosen]
    others = "" if len(chosen) == len(waiting) else "; all with --check-all"
    names = (FLOES, STEPS, SECONDS, JAMMED, MEMORY, DISK)
    found = {name: np.array([facts[name] for facts in looked], dtype=float) for name in names}
    total = {name: values.mean() * len(waiting) for name, values in found.items()}
    at_a_time = 1 if scheduler else min(jobs or core_count(), len(waiting))
    told |= {
        "looked at": f"{len(looked)} of the {len(waiting)} cases to be run{others}",
        "floes of a case": _range(found[FLOES]),
        "steps of a case": _range(found[STEPS]),
        "wall time of a case, about": f"{duration(found[SECONDS].min())} to {duration(found[SECONDS].max())}",
        "cases at a time": "as many as the cluster has workers" if scheduler else at_a_time,
        "processor time in all, about": f"{duration(total[SECONDS])}, in jams up to {duration(total[JAMMED])}",
    }
    if not scheduler:
        wall = [duration(max(total[name] / at_a_time, found[name].max())) for name in (SECONDS, JAMMED)]
        told["wall time in all, about"] = f"{wall[0]}, in jams up to {wall[1]}"
    told["memory at a time, MB, about"] = f"{at_a_time * found[MEMORY].max():.0f}{' a worker' if scheduler else ''}"
    return told | {"disk, MB, about": f"{total[DISK]:.3g}"}


def spread(jobs: list[Job]) -> list[Job]:
    """At most MOST_LOOKS of them, evenly from the first to the last."""
    return [jobs[i] for i in np.unique(np.linspace(0, len(jobs) - 1, MOST_LOOKS).round().astype(int))]


def _facts(job: Job) -> dict:
    """What `check` says of a case. Raises CaseError as that does, with the folder of the case."""
    try:
        return check(job.case, trial_s=TRIAL_S)
    except CaseError as error:
        raise CaseError(f"{job.folder.name}: {error}") from None


def _range(values: np.ndarray) -> str:
    least, most = int(values.min()), int(values.max())
    return f"{least}" if least == most else f"{least} to {most}"

"""The cases of a sweep, planned and checked before anything is written."""

import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from dilatedem.case import grid, load
from dilatedem.case.overrides import Override, parse
from dilatedem.case.schema import Case
from dilatedem.errors import CaseError, printable

#: as many faults of the cases are listed; a wrong key is wrong in every case of a grid
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

    @property
    def log(self) -> Path:
        """Where the last words of a case go that failed."""
        return self.folder.with_name(f"{self.folder.name}.log")


def plan(
    path: str | Path,
    *,
    vary: Sequence[str] = (),
    seeds: int | None = None,
    out: Path,
    overrides: Sequence[str] = (),
) -> list[Job]:
    """The cases of the grid in its order, the last axis (seeds, if any) changing fastest; all are checked.

    What is hardly meant is said to standard error.
    """
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
    _require_own_folders(todo)
    for remark in (remark for axis in axes for remark in axis.remarks):
        print(printable(f"note: {remark}"), file=sys.stderr)
    return todo


def _require_own_folders(todo: list[Job]) -> None:
    names: set[str] = set()
    for job in todo:
        if job.folder.name in names:
            raise CaseError(f"two cases would share the folder {job.folder.name}; give their values in simpler words")
        names.add(job.folder.name)

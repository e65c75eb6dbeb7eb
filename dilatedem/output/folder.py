"""The run folder: the names of its files, whether a folder already holds a run, and what of it may be replaced."""

import re
from collections.abc import Iterator
from pathlib import Path

from dilatedem.errors import CaseError
from dilatedem.files.atomic import TEMPORARY
from dilatedem.files.lock import was_used
from dilatedem.files.whose import is_marked, matching, refuse_foreign, refuse_links, refuse_other_kinds

CASE = "case.toml"
FORCES = "forces.csv"
ENERGY = "energy.csv"
HITS = "hits.csv"
BODIES = "bodies.csv"
ICE_COLLECTION = "ice.pvd"
SNAPSHOTS = "snapshots"
STRUCTURES = "structures.vtu"  # those that are held; those that move:
STRUCTURE_MOTION = "structures.csv"
STRUCTURE_COLLECTION = "structures.pvd"
FLEXURE = "flexure.csv"  # of floes that bend, and:
BENT_COLLECTION = "bent.pvd"
RUN_ARCHIVE = "run.h5"
CHECKPOINT = "restart.h5"
BEFORE_END = "before_end.h5"
STOPPED = "stopped.h5"
SUMMARY = "summary.json"
REPORT = "report.html"  # this one, the figures and the table are made by `post`, and removed with the run that they show
STATISTICS = "statistics.csv"
FIGURES = "figures"
EXPORT = "export"  # likewise, by `export`

RUN_MARKS = (CASE, FORCES, CHECKPOINT, SUMMARY)  # any one of them, and the folder holds a run
#: files that a run replaces and removes, case.toml last: as long as it is there, the folder holds a run that may be replaced
FILES = (
    CHECKPOINT, BEFORE_END, STOPPED, SUMMARY, RUN_ARCHIVE, FORCES, HITS, ENERGY, BODIES, ICE_COLLECTION, STRUCTURES,
    STRUCTURE_MOTION, STRUCTURE_COLLECTION, FLEXURE, BENT_COLLECTION, REPORT, STATISTICS, CASE,
)  # fmt: skip
#: of what lies in folders, the same
PARTS = {
    SNAPSHOTS: re.compile(r"(ice|structures|bent)_\d{6,}\.vtu(\.tmp)?"),
    FIGURES: re.compile(r"(field|plan|speed|energy|extremes_.+|motion_.+|force_.+|peak_.+|load_.+|hit_.+)\.(png|svg|pdf)(\.tmp)?"),
    EXPORT: re.compile(r".+_(loads\.(csv|dat|inp)|heights\.csv)(\.tmp)?"),
}


def snapshot_name(number: int) -> str:
    """Path of snapshot `number`, relative to the run folder, as the collection ice.pvd lists it."""
    return f"{SNAPSHOTS}/ice_{number:06d}.vtu"


def structures_name(number: int) -> str:
    """The same of the structures that move, as the collection structures.pvd lists them."""
    return f"{SNAPSHOTS}/structures_{number:06d}.vtu"


def bent_name(number: int) -> str:
    """The same of the floes that bend, as the collection bent.pvd lists them."""
    return f"{SNAPSHOTS}/bent_{number:06d}.vtu"


def holds_run(folder) -> bool:
    """Whether `folder` holds a run, whole or cut short: such a folder is never overwritten silently."""
    return any((Path(folder) / name).exists() for name in RUN_MARKS)


def is_run(folder: Path) -> bool:
    """Whether a run of this program made the folder: its case.toml says so, and what a run leaves lies beside it.

    A case.toml that somebody copied from a run into a folder of his own is the beginning of his case, not a run.
    """
    beside = was_used(folder) or any((folder / name).is_file() for name in (CHECKPOINT, SUMMARY, FORCES))
    return beside and is_marked(folder / CASE)


def check(folder: Path, *, resume: bool = False, overwrite: bool = False) -> None:
    """Raises CaseError unless a run may start, or go on, in this folder without harm to what is not its own."""
    if resume and not (folder / CASE).exists():
        raise CaseError(f"{folder}: holds no run to resume; leave --resume away to start one")
    if is_run(folder) and not (resume or overwrite):
        raise CaseError(f"{folder}: holds a run already; continue it with --resume, replace it with --overwrite, or choose --out")
    refuse_links([*(folder / name for name in PARTS), *_own(folder)])
    refuse_other_kinds((folder / name for name in FILES), (folder / name for name in PARTS))
    if not (resume or is_run(folder)):
        refuse_foreign(folder, (folder / name for name in (*FILES, *PARTS)), "run")


def clear(folder: Path) -> None:
    """Remove an earlier run's files from a folder that was given to be overwritten; `check` has been there before.

    Its case.toml is left: it is replaced in one step, so that the folder holds a run whenever the program is killed.
    """
    for path in _own(folder):
        if path != folder / CASE:
            path.unlink(missing_ok=True)
        path.with_name(path.name + TEMPORARY).unlink(missing_ok=True)


def _own(folder: Path) -> Iterator[Path]:
    """Every path at which a run or `post` may have put a file into this folder."""
    yield from (folder / name for name in FILES)
    for name, pattern in PARTS.items():
        yield from matching(folder / name, pattern)

"""The run folder: the names of its files, and whether a folder already holds a run."""

from pathlib import Path

CASE = "case.toml"
FORCES = "forces.csv"
ENERGY = "energy.csv"
BODIES = "bodies.csv"
ICE_COLLECTION = "ice.pvd"
SNAPSHOTS = "snapshots"
STRUCTURES = "structures.vtu"
RUN_ARCHIVE = "run.h5"
CHECKPOINT = "restart.h5"
STOPPED = "stopped.h5"
SUMMARY = "summary.json"

RUN_MARKS = (CASE, FORCES, CHECKPOINT, SUMMARY)  # any one of them, and the folder holds a run


def snapshot_name(number: int) -> str:
    """Path of snapshot `number`, relative to the run folder, as the collection ice.pvd lists it."""
    return f"{SNAPSHOTS}/ice_{number:06d}.vtu"


def holds_run(folder) -> bool:
    """Whether `folder` holds a run, whole or cut short: such a folder is never overwritten silently."""
    return any((Path(folder) / name).exists() for name in RUN_MARKS)


def clear(folder: Path) -> None:
    """Remove an earlier run's files from a folder that was given to be overwritten."""
    names = (CASE, FORCES, ENERGY, BODIES, ICE_COLLECTION, STRUCTURES)
    for name in (*names, RUN_ARCHIVE, CHECKPOINT, SUMMARY, STOPPED, "report.html"):
        (folder / name).unlink(missing_ok=True)
    for part in (SNAPSHOTS, "figures"):
        for file in (folder / part).glob("*"):
            file.unlink()

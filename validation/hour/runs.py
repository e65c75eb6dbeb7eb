"""The runs behind the page: an hour in one piece, its memory watched, and an hour that is killed on the way and resumed."""

import json
import os
import resource
import signal
import subprocess
import sys
import time
from pathlib import Path

CASE = "cases/hour.toml"
#: s of wall time between two looks at the memory
LOOK = 2.0
KILLS = 5
#: s of simulated time by which the speed is told, and where that stands, in the folder of the runs: processor time [s]
SAMPLE, SPEED = 600.0, "speed.json"
#: where the memory of the whole run is noted, in the folder of both runs: simulated time [s], resident bytes
MEMORY = "memory.json"
#: which of the tables both runs have to hold alike, besides all snapshots
TABLES = ("forces.csv", "energy.csv", "hits.csv", "ice.pvd")


def command(out: Path, *options: str) -> list[str]:
    return [sys.executable, "-m", "dilatedem", "run", CASE, "--out", str(out), "--quiet", *options]


def whole(folder: Path, *options: str) -> Path:
    """The hour in one piece, unless it is there already; its memory goes to MEMORY."""
    out = folder / "whole"
    if (out / "summary.json").exists() and json.loads((out / "summary.json").read_text())["status"] == "completed":
        return out
    noted = []
    run = subprocess.Popen(command(out, "--overwrite", *options))
    while run.poll() is None:
        time.sleep(LOOK)
        if resident := _resident(run.pid):
            noted.append([_simulated(out), resident])
    if run.returncode:
        raise SystemExit(f"the run ended with {run.returncode}")
    (folder / MEMORY).write_text(json.dumps(noted))
    return out


def processor_time(folder: Path) -> float:
    """What the hour takes of a processor [s]: by the first SAMPLE seconds of it, the start of the program included."""
    file = folder / SPEED
    if not file.exists():
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run(command(folder / "sample", "--overwrite", "--set", f"time.duration={SAMPLE:g}"), check=True)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        file.write_text(json.dumps(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime))
    return json.loads(file.read_text()) * 3600.0 / SAMPLE


def in_parts(folder: Path, *options: str) -> Path:
    """The same hour, killed KILLS times, as evenly as can be, and resumed each time."""
    out = folder / "parts"
    if (out / "summary.json").exists() and json.loads((out / "summary.json").read_text())["status"] == "completed":
        return out
    for part in range(KILLS + 1):
        run = subprocess.Popen(command(out, "--resume" if part else "--overwrite", *options))
        if part == KILLS:
            break
        goal = (part + 1) * 3600.0 / (KILLS + 1)
        while run.poll() is None and _simulated(out) < goal:
            time.sleep(0.2)
        run.send_signal(signal.SIGKILL)
        run.wait()
        print(f"killed at {_simulated(out):.0f} s", flush=True)
    if run.wait():
        raise SystemExit(f"the run ended with {run.returncode}")
    return out


def differing(one: Path, other: Path) -> list[str]:
    """Names of files that two runs do not hold alike, byte for byte."""
    names = [*TABLES, *(f"snapshots/{path.name}" for path in (one / "snapshots").iterdir())]
    return [name for name in names if not (other / name).exists() or (one / name).read_bytes() != (other / name).read_bytes()]


def _resident(pid: int) -> int:
    """Resident memory of a process [bytes]; 0 where it has ended."""
    try:
        return int(Path(f"/proc/{pid}/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")
    except (OSError, IndexError):
        return 0


def _simulated(out: Path) -> float:
    """Time that the last row of forces.csv tells [s]."""
    try:
        with (out / "forces.csv").open("rb") as file:
            file.seek(max(0, file.seek(0, os.SEEK_END) - 2000))
            return float(file.read().split(b"\n")[-2].split(b",")[0])
    except (OSError, ValueError, IndexError):
        return 0.0

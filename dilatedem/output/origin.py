"""Where the numbers of a run come from, for whoever signs them: when, on which machine, by which command."""

import functools
import os
import platform
import shlex
import sys
from datetime import datetime
from pathlib import Path

#: of a command line typed as `dilatedem ...` or `python -m dilatedem ...`, the last part of its first word, or of the folder that
#: holds it
PROGRAM = "dilatedem"


def origin(started: str) -> dict[str, str]:
    """Entry `origin` of summary.json: times with their distance from UTC, machine, and the command, if it was one.

    started: when the run was begun, as `now` gives it; a run that goes on keeps it.
    """
    return {"started": started, "written": now(), **machine(), "command": command(sys.argv)}


def now() -> str:
    """This moment by the clock of the place, to the second."""
    return datetime.now().astimezone().isoformat(timespec="seconds")


@functools.cache
def machine() -> dict[str, str]:
    """Name, system and processor of this machine."""
    return {"machine": platform.node(), "system": platform.platform(), "processor": _processor(), "cores": str(os.cpu_count())}


def _processor() -> str:
    """The processor's name, as Linux tells it, or else what the system says; empty where neither does."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError:
        lines = []
    named = (line.partition(":")[2].strip() for line in lines if line.startswith("model name"))
    return next(named, "") or platform.processor() or platform.machine()


def command(words: list[str]) -> str:
    """The command line of these words of `sys.argv`; empty for a script of somebody, and for a worker of a sweep."""
    called = Path(words[0]) if words and words[0] else Path()
    if PROGRAM not in (called.stem, called.parent.name) or called.stem not in (PROGRAM, "__main__"):
        return ""
    return shlex.join([PROGRAM, *words[1:]])

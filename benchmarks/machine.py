"""What a figure was measured on."""

import os
import platform
import subprocess
from datetime import datetime
from functools import cache
from importlib import metadata
from pathlib import Path

from dilatedem import __version__
from dilatedem.jit import start_threads


def processor() -> str:
    """Name of the processor, with family and model where the system tells (a virtual machine often hides the rest)."""
    facts = {}
    try:
        for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
            key, _, value = line.partition(":")
            facts.setdefault(key.strip(), value.strip())
    except OSError:
        return platform.processor() or platform.machine()
    name = facts.get("model name", platform.machine())
    if "cpu family" in facts and "model" in facts:
        name += f" (family {facts['cpu family']}, model {facts['model']})"
    return name


@cache  # results that are being written make the working tree dirty
def program() -> str:
    """Version of dilatedem, with the commit where the sources are a repository's."""
    try:
        command = ["git", "describe", "--always", "--dirty", "--exclude", "*"]
        told = subprocess.run(command, cwd=Path(__file__).parent, capture_output=True, text=True, check=True)
    except (OSError, subprocess.CalledProcessError):
        return __version__
    return f"{__version__} ({told.stdout.strip()})"


def load() -> float:
    """Processes that wanted to run in the last minute, on average; nan where the system does not tell."""
    try:
        return round(os.getloadavg()[0], 2)
    except OSError:
        return float("nan")


def describe(threads: int) -> dict[str, str | int | float]:
    """Columns of every result: when, on what, with which versions, and the layer that runs the threads ("none" for one)."""
    return {
        "date": datetime.now().astimezone().isoformat(timespec="minutes"),
        "program": program(),
        "processor": processor(),
        "cores": os.cpu_count() or 0,
        "load": load(),
        "system": f"{platform.system()} {platform.machine()}",
        "python": platform.python_version(),
        "numba": metadata.version("numba"),
        "numpy": metadata.version("numpy"),
        "coal": _version("coal"),
        "layer": start_threads(threads) or "none",
    }


def _version(package: str) -> str:
    try:
        return metadata.version(package)
    except metadata.PackageNotFoundError:
        return ""

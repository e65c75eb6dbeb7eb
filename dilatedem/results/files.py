"""What a folder holds, and those of its files that are no tables: the case, the summary, the list of snapshots."""

from __future__ import annotations

import json
import math
import tomllib
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from typing import Any

from dilatedem.errors import CaseError, printable
from dilatedem.results.soundness import MOST_DIGITS, require_case, require_summary


def is_run(folder: Path) -> bool:
    return (folder / "case.toml").is_file()


def is_sweep(folder: Path) -> bool:
    return (folder / "sweep.csv").is_file()


def read_case(folder: Path) -> dict[str, Any]:
    """case.toml of a run. Raises CaseError when there is none, or one that is not TOML or no case."""
    if not is_run(folder):
        raise CaseError(f"{folder}: no run to be found here (there is no case.toml in it)")
    path = folder / "case.toml"
    try:
        case = tomllib.loads(path.read_text(encoding="utf-8"))
    except (ValueError, RecursionError) as error:  # no TOML, no UTF-8, numbers or nesting beyond what Python reads
        raise CaseError(f"{path}: not a readable TOML file: {printable(str(error))}") from error
    require_case(case, path)
    return case


def read_summary(path: Path) -> dict[str, Any]:
    """summary.json, or an empty dict where there is none or it is no JSON. Raises CaseError for one that no run has written."""
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError):
        return {}
    if not isinstance(content, dict):
        return {}
    require_summary(content, path)
    return content


def list_snapshots(folder: Path, case: dict[str, Any]) -> list[tuple[float, Path]]:
    """Times and files of the snapshots, from ice.pvd; where that is missing, from the files' numbers."""
    found: list[tuple[float, Path]] = []
    try:
        tree = ElementTree.parse(folder / "ice.pvd")
        for entry in tree.iter("DataSet"):
            found.append((float(entry.get("timestep", "nan")), folder / entry.get("file", "")))
    except (OSError, ElementTree.ParseError, ValueError, LookupError):  # LookupError: an encoding that Python does not know
        interval = float(case.get("output", {}).get("snapshot_interval", 1.0))
        for file in sorted((folder / "snapshots").glob("ice_*.vtu")):
            number = file.stem.removeprefix("ice_")
            if number.isdecimal() and len(number) < MOST_DIGITS:
                found.append((int(number) * interval, file))
    return sorted((time, file) for time, file in found if math.isfinite(time) and file.is_file())

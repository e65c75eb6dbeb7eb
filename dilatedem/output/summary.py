"""summary.json: what the run is, how far it got, its headline loads, what it ran on."""

import functools
import json
import math
import platform
from importlib import metadata

import numpy as np

from dilatedem.files.atomic import write_text

STATUSES = ("running", "completed", "interrupted", "stopped")
RECORDED_LIBRARIES = ("numpy", "numba", "llvmlite", "scipy", "shapely", "h5py", "meshio", "pydantic")


def write_summary(path, summary: dict) -> None:
    """Replace `path` by `summary` (nested dicts, lists, numbers, arrays, text, or functions that return such), atomically.

    Numbers that JSON has no word for (nan, infinity) become null. Raises ValueError for a status that is
    not in STATUSES.
    """
    if "status" in summary and summary["status"] not in STATUSES:
        raise ValueError(f"status {summary['status']!r} is none of {', '.join(STATUSES)}")
    write_json(path, summary)


def write_json(path, content: dict) -> None:
    """Replace `path` by `content` as indented JSON, atomically; see `write_summary` for what it may hold."""
    write_text(path, json.dumps(_plain(content), indent=2, allow_nan=False, ensure_ascii=False) + "\n")


@functools.cache
def versions() -> dict[str, str]:
    """Versions of Python and of the libraries that can change the numbers, without importing them."""
    found = {"python": platform.python_version()}
    for name in RECORDED_LIBRARIES:
        try:
            found[name] = metadata.version(name)
        except metadata.PackageNotFoundError:
            found[name] = "unknown"
    return found


def _plain(value):
    if isinstance(value, dict):
        return {str(key): _plain(entry) for key, entry in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(entry) for entry in value]
    if isinstance(value, np.ndarray | np.generic):
        return _plain(value.tolist())
    if callable(value):
        return _plain(value())
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if value is None or isinstance(value, bool | int | str):
        return value
    raise TypeError(f"summary entries are numbers, text, lists or dicts, not {type(value).__name__}")

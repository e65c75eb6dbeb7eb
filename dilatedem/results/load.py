"""The door: what a folder holds, as an object that reads its files when they are asked for."""

from __future__ import annotations

import os
from pathlib import Path

from dilatedem.errors import CaseError
from dilatedem.results.files import is_run, is_sweep
from dilatedem.results.run import Run
from dilatedem.results.sweep import Sweep


def load(folder: str | os.PathLike[str]) -> Run | Sweep:
    """The run or the sweep in `folder`. Raises CaseError for a folder that holds neither, or a case that cannot be read."""
    path = Path(folder)
    if is_sweep(path):
        return Sweep(path)
    if is_run(path):
        return Run(path)
    if not path.is_dir():
        raise CaseError(f"{path}: no such folder")
    raise CaseError(f"{path}: holds neither a run (there is no case.toml) nor a sweep (no sweep.csv)")

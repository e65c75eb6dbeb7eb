"""What it means that two run folders are the same run, and the command that makes one."""

import os
import subprocess
import sys
from pathlib import Path

import h5py
import numpy as np
from typer.testing import CliRunner

from dilatedem.cli import app
from dilatedem.output import checkpoint
from dilatedem.processes import children
from dilatedem.processes.children import Answer
from dilatedem.sweeps import fields, local

ROOT = Path(__file__).parents[2]
CASES = ROOT / "tests" / "cases"

#: the same bytes in two runs of one case, whatever the number of threads and however often it was resumed
EXACT = ("case.toml", "forces.csv", "hits.csv", "energy.csv", "bodies.csv", "ice.pvd", "structures.vtu")
#: the same, of runs with structures that move
MOVING = ("structures.csv", "structures.pvd")


def without_work(patch, work=lambda order, tell: Answer(0)) -> None:
    """Have `work` stand for what the processes of a sweep do with a case: nothing, and say that all went well, unless given."""
    patch.setattr(local, "simulate_here", work)
    patch.setattr(local.Local, "warm", lambda *_: None)
    patch.setattr(fields, "require_fields", lambda *_, **__: "")
    patch.setattr(children, "way_to_start", lambda: "fork")  # copies know the stand-in; the threads of pytest sleep


def command(*arguments) -> list[str]:
    return [sys.executable, "-m", "dilatedem.cli", *map(str, arguments)]


def environment() -> dict[str, str]:
    """The package of this tree, whatever is installed; the threads are those of tests/conftest.py."""
    return {**os.environ, "PYTHONPATH": str(ROOT)}


def dilatedem(*arguments) -> subprocess.CompletedProcess:
    """The command line in a process of its own."""
    return subprocess.run(command(*arguments), capture_output=True, text=True, env=environment(), check=False)


def in_process(*arguments):
    """The command line in this process, which has all modules and kernels already; `exit_code`, `stdout` and `stderr`."""
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


def assert_same_run(folder: Path, expected: Path) -> None:
    """Every byte of the tables and snapshots, and every number of run.h5 and of the saved state."""
    snapshots = sorted(path.relative_to(expected) for path in expected.glob("snapshots/*.vtu"))
    assert sorted(path.relative_to(folder) for path in folder.glob("snapshots/*.vtu")) == snapshots
    for name in MOVING:
        assert (folder / name).exists() == (expected / name).exists(), f"{name} is there in one of them alone"
    for name in (*EXACT, *(name for name in MOVING if (expected / name).exists()), *snapshots):
        assert (folder / name).read_bytes() == (expected / name).read_bytes(), f"{name} differs"
    for name, numbers in (("run.h5", datasets), ("restart.h5", saved)):
        found, wanted = numbers(folder / name), numbers(expected / name)
        assert found.keys() == wanted.keys()
        differing = [key for key in wanted if not same(found[key], wanted[key])]
        assert not differing, f"{name}: {differing} differ"


def same(found: np.ndarray, wanted: np.ndarray) -> bool:
    """Numbers, where NaN equals NaN, or names."""
    return np.array_equal(found, wanted, equal_nan=wanted.dtype.kind == "f")


def datasets(path: Path) -> dict[str, np.ndarray]:
    """All datasets of an HDF5 file."""
    found: dict[str, np.ndarray] = {}
    with h5py.File(path) as file:
        file.visititems(lambda name, item: found.update({name: item[()]}) if isinstance(item, h5py.Dataset) else None)
    return found


def saved(path: Path) -> dict[str, np.ndarray]:
    """All fields of a checkpoint."""
    groups, _ = checkpoint.load(path)
    return {f"{name}/{field}": value for name, fields in groups.items() for field, value in fields.items()}

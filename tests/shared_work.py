"""Work that several processes of one test session need: one of them does it, the others wait and take what it made."""

import fcntl
import hashlib
import os
import shutil
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from numba.core.caching import NullCache
from numba.core.dispatcher import Dispatcher


def common_folder(tmp_path_factory) -> Path:
    """A folder that all workers of a session share; that of the only process where there are no workers."""
    own = tmp_path_factory.getbasetemp()
    return own.parent if "PYTEST_XDIST_WORKER" in os.environ else own


@contextmanager
def turn(lock: Path, *, wait: bool = True) -> Iterator[bool]:
    """Hold the lock, a file, as the only process: whether that came true, where one does not wait for it."""
    lock.parent.mkdir(parents=True, exist_ok=True)
    with lock.open("w") as file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | (0 if wait else fcntl.LOCK_NB))
        except BlockingIOError:
            yield False
        else:
            yield True


def made_once(folder: Path, make: Callable[[Path], object]) -> Path:
    """The folder, made by the first process that asks for it; one that a failure left unfinished is made again."""
    with turn(folder.with_name(f"{folder.name}.lock")):
        if not folder.exists():
            begun = folder.with_name(f"{folder.name}.begun")
            shutil.rmtree(begun, ignore_errors=True)
            make(begun)
            begun.rename(folder)
    return folder


def share_out(jobs: dict[str, Callable[[], object]], folder: Path) -> None:
    """Do all jobs, each in the first process that comes to it; returns when all are done."""
    for name, job in jobs.items():
        done = folder / f"{name}.done"
        with turn(folder / f"{name}.lock", wait=False) as mine:
            if mine and not done.exists():
                job()
                done.touch()
    for name in jobs:
        with turn(folder / f"{name}.lock"):
            pass  # a job that failed elsewhere fails in the test that needs it


@contextmanager
def compiled_in_turn(locks: Path) -> Iterator[None]:
    """Have each kernel compiled for arguments of one kind by one process: who waited finds the machine code on disk."""
    compile = Dispatcher.compile

    def compile_in_turn(self, signature):
        if isinstance(self._cache, NullCache):  # what kernels call is compiled with them
            return compile(self, signature)
        # other arguments are another kernel: the step of one contact model need not wait for that of the other
        kind = hashlib.sha256(str(signature).encode()).hexdigest()[:16]
        with turn(locks / f"{self.py_func.__module__}.{self.py_func.__qualname__}-{kind}"):
            return compile(self, signature)

    Dispatcher.compile = compile_in_turn
    try:
        yield
    finally:
        Dispatcher.compile = compile

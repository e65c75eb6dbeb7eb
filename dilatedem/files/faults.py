"""What the disk refuses, in one sentence."""

import errno
import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager

#: faults after which the same command may go on once there is room again
FULL = frozenset({errno.ENOSPC, getattr(errno, "EDQUOT", errno.ENOSPC)})


def sentence(error: OSError) -> str:
    """Which file, and why."""
    if not error.errno:
        return str(error).partition("\n")[0] or type(error).__name__
    return f"{error.filename or 'output'}: {os.strerror(error.errno)}"  # not error.strerror: HDF5 puts a paragraph there


@contextmanager
def told_as(kind: type[Exception], way_on: Callable[[OSError], str] = lambda error: "") -> Iterator[None]:
    """Raise a fault of the disk as an exception of this kind, with its sentence and a way on."""
    try:
        yield
    except OSError as error:
        raise kind(sentence(error) + way_on(error)) from error

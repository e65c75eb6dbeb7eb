"""Files that are either the old one or the whole new one, whenever the process is killed."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path


@contextmanager
def replacing(path, *, durable: bool = False) -> Iterator[Path]:
    """Yield a temporary path beside `path`; after the block it takes the place of `path` in one step.

    If the block fails the temporary file is removed and the old file stays. A kill leaves a stale `*.tmp`,
    which the next write of the same file overwrites (its name is fixed for that reason). `durable` also
    forces the data to the disk before the exchange, so that after a power cut, too, there is either file as a whole: checkpoints
    pay for it, snapshots do not. The exchange is not forced: the old checkpoint is as good, and the system writes it in seconds.
    """
    path = Path(path)
    temporary = path.with_name(path.name + ".tmp")
    try:
        yield temporary
        if durable:
            _force_to_disk(temporary)
        os.replace(temporary, path)
    except BaseException as fault:
        temporary.unlink(missing_ok=True)
        if isinstance(fault, OSError) and fault.errno and not fault.filename:  # HDF5 names none
            fault.filename = str(path)
        raise


def write_text(path, text: str, *, durable: bool = False) -> None:
    """Replace the file `path` by `text`, UTF-8, atomically."""
    with replacing(path, durable=durable) as temporary:
        temporary.write_text(text, encoding="utf-8")


def _force_to_disk(path: Path) -> None:
    descriptor = os.open(path, os.O_RDONLY if os.name == "posix" else os.O_RDWR)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)

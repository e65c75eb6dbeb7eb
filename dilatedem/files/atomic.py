"""Files that are either the old one or the whole new one, whenever the process is killed."""

import os
from contextlib import suppress
from pathlib import Path

#: added to a file's name while it is written
TEMPORARY = ".tmp"
#: where the system knows it: a link that somebody laid in place of a file is an error, not a way to another file
NO_LINK = getattr(os, "O_NOFOLLOW", 0)


def write_bytes(path, data, *, durable: bool = False) -> None:
    """Replace the file `path` by `data`, bytes that are all there already, in one step.

    On a fault the old file stays, the temporary one beside it is removed, and the OSError names `path`. A kill leaves a stale
    `*.tmp`, which the next write of the same file overwrites (its name is fixed for that reason). `durable` also forces the data to
    the disk before the exchange, so that after a power cut, too, there is either file as a whole: checkpoints pay for it, snapshots
    do not. The exchange is not forced: the old checkpoint is as good, and the system writes it in seconds.
    """
    path = Path(path)
    temporary = path.with_name(path.name + TEMPORARY)
    begun = False
    try:
        descriptor = open_file(temporary, os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
        begun = True
        try:
            write_whole(descriptor, data)
            if durable:
                os.fsync(descriptor)
        finally:
            os.close(descriptor)
        os.replace(temporary, path)
    except BaseException as fault:
        if begun:
            with suppress(OSError):
                os.unlink(temporary)
        if isinstance(fault, OSError) and fault.errno:
            raise OSError(fault.errno, os.strerror(fault.errno), str(path)) from fault
        raise


def write_text(path, text: str, *, durable: bool = False) -> None:
    """Replace the file `path` by `text`, UTF-8, atomically; see `write_bytes`."""
    write_bytes(path, text.encode(), durable=durable)


def open_file(path, flags: int) -> int:
    """A descriptor of the file itself: a link in its place is refused (ELOOP)."""
    return os.open(path, flags | NO_LINK | getattr(os, "O_BINARY", 0), 0o666)


def write_whole(descriptor: int, data) -> None:
    """Write all of `data`: one call may take only a part of it (a signal, a nearly full disk)."""
    view = memoryview(data)
    while view:
        view = view[os.write(descriptor, view) :]

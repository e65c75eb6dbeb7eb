"""One process at a time works in a folder.

The lock is the system's (flock): it ends with the process, however that ends. Where a file system knows no locks, there are none.
"""

import os
import stat
from contextlib import suppress
from pathlib import Path

from dilatedem.errors import CaseError
from dilatedem.files.atomic import open_file, write_whole

try:
    import fcntl
except ImportError:  # Windows
    fcntl = None

#: the file in a folder whose lock is that of the folder
LOCK = ".dilatedem.lock"
#: times that a lock is tried whose file or folder is gone as soon as it was there
TRIES = 100
#: what it holds once something was written beside it
USED = b"dilatedem wrote into this folder; whoever locks this file works in it\n"


class Lock:
    """Within `with`, no other process gets the lock of this folder.

    The folder is made where it is missing. Unless `keep` was called, the end of the block leaves nothing that its beginning made.
    Raises CaseError if another process holds the lock, OSError for what the disk refuses.
    """

    def __init__(self, folder: Path):
        self._folder, self._path = Path(folder), Path(folder) / LOCK
        self._made: list[Path] = []
        self._kept = False

    def __enter__(self) -> "Lock":
        self._made = [path for path in (self._folder, *self._folder.parents) if not path.exists()]
        try:
            self._descriptor = self._locked()
        except BaseException:
            self._remove_folders()
            raise
        return self

    def __exit__(self, *exception) -> None:
        if self._new and not self._kept:
            with suppress(OSError):
                os.unlink(self._path)  # while it is locked: whoever opened it meanwhile sees that it is gone
            self._remove_folders()
        os.close(self._descriptor)

    def keep(self) -> None:
        """The folder is used: its lock file stays and says so."""
        self._kept = True
        if not os.fstat(self._descriptor).st_size:
            write_whole(self._descriptor, USED)

    def leave(self) -> None:
        """In a process that is a copy of the one that holds the lock: have no part in it, so that it ends with the other."""
        os.close(self._descriptor)

    def _locked(self) -> int:
        """The descriptor of the lock file."""
        for left in reversed(range(TRIES)):
            try:
                self._folder.mkdir(parents=True, exist_ok=True)
                self._new = not os.path.lexists(self._path)
                descriptor = open_file(self._path, os.O_RDWR | os.O_CREAT)
            except (FileNotFoundError, FileExistsError):  # its owner removed the folder in between, before or after a look at it
                if not left or _in_the_way(self._folder):
                    raise
                continue
            try:
                if not _lock(descriptor):
                    raise CaseError(f"{self._folder}: another process is at work in it; wait for its end or choose another --out")
                if _is_there(descriptor, self._path):
                    return descriptor
            except BaseException as fault:
                if self._new and not isinstance(fault, CaseError):
                    with suppress(OSError):
                        os.unlink(self._path)
                os.close(descriptor)
                raise
            os.close(descriptor)  # its owner removed the file in between
        raise CaseError(f"{self._folder}: other processes come and go in it; choose another --out")

    def _remove_folders(self) -> None:
        with suppress(OSError):
            for path in self._made:
                path.rmdir()


def was_used(folder: Path) -> bool:
    """Whether something was written into a folder under its lock."""
    try:
        found = os.lstat(folder / LOCK)
    except OSError:
        return False
    return stat.S_ISREG(found.st_mode) and found.st_size > 0


def in_use(folder: Path) -> bool:
    """Whether some process holds the lock of a folder."""
    try:
        descriptor = open_file(Path(folder) / LOCK, os.O_RDWR)  # network file systems lock no file that may only be read
    except OSError:
        return False
    try:
        return not _lock(descriptor)
    finally:
        os.close(descriptor)


def _lock(descriptor: int) -> bool:
    """Take the lock; False if another process holds it."""
    if fcntl:
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            return False
        except OSError:  # there are file systems without locks
            pass
    return True


def _in_the_way(folder: Path) -> bool:
    """Whether something that is no folder has its name, or that of one above it."""
    return any(os.path.lexists(path) and not path.is_dir() for path in (folder, *folder.parents))


def _is_there(descriptor: int, path: Path) -> bool:
    try:
        return os.path.samestat(os.fstat(descriptor), os.stat(path, follow_symlinks=False))
    except FileNotFoundError:
        return False

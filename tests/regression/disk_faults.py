"""A disk that refuses one call: every function by which Python asks the system for a file or a folder, counted and made to fail."""

import builtins
import io
import os
from collections.abc import Callable
from pathlib import Path

#: of module `os`: those that name a path, and those that take a descriptor
BY_PATH = ("open", "mkdir", "rmdir", "unlink", "replace", "stat", "lstat", "scandir", "listdir")
BY_DESCRIPTOR = ("write", "fsync", "ftruncate", "lseek", "fstat")

#: two floes and a pile: in 0.05 s there is something in every file, and a state is saved four times
CASE = """
[field]
source = "bodies"
[time]
duration = 0.05
[output]
snapshot_interval = 0.02
checkpoint_interval = 0.02
track = "all"
[[structure]]
kind = "pile"
center = [3.505, 1.0]
[[body]]
outline = [[0.0, 0.0], [1.5, 0.0], [1.5, 2.0], [0.0, 2.0]]
velocity = [0.5, 0.0, 0.0]
[[body]]
outline = [[-3.0, 0.0], [-1.0, 0.0], [-1.0, 2.0], [-3.0, 2.0]]
"""


class DiskFault:
    """Within `with`, call number `fails` (from 0; None for none) on a file under `folder` raises OSError `number`.

    count: calls so far; failed: the name of the one that did.
    """

    def __init__(self, folder: Path, number: int = 0, fails: int | None = None):
        self._folder, self._number, self._fails = str(folder), number, fails
        self._descriptors: set[int] = set()
        self._before: list[tuple] = []
        self.count, self.failed = 0, ""

    def __enter__(self) -> "DiskFault":
        for name in BY_PATH:
            self._wrap(os, name, self._names_folder)
        for name in BY_DESCRIPTOR:
            self._wrap(os, name, lambda descriptor, *more: descriptor in self._descriptors)
        for module in (io, builtins):
            self._wrap(module, "open", self._names_folder)
        close = os.close
        self._before.append((os, "close", close))
        os.close = lambda descriptor: (self._descriptors.discard(descriptor), close(descriptor))[1]
        return self

    def __exit__(self, *exception) -> None:
        while self._before:
            setattr(*self._before.pop())

    def _names_folder(self, path=".", *more) -> bool:
        if isinstance(path, int):
            return False
        text = os.fsdecode(path)
        return text == self._folder or text.startswith(self._folder + os.sep)

    def _wrap(self, module, name: str, concerns: Callable[..., bool]) -> None:
        call = getattr(module, name)

        def wrapped(*arguments, **more):
            concerned = concerns(*arguments)
            if concerned:
                self.count += 1
                if self.count - 1 == self._fails:
                    self.failed = name
                    # as the system tells it: a descriptor has no name
                    raise OSError(self._number, os.strerror(self._number), *([] if name in BY_DESCRIPTOR else arguments[:1]))
            found = call(*arguments, **more)
            if concerned and module is os and name == "open":
                self._descriptors.add(found)
            return found

        self._before.append((module, name, call))
        setattr(module, name, wrapped)

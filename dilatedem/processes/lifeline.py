"""Processes that end when the process that started them does, however that ends.

The parent holds one end of a pipe, of which every child has the other. When the parent is gone, the system closes its end, and the
children read that. What a parent can do in its last moment (signals, `atexit`) a SIGKILL would skip.
"""

import os
import signal
import threading
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any

#: the environment variable that tells a child which descriptor to read
NAME = "DILATEDEM_LIFELINE"


@contextmanager
def held() -> Iterator[int]:
    """Within `with`, children may be `given` the descriptor that this yields."""
    reading, writing = os.pipe()  # neither is inherited unless it is passed on: no child keeps another one alive
    try:
        yield reading
    finally:
        os.close(reading)
        os.close(writing)


def given(descriptor: int, environment: Mapping[str, str]) -> dict[str, Any]:
    """Arguments of subprocess.Popen that give a child this environment and the lifeline (where children inherit descriptors)."""
    if os.name != "posix":
        return {"env": dict(environment)}
    return {"env": {**environment, NAME: str(descriptor)}, "pass_fds": (descriptor,)}


def watch() -> None:
    """In a child: have this process told by SIGTERM that its parent is gone, so that a run saves its state.

    Without a parent that says so nothing is watched.
    """
    number = os.environ.pop(NAME, "")
    if number.isdigit():
        threading.Thread(target=_wait, args=(int(number),), daemon=True).start()


def _wait(descriptor: int) -> None:
    try:
        while os.read(descriptor, 1):
            pass
    except OSError:  # there is no such pipe
        return
    os.kill(os.getpid(), signal.SIGTERM)

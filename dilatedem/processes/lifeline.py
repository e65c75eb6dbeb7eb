"""Processes that end when the process that started them does, however that ends.

The parent holds one end of a pipe, of which every child has the other. When the parent is gone, the system closes its end, and the
children notice. What a parent can do in its last moment (signals, `atexit`) a SIGKILL would skip.
"""

import os
import signal
import threading
from multiprocessing.connection import Connection


def watch(line: Connection) -> None:
    """In a child: have this process told by SIGTERM that nobody holds the other end of `line` any more: a run saves its state."""
    threading.Thread(target=_wait, args=(line,), daemon=True).start()


def _wait(line: Connection) -> None:
    line.poll(None)  # nothing is ever sent
    os.kill(os.getpid(), signal.SIGTERM)

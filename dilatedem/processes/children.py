"""The processes of a sweep: one a case, told to stop when the sweep is, and gone when it is gone."""

import os
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from typing import Any

from dilatedem.errors import printable
from dilatedem.processes import lifeline
from dilatedem.processes.interruption import Interruption


class Children:
    """Cases that are running now, so that they can be told to stop.

    line : the descriptor of a lifeline (`lifeline.held`), which every case gets.
    """

    def __init__(self, line: int):
        self._line = line
        self._lock = threading.RLock()  # a signal may come while its thread has it
        self._running: set[subprocess.Popen] = set()
        self.stopping = False

    def run(self, command: Sequence[str], text: str) -> tuple[str, str, str] | None:
        """Runs a case, whose standard input is `text`, to its end: status, message, all it said. None where all are to stop."""
        environment = {**os.environ, "NUMBA_NUM_THREADS": "1"}
        with self._lock:
            if self.stopping:
                return None
            # A session of its own: a Ctrl-C in the terminal reaches the children through us, and once only.
            process = subprocess.Popen(
                command,
                stdin=subprocess.PIPE,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.PIPE,
                text=True,
                start_new_session=True,
                **lifeline.given(self._line, environment),
            )
            self._running.add(process)
        _, said = process.communicate(text)
        with self._lock:
            self._running.discard(process)
            stopped_by_us = self.stopping
        return *_outcome(process.returncode, said, stopped_by_us), said

    def interrupt(self) -> None:
        with self._lock:
            self.stopping = True
            for process in self._running:
                process.send_signal(signal.SIGINT)

    def kill(self) -> None:
        with self._lock:
            for process in self._running:
                process.kill()


@contextmanager
def heard(children: Children) -> Iterator[None]:
    """Within `with`, the first signal has the running cases save their state, the second one kills them, others change nothing.

    Batch systems end a job with SIGTERM, a terminal that is closed with SIGHUP: then, too, states shall be saved.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return

    def hear(number: int, frame: Any) -> None:
        if not children.stopping:
            say("stopping; the running cases save their state (Ctrl-C again: without saving)")
            children.interrupt()
        elif number != getattr(signal, "SIGHUP", None):
            children.kill()

    before = {number: signal.signal(number, hear) for number in Interruption.heard()}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def _outcome(code: int, said: str, stopped_by_us: bool) -> tuple[str, str]:
    """Status and message from what a process returned and wrote to standard error."""
    lines = [line.strip() for line in said.splitlines() if line.strip()]
    if code == 0:
        return "completed", ""
    if code == 130 or stopped_by_us:
        return "interrupted", "--resume goes on"
    if code == 3:
        return "stopped", "; ".join(lines)
    if code == 2:
        return "failed", "; ".join(lines)
    if code < 0:
        return "failed", f"killed by signal {-code}"
    return "failed", lines[-1] if lines else f"exit code {code}"


def say(text: str) -> None:
    with suppress(OSError):  # the terminal may be gone
        print(printable(text, keep="\n"), file=sys.stderr, flush=True)

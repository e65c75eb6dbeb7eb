"""The processes of a sweep: each runs one case after another, is told to stop when the sweep is, and gone when it is gone."""

import json
import os
import signal
import subprocess
import sys
import tempfile
import threading
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from typing import IO, Any

from dilatedem.errors import INTERRUPTED, STOPPED, WRONG, printable
from dilatedem.processes import lifeline
from dilatedem.processes.interruption import Interruption


class Children:
    """Processes of one command that carry out orders: a line of JSON to each, another one back with `code` and `said`.

    command : starts such a process. line : the descriptor of a lifeline (`lifeline.held`), which every one gets.
    """

    def __init__(self, command: Sequence[str], line: int):
        self._command = command
        self._environment = lifeline.given(line, {**os.environ, "NUMBA_NUM_THREADS": "1"})
        self._lock = threading.RLock()  # a signal may come while its thread has it
        self._idle: list[_Child] = []
        self._busy: set[_Child] = set()
        self.stopping = False

    def prepare(self, count: int) -> None:
        """Start so many: they load what they need while nothing is asked of them."""
        self._idle = [_Child(self._command, self._environment) for _ in range(count)]

    def run(self, order: dict[str, Any]) -> tuple[str, str, str] | None:
        """Has an order carried out: status, message, all that was said. None where all are to stop."""
        with self._lock:
            if self.stopping:
                return None
            child = self._idle.pop() if self._idle else _Child(self._command, self._environment)
            self._busy.add(child)
        code, said = child.answer(order)
        with self._lock:
            self._busy.discard(child)
            stopped_by_us = self.stopping
            goes_on = child.is_alive and not self.stopping
            if goes_on:
                self._idle.append(child)
        if not goes_on:
            child.dismiss()
        return *_outcome(code, said, stopped_by_us), said

    def dismiss(self) -> None:
        """Nothing more is asked of those that wait."""
        with self._lock:
            while self._idle:
                self._idle.pop().dismiss()

    def interrupt(self) -> None:
        with self._lock:
            self.stopping = True
            for child in self._busy:
                child.process.send_signal(signal.SIGINT)

    def kill(self) -> None:
        with self._lock:
            for child in self._busy:
                child.process.kill()


class _Child:
    """One process, and what it writes where nobody answers: its last words."""

    def __init__(self, command: Sequence[str], environment: dict[str, Any]):
        self._words: IO[bytes] = tempfile.TemporaryFile()
        # A session of its own: a Ctrl-C in the terminal reaches the children through us, and once only.
        self.process = subprocess.Popen(
            command,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self._words,
            text=True,
            start_new_session=True,
            **environment,
        )

    @property
    def is_alive(self) -> bool:
        return self.process.poll() is None

    def answer(self, order: dict[str, Any]) -> tuple[int, str]:
        """Exit code of an order and what was said; those of the process where that ends instead."""
        with suppress(OSError):  # it is gone: it says why
            print(json.dumps(order), file=self.process.stdin, flush=True)
        if line := self.process.stdout.readline():
            answer = json.loads(line)
            return answer["code"], answer["said"]
        code = self.process.wait()
        self._words.seek(0)
        return code, self._words.read().decode(errors="replace")

    def dismiss(self) -> None:
        """Have it end, and wait for that."""
        with suppress(OSError):
            self.process.stdin.close()
        self.process.wait()
        self.process.stdout.close()
        self._words.close()


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
    if code == INTERRUPTED or stopped_by_us:
        return "interrupted", "--resume goes on"
    if code == STOPPED:
        return "stopped", "; ".join(lines)
    if code == WRONG:
        return "failed", "; ".join(lines)
    if code < 0:
        return "failed", f"killed by signal {-code}"
    return "failed", lines[-1] if lines else f"exit code {code}"


def say(text: str) -> None:
    with suppress(OSError):  # the terminal may be gone
        print(printable(text, keep="\n"), file=sys.stderr, flush=True)

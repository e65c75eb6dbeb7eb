"""The processes of one command, made from it with all that it has loaded: each carries out one order after another.

They are told to stop when the command is, and gone when it is gone; one that dies takes its present order with it and no other.
"""

import gc
import multiprocessing
import os
import signal
import sys
import tempfile
import threading
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from multiprocessing.connection import Connection, wait
from multiprocessing.process import BaseProcess
from pathlib import Path
from typing import Any, NamedTuple

from dilatedem.errors import INTERRUPTED
from dilatedem.processes import lifeline
from dilatedem.processes.interruption import Interruption

#: s after which whoever waits for children may look around, at the latest
TICK_S = 0.5


class Answer(NamedTuple):
    """How an order ended: the exit code that a command would end with, and what it would have said to standard error."""

    code: int
    said: str = ""


def way_to_start() -> str:
    """`fork`, a copy of this process as it stands, where that is safe: on Linux, with no other thread of Python, whose locks
    nobody would open in the copy. Elsewhere `spawn`: a process that imports and loads everything by itself."""
    return "fork" if sys.platform == "linux" and threading.active_count() == 1 else "spawn"


class Children:
    """So many processes, started as orders come.

    work : in a child, work(order, tell) carries out an order and returns its Answer; tell(anything) lets the parent know meanwhile.
    leave : called in each child that is a copy of this process: what it must not share with its parent (locks).
    """

    #: why orders are left that nobody carries out any more; never, of processes of this machine
    fault = ""

    def __init__(self, work: Callable[[Any, Callable], Answer], count: int, *, leave: Callable[[], None] = lambda: None):
        self.stopping = False
        self._work, self._count, self._leave = work, count, leave
        self._context = multiprocessing.get_context(way_to_start())
        self._idle: list[_Child] = []
        self._busy: dict[Connection, tuple[_Child, int]] = {}

    def __enter__(self) -> "Children":
        self._line, self._held = self._context.Pipe(duplex=False)
        self._words = tempfile.TemporaryDirectory(prefix="dilatedem-", ignore_cleanup_errors=True)
        self._started = 0
        return self

    def __exit__(self, kind, *exception) -> None:
        """Nothing more is asked; after a fault, those that are at work save their state."""
        if self._busy:
            self.interrupt()
        for child in (*self._idle, *(child for child, _ in self._busy.values())):
            child.dismiss()
        self._line.close()
        self._held.close()
        self._words.cleanup()

    def carry_out(self, orders: Sequence[Any], tell: Callable[..., None]) -> Iterator[tuple[int, Answer]]:
        """The answers as they come, each with the number of its order; those that have not begun when all are to stop get none.

        tell(number, what) : called with what a child lets know, and without arguments now and then.
        """
        waiting = deque(enumerate(orders))
        while self._busy or (waiting and not self.stopping):
            while waiting and len(self._busy) < self._count and not self.stopping:
                self._ask(*waiting.popleft())
            for connection in wait(list(self._busy), TICK_S):
                child, number = self._busy[connection]
                told = child.hear()
                if isinstance(told, Answer):
                    del self._busy[connection]
                    self._put_away(child)
                    yield number, told
                else:
                    tell(number, told)
            tell()

    def interrupt(self) -> None:
        """Have the running orders end as Ctrl-C would, and no other begin."""
        self.stopping = True
        for child, _ in self._busy.values():
            with suppress(OSError):  # it is gone
                os.kill(child.process.pid, signal.SIGINT)

    def kill(self) -> None:
        for child, _ in self._busy.values():
            child.process.kill()

    def _ask(self, number: int, order: Any) -> None:
        child = self._idle.pop() if self._idle else self._start()
        self._busy[child.connection] = child, number
        child.ask(order)

    def _start(self) -> "_Child":
        self._started += 1
        ours, theirs = self._context.Pipe()
        ends = [self._held, ours, *(child.connection for child in self._idle), *self._busy]

        def leave() -> None:
            self._leave()
            for end in ends:  # with copies of them, no child would see that the parent is gone
                end.close()

        words = Path(self._words.name, str(self._started))
        copied = self._context.get_start_method() == "fork"
        process = self._context.Process(
            target=_serve, args=(self._work, theirs, self._line, leave if copied else None, words), daemon=True
        )
        with _signals_wait():
            process.start()
        theirs.close()
        return _Child(process, ours, words)

    def _put_away(self, child: "_Child") -> None:
        if child.process.is_alive() and not self.stopping:
            self._idle.append(child)
        else:
            child.dismiss()


class _Child:
    """One process; `words`: the file for what it writes where nobody answers, its last words."""

    def __init__(self, process: BaseProcess, connection: Connection, words: Path):
        self.process, self.connection, self._words = process, connection, words

    def ask(self, order: Any) -> None:
        with suppress(OSError):  # it is gone: `hear` says so
            self.connection.send(order)

    def hear(self) -> Any:
        """What it has to tell: an Answer to its order, or what it lets know before that."""
        try:
            return self.connection.recv()
        except (EOFError, OSError):
            self.process.join()
            said = self._words.read_text(errors="replace") if self._words.exists() else ""
            return Answer(self.process.exitcode, said)

    def dismiss(self) -> None:
        """Have it end, and wait for that."""
        self.connection.close()
        self.process.join()
        with suppress(OSError):
            self._words.unlink(missing_ok=True)


def _serve(work: Callable, connection: Connection, line: Connection, leave: Callable[[], None] | None, words: Path) -> None:
    """What a child does: orders, until there are no more."""
    if leave:
        leave()
        gc.freeze()  # what it has of its parent is no garbage, and stays one copy in memory
    _stand_alone(words)
    lifeline.watch(line)
    try:
        while True:
            order = connection.recv()
            connection.send(work(order, lambda what: _let_know(connection, what)))
            gc.collect()
    except (EOFError, OSError):  # dismissed, or the parent is gone
        return
    except KeyboardInterrupt:  # between two orders
        sys.exit(INTERRUPTED)


def _let_know(connection: Connection, what: Any) -> None:
    with suppress(OSError):  # the parent is gone: the lifeline ends the work
        connection.send(what)


def _stand_alone(words: Path) -> None:
    """Hear what the parent says and nothing else: a Ctrl-C in the terminal comes through the parent, and once only."""
    if hasattr(os, "setsid"):
        os.setsid()
    for number in Interruption.heard():
        signal.signal(number, signal.default_int_handler if number == signal.SIGINT else signal.SIG_DFL)
    if hasattr(signal, "pthread_sigmask"):
        signal.pthread_sigmask(signal.SIG_UNBLOCK, Interruption.SIGNALS)
    descriptor = os.open(words, os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o600)
    for stream in (1, 2):
        os.dup2(descriptor, stream)
    os.close(descriptor)


@contextmanager
def _signals_wait() -> Iterator[None]:
    """Within `with`, signals wait: a process that is being made would hear them as its parent does."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, Interruption.SIGNALS)
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


@contextmanager
def heard(workers, say: Callable[[str], None]) -> Iterator[None]:
    """Within `with`, the first signal has the running orders save their state, the second one kills them, others change nothing.

    workers : Children, or what can be stopped like them. say : called in the midst of whatever the program does.
    Batch systems end a job with SIGTERM, a terminal that is closed with SIGHUP: then, too, states shall be saved.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return

    def hear(number: int, frame: Any) -> None:
        if not workers.stopping:
            say("stopping; the running cases save their state (Ctrl-C again: without saving)")
            workers.interrupt()
        elif number != getattr(signal, "SIGHUP", None):
            workers.kill()

    before = {number: signal.signal(number, hear) for number in Interruption.heard()}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)

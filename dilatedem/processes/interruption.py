"""Ctrl-C, SIGTERM and SIGHUP, heard between two calls of the kernels instead of in the middle of one."""

import signal
import threading

from dilatedem.processes.interrupts import end_at_once


class Interruption:
    """Within `with`, the first signal only sets `asked`; a second one ends the program at once, as a kill would.

    SIGHUP, which a terminal sends when it is closed, sets `asked` however often it comes: shell and system may both send it. A
    program that was told to outlive its terminal (nohup) does not hear it.
    """

    SIGNALS = (signal.SIGINT, signal.SIGTERM, *([signal.SIGHUP] if hasattr(signal, "SIGHUP") else []))
    #: a shell adds the signal's number to it
    EXIT_CODE = 128

    def __init__(self):
        self.asked = False
        self._before: dict = {}

    def __enter__(self) -> "Interruption":
        if threading.current_thread() is threading.main_thread():  # Python lets no other thread set handlers
            self._before = {number: signal.signal(number, self._hear) for number in self.heard()}
        return self

    @classmethod
    def heard(cls) -> list[signal.Signals]:
        """The signals that this program listens to."""
        return [number for number in cls.SIGNALS if not _outlived(number)]

    def __exit__(self, *exception) -> None:
        while self._before:
            signal.signal(*self._before.popitem())

    def _hear(self, number, frame) -> None:
        if self.asked and not _is_hangup(number):
            end_at_once(self.EXIT_CODE + number)  # an exception could meet any line, those included that write its traceback
        self.asked = True


def _is_hangup(number) -> bool:
    return number == getattr(signal, "SIGHUP", None)


def _outlived(number) -> bool:
    return _is_hangup(number) and signal.getsignal(number) == signal.SIG_IGN

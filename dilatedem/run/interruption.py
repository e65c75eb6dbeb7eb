"""Ctrl-C and SIGTERM, heard between two calls of the kernels instead of in the middle of one."""

import signal
import threading


class Interruption:
    """Within `with`, the first signal only sets `asked`; a second one ends the program at once."""

    SIGNALS = (signal.SIGINT, signal.SIGTERM)

    def __init__(self):
        self.asked = False
        self._before: dict = {}

    def __enter__(self) -> "Interruption":
        if threading.current_thread() is threading.main_thread():  # Python lets no other thread set handlers
            self._before = {number: signal.signal(number, self._hear) for number in self.SIGNALS}
        return self

    def __exit__(self, *exception) -> None:
        self._restore()

    def _hear(self, number, frame) -> None:
        self.asked = True
        self._restore()

    def _restore(self) -> None:
        while self._before:
            signal.signal(*self._before.popitem())

"""Files that are written beside the steps: in a thread of their own, in the order in which they were handed over."""

from collections import deque
from concurrent.futures import Future, ThreadPoolExecutor

#: calls that may wait: a disk that is slower than the steps slows them down instead of filling the memory
MOST = 8


class Background:
    """Makes calls while kernels run: packing a snapshot and writing a checkpoint take longer than what they hold takes to copy.

    What is handed over must not change afterwards. A fault of a call is raised at the next `put` or `wait`, and no call after it is
    made: a checkpoint must not follow on rows that did not reach the disk.
    """

    def __init__(self):
        self._failed = False
        self._thread = ThreadPoolExecutor(1)
        self._calls: deque[Future] = deque()

    def put(self, call, *arguments) -> None:
        """Have call(*arguments) made after all that was handed over before."""
        while self._calls and (self._calls[0].done() or len(self._calls) >= MOST):
            self._calls.popleft().result()
        self._calls.append(self._thread.submit(self._make, call, *arguments))

    def _make(self, call, *arguments) -> None:
        if not self._failed:
            self._failed = True  # unless it comes to its end
            call(*arguments)
            self._failed = False

    def wait(self) -> None:
        """Come back when all calls have been made."""
        while self._calls:
            self._calls.popleft().result()

    def close(self) -> None:
        try:
            self.wait()
        finally:
            self._thread.shutdown()

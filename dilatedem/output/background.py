"""Files that are written beside the steps: in a thread of their own, in the order in which they were handed over."""

from collections import deque
from concurrent.futures import Future, ThreadPoolExecutor

#: calls that may wait: a disk that is slower than the steps slows them down instead of filling the memory
MOST = 4


class Background:
    """Makes calls while kernels run: packing a snapshot and writing a checkpoint take longer than what they hold takes to copy.

    What is handed over must not change afterwards. A fault of a call is raised at the next `put` or `wait`, and calls after it are
    still made.
    """

    def __init__(self):
        self._thread = ThreadPoolExecutor(1)
        self._calls: deque[Future] = deque()

    def put(self, call, *arguments) -> None:
        """Have call(*arguments) made after all that was handed over before."""
        while self._calls and (self._calls[0].done() or len(self._calls) >= MOST):
            self._calls.popleft().result()
        self._calls.append(self._thread.submit(call, *arguments))

    def wait(self) -> None:
        """Come back when all calls have been made."""
        while self._calls:
            self._calls.popleft().result()

    def close(self) -> None:
        try:
            self.wait()
        finally:
            self._thread.shutdown()

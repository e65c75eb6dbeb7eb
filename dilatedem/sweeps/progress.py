"""What the user sees while a sweep is under way: runs done, failed and running, and the time left."""

import sys
import time
from collections.abc import Callable
from typing import TextIO

from dilatedem.errors import printable
from dilatedem.output.progress import BAR_INTERVAL_S, Bar, wall_time

#: s of wall time between two plain lines where there is no terminal; the end of a run has a line of its own
LINE_INTERVAL_S = 30.0
#: share of one run that must have been done before the time left is told
LEAST_DONE = 0.01


class Progress:
    """Of `count` runs: a bar on a terminal, plain lines elsewhere. Time left: by the mean pace since the first word of a run."""

    def __init__(self, count: int, *, stream: TextIO | None = None, clock: Callable[[], float] = time.monotonic):
        self._count, self._stream, self._clock = count, sys.stderr if stream is None else stream, clock
        self._bar: Bar | None = None
        self._shares: dict[int, float] = {}  # of the runs under way
        self._before: dict[int, float] = {}  # what of each was there when it was first heard of
        self._ended = self._failed = 0
        self._later: list[str] = []
        self._began = self._shown = clock()

    def __enter__(self) -> "Progress":
        if self._count and self._stream.isatty():
            self._tell(self._draw_bar)
            self._show()
        return self

    def __exit__(self, *exception) -> None:
        if self._bar is not None:
            self._tell(self._bar.stop)

    def tell(self, number: int | None = None, share: float = 0.0) -> None:
        """Run `number` has come to a share of its duration; without arguments: time has passed."""
        while self._later:
            self.message(self._later.pop(0))
        if number is not None:
            if not self._before and not self._ended:
                self._began = self._clock()
            self._before.setdefault(number, share)
            self._shares[number] = share
        if self._clock() - self._shown >= (LINE_INTERVAL_S if self._bar is None else BAR_INTERVAL_S):
            self._show()

    def ended(self, number: int, text: str, *, failed: bool) -> None:
        """A run is over; text: how, in a line."""
        self._shares.pop(number, None)
        self._ended += 1
        self._failed += failed
        self.message(f"[{self._ended}/{self._count}] {text}")
        if self._bar is not None:
            self._show()

    def message(self, text: str) -> None:
        """Print a line of its own, above the bar if there is one."""
        self._tell(self._bar.message if self._bar is not None else self._line, printable(text, keep="\n"))

    def later(self, text: str) -> None:
        """Have a line printed with the next word of a run: a signal may come while another one is."""
        self._later.append(text)

    @property
    def figures(self) -> str:
        """How far the sweep is, in words."""
        words = [f"{self._ended} of {self._count} runs done"]
        words += [f"{self._failed} not completed"] if self._failed else []
        words += [f"{len(self._shares)} under way"] if self._shares else []
        return ", ".join([*words, self._left()])

    def _left(self) -> str:
        done = self._ended + sum(self._shares.values())
        here = done - sum(self._before.values())
        if here < LEAST_DONE:
            return "time left unknown"
        return f"{wall_time((self._count - done) / here * (self._clock() - self._began))} left"

    def _show(self) -> None:
        self._shown = self._clock()
        if self._bar is not None:
            self._tell(self._bar.draw, self._ended + sum(self._shares.values()), self.figures)
        else:
            self._tell(self._line, self.figures)

    def _tell(self, call: Callable, *arguments) -> None:
        """Show something. A terminal that was closed is no fault of the sweep: it goes on in silence."""
        try:
            call(*arguments)
        except OSError:
            self._bar = None

    def _draw_bar(self) -> None:
        self._bar = Bar(self._stream, self._count)

    def _line(self, text: str) -> None:
        print(text, file=self._stream, flush=True)

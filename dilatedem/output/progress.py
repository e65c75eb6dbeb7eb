"""What the user sees while a run is under way."""

import sys
import time
from collections import deque
from collections.abc import Callable
from typing import TextIO

BAR_INTERVAL_S = 0.1  # wall time between two drawings of the bar: smooth to the eye, nothing beside a run
LINE_INTERVAL_S = 10.0  # wall time between two plain lines where there is no terminal
SAMPLE_INTERVAL_S = 0.5  # wall time between the samples that rates are taken from
SAMPLE_COUNT = 41  # rates are means over the last 20 s: a jam slows a run, and the forecast has to follow


class Progress:
    """Simulated time, wall time left, steps/s and contacts: a bar, plain lines off a terminal, or nothing.

    duration_s  end of the simulated time [s]
    quiet       show nothing at all
    stream      where to (standard error unless given: standard output stays free for results)
    clock       wall clock [s], exchanged in tests

    Rates count from the first `update`, so call it once before the first step: compiling is not stepping.
    """

    def __init__(
        self,
        duration_s: float,
        quiet: bool = False,
        *,
        stream: TextIO | None = None,
        clock: Callable[[], float] = time.monotonic,
    ):
        self._duration_s = duration_s
        self._quiet = quiet
        self._stream = sys.stderr if stream is None else stream
        self._clock = clock
        self._samples: deque[tuple[float, float, int]] = deque(maxlen=SAMPLE_COUNT)
        self._shown_at: float | None = None
        self._latest: tuple[float, int, Callable[[], int]] | None = None
        self._bar = None

    def __enter__(self) -> "Progress":
        if not self._quiet and self._stream.isatty():
            self._tell(self._draw_bar)
        return self

    def __exit__(self, *exception) -> None:
        if self._latest is not None and not self._quiet:
            self._show(self._clock())
        if self._bar is not None:
            self._tell(self._bar.stop)

    def update(self, time_s: float, steps: int, contacts: Callable[[], int]) -> None:
        """Tell how far the run is: simulated time [s], steps so far, how to count the contacts of now.

        Cheap: call it often. They are counted when they are shown.
        """
        if self._quiet:
            return
        now = self._clock()
        self._latest = (time_s, steps, contacts)
        if not self._samples or now - self._samples[-1][0] >= SAMPLE_INTERVAL_S:
            self._samples.append((now, time_s, steps))
        interval = LINE_INTERVAL_S if self._bar is None else BAR_INTERVAL_S
        if self._shown_at is None:
            # Off a terminal the first line comes after the first interval: a short run prints one, not two.
            self._shown_at = now
            if self._bar is not None:
                self._show(now)
        elif now - self._shown_at >= interval:
            self._show(now)

    def message(self, text: str) -> None:
        """Print a line of its own, above the bar if there is one."""
        if self._quiet:
            return
        self._tell(self._bar.message if self._bar is not None else self._line, text)

    def _show(self, now: float) -> None:
        self._shown_at = now
        time_s, steps, contacts = self._latest
        speed, step_rate = self._rates(now)
        remaining = self._duration_s - time_s
        if remaining <= 0.0:
            left = "done"
        else:
            left = f"{wall_time(remaining / speed)} left" if speed > 0.0 else "time left unknown"
        reached = f"{time_s:.2f} of {self._duration_s:g} s"
        figures = f"{reached}, {left}, {step_rate:,.0f} steps/s, {contacts()} contacts"
        if self._bar is not None:
            self._tell(self._bar.draw, time_s, figures)
        else:
            self._tell(self._line, figures)

    def _tell(self, call: Callable, *arguments) -> None:
        """Show something. A terminal that was closed or a pipe that nobody reads is no fault of the run: it goes on in silence."""
        try:
            call(*arguments)
        except OSError:
            self._quiet, self._bar = True, None

    def _draw_bar(self) -> None:
        self._bar = Bar(self._stream, self._duration_s)

    def _line(self, text: str) -> None:
        print(text, file=self._stream, flush=True)

    def _rates(self, now: float) -> tuple[float, float]:
        """Simulated seconds and steps per second of wall time, over the samples kept."""
        since, time_then, steps_then = self._samples[0]
        wall = now - since
        if wall <= 0.0:
            return 0.0, 0.0
        time_s, steps, _ = self._latest
        return (time_s - time_then) / wall, (steps - steps_then) / wall


class Bar:
    """rich's bar, drawn only when told to: its own thread would compete with the kernels for a core."""

    def __init__(self, stream: TextIO, total: float):
        from rich import progress
        from rich.console import Console
        from rich.table import Column

        self._console = Console(file=stream, highlight=False)
        self._progress = progress.Progress(
            progress.BarColumn(bar_width=16),
            progress.TextColumn("{task.fields[figures]}", markup=False, table_column=Column(no_wrap=True)),
            console=self._console,
            auto_refresh=False,
        )
        self._task = self._progress.add_task("", total=total, figures="")
        self._progress.start()

    def draw(self, done: float, figures: str) -> None:
        self._progress.update(self._task, completed=done, figures=figures, refresh=True)

    def message(self, text: str) -> None:
        self._progress.console.print(text, markup=False, highlight=False)

    def stop(self) -> None:
        self._progress.stop()


def wall_time(seconds: float) -> str:
    """5 s, 2:05 or 1:02:05."""
    seconds = int(round(seconds))
    if seconds < 60:
        return f"{seconds} s"
    minutes, seconds = divmod(seconds, 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02d}:{seconds:02d}" if hours else f"{minutes}:{seconds:02d}"

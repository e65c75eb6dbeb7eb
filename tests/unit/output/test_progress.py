import io

import pytest

from dilatedem.output.progress import Progress, wall_time


class Terminal(io.StringIO):
    def isatty(self):
        return True


class Clock:
    now = 100.0

    def __call__(self):
        return self.now


def run(stream, quiet=False, wall_per_update=1.0, updates=25):
    """25 updates, one a second of wall time, each 1 s of simulated time and 1000 steps."""
    clock = Clock()
    with Progress(100.0, quiet, stream=stream, clock=clock) as progress:
        for i in range(updates + 1):
            progress.update(float(i), 1000 * i, lambda: 12)
            clock.now += wall_per_update
        progress.message("checkpoint [written]")
    return stream.getvalue()


def test_plain_lines_now_and_then():
    # The last one on leaving, one idle second after the last update.
    lines = run(io.StringIO()).splitlines()
    assert lines == [
        "10.00 of 100 s, 1:30 left, 1,000 steps/s, 12 contacts",
        "20.00 of 100 s, 1:20 left, 1,000 steps/s, 12 contacts",
        "checkpoint [written]",
        "25.00 of 100 s, 1:18 left, 962 steps/s, 12 contacts",
    ]


def test_resumed_run_counts_from_where_it_went_on():
    clock = Clock()
    stream = io.StringIO()
    with Progress(100.0, stream=stream, clock=clock) as progress:
        progress.update(90.0, 900_000, lambda: 0)
        clock.now += 10.0
        progress.update(95.0, 950_000, lambda: 0)
    assert stream.getvalue().splitlines()[0] == "95.00 of 100 s, 10 s left, 5,000 steps/s, 0 contacts"


def test_end_says_done():
    clock = Clock()
    stream = io.StringIO()
    with Progress(1.0, stream=stream, clock=clock) as progress:
        progress.update(0.0, 0, lambda: 0)
        clock.now += 2.0
        progress.update(1.0, 100, lambda: 3)
    assert stream.getvalue() == "1.00 of 1 s, done, 50 steps/s, 3 contacts\n"


def test_bar_on_a_terminal(monkeypatch):
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setenv("COLUMNS", "120")
    shown = run(Terminal())
    assert "25.00 of 100 s" in shown and "12 contacts" in shown and "checkpoint [written]" in shown


@pytest.mark.parametrize("stream", [io.StringIO(), Terminal()])
def test_quiet_is_silent(stream):
    assert run(stream, quiet=True) == ""


def test_nothing_to_show_without_an_update():
    stream = io.StringIO()
    with Progress(1.0, stream=stream):
        pass
    assert stream.getvalue() == ""


@pytest.mark.parametrize(("seconds", "text"), [(4.6, "5 s"), (125, "2:05"), (3725, "1:02:05")])
def test_wall_time(seconds, text):
    assert wall_time(seconds) == text

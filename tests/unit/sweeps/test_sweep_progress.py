"""The progress of a sweep: what is done, what failed, and a time left that follows from the pace."""

import io

from dilatedem.sweeps.progress import Progress


class Clock:
    now = 0.0

    def __call__(self) -> float:
        return self.now


def lines(stream: io.StringIO) -> list[str]:
    return stream.getvalue().splitlines()


def test_time_left_is_that_of_the_pace_since_the_first_word():
    stream, clock = io.StringIO(), Clock()
    with Progress(10, stream=stream, clock=clock) as progress:
        clock.now = 100.0  # machine code was compiled
        progress.tell(0, 0.0)
        progress.tell(1, 0.0)
        assert progress.figures == "0 of 10 runs done, 2 under way, time left unknown"
        clock.now = 150.0
        progress.tell(0, 0.5)
        progress.tell(1, 0.5)
        assert progress.figures == "0 of 10 runs done, 2 under way, 7:30 left"  # a run in 50 s, nine to do
        clock.now = 200.0
        progress.ended(0, "a: completed", failed=False)
        progress.ended(1, "b: failed: a bug", failed=True)
        assert progress.figures == "2 of 10 runs done, 1 not completed, 6:40 left"
    assert [line for line in lines(stream) if line.startswith("[")] == ["[1/10] a: completed", "[2/10] b: failed: a bug"]


def test_what_a_resumed_run_had_before_is_no_work_of_this_sweep():
    clock = Clock()
    progress = Progress(1, stream=io.StringIO(), clock=clock)
    progress.tell(0, 0.8)
    clock.now = 10.0
    progress.tell(0, 0.9)
    assert progress.figures == "0 of 1 runs done, 1 under way, 10 s left"


def test_a_line_every_half_minute_and_what_a_signal_says_with_the_next_word():
    stream, clock = io.StringIO(), Clock()
    progress = Progress(2, stream=stream, clock=clock)
    for second in range(95):
        clock.now = float(second)
        progress.tell()
        if second == 10:
            progress.later("stopping")
    assert len(lines(stream)) == 4 and lines(stream)[0] == "stopping"
    assert lines(stream)[1] == "0 of 2 runs done, time left unknown"

import math

import pytest

from dilatedem.output.schedule import Schedule
from dilatedem.state.clock import NEVER


def due_steps(schedule, last):
    step, steps = -1, []
    while (step := schedule.next_due(step)) <= last:
        steps.append(step)
    return steps


@pytest.mark.parametrize(
    ("interval", "dt", "first"),
    [
        (1.0, 0.25, [0, 4, 8, 12]),
        (0.3, 0.1, [0, 3, 6, 9, 12]),  # 0.3 / 0.1 is 2.9999999999999996: not a step too late
        (0.1, 0.03, [0, 4, 7, 10]),
        (0.01, 0.04, list(range(14))),  # shorter than a step: every step, once
    ],
)
def test_due_steps(interval, dt, first):
    assert due_steps(Schedule(interval, dt), 13)[: len(first)] == first


def test_is_due_agrees_with_the_definition():
    schedule = Schedule(0.0137, 0.0021)
    due = {math.ceil(k * 0.0137 / 0.0021 - 1e-9) for k in range(400)}
    for step in range(2000):
        assert schedule.is_due(step) == (step in due)
        assert schedule.events_until(step) == sum(d <= step for d in due)


def test_long_run_stays_on_time():
    # Ten million steps: sums of 1e-5 would be off by more than a step by now.
    schedule = Schedule(0.01, 1e-5)
    assert schedule.next_due(9_999_999) == 10_000_000
    assert schedule.next_due(10_000_000) == 10_001_000
    assert schedule.events_until(10_000_000) == 10_001


@pytest.mark.parametrize(("interval", "dt", "span"), [(0.0137, 0.0021, 1), (0.01, 1.2987e-4, 7), (1e-3, 4e-4, 16), (0.3, 0.1, 1)])
@pytest.mark.parametrize("since", [-1, 0, 41, 1000])
def test_due_steps_come_in_one_go_as_one_by_one(interval, dt, span, since):
    schedule, one_by_one, step = Schedule(interval, dt, span), [], since
    together = schedule.due_after(since, 300)
    assert len(together) == 300 or (interval < span * dt and len(together) > 10)
    for _ in together:
        step = schedule.next_due(step)
        one_by_one.append(step)
    assert together.tolist() == one_by_one


def test_interval_zero_is_never():
    schedule = Schedule(0.0, 0.1)
    assert schedule.next_due(-1) == NEVER and len(schedule.due_after(-1, 5)) == 0
    assert not schedule.is_due(0)
    assert schedule.events_until(10**9) == 0


@pytest.mark.parametrize(("interval", "dt"), [(-1.0, 0.1), (math.nan, 0.1), (1.0, 0.0), (math.inf, 0.1)])
def test_senseless_times_are_refused(interval, dt):
    with pytest.raises(ValueError, match="seconds"):
        Schedule(interval, dt)

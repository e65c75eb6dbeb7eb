"""How many threads of a run work at a time: what is tried and chosen, and that no number depends on it."""

from pathlib import Path

import numpy as np
import pytest

from dilatedem.jit import start_threads
from dilatedem.run.crew import LATE_S, SOON_S, Crew
from dilatedem.run.simulation import Simulation

CROWDED = Path(__file__).parents[2] / "cases" / "crowded.toml"


def worked(crew: Crew, cost, seconds: float, steps: int = 500) -> list[tuple[float, int]]:
    """Time and number of threads of each call of so many steps in a run that takes so long, a step cost(time, threads) seconds."""
    now, calls = 0.0, []
    while now < seconds:
        calls.append((now, crew.now))
        spent = steps * cost(now, crew.now)
        crew.took(steps, spent)
        now += spent
    return calls


@pytest.mark.parametrize("quick,slow", [(1, 2), (2, 1)])
def test_the_quicker_way_is_found_and_the_other_one_tried_ever_less(quick, slow):
    crew = Crew(2)
    parts = worked(crew, lambda now, threads: 1e-5 if threads == quick else 1e-4, 300.0)
    assert crew.now == quick
    ends = [now for now, _ in parts[1:]] + [300.0]
    lost = [(now, end - now) for (now, threads), end in zip(parts, ends, strict=True) if threads == slow]
    assert sum(spent for _, spent in lost) < 300.0 * 0.02 + SOON_S
    late = [now for now, _ in lost if now > 150.0]
    assert late and min(np.diff(late)[np.diff(late) > 1.0], default=LATE_S) >= LATE_S - 1.0


def test_long_calls_are_tried_seldom():
    """Where a call takes 17 s with two threads and twice that with one."""
    crew = Crew(2)
    calls = worked(crew, lambda now, threads: 17.0 / threads / 500, 5000.0)
    assert 1 < sum(threads == 1 for _, threads in calls) < 0.06 * len(calls)


def test_other_work_that_comes_and_goes_is_noticed():
    """Two threads take half the time of one, or ten times as long from 100 s to 200 s."""
    crew = Crew(2)
    parts = worked(crew, lambda now, threads: 1e-5 * ((10.0 if 100.0 < now < 200.0 else 0.5) if threads == 2 else 1.0), 300.0)

    def alone(start, end):
        return np.mean([threads == 1 for now, threads in parts if start < now < end])

    assert alone(0.0, 100.0) < 0.1 and alone(103.0, 200.0) > 0.8 and alone(235.0, 300.0) < 0.1


def test_the_user_hears_of_threads_that_did_not_pay():
    short, busy, quiet = Crew(4), Crew(4), Crew(4)
    worked(short, lambda now, threads: 1e-5 * threads, 3.0)
    worked(busy, lambda now, threads: 1e-5 * threads, 100.0)
    worked(quiet, lambda now, threads: 1e-5 / threads, 100.0)
    assert short.remark() == quiet.remark() == ""
    assert busy.remark().startswith("one of 4 threads worked alone in 9") and 1.0 < busy.mean < 1.2 and quiet.mean > 3.8


def test_one_thread_is_never_anything_else():
    crew = Crew(1)
    crew.took(10**6, 100.0)
    assert crew.now == 1 and crew.alone_s == 0.0 and crew.all_s == 100.0


class Fickle(Crew):
    """Changes after every call."""

    def took(self, steps, seconds):
        self.now = 3 - self.now


@pytest.mark.parametrize("model", ["liu2015", "consistent"])
def test_no_number_depends_on_how_many_threads_worked(model):
    found = []
    for threads, crew in ((1, Crew(1)), (2, Fickle(2))):
        simulation = Simulation.from_case(CROWDED, threads=threads, **{"contact.model": model})
        start_threads(threads)
        simulation.crew = crew
        for _ in range(20):
            simulation.step(400)
        found.append(simulation)
    one, two = found
    assert one.state.ledger.cost.any()
    for name, values in one.state.bodies._asdict().items():
        assert np.array_equal(values, getattr(two.state.bodies, name)), name
    assert one.energies() == two.energies()

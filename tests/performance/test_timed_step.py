"""The step with a clock in it gives the numbers of the step to the last bit, and every stage has its time."""

import inspect

import numpy as np
import pytest

from benchmarks.scenes import scene_simulation
from benchmarks.timed_step import clock_cost, timed
from dilatedem.jit import NoTimer
from dilatedem.state.clock import Status
from dilatedem.step.advance import advance
from dilatedem.step.stages import STAGES


@pytest.mark.parametrize("name", ["jam", "packed"])
def test_the_timed_step_gives_the_numbers_of_the_step(name):
    plain, clocked = scene_simulation(name), scene_simulation(name)
    for simulation in (plain, clocked):
        simulation.evaluate()
    assert plain.advance(300) == Status.DONE
    spent, awake = timed(clocked, 300)
    for group, values in plain.state.groups().items():
        for field, expected in values._asdict().items():
            np.testing.assert_array_equal(getattr(clocked.state.groups()[group], field), expected, err_msg=f"{group}.{field}")
    assert set(spent) == set(STAGES) and spent["collide"] > 0.0
    assert 0.0 < awake <= plain.state.pairs.count[0]
    assert isinstance(clocked.timer, NoTimer), "later steps are not timed"


def test_every_stage_has_a_reading_of_its_own():
    source = inspect.getsource(advance.py_func)
    assert [source.count(f"lap(timer, {stage.upper()})") for stage in STAGES] == [1] * len(STAGES)
    assert 0.0 < clock_cost(1000) < 1e5

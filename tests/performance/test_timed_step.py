"""The step with a clock in it is the step of the program: the same stages in the same order, the same numbers to the last bit."""

import ast
import inspect
import textwrap

import numpy as np
import pytest

from benchmarks import timed_step
from benchmarks.scenes import scene_simulation
from benchmarks.timed_step import STAGES, clock_cost, timed, timed_advance
from dilatedem.state.clock import Status
from dilatedem.step.advance import advance

#: what `timed_advance` does besides: look at the clock, count
EXTRA = {"_now", "_lap"}


def calls(function) -> list[str]:
    """Calls in a function's body with their arguments, in the order of the text."""
    tree = ast.parse(textwrap.dedent(inspect.getsource(function.py_func)))
    found = [node for node in ast.walk(tree) if isinstance(node, ast.Call)]
    found.sort(key=lambda node: (node.lineno, node.col_offset))
    return [ast.unparse(node) for node in found if ast.unparse(node.func) not in EXTRA]


def test_the_timed_step_makes_the_calls_of_the_step():
    """A stage that changes nothing in a scene would escape a comparison of states."""
    assert calls(timed_advance) == calls(advance), "mend benchmarks/timed_step.py after a change of step/advance.py"


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
    assert plain.contacts <= awake <= plain.state.pairs.count[0] and awake > 0.0


def test_every_stage_has_a_reading_of_its_own():
    source = inspect.getsource(timed_step.timed_advance.py_func)
    assert [source.count(f"booked, {stage.upper()},") for stage in STAGES] == [1] * len(STAGES)
    assert 0.0 < clock_cost(1000) < 1e5

"""Each parallel loop does what its serial form does: all it writes, bit by bit, for any number of parts.

A write through a NamedTuple that is lost in a parallel loop raises no error; this is where it would show.
"""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from dilatedem.case.load import load
from dilatedem.jit import Team
from dilatedem.run.simulation import Simulation
from dilatedem.state.clock import Status
from dilatedem.state.pairs import unpacked
from dilatedem.step.advance import advance
from dilatedem.step.launch import _collide_shared, _drift_shared, _float_shared

CROWDED = Path(__file__).parents[1] / "cases" / "crowded.toml"

#: the comparison starts when so many contacts are open, and takes so many steps
CONTACTS, COMPARED = 4, 40


def advanced(threads: int, start: dict | None = None) -> Simulation:
    simulation = Simulation.of_case(load(CROWDED), threads=threads)
    if start is None:
        simulation.evaluate()
        while simulation.contacts < CONTACTS and simulation.time_s < simulation.case.time.duration:
            assert simulation.advance(100) == Status.DONE
        return simulation
    for name, group in start.items():
        setattr(simulation.state, name, type(group)(*(np.copy(field) for field in group)))
    simulation.state.pairs = unpacked(simulation.state.pairs, len(simulation.state.pairs.a))
    simulation.make_room()
    assert simulation.advance(COMPARED) == Status.DONE
    return simulation


@pytest.fixture(scope="module")
def start() -> dict:
    simulation = advanced(1)
    assert simulation.contacts >= CONTACTS
    return simulation.state.groups()


@pytest.mark.parametrize("parts", [2, 3, 7])
def test_shared_loops_write_what_the_serial_loop_writes(start, parts):
    alone, shared = advanced(1, start), advanced(parts, start)
    for name, group in alone.state.groups().items():
        for field, values in group._asdict().items():
            np.testing.assert_array_equal(getattr(shared.state.groups()[name], field), values, err_msg=f"{name}.{field}")
    # of the workspace, what both loops leave there
    np.testing.assert_array_equal(shared.workspace.wet, alone.workspace.wet)
    assert np.any(alone.state.bodies.velocity != start["bodies"].velocity)
    assert np.any(alone.state.pairs.force != unpacked(start["pairs"], len(alone.state.pairs.a)).force)


def test_the_shared_loops_are_those_that_were_compared(start):
    """Guards against a comparison of the serial loops with themselves."""
    advanced(2, start)
    assert any(Team.__name__ in str(signature[0]) for signature in advance.signatures)
    for loop in (_drift_shared, _collide_shared, _float_shared):
        assert loop.targetoptions["parallel"]


def test_shared_loops_run_from_machine_code_on_disk(start):
    """The threads must be there before, or the first step of the second run is a crash."""
    advanced(2, start)
    program = (
        "from tests.architecture.test_threads import advance, advanced; s = advanced(2, advanced(1).state.groups()); "
        "assert s.is_compiled() and advance.stats.cache_hits and not advance.stats.cache_misses"
    )
    root = Path(__file__).parents[2]
    told = subprocess.run([sys.executable, "-c", program], cwd=root, env=os.environ, capture_output=True, text=True, check=False)
    assert told.returncode == 0, told.stderr[-2000:]

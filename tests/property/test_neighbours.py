"""Sleeping pairs and the neighbour list may never miss a contact: all pairs, looked at afresh, find the same ones."""

import numpy as np
import pytest

from dilatedem.case.schema import Case
from dilatedem.jit import Alone, NoTimer
from dilatedem.motion.strides import Pace
from dilatedem.run.simulation import Simulation
from dilatedem.state.ledger import empty_ledger
from dilatedem.state.pairs import empty_pairs
from dilatedem.state.storage import empty_tally, make_workspace
from dilatedem.step.advance import advance


def open_contacts(pairs) -> dict:
    count = pairs.count[0]
    return {
        (int(pairs.a[k]), int(pairs.b[k])): float(pairs.overlap[k]) for k in range(count) if pairs.overlap[k] > 0.0
    }


@pytest.mark.parametrize("boundary", ["periodic", "wall", "open"])
def test_no_contact_is_missed(boundary):
    case = Case.model_validate({
        "domain": {"size": [18.0, 14.0], "x_boundary": boundary, "y_boundary": "periodic"},
        "field": {"floe_count": 31, "concentration": 0.8, "seed": 3},
        "structure": [{"kind": "pile", "center": [2.0, 5.0], "radius": 0.8}],
        "water": {"velocity": [0.8, 0.2]},
        "time": {"duration": 20.0},
    })  # fmt: skip
    simulation = Simulation.of_case(case)
    simulation.evaluate()
    found = 0
    for _ in range(80):
        simulation.advance(400)
        state = simulation.state
        remembered = open_contacts(state.pairs)
        # the same bodies, but a list that knows nothing: every near pair is evaluated from scratch in a step of no length
        fresh = empty_pairs(len(state.pairs.a))
        copies = type(state.bodies)(*(array.copy() for array in state.bodies))
        loads = type(state.loads)(*(array.copy() for array in state.loads))
        clock = type(state.clock)(*(array.copy() for array in state.clock))
        clock.dt[0] = 0.0
        workspace = make_workspace(simulation.model.shapes, simulation.model.hulls, len(fresh.a), 1)
        status = advance(
            Alone(), NoTimer(), simulation.model, state.ids, copies, state.excursions, fresh, empty_pairs(len(fresh.a)),
            simulation.cells, workspace, empty_tally(), empty_ledger(), loads, simulation.windows, state.hits, simulation.log,
            clock, Pace(1, 0.0, 0.0, 1), 1,
        )  # fmt: skip
        assert status == 0
        anew = open_contacts(fresh)
        assert anew.keys() == remembered.keys()
        for pair, overlap in anew.items():
            assert overlap == pytest.approx(remembered[pair], rel=1e-6, abs=1e-12)
        found += len(anew)
    assert found > 10  # the test has seen contacts
    assert np.isfinite(simulation.state.bodies.position).all()

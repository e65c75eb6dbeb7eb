"""Bodies come and go: every array that has a row a body, brought to those that are there afterwards.

Bodies keep their ids; contacts of bodies that stay keep their memory, and the list of pairs its order.
"""

import numpy as np

from dilatedem.geometry.packing import selected
from dilatedem.state.bodies import Bodies, Ids, Solids
from dilatedem.state.model import Model
from dilatedem.state.pairs import PackedPairs, Pairs, in_use, unpacked


def without(simulation, gone: np.ndarray) -> None:
    """Take the floating bodies `gone` (floating,) bool out of a simulation; its loads are evaluated anew.

    What they have of the ledger's energies is booked as carried out, and the work that was done on them stays on the books.
    """
    model, state = simulation.model, simulation.state
    before = float(state.ledger.instant.sum())
    state.ledger.departed_work[:] += state.bodies.work[: model.floating][gone].sum(axis=0)
    stay = np.concatenate([np.flatnonzero(~gone), np.arange(model.floating, len(model.structure_of))])
    reduced = _model(model, stay)
    state.pairs = _pairs(state.pairs, model, reduced, stay)
    state.bodies = Bodies(*(rows[stay] for rows in state.bodies))
    state.ids = Ids(state.ids.body[~gone])
    simulation.adopt(reduced)
    simulation.evaluate()
    state.ledger.carried_out[0] += before - float(state.ledger.instant.sum())


def _model(model: Model, rows: np.ndarray) -> Model:
    floating = int(np.count_nonzero(rows < model.floating))
    return model._replace(
        floating=floating,
        structure_of=model.structure_of[rows],
        shapes=selected(model.shapes, rows),
        hulls=selected(model.hulls, rows[:floating]),
        solids=Solids(*(values[rows] for values in model.solids)),
    )


def _pairs(pairs: Pairs, old: Model, new: Model, rows: np.ndarray) -> Pairs:
    """The pairs of bodies that are both there, their bodies and the corners they remember by their new numbers."""
    place = np.full(len(old.structure_of), -1)
    place[rows] = np.arange(len(rows))
    listed = in_use(pairs)
    a, b = place[listed.a], place[listed.b]
    both = (a >= 0) & (b >= 0)
    kept = listed._replace(
        count=np.array([np.count_nonzero(both)]), a=a[both], b=b[both], wake=listed.wake[both], row=listed.row[both]
    )
    left = unpacked(PackedPairs(*kept), len(pairs.a))
    count = int(left.count[0])
    shift = new.shapes.vertex_start[:-1] - old.shapes.vertex_start[rows]  # of a body's vertices
    left.corner_a[:count] += shift[left.a[:count], None]
    left.corner_b[:count] += shift[left.b[:count], None]
    return left

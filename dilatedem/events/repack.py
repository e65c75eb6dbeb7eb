"""Bodies come and go: every array that has a row a body, brought to those that are there afterwards.

Bodies keep their ids; contacts of bodies that stay keep their memory, and the list of pairs its order.
"""

import numpy as np

from dilatedem.geometry.packing import selected, together
from dilatedem.state.bodies import Bodies, Ids, joined_rows
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
    reduced, place = of_rows(model, stay), np.full(len(model.structure_of), -1)
    place[stay] = np.arange(len(stay))
    state.pairs = _pairs(state.pairs, model, reduced, place)
    state.bodies = Bodies(*(rows[stay] for rows in state.bodies))
    state.ids = Ids(state.ids.body[~gone])
    simulation.adopt(reduced)
    simulation.evaluate()
    state.ledger.carried_out[0] += before - float(state.ledger.instant.sum())


def whole_floes(chosen: np.ndarray, model: Model) -> np.ndarray:
    """Those of the `chosen` (floating,) bool that are no part of a floe of which another part is not."""
    entire = chosen.copy()
    for first, last in model.joined:
        entire[first:last] = chosen[first:last].all()
    return entire


def joined(simulation, came: Model, bodies: Bodies, ids: np.ndarray) -> float:
    """Put the floating bodies of another model into a simulation, behind those there are; its loads are evaluated anew.

    came: built for the same structures; bodies: of all its rows; ids (came.floating,): numbers that no other body has. They touch
    nothing. Returns the energy that they bring [J].
    """
    model, state = simulation.model, simulation.state
    before = float(state.ledger.instant.sum())
    count, first = len(model.structure_of), model.floating  # of the bodies that were there, and of the first structure's
    rows = np.concatenate([np.arange(first), count + np.arange(came.floating), np.arange(first, count)])
    enlarged, place = _together(model, came, rows), np.arange(count)
    place[first:] += came.floating
    state.pairs = _pairs(state.pairs, model, enlarged, place)
    state.pairs.limit[0] = 0.0  # those that came are not in the list: the next step makes it anew
    state.bodies = Bodies(*(np.concatenate(both)[rows] for both in zip(state.bodies, bodies, strict=True)))
    state.ids = Ids(np.concatenate([state.ids.body, ids]))
    simulation.adopt(enlarged)
    simulation.evaluate()
    return float(state.ledger.instant.sum()) - before


def of_rows(model: Model, rows: np.ndarray) -> Model:
    """The model of some of its bodies alone, in this order; those that float come first."""
    floating = int(np.count_nonzero(rows < model.floating))
    return model._replace(
        floating=floating,
        structure_of=model.structure_of[rows],
        joined=joined_rows(model.solids.floe[rows]),
        shapes=selected(model.shapes, rows),
        hulls=selected(model.hulls, rows[:floating]),
        solids=type(model.solids)(*(values[rows] for values in model.solids)),
    )


def _together(model: Model, came: Model, rows: np.ndarray) -> Model:
    """One model of the bodies of two; rows: what stands where, when those of the second are counted behind those of the first.

    Those that came are floes of one part.
    """
    solids = type(model.solids)(*(np.concatenate(both)[rows] for both in zip(model.solids, came.solids, strict=True)))
    return model._replace(
        floating=model.floating + came.floating,
        structure_of=np.concatenate([model.structure_of, came.structure_of])[rows],
        joined=joined_rows(solids.floe),
        shapes=selected(together(model.shapes, came.shapes), rows),
        hulls=together(model.hulls, came.hulls),
        solids=solids,
    )


def _pairs(pairs: Pairs, old: Model, new: Model, place: np.ndarray) -> Pairs:
    """The pairs of bodies that are both there, their bodies and the corners they remember by their new numbers.

    place (n,): the new number of each old body, -1 where it is gone.
    """
    listed = in_use(pairs)
    a, b = place[listed.a], place[listed.b]
    both = (a >= 0) & (b >= 0)
    kept = listed._replace(
        count=np.array([np.count_nonzero(both)]), a=a[both], b=b[both], wake=listed.wake[both], row=listed.row[both]
    )
    left = unpacked(PackedPairs(*kept), len(pairs.a))
    count = int(left.count[0])
    shift = new.shapes.vertex_start[place] - old.shapes.vertex_start[:-1]  # of a body's vertices
    left.corner_a[:count] += shift[listed.a[both], None]
    left.corner_b[:count] += shift[listed.b[both], None]
    return left

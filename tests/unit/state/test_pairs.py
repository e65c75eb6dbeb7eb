"""Rows of pairs: one memory for all columns, which goes with a pair from list to list."""

import numpy as np
import pytest

from benchmarks.scenes import scene_simulation
from dilatedem.contact.search.neighbours import find_pairs
from dilatedem.errors import CaseError
from dilatedem.jit import kernel
from dilatedem.state.clock import Status
from dilatedem.state.pairs import COLUMNS, KEPT, LEDGER, empty_pairs, packed, unpacked


def test_columns_are_views_of_the_row_one_after_the_other():
    pairs, first = empty_pairs(3), 0
    for column in COLUMNS:
        values = getattr(pairs, column.name)
        assert values.shape == ((3,) if column.width == 1 else (3, column.width)) and values.dtype == column.kind
        values[1] = 1
        found = np.flatnonzero(pairs.row[1])
        assert found.tolist() == list(range(first, first + column.words)), column.name
        values[1] = 0
        assert (first >= KEPT) == (column.group == LEDGER), column.name
        first += column.words


def test_what_the_sums_ask_for_fills_two_cache_lines():
    names = [column.name for column in COLUMNS]
    asked = COLUMNS[names.index("overlap") : names.index("couple") + 1]
    assert {"overlap", "force", "point", "arm", "couple"} <= {column.name for column in asked}
    assert sum(column.words for column in COLUMNS[: names.index("overlap")]) % 8 == 0
    assert sum(column.words for column in asked) <= 16


def test_rows_with_other_columns_are_refused():
    copy = packed(empty_pairs(2))
    with pytest.raises(CaseError, match="other columns"):
        unpacked(copy._replace(layout=copy.layout[1:]), 2)


@kernel
def list_anew(model, bodies, pairs, spare, cells, clock):
    """`find_pairs`."""
    return find_pairs(model, bodies, pairs, spare, cells, clock)


def test_pairs_keep_their_rows_when_the_list_is_made_anew():
    simulation = scene_simulation("packed")
    simulation.evaluate()
    assert simulation.advance(20) == Status.DONE
    pairs = simulation.state.pairs
    count = int(pairs.count[0])
    pairs.cost[:count], pairs.rounds[:count] = 1.0, 7
    rows = {(int(pairs.a[k]), int(pairs.b[k])): pairs.row[k].copy() for k in range(count)}
    assert np.count_nonzero(pairs.slip[:count].any(axis=1)) > 50
    # the first half is forgotten: its pairs are new to the list, and the rows of the others move
    kept = count - count // 2
    for values in (pairs.a, pairs.b, pairs.row):
        values[:kept] = values[count - kept : count].copy()
    known = set(zip(pairs.a[:kept].tolist(), pairs.b[:kept].tolist(), strict=True))
    pairs.count[0] = kept
    state = simulation.state
    assert list_anew(simulation.model, state.bodies, pairs, simulation.spare, simulation.cells, state.clock)
    found = list(zip(pairs.a[: pairs.count[0]].tolist(), pairs.b[: pairs.count[0]].tolist(), strict=True))
    assert known < set(found)
    for k, pair in enumerate(found):
        np.testing.assert_array_equal(pairs.row[k, :KEPT], rows[pair][:KEPT] if pair in known else 0)
        assert not pairs.row[k, KEPT:].any() and pairs.wake[k] == -1.0

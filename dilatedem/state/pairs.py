"""Pairs of bodies that may touch, with the memory of each pair's contact."""

from collections import namedtuple
from typing import NamedTuple

import numpy as np

from dilatedem.errors import CaseError
from dilatedem.state.ledger import COSTS

#: corners of the Minkowski difference that span a closest feature: a tetrahedron at most
SIMPLEX = 4

#: bytes of a number of a row
_WORD = 8

#: what a column of a pair's row is for: to find the closest points fast; what a law must know of the last step; what the last
#: evaluation found; what it cost. The first three go with a pair from list to list, the last starts afresh.
SEARCH, MEMORY, RESULT, LEDGER = "search", "memory", "result", "ledger"


class Column(NamedTuple):
    """A field of `Pairs` that lies in the pair's row."""

    name: str
    width: int  # 1: the field is (m,), else (m, width)
    kind: type
    group: str
    meaning: str  # and unit

    @property
    def words(self) -> int:
        """How many numbers of 8 bytes it takes in the row."""
        return self.width * np.dtype(self.kind).itemsize // _WORD


#: the row of a pair: everything that only the pair itself needs, in the order of memory and group by group. What the sums per body
#: ask for, `overlap` to `couple`, begins with a line of the processor's cache and fills two.
COLUMNS = (
    Column("corners", 1, np.int64, SEARCH, "corners of the closest simplex, 0 = not known yet"),
    Column("corner_a", SIMPLEX, np.int32, SEARCH, "vertices of a's core"),
    Column("corner_b", SIMPLEX, np.int32, SEARCH, "vertices of b's core"),
    Column("normal", 3, np.float64, SEARCH, "unit normal of the last evaluation"),
    Column("mode", 1, np.int64, MEMORY, "contact mode"),
    Column("stiffness", 1, np.float64, MEMORY, "K of F = K overlap^exponent, N/m^exponent (liu2015)"),
    Column("exponent", 1, np.float64, MEMORY, "kappa (liu2015)"),
    Column("shear_stiffness", 1, np.float64, MEMORY, "tangential spring, N/m"),
    Column("slip", 3, np.float64, MEMORY, "m, elongation of the tangential spring"),
    Column("wrung", 1, np.float64, MEMORY, "m, the same of turning about the normal, at the arm `grip` (consistent)"),
    Column("grip", 1, np.float64, MEMORY, "m, root of the patch's mean square distance from its centre (consistent)"),
    Column("damping_power", 1, np.float64, MEMORY, "W"),
    Column("elastic_power", 1, np.float64, MEMORY, "W that the elastic force takes up"),
    Column("crushed", 1, np.float64, MEMORY, "m, depth that has crushed"),
    Column("dent", 1, np.float64, MEMORY, "rad, where around a's vertical axis it did"),
    Column("bears", 1, np.float64, MEMORY, "N that the ice can take there, at least, as its bodies moved since it was looked at"),
    Column("turn_loss", 1, np.float64, MEMORY, "N/rad, most of it that the contact loses as it turns"),
    Column("stored", 1, np.float64, RESULT, "J, elastic energy of the normal force"),
    Column("overlap", 1, np.float64, RESULT, "m, at the centroid of the patch; > 0 says that there is a contact"),
    Column("force", 3, np.float64, RESULT, "N, on b"),
    Column("point", 3, np.float64, RESULT, "m, from the centroid of a"),
    Column("normal_force", 1, np.float64, RESULT, "N"),
    Column("arm", 3, np.float64, RESULT, "m, from the centroid of b to the same point"),
    Column("couple", 3, np.float64, RESULT, "N m, on b, along the normal force, beside its moment at `point` (consistent)"),
    Column("tangent", 1, np.float64, RESULT, "N/m, what the normal force rises by with the overlap"),
    Column("size", 1, np.float64, RESULT, "length or area of the patch, m or m2; 1 for a contact at a point"),
    Column("slide_loss", 1, np.float64, MEMORY, "N/m, most of what the ice can take that the contact loses as it slides"),
    Column("seat", 1, np.int64, MEMORY, "where bodies that bend are carried: 0 the point of contact, 1 their faces"),
    Column("yields", 1, np.float64, RESULT, "1/kg, with which the modes of both bodies give way to the contact"),
    Column("rounds", 1, np.int64, LEDGER, "rounds of the last distance search"),
    Column("cost", len(COSTS), np.float64, LEDGER, "J of each of `state.ledger.COSTS` in the last step"),
)

#: arrays of their own, read from end to end: sleeping pairs need no more
#: a, b: bodies, the normal points from a to b; wake [m]: sum of the two paths at which the gap could close
SCANNED = {"a": np.int64, "b": np.int64, "wake": np.float64}
#: of the list as a whole: pairs in use; horizontal velocity [m/s] of the frame in which paths are measured; path [m] at which the
#: list must be made anew
ALONE = {"count": (1, np.int64), "frame": (2, np.float64), "limit": (1, np.float64)}
#: numbers in a line of the processor's cache
_LINE = 8
#: columns that go with a pair from list to list, and all columns: full lines
KEPT = sum(column.words for column in COLUMNS if column.group != LEDGER)
ROW = -(-sum(column.words for column in COLUMNS) // _LINE) * _LINE

#: Candidates for contact, sorted by body a, then body b (a < b); rows beyond `count[0]` are unused. A pair sleeps until its two
#: bodies' paths have used up its gap (`wake`): no contact can begin before. row (m, ROW), as whole numbers: the memory whose
#: columns the fields of `COLUMNS` are. To write to those is to write to the row.
Pairs = namedtuple("Pairs", [*ALONE, *SCANNED, "row", *(column.name for column in COLUMNS)])


class PackedPairs(NamedTuple):
    """The pairs of a list without those fields of `Pairs` that are views of its rows: each number once.

    What checkpoints and copies hold. Field by field, copying takes ten times as long.
    """

    count: np.ndarray
    frame: np.ndarray
    limit: np.ndarray
    a: np.ndarray
    b: np.ndarray
    wake: np.ndarray
    row: np.ndarray  # (count, ROW)
    layout: np.ndarray  # which columns a row has, as text: another version may have others


def _layout() -> np.ndarray:
    """Names, widths and kinds of all columns, as bytes."""
    return np.frombuffer(" ".join(f"{name}:{width}{kind.__name__}" for name, width, kind, *_ in COLUMNS).encode(), np.uint8)


def empty_pairs(capacity: int) -> Pairs:
    """Room for `capacity` pairs; limit 0 makes the first step build the list.

    The fields of a pair that only its contact needs are columns of one array: a contact touches the 6 cache lines of its row, not a
    line in each of 40 arrays, most of which would be filled with what sleeping pairs do not need.
    """
    row = _aligned(capacity, ROW)
    arrays = {name: np.zeros(size, kind) for name, (size, kind) in ALONE.items()}
    arrays |= {name: np.zeros(capacity, kind) for name, kind in SCANNED.items()}
    first = 0
    for column in COLUMNS:
        values = row[:, first : first + column.words].view(column.kind)
        arrays[column.name] = values[:, 0] if column.width == 1 else values
        first += column.words
    return Pairs(**arrays, row=row.view(np.int64))


def _aligned(rows: int, columns: int) -> np.ndarray:
    """Zeros (rows, columns) that begin where a cache line does."""
    memory = np.zeros(rows * columns + _LINE)
    start = -(memory.__array_interface__["data"][0] // memory.itemsize) % _LINE
    return memory[start : start + rows * columns].reshape(rows, columns)


def in_use(pairs: Pairs) -> PackedPairs:
    """The pairs of a list without the rows beyond `count`: views, not copies."""
    count = int(pairs.count[0])
    rows = (getattr(pairs, name)[:count] for name in (*SCANNED, "row"))
    return PackedPairs(*(getattr(pairs, name) for name in ALONE), *rows, _layout())


def packed(pairs: Pairs) -> PackedPairs:
    """A copy of the pairs as they are now."""
    return PackedPairs(*(values.copy() for values in in_use(pairs)))


def unpacked(copy: PackedPairs, capacity: int) -> Pairs:
    """The same pairs with room for `capacity`. Raises CaseError where another version's rows had other columns."""
    if not np.array_equal(copy.layout, _layout()):
        raise CaseError("the saved pairs have other columns than this version's: they were written by another version of dilatedem")
    pairs = empty_pairs(capacity)
    for name in (*ALONE, *SCANNED, "row"):
        values = getattr(copy, name)
        getattr(pairs, name)[: len(values)] = values
    return pairs


def grown(pairs: Pairs, capacity: int) -> Pairs:
    """The same pairs with room for more."""
    return unpacked(in_use(pairs), capacity)

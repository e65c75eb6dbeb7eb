"""Pairs of bodies that may touch, with the memory of each pair's contact."""

from typing import NamedTuple

import numpy as np

#: corners of the Minkowski difference that span a closest feature: a tetrahedron at most
SIMPLEX = 4


class Pairs(NamedTuple):
    """Candidates for contact, sorted by body a, then body b (a < b); rows beyond `count[0]` are unused.

    A pair sleeps until its two bodies' paths have used up its gap (`wake`): no contact can begin before.
    """

    count: np.ndarray  # (1,) pairs in use
    frame: np.ndarray  # (2,) m/s, horizontal velocity of the frame in which paths are measured
    limit: np.ndarray  # (1,) m, path at which the list must be made anew
    a: np.ndarray  # (m,) body
    b: np.ndarray  # (m,) body; the normal points from a to b
    wake: np.ndarray  # (m,) m, sum of the two paths at which the gap could close
    rounds: np.ndarray  # (m,) rounds of the last distance search
    corners: np.ndarray  # (m,) corners of the closest simplex, 0 = not known yet
    corner_a: np.ndarray  # (m, 4) vertices of a's core
    corner_b: np.ndarray  # (m, 4) vertices of b's core
    normal: np.ndarray  # (m, 3) unit normal of the last evaluation
    # memory of an open contact
    mode: np.ndarray  # (m,) contact mode
    stiffness: np.ndarray  # (m,) K of F = K overlap^exponent, N/m^exponent (liu2015)
    exponent: np.ndarray  # (m,) kappa (liu2015)
    stored: np.ndarray  # (m,) J, elastic energy of the normal force
    tangent: np.ndarray  # (m,) N/m, what the normal force rises by with the overlap
    shear_stiffness: np.ndarray  # (m,) tangential spring, N/m
    slip: np.ndarray  # (m, 3) m, elongation of the tangential spring
    wrung: np.ndarray  # (m,) m, the same of turning about the normal, at the arm `grip` (consistent)
    grip: np.ndarray  # (m,) m, root of the patch's mean square distance from its centre (consistent)
    # what the sums per body need, in two cache lines
    overlap: np.ndarray  # (m,) m, at the centroid of the patch; > 0 says that there is a contact
    force: np.ndarray  # (m, 3) N, on b
    point: np.ndarray  # (m, 3) m, from the centroid of a
    normal_force: np.ndarray  # (m,) N
    arm: np.ndarray  # (m, 3) m, from the centroid of b to the same point
    couple: np.ndarray  # (m, 3) N m, on b, along the normal force (consistent: what is left of its moment at `point`)
    # memory again, and results of the last evaluation
    damping_power: np.ndarray  # (m,) W
    elastic_power: np.ndarray  # (m,) W that the elastic force takes up
    size: np.ndarray  # (m,) length or area of the patch, m or m2; 1 for a contact at a point
    loss_damping: np.ndarray  # (m,) J lost in the last step
    loss_friction: np.ndarray  # (m,) J lost in the last step
    gain_law: np.ndarray  # (m,) J made in the last step by the laws: more stored than the bodies have paid for


_WIDTH = {"corner_a": SIMPLEX, "corner_b": SIMPLEX, "normal": 3, "slip": 3, "force": 3, "couple": 3, "point": 3, "arm": 3}
_WHOLE = {"count", "a", "b", "rounds", "corners", "corner_a", "corner_b", "mode"}
_ALONE = {"count": (1,), "frame": (2,), "limit": (1,)}
#: arrays of their own, read from end to end; all other fields of a pair lie side by side in one row of memory
_SCANNED = ("a", "b", "wake")
#: numbers in a line of the processor's cache
_LINE = 8


def empty_pairs(capacity: int) -> Pairs:
    """Room for `capacity` pairs; limit 0 makes the first step build the list.

    The fields of a pair that only its contact needs are columns of one array: a contact touches the 6 cache lines of its row, not a
    line in each of 40 arrays, most of which would be filled with what sleeping pairs do not need.
    """
    arrays = {}
    rows = [name for name in Pairs._fields if name not in _ALONE and name not in _SCANNED]
    width = sum(_WIDTH.get(name, 1) for name in rows)
    memory = _aligned(capacity, -(-width // _LINE) * _LINE)
    column = 0
    for name in Pairs._fields:
        kind = np.int64 if name in _WHOLE else np.float64
        if name in rows:
            last = column + _WIDTH.get(name, 1)
            view = memory.view(kind)
            arrays[name] = view[:, column:last] if name in _WIDTH else view[:, column]
            column = last
        else:
            arrays[name] = np.zeros(_ALONE.get(name) or (capacity,), kind)
    return Pairs(**arrays)


def _aligned(rows: int, columns: int) -> np.ndarray:
    """Zeros (rows, columns) that begin where a cache line does."""
    memory = np.zeros(rows * columns + _LINE)
    start = _start(memory)
    return memory[start : start + rows * columns].reshape(rows, columns)


def _start(memory: np.ndarray) -> int:
    """The first number of `memory` that begins a cache line."""
    return -(memory.__array_interface__["data"][0] // memory.itemsize) % _LINE


def grown(pairs: Pairs, capacity: int) -> Pairs:
    """The same pairs with room for more, laid out as `empty_pairs` does."""
    larger = empty_pairs(capacity)
    for name in Pairs._fields:
        old = getattr(pairs, name)
        getattr(larger, name)[: len(old)] = old
    return larger


def in_use(pairs: Pairs) -> Pairs:
    """The same pairs without the rows beyond `count`: views, not copies."""
    count = int(pairs.count[0])
    return Pairs(*(values if name in _ALONE else values[:count] for name, values in pairs._asdict().items()))


class PackedPairs(NamedTuple):
    """A copy of the rows in use as they lie in memory: field by field, copying takes ten times as long."""

    count: np.ndarray
    frame: np.ndarray
    limit: np.ndarray
    a: np.ndarray
    b: np.ndarray
    wake: np.ndarray
    rows: np.ndarray  # (m, columns) all other fields of `Pairs`


def packed(pairs: Pairs) -> PackedPairs:
    """Pairs, laid out as `empty_pairs` does, as they are now."""
    count = int(pairs.count[0])
    alone = (getattr(pairs, name).copy() for name in _ALONE)
    return PackedPairs(*alone, *(getattr(pairs, name)[:count].copy() for name in _SCANNED), _rows(pairs)[:count].copy())


def unpacked(copy: PackedPairs, capacity: int) -> Pairs:
    """The same pairs with room for `capacity`."""
    pairs = empty_pairs(capacity)
    for name in (*_ALONE, *_SCANNED):
        values = getattr(copy, name)
        getattr(pairs, name)[: len(values)] = values
    _rows(pairs)[: len(copy.rows)] = copy.rows
    return pairs


def _rows(pairs: Pairs) -> np.ndarray:
    """(m, columns) the rows of memory whose columns the other fields are: what `_aligned` made, as whole numbers.

    `as_strided` from the first column on would not need the memory's start, but takes longer than copying all rows.
    """
    memory, columns = pairs.rounds.base, pairs.rounds.strides[0] // pairs.rounds.itemsize
    start = _start(memory)
    return memory[start : start + len(pairs.rounds) * columns].view(np.int64).reshape(-1, columns)

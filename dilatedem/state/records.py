"""What the record of loads has rows for: every structure, and sums over several rows. Constant during a run."""

from typing import NamedTuple

import numpy as np


class Records(NamedTuple):
    """Of r rows of `state.loads.Loads`: which of them are sums, in the order in which they are taken.

    A row is loaded by the bodies that belong to it, or it is the sum of rows that are known before it.
    """

    total: np.ndarray  # (t,) rows that are sums
    start: np.ndarray  # (t + 1,) where the members of each begin
    member: np.ndarray  # (m,) rows that add up to it
    flow: np.ndarray  # (2,) unit vector along which and across which loads are looked at: of the current, +x in still water


def records_of(members: list[tuple[int, ...]], flow: tuple[float, float] = (1.0, 0.0)) -> Records:
    """Rows whose loads are the sums of `members`, one entry a row: empty for a row that bodies load themselves."""
    total = [row for row, summed in enumerate(members) if summed]
    counts = [len(members[row]) for row in total]
    return Records(
        total=np.array(total, np.int64),
        start=np.concatenate([[0], np.cumsum(counts)]).astype(np.int64),
        member=np.array([other for row in total for other in members[row]], np.int64),
        flow=np.array(flow, float),
    )

"""What the record of loads has rows for, by name: every structure, then all structures of the case together."""

import math
from dataclasses import dataclass

import numpy as np

from dilatedem.case.names import TOTAL
from dilatedem.case.schema import Case
from dilatedem.structures.kind import Chart


@dataclass(frozen=True, eq=False)
class Record:
    """A row of forces.csv: its name, the point (3,) [m] about which its moments are stated, its load map, if it has one.

    members: rows whose loads add up to it; none: a structure, which its own bodies load.
    """

    name: str
    place: np.ndarray
    chart: Chart | None = None
    members: tuple[int, ...] = ()


def records_of(case: Case, structures: list) -> list[Record]:
    """Rows of the placed `structures` in their order, of those with parts the sums of these; where the case lists several, their
    sum behind them.

    Walls of the domain and bodies that are held fast have rows of their own, but no part in the sum: the case lists no structure
    there. Its moments are about the middle of the domain, those of structures about their centres, all at the case's level.
    """
    level = case.output.moment_level
    numbers = {id(each): number for number, each in enumerate(structures)}
    parts: dict[int, list[int]] = {}
    for number, each in enumerate(structures):
        if each.whole is not None:
            parts.setdefault(numbers[id(each.whole)], []).append(number)
    rows = [
        Record(each.name, np.array([*each.place[:2], level]), each.chart, tuple(parts.get(number, ())))
        for number, each in enumerate(structures)
    ]
    listed = {structure.name for structure in case.structure}
    if len(listed) > 1:
        members = tuple(number for number, each in enumerate(structures) if each.name in listed)
        rows.append(Record(TOTAL, np.array([0.0, 0.0, level]), members=members))
    return rows


def flow_direction(case: Case) -> tuple[float, float]:
    """Unit vector of the current, where a table tells it of its strongest; along x in still water."""
    u, v = case.water.strongest if case.water.enabled else (0.0, 0.0)
    speed = math.sqrt(u * u + v * v)
    return (u / speed, v / speed) if speed > 0.0 else (1.0, 0.0)

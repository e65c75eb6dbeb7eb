"""Columns of sweep.csv on all runs of one setting together, which differ in the seed alone: means and percentiles, with bands."""

import math
from collections.abc import Iterable, Iterator, Sequence
from typing import Any

from dilatedem.statistics import Band, mean, quantile

#: loads of a run that are told over the runs of a setting, and in per cent which of them stay below what
LOADS = ("fh_max_N", "along_mean_N")
PERCENTILES = (50, 90)

Row = dict[str, Any]  # of sweep.csv, by column


class Together:
    """What the rows of a sweep say together; a setting is told anew only when another of its runs has completed.

    settings : that of each row, in any words. Where no two rows share one there are no columns.
    """

    def __init__(self, settings: Sequence[str]):
        self._settings, self._repeated = settings, len(set(settings)) < len(settings)
        self._told: dict[str, Row] = {}

    def columns(self, rows: Sequence[Row]) -> list[Row]:
        """For each row the columns of its setting: `runs`, how many of them completed, and for each load STRUCTURE_LOAD_WHAT_N."""
        if not self._repeated:
            return [{} for _ in rows]
        members: dict[str, list[Row]] = {setting: [] for setting in self._settings}
        for setting, row in zip(self._settings, rows, strict=True):
            members[setting].append(row)
        for setting, runs in members.items():
            done = [row for row in runs if row["status"] == "completed"]
            if self._told.get(setting, {}).get("runs") != len(done):
                loads = dict.fromkeys(name for row in runs for name in row if name.endswith(LOADS))
                self._told[setting] = {"runs": len(done)} | dict(_told(done, loads))
        return [self._told[setting] for setting in self._settings]


def _told(rows: Sequence[Row], columns: Iterable[str]) -> Iterator[tuple[str, float | str]]:
    """Names and cells, empty where there is no number, over these rows of these columns; the unit stays at the end of a name."""
    for column in columns:
        values = [_number(row.get(column, "")) for row in rows]
        load, _, unit = column.rpartition("_")
        yield from _cells(f"{load}_mean", unit, mean(values))
        for percent in PERCENTILES:
            yield from _cells(f"{load}_p{percent}", unit, quantile(values, percent / 100.0))


def _cells(name: str, unit: str, band: Band) -> Iterator[tuple[str, float | str]]:
    for end, number in (("", band.value), ("_low", band.low), ("_high", band.high)):
        yield f"{name}{end}_{unit}", number if math.isfinite(number) else ""


def _number(cell: float | str) -> float:
    """A load as this sweep found it, or as an earlier one wrote it; nan where it is not known."""
    try:
        return float(cell)
    except ValueError:
        return math.nan

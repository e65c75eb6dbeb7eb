"""Runs cut into blocks, pieces of as much drift of the ice or time: what is told of runs is told of blocks then."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from dilatedem.errors import CaseError
from dilatedem.post.ensembles.part import CLOSE, END, Part, drift
from dilatedem.post.labels import number

#: with fewer blocks of a setting nothing is told of them
FEWEST = 10


@dataclass(frozen=True)
class Blocks:
    """So much drift of the ice [m], or time [s], each."""

    length: float
    unit: str

    def words(self) -> str:
        """As a caption says it."""
        return f"blocks of {number(self.length)} {self.unit}{' of drift' if self.unit == 'm' else ''}"

    def along(self, case: dict[str, Any], times: tuple[float, float], simulated: float) -> tuple[np.ndarray, np.ndarray]:
        """Times [s] between two, and how far a run is by then in the unit of the blocks, from 0 on; never backwards."""
        if self.unit == "s":
            return np.array(times), np.array(times) - times[0]
        time, drifted = drift(case, simulated)
        inner = (time > times[0]) & (time < times[1])
        place = np.concatenate([[times[0]], time[inner], [times[1]]])
        way = np.interp(place, time, drifted)
        return place, way - way[0]

    def edges(self, case: dict[str, Any], times: tuple[float, float], simulated: float) -> np.ndarray:
        """(blocks + 1,) times [s] at which whole blocks begin and end, from the first time on; what is left is in none."""
        time, way = self.along(case, times, simulated)
        count = math.floor(way[-1] / self.length * (1.0 + CLOSE))
        return np.interp(self.length * np.arange(count + 1), way, time)


def read_block(text: str | None) -> Blocks | None:
    """--block as typed, such as 600s or 180m; None where it was not. Raises CaseError for what is neither."""
    if text is None:
        return None
    found = END.fullmatch(text)
    if not found or float(found[1]) <= 0.0:
        raise CaseError(f"--block {text}: must be a time in seconds or a drift in metres above 0, such as 600s or 180m")
    return Blocks(float(found[1]), found[2])


def at_windows(edges: np.ndarray, ends: np.ndarray) -> np.ndarray:
    """Edges [s] moved back to the ends (n,) of windows, so that each window belongs to the block that it ends in."""
    places = np.concatenate([[0.0], ends])
    return places[np.searchsorted(places, edges * (1.0 + 1e-9), side="right") - 1]


def require_enough(blocks: Blocks, part: Part, count: int, spans: Sequence[float], where: str) -> None:
    """Raises CaseError for fewer than FEWEST blocks; spans: how much the runs have of which they are cut, in the blocks' unit."""
    if count >= FEWEST:
        return
    unit, allowed = blocks.unit, longest(spans)
    none = "the ice does not drift; choose a time" if unit == "m" else "there is nothing to cut"
    mend = f"choose blocks of {number(allowed, 3)} {unit} or less" if allowed > 0.0 else none
    asked = f"--block {number(blocks.length)}{unit}"
    raise CaseError(f"{asked}: {where} has {count} of them ({part.words()}); it takes {FEWEST}: {mend}")


def longest(spans: Sequence[float]) -> float:
    """The longest block, to three digits, of which these spans have FEWEST together; 0 for none."""
    tried = sorted((span / count for span in spans if span > 0.0 for count in range(1, FEWEST + 1)), reverse=True)
    found = next((one for one in tried if sum(math.floor(span / one * (1.0 + CLOSE)) for span in spans) >= FEWEST), 0.0)
    if found == 0.0:
        return 0.0
    digit = 10.0 ** (math.floor(math.log10(found)) - 2)
    return math.floor(found / digit * (1.0 + CLOSE)) * digit

"""The part of a run that is looked at: from so many metres that the ice has drifted, or seconds, to so many."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from typing import Any

import numpy as np

from dilatedem.errors import CaseError
from dilatedem.post.labels import number

#: of a drift or a time: what counts as the same, over it
CLOSE = 1e-6

END = re.compile(r"\s*([0-9]*\.?[0-9]+(?:[eE][+-]?[0-9]+)?)\s*(m|s)\s*")


@dataclass(frozen=True)
class Part:
    """From one drift [m] or time [s] of the ice to another; infinite: to the end of the run."""

    start: float = 0.0
    end: float = math.inf
    unit: str = "s"

    @property
    def whole(self) -> bool:
        return self.start == 0.0 and math.isinf(self.end)

    def words(self) -> str:
        """As a caption says it."""
        if self.whole:
            return "whole runs"
        kind = "drift" if self.unit == "m" else "time"
        if math.isinf(self.end):
            return f"{kind} from {number(self.start)} {self.unit} on"
        return f"{kind} from {number(self.start)} to {number(self.end)} {self.unit}"

    def times(self, case: dict[str, Any], simulated: float) -> tuple[float, float] | None:
        """From when to when [s] a run of this case is looked at, None for one that ends before; `simulated`: how far it got [s]."""
        if self.unit == "s":
            start, end = self.start, self.end
        else:
            start, end = time_of_drift(case, self.start, simulated), time_of_drift(case, self.end, simulated)
        reached = simulated * (1.0 + CLOSE)
        if start >= reached or (math.isfinite(self.end) and end > reached):
            return None
        return start, min(end, simulated)


def read_part(start: str | None, end: str | None) -> Part | None:
    """--from and --to as typed, such as 5m and 30m, or 10s; None where neither was. Raises CaseError for what is neither."""
    if start is None and end is None:
        return None
    ends = [(option, text, END.fullmatch(text)) for option, text in (("--from", start), ("--to", end)) if text is not None]
    for option, text, found in ends:
        if not found:
            raise CaseError(f"{option} {text}: must be a drift in metres or a time in seconds, such as 5m or 10s")
    units = {found[2] for _, _, found in ends}
    if len(units) > 1:
        raise CaseError(f"--from {start} --to {end}: must both be drifts (m) or both times (s)")
    told = {option: float(found[1]) for option, _, found in ends}
    part = Part(told.get("--from", 0.0), told.get("--to", math.inf), units.pop())
    if part.end <= part.start:
        raise CaseError(f"--from {start or 0} --to {end}: the end must lie beyond the beginning")
    return part


def time_of_drift(case: dict[str, Any], metres: float, until: float) -> float:
    """When [s] the ice of a case has drifted so far; infinite where it does not, or its drift is unknown."""
    if metres == 0.0:
        return 0.0
    time, drifted = drift(case, until)
    if metres > drifted[-1] * (1.0 + CLOSE):
        return math.inf
    return float(np.interp(metres, drifted, time))


def drift(case: dict[str, Any], until: float) -> tuple[np.ndarray, np.ndarray]:
    """Times [s] from 0 to `until`, and how far [m] the ice has drifted by then, relative to a structure that is driven.

    Ice goes with the current; in still water, as it was started.
    """
    water, driven = case.get("water", {}), _driven(case)
    rows = water.get("velocity_table") if water.get("enabled", True) else None
    if not rows:
        return np.array([0.0, until]), np.array([0.0, until * math.dist(_flow(case), driven)])
    table = np.array(rows, dtype=float)
    time = np.unique(np.concatenate([np.linspace(0.0, until, 1001), table[:, 0].clip(0.0, until)]))
    u, v = np.interp(time, table[:, 0], table[:, 1]), np.interp(time, table[:, 0], table[:, 2])
    speed = np.hypot(u - driven[0], v - driven[1])
    return time, np.concatenate([[0.0], np.cumsum(0.5 * np.diff(time) * (speed[1:] + speed[:-1]))])


def _flow(case: dict[str, Any]) -> tuple[float, float]:
    """Velocity of the ice [m/s]: that of the current, in still water that of its start."""
    water, started = case.get("water", {}), case.get("ice", {}).get("initial_velocity", "current")
    current = water.get("velocity", (0.0, 0.0)) if water.get("enabled", True) else (0.0, 0.0)
    u, v, *_ = current if any(current) or isinstance(started, str) else started
    return float(u), float(v)


def _driven(case: dict[str, Any]) -> tuple[float, float]:
    """Velocity [m/s] of the first structure that is driven at one."""
    for structure in case.get("structure", []):
        if velocity := structure.get("support", {}).get("velocity"):
            return float(velocity[0]), float(velocity[1])
    return 0.0, 0.0

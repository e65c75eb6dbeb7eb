"""When a run ends: at its duration, or where a condition of `time.until` is met before.

A condition that is met ends the run a span later, so that there is always a state of before its end, from which a longer run
goes on.
"""

import math

import numpy as np

from dilatedem.case.schema import Case
from dilatedem.case.until import drift_past
from dilatedem.output.observer import Observer
from dilatedem.output.schedule import Schedule
from dilatedem.output.windows import sideways
from dilatedem.state.loads import EXTREMES

#: s between two looks at the conditions
LOOK = 1.0
#: s that the loads of one entry of the record that `steady` looks at are summed over
BLOCK = 5.0
#: parts that the latter half of a run is cut into, and the blocks in each, at least
PARTS, LEAST_BLOCKS = 10, 2
#: of Student's distribution, 97.5 %, with 9 degrees of freedom, and with 8 (two halves of five parts each)
STUDENT_9, STUDENT_8 = 2.262, 2.306
#: what a condition says once it is met
SENTENCES = {
    "ice_gone": "no ice is left that could come to a structure",
    "load_above": "the load on a structure has been above {load_above:g} N",
    "steady": "the mean load is known to {steady:g} of itself",
}


def total_steps(case: Case, dt: float) -> int:
    """Steps of dt [s] in the duration of a case."""
    return math.ceil(case.time.duration / dt - 1e-9)


class Ending(Observer):
    """Looks at the conditions of the case, and says at which step the run ends."""

    name = "ending"

    def open(self, kept: dict | None, since: int) -> None:
        case = self.simulation.case
        self.schedule = Schedule(LOOK if case.time.until.asked else 0.0, self.simulation.dt, self.simulation.span)
        self._blocks = Schedule(BLOCK if case.time.until.steady else 0.0, self.simulation.dt, self.simulation.span)
        self._sums: list[list[float]] = kept.get("sums", []) if kept else []  # N steps, along the current, of each structure
        self._met: dict[str, int] = kept.get("met", {}) if kept else {}  # conditions, and the step at which they were
        self._met = {name: step for name, step in self._met.items() if name in case.time.until.asked}
        self._say_end()

    def attach(self, forces) -> None:
        """forces: the observer of the loads, which knows all that was before."""
        self._forces = forces

    @property
    def end(self) -> int:
        """The step with which the run ends, as far as is known."""
        span, relaxed = self.simulation.span, self.simulation.state.relaxed
        rest = [int(relaxed.settled[0]) + span] if relaxed and relaxed.settled[0] >= 0 else []
        return min([total_steps(self.simulation.case, self.simulation.dt), *rest, *(step + span for step in self._met.values())])

    def _say_end(self) -> None:
        """Have load events end with the run."""
        self.simulation.log = self.simulation.log._replace(end=self.end)

    def next_due(self, step: int) -> int:
        return min(self.schedule.next_due(step), self._blocks.next_due(step))

    def look(self, step: int, last: bool) -> None:
        if step and self._blocks.is_due(step):
            self._sums.append(self._along().tolist())
        if step and self.schedule.is_due(step) and not self._met:
            self._met = {name: step for name in self.simulation.case.time.until.asked if getattr(self, f"_{name}")()}
            self._say_end()
        if self.simulation.state.relaxed:
            self._say_end()

    def _watched(self) -> list[int]:
        """Rows of the record of the structures that the case lists."""
        names = [structure.name for structure in self.simulation.case.structure]
        return [self._forces.records.index(name) for name in names]

    def _along(self) -> np.ndarray:
        """Sum over all steps so far of the load along the current on each structure [N]: window by window, however they came."""
        windows, forces = self.simulation.windows, self._forces
        waiting = sideways(windows.sum[: int(windows.count[0])], forces.flow)[:, :, 0]
        total = np.array([forces.peaks[name]["along_sum"] if name in forces.peaks else 0.0 for name in forces.records])
        for window in waiting:
            total = total + window
        return total[self._watched()]

    def _load_above(self) -> bool:
        """Whether any step so far, of windows that have ended, had a higher horizontal load on a structure."""
        windows, forces = self.simulation.windows, self._forces
        watched, highest = self._watched(), EXTREMES.index("fh_max_N")
        before = [forces.peaks[forces.records[s]]["fh_max_N"] for s in watched if forces.records[s] in forces.peaks]
        now = windows.extreme[: int(windows.count[0]), watched, highest].ravel().tolist()
        return max([*before, *now], default=0.0) > self.simulation.case.time.until.load_above

    def _ice_gone(self) -> bool:
        """Whether every body that moves lies downstream of every part of a structure that is no half space."""
        simulation, model = self.simulation, self.simulation.model
        case, place = simulation.case, simulation.state.bodies.position[:, :2]
        ahead = np.array(drift_past(case.domain, case.water.velocity))
        along = place @ (ahead / math.sqrt(ahead @ ahead))
        free = np.flatnonzero(model.solids.inverse_mass[: model.floating] > 0.0)
        parts = model.floating + np.flatnonzero(model.shapes.kind[model.floating :] == 0)
        farthest = (along[parts] + model.shapes.plan_reach[parts]).max()
        return bool((along[free] - model.shapes.reach[free] > farthest).all())

    def _steady(self) -> bool:
        """Whether the means of the latter half are known well enough and do not drift."""
        sums = np.array(self._sums)
        each = len(sums) // (2 * PARTS)  # blocks of a part
        if each < LEAST_BLOCKS:
            return False
        marks = sums[len(sums) - 1 - each * np.arange(PARTS, -1, -1)]
        means = np.diff(marks, axis=0)  # (parts, structures), of equal lengths
        return all(is_steady(part, self.simulation.case.time.until.steady) for part in means.T)

    def kept(self) -> dict:
        return {"sums": [list(sums) for sums in self._sums], "met": dict(self._met)}

    def summary(self) -> dict:
        if not self.simulation.case.time.until.asked:
            return {}
        return {"until": {"met": list(self._met), "message": self.remark()}}

    def remark(self) -> str:
        """Why the run ends, where it does so before its duration is over."""
        if not self._met:
            return ""
        until = self.simulation.case.time.until.model_dump()
        told = " and ".join(f"{SENTENCES[name].format(**until)} (time.until.{name})" for name in self._met)
        return f"ends at t = {self.end * self.simulation.dt:.6g} s: {told}"


def is_steady(parts: np.ndarray, share: float) -> bool:
    """Whether the mean of PARTS numbers is known to a share of itself, and their first half does not differ from their second.

    Both by Student's distribution, 95 %: means of parts that are long beside what correlates in time are independent.
    """
    mean, spread = float(parts.mean()), float(parts.std(ddof=1))
    first, second = parts[: PARTS // 2], parts[PARTS // 2 :]
    both = math.sqrt((float(first.var(ddof=1)) + float(second.var(ddof=1))) / (PARTS // 2))
    known = STUDENT_9 * spread / math.sqrt(PARTS) <= share * abs(mean)
    return known and abs(float(first.mean() - second.mean())) <= STUDENT_8 * both

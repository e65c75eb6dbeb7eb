"""The runs of a sweep as ensembles: runs that differ in nothing but the seed, looked at over the same drift of the ice."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from dilatedem.errors import CaseError
from dilatedem.post.ensembles.measures import Loads, loads_of, loads_of_row
from dilatedem.post.ensembles.part import Part, drift
from dilatedem.post.ensembles.sweeps import Sweep, SweepRun
from dilatedem.post.loads import HIT_FORCE, HIT_GAP
from dilatedem.post.read import RunFolder, open_facts, read_forces
from dilatedem.results.files import is_run
from dilatedem.statistics import peaks_above

#: drifts that differ by less than this share of them are the same
SAME_DRIFT = 0.02


@dataclass(frozen=True)
class Choice:
    """What the user asks of ensembles; None: as it suits.

    part: of each run; threshold [N] of hits, and of the law of their peaks; gap [s] between hits.
    """

    part: Part | None = None
    threshold: float | None = None
    gap: float | None = None

    @property
    def asked(self) -> bool:
        return self != Choice(None, None, None)


AS_IT_SUITS = Choice()


@dataclass(frozen=True)
class Member:
    """A run of an ensemble: where it comes from, and its loads by structure."""

    run: SweepRun
    current: tuple[float, float]
    loads: dict[str, Loads]


@dataclass(frozen=True)
class Ensemble:
    """Runs that differ in nothing but the seed."""

    values: dict[str, Any]  # of the keys that vary
    members: list[Member]

    def on(self, structure: str) -> list[Loads]:
        return [member.loads[structure] for member in self.members if structure in member.loads]

    def sample(self, structure: str, quantity: str) -> np.ndarray:
        """(runs,) of a quantity, of the runs that have it."""
        found = [loads.measures.get(quantity, math.nan) for loads in self.on(structure)]
        return np.array([value for value in found if math.isfinite(value)])


@dataclass(frozen=True)
class Study:
    """A sweep as ensembles.

    equalized: the part was chosen here, as the ice drifts farther in some runs than in others; threshold [N], gap [s]: what counts
    as a hit; fixed: the threshold was asked for; left_out: names of runs that do not reach the end of the part.
    """

    sweep: Sweep
    ensembles: list[Ensemble]
    part: Part
    threshold: float
    gap: float
    equalized: bool = False
    fixed: bool = False
    left_out: tuple[str, ...] = ()

    def peaks(self, ensemble: Ensemble, structure: str, threshold: float | None = None) -> list[np.ndarray]:
        """Of every run, the peaks [N] of its hits above a threshold, that of the study unless given."""
        level = self.threshold if threshold is None else threshold
        return [peaks_above(loads.start, loads.end, loads.force, level, self.gap) for loads in ensemble.on(structure)]


def study(sweep: Sweep, choice: Choice = AS_IT_SUITS) -> Study:
    """Read the forces of the runs that completed, one after another. Raises CaseError where none reaches the part asked for."""
    folders = {run.folder: open_facts(run.folder) for run in sweep.runs if run.completed and is_run(run.folder)}
    part = choice.part or _common_drift(list(folders.values()))
    threshold, gap = _what_counts(list(folders.values()), choice)
    ensembles: dict[str, Ensemble] = {}
    left_out: list[str] = []
    for run in sweep.runs:
        if not run.completed:
            continue
        member = _member(run, folders.get(run.folder), part, threshold, gap)
        if member is None:
            left_out.append(run.folder.name)
            continue
        ensembles.setdefault(repr(sorted(run.values.items())), Ensemble(run.values, [])).members.append(member)
    if left_out and not ensembles:
        raise CaseError(f"{sweep.folder}: none of its runs reaches the end of what is asked for ({part.words()})")
    return Study(
        sweep, list(ensembles.values()), part, threshold, gap, equalized=choice.part is None and not part.whole,
        fixed=choice.threshold is not None, left_out=tuple(left_out),
    )  # fmt: skip


def _member(run: SweepRun, folder: RunFolder | None, part: Part, threshold: float, gap: float) -> Member | None:
    """The loads of a run within the part, None for one that ends before; without its files, what sweep.csv says of whole runs."""
    forces = {} if folder is None else read_forces(folder.path, folder.case)
    if folder is None or not forces:
        return Member(run, (0.0, 0.0), {name: loads_of_row(row) for name, row in run.loads.items()}) if part.whole else None
    times = part.times(folder.case, folder.simulated)
    if times is None:
        return None
    found = {name: loads_of(history, folder.current, times, threshold, gap) for name, history in forces.items()}
    return Member(run, folder.current, {name: loads for name, loads in found.items() if loads is not None})


def _common_drift(folders: Sequence[RunFolder]) -> Part:
    """The drift that all runs reach, where some go farther than others; whole runs where all go as far, or ice stands."""
    drifts = [float(drift(folder.case, folder.simulated)[1][-1]) for folder in folders]
    if len(drifts) < 2 or min(drifts) <= 0.0 or max(drifts) <= (1.0 + SAME_DRIFT) * min(drifts):
        return Part()
    return Part(0.0, min(drifts), "m")


def _what_counts(folders: Sequence[RunFolder], choice: Choice) -> tuple[float, float]:
    """Threshold [N] and gap [s] of hits for all runs alike: as asked for, else the highest that any of them was run with."""
    told = [folder.summary.get("hits") or {} for folder in folders]
    thresholds = [one["threshold_N"] for one in told if one.get("threshold_N") is not None]
    gaps = [one["gap_s"] for one in told if one.get("gap_s") is not None]
    threshold = max(thresholds, default=HIT_FORCE) if choice.threshold is None else choice.threshold
    return threshold, max(gaps, default=HIT_GAP) if choice.gap is None else choice.gap

"""The runs of a sweep as ensembles: runs that differ in nothing but the seed, looked at over the same drift, or cut into blocks."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from dilatedem.errors import CaseError
from dilatedem.post.ensembles.blocks import Blocks, at_windows, require_enough
from dilatedem.post.ensembles.measures import Loads, loads_of, loads_of_row
from dilatedem.post.ensembles.part import Part, drift
from dilatedem.post.ensembles.sweeps import Sweep, SweepRun
from dilatedem.post.loads import HIT_FORCE, HIT_GAP
from dilatedem.post.read import RunFolder, open_facts, read_forces
from dilatedem.results.files import is_run
from dilatedem.results.tables import Table
from dilatedem.statistics import peaks_above

#: drifts that differ by less than this share of them are the same
SAME_DRIFT = 0.02


@dataclass(frozen=True)
class Choice:
    """What the user asks of ensembles; None: as it suits.

    part: of each run; threshold [N] of hits, and of the law of their peaks; gap [s] between hits; blocks: into which runs are cut.
    """

    part: Part | None = None
    threshold: float | None = None
    gap: float | None = None
    blocks: Blocks | None = None

    @property
    def asked(self) -> bool:
        return self != Choice()


AS_IT_SUITS = Choice()


@dataclass(frozen=True)
class Member:
    """A run of an ensemble, or a block of one: where it comes from, and its loads by structure."""

    run: SweepRun
    current: tuple[float, float]
    loads: dict[str, Loads]


@dataclass(frozen=True)
class Ensemble:
    """Runs that differ in nothing but the seed, or the blocks of such runs, one after another."""

    values: dict[str, Any]  # of the keys that vary
    members: list[Member]

    def on(self, structure: str) -> list[Loads]:
        return [member.loads[structure] for member in self.members if structure in member.loads]

    def sample(self, structure: str, quantity: str) -> np.ndarray:
        """(runs,) of a quantity, of the runs that have it."""
        found = [loads.measures.get(quantity, math.nan) for loads in self.on(structure)]
        return np.array([value for value in found if math.isfinite(value)])

    def neighbours(self, structure: str, quantity: str) -> tuple[np.ndarray, np.ndarray]:
        """(pairs,) of a quantity in blocks, and in those that follow them in the same run."""
        pairs = [
            [member.loads[structure].measures[quantity] for member in two]
            for two in zip(self.members, self.members[1:], strict=False)
            if two[0].run is two[1].run and all(structure in member.loads for member in two)
        ]
        first, second = np.array(pairs).reshape(-1, 2).T
        return first, second


@dataclass(frozen=True)
class Study:
    """A sweep as ensembles.

    equalized: the part was chosen here, as the ice drifts farther in some runs than in others; threshold [N], gap [s]: what counts
    as a hit; fixed: the threshold was asked for; left_out: names of runs that do not reach the end of the part; blocks: what
    members are, unless they are runs.
    """

    sweep: Sweep
    ensembles: list[Ensemble]
    part: Part
    threshold: float
    gap: float
    equalized: bool = False
    fixed: bool = False
    left_out: tuple[str, ...] = ()
    blocks: Blocks | None = None

    @property
    def noun(self) -> str:
        """What a member of an ensemble is."""
        return "block" if self.blocks else "run"

    @property
    def looked_at(self) -> str:
        """Which part of the runs, and as what, in words."""
        return f"{self.part.words()}, in {self.blocks.words()}" if self.blocks else self.part.words()

    def peaks(self, ensemble: Ensemble, structure: str, threshold: float | None = None) -> list[np.ndarray]:
        """Of every member, the peaks [N] of its hits above a threshold, that of the study unless given."""
        level = self.threshold if threshold is None else threshold
        return [peaks_above(loads.start, loads.end, loads.force, level, self.gap) for loads in ensemble.on(structure)]


def study(sweep: Sweep, choice: Choice = AS_IT_SUITS) -> Study:
    """Read the forces of the runs that completed, one after another.

    Raises CaseError where none reaches the part asked for, or runs are too short for so long blocks.
    """
    folders = {run.folder: open_facts(run.folder) for run in sweep.runs if run.completed and is_run(run.folder)}
    part = choice.part or (Part() if choice.blocks else _common_drift(list(folders.values())))
    threshold, gap = _what_counts(list(folders.values()), choice)
    ensembles: dict[str, Ensemble] = {}
    looked_at: dict[str, list[RunFolder]] = {}
    left_out: list[str] = []
    for run in sweep.runs:
        if not run.completed:
            continue
        members = _members(run, folders.get(run.folder), part, choice.blocks, threshold, gap)
        if members is None:
            left_out.append(run.folder.name)
            continue
        setting = repr(sorted(run.values.items()))
        ensembles.setdefault(setting, Ensemble(run.values, [])).members.extend(members)
        looked_at.setdefault(setting, []).append(folders.get(run.folder))
    if left_out and not ensembles:
        raise CaseError(f"{sweep.folder}: none of its runs reaches the end of what is asked for ({part.words()})")
    if choice.blocks:
        for setting, ensemble in ensembles.items():
            _require_blocks(choice.blocks, part, len(ensemble.members), looked_at[setting])
    return Study(
        sweep, list(ensembles.values()), part, threshold, gap, equalized=choice.part is None and not part.whole,
        fixed=choice.threshold is not None, left_out=tuple(left_out), blocks=choice.blocks,
    )  # fmt: skip


def _members(
    run: SweepRun, folder: RunFolder | None, part: Part, blocks: Blocks | None, threshold: float, gap: float
) -> list[Member] | None:  # fmt: skip
    """The loads of a run within the part, or of its blocks; None for a run that ends before.

    Without the files of a run, what sweep.csv says of it as a whole.
    """
    forces = {} if folder is None else read_forces(folder.path, folder.case)
    if folder is None or not forces:
        whole = part.whole and not blocks
        return [Member(run, (0.0, 0.0), {name: loads_of_row(row) for name, row in run.loads.items()})] if whole else None
    times = part.times(folder.case, folder.simulated)
    if times is None:
        return None
    edges = blocks.edges(folder.case, times, folder.simulated) if blocks else np.array(times)
    pieces = {name: _pieces(history, folder.current, edges, threshold, gap, bool(blocks)) for name, history in forces.items()}
    return [
        Member(run, folder.current, {name: piece[k] for name, piece in pieces.items() if piece[k] is not None})
        for k in range(len(edges) - 1)
    ]  # fmt: skip


def _pieces(
    history: Table, current: tuple[float, float], edges: np.ndarray, threshold: float, gap: float, cut: bool
) -> list[Loads | None]:  # fmt: skip
    """Loads on one structure between these times [s]; cut: no window that lies across one of them is lost."""
    places = at_windows(edges, history["time_s"]) if cut else edges
    return [loads_of(history, current, (float(a), float(b)), threshold, gap) for a, b in zip(places, places[1:], strict=False)]


def _require_blocks(blocks: Blocks, part: Part, count: int, runs: Sequence[RunFolder]) -> None:
    """Raises CaseError where the runs of an ensemble have too few blocks."""
    times = [part.times(run.case, run.simulated) for run in runs]
    ways = [blocks.along(run.case, time, run.simulated)[1] for run, time in zip(runs, times, strict=True)]
    others = f" with {len(runs) - 1} more" if len(runs) > 1 else ""
    require_enough(blocks, part, count, [float(way[-1]) for way in ways], f"{runs[0].path}{others}")


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

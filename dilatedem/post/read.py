"""A run folder as pictures and reports need it: whatever is there, also when the run was killed half way or is still going on."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from dilatedem.results.archive import ContactStatistics, FloeTable, LoadMap, PlanOutline, read_archive
from dilatedem.results.files import list_snapshots, read_case, read_summary
from dilatedem.results.hits import KeptHit
from dilatedem.results.soundness import require_table
from dilatedem.results.tables import Table, read_table, row_count, split_by_structure
from dilatedem.results.whole import whole_table


@dataclass(frozen=True)
class RunFolder:
    """Everything but the snapshots' contents, which are read one by one when they are drawn."""

    path: Path
    case: dict[str, Any]
    summary: dict[str, Any]
    forces: dict[str, Table]  # by structure, in the order of the case
    energy: Table
    snapshots: list[tuple[float, Path]]  # (time [s], file)
    load_maps: dict[str, LoadMap] = field(default_factory=dict)
    contacts: dict[str, ContactStatistics] = field(default_factory=dict)  # by "ice_ice", "ice_structure"
    floes: FloeTable | None = None  # a row for each body
    outlines: dict[str, PlanOutline] = field(default_factory=dict)  # by structure
    energy_labels: dict[str, str] = field(default_factory=dict)  # terms of energy.csv in words
    hits: dict[str, Table] = field(default_factory=dict)  # load events, by structure
    kept_hits: list[KeptHit] = field(default_factory=list)  # the highest of them at every step
    motion: dict[str, Table] = field(default_factory=dict)  # of structures that move, by structure

    @property
    def title(self) -> str:
        return str(self.case.get("title") or self.path.name)

    @cached_property
    def ice(self) -> FloeTable | None:
        """`floes` with a row for each floe, be it of one part or several."""
        return self.floes and whole_table(self.floes)

    @property
    def structures(self) -> list[dict[str, Any]]:
        return list(self.case.get("structure", []))

    def outlines_at(self, time: float) -> dict[str, PlanOutline]:
        """The structures in plan as they stood at a time [s], in the domain along its periodic axes."""
        found = dict(self.outlines)
        for name, outline in self.outlines.items():
            motion = self.motion.get(name.partition("/")[0])  # a part goes with its structure
            if motion and row_count(motion):
                x, y, yaw = (float(np.interp(time, motion["time_s"], motion[column])) for column in ("x_m", "y_m", "yaw_rad"))
                found[name] = self._wrapped(outline.moved(np.array([x, y]), yaw))
        return found

    def _wrapped(self, outline: PlanOutline) -> PlanOutline:
        periods = np.where([side == "periodic" for side in self.boundaries], self.domain_size, np.inf)
        turns = np.floor(outline.place / periods + 0.5)
        return outline.moved(np.where(turns != 0.0, -turns * np.array(self.domain_size), 0.0), 0.0)

    @property
    def domain_size(self) -> tuple[float, float]:
        """Length along x and y [m]; the domain is centred on the origin."""
        size = self.case.get("domain", {}).get("size", (50.0, 50.0))
        return float(size[0]), float(size[1])

    @property
    def boundaries(self) -> tuple[str, str]:
        """What the sides are at the two ends of x, and of y: open, periodic or wall."""
        domain = self.case.get("domain", {})
        return str(domain.get("x_boundary", "open")), str(domain.get("y_boundary", "open"))

    @property
    def current(self) -> tuple[float, float]:
        """Velocity of the water [m/s]; zero where the water is switched off."""
        return self._velocity_of("water")

    @property
    def wind(self) -> tuple[float, float]:
        """Velocity of the wind [m/s]; zero where the water is switched off, out of which floes would stand."""
        return self._velocity_of("wind")

    @property
    def moment_level(self) -> float:
        """Height [m] over the water level about which moments are stated."""
        return float(self.case.get("output", {}).get("moment_level", 0.0))

    @property
    def flows(self) -> dict[str, tuple[float, float]]:
        """What moves the ice, by name, and its velocity [m/s], of a table that at the start; without what stands still."""
        told = {"current": self.case.get("water", {}), "wind": self.case.get("wind", {})}
        names = {what: f"{what} at the start" if table.get("velocity_table") else what for what, table in told.items()}
        return {names[what]: flow for what, flow in (("current", self.current), ("wind", self.wind)) if any(flow)}

    @property
    def changing_flows(self) -> dict[str, tuple[float, float]]:
        """Least and highest speed [m/s] of the current and of the wind where a table tells them."""
        tables = {what: self.case.get(table, {}).get("velocity_table") for what, table in (("current", "water"), ("wind", "wind"))}
        if not self.case.get("water", {}).get("enabled", True):
            return {}
        speeds = {what: [math.hypot(u, v) for _, u, v in rows] for what, rows in tables.items() if rows}
        return {what: (min(some), max(some)) for what, some in speeds.items()}

    def _velocity_of(self, what: str) -> tuple[float, float]:
        if not self.case.get("water", {}).get("enabled", True):
            return 0.0, 0.0
        velocity = self.case.get(what, {}).get("velocity", (0.0, 0.0))
        return float(velocity[0]), float(velocity[1])

    @property
    def upstream_angle(self) -> float | None:
        """Direction from which the current comes, degrees from +x; None in still water."""
        u, v = self.current
        return None if math.hypot(u, v) == 0.0 else math.degrees(math.atan2(0.0 - v, 0.0 - u))

    @property
    def afloat(self) -> tuple[float, float] | None:
        """Draft and freeboard [m] of a flat floe of the case's ice; None without water, or where the case does not say."""
        ice, water = self.case.get("ice", {}), self.case.get("water", {})
        thickness, densities = ice.get("thickness"), (ice.get("density"), water.get("density"))
        if thickness is None or None in densities or not water.get("enabled", True):
            return None
        draft = float(thickness) * float(densities[0]) / float(densities[1])
        return draft, float(thickness) - draft

    @property
    def simulated(self) -> float:
        """How far the run got [s]: the latest time in any of its files."""
        times = [float(self.summary.get("simulated_s") or 0.0)]
        times += [float(table["time_s"][-1]) for table in [self.energy, *self.forces.values()] if row_count(table)]
        times += [time for time, _ in self.snapshots[-1:]]
        return max(times)


def _sound(path: Path) -> Table:
    return require_table(read_table(path), path)


def open_facts(folder: Path) -> RunFolder:
    """A run folder with its case and summary alone: of a thousand runs not all tables fit into memory. Raises CaseError as open_run
    does."""
    case, summary = read_case(folder), read_summary(folder / "summary.json")
    return RunFolder(path=folder, case=case, summary=summary, forces={}, energy={}, snapshots=[])


def read_forces(folder: Path, case: dict[str, Any]) -> dict[str, Table]:
    """forces.csv by structure, in the order of the case. Raises CaseError for a damaged one."""
    return split_by_structure(_sound(folder / "forces.csv"), case)


def open_run(folder: Path) -> RunFolder:
    """Read the folder of one run. Raises CaseError when it holds no case.toml, or a file that is damaged."""
    case = read_case(folder)
    archive = read_archive(folder / "run.h5")
    return RunFolder(
        path=folder,
        case=case,
        summary=read_summary(folder / "summary.json"),
        forces=read_forces(folder, case),
        energy=_sound(folder / "energy.csv"),
        snapshots=list_snapshots(folder, case),
        load_maps=archive.load_maps,
        contacts=archive.contacts,
        floes=archive.floes,
        outlines=archive.outlines,
        energy_labels=archive.energy_labels,
        hits=split_by_structure(_sound(folder / "hits.csv"), case),
        kept_hits=archive.hits,
        motion=split_by_structure(_sound(folder / "structures.csv"), case),
    )

"""Reading a run folder: whatever is there, also when the run was killed half way or is still going on."""

from __future__ import annotations

import csv
import json
import math
import tomllib
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from dilatedem.errors import CaseError

Table = dict[str, np.ndarray]  # column name -> (rows,) float64, or object where a column holds text

AXES = ("x", "y")


@dataclass(frozen=True)
class LoadMap:
    """Impulse that a structure took up, by place: around a pile or along a plane, and over height."""

    structure: str
    kind: str  # "pile" | "plane"
    impulse: np.ndarray  # (places, heights) [N s], normal to the surface
    place_edges: np.ndarray  # (places + 1,): degrees for a pile, metres for a plane
    height_edges: np.ndarray  # (heights + 1,) [m], 0 is the water level
    duration: float  # s over which the impulse was gathered
    radius: float  # m, of a pile; nan otherwise


@dataclass(frozen=True)
class FloeTable:
    """The floes as they were at the start."""

    outlines: list[np.ndarray]  # each (vertices, 2) [m], world coordinates at t = 0
    plan_area: np.ndarray  # (n,) [m2]
    mass: np.ndarray  # (n,) [kg]


@dataclass(frozen=True)
class ContactStatistics:
    """Counts and extremes of the contacts by mode, for one kind of pair."""

    mode: list[str]
    columns: Table  # steps, impulse_Ns, max_force_N, max_overlap_m, each (modes,)


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
    floes: FloeTable | None = None

    @property
    def title(self) -> str:
        return str(self.case.get("title") or self.path.name)

    @property
    def structures(self) -> list[dict[str, Any]]:
        return list(self.case.get("structure", []))

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
        water = self.case.get("water", {})
        if not water.get("enabled", True):
            return 0.0, 0.0
        velocity = water.get("velocity", (0.0, 0.0))
        return float(velocity[0]), float(velocity[1])

    @property
    def upstream_angle(self) -> float | None:
        """Direction from which the current comes, degrees from +x; None in still water."""
        u, v = self.current
        return None if math.hypot(u, v) == 0.0 else math.degrees(math.atan2(0.0 - v, 0.0 - u))

    @property
    def simulated(self) -> float:
        """How far the run got [s]: the latest time in any of its files."""
        times = [float(self.summary.get("simulated_s") or 0.0)]
        times += [float(table["time_s"][-1]) for table in [self.energy, *self.forces.values()] if row_count(table)]
        times += [time for time, _ in self.snapshots[-1:]]
        return max(times)


def is_run(folder: Path) -> bool:
    return (folder / "case.toml").is_file()


def is_sweep(folder: Path) -> bool:
    return (folder / "sweep.csv").is_file()


def open_run(folder: Path) -> RunFolder:
    """Read the folder of one run. Raises CaseError when it holds no case.toml, or one that is not TOML."""
    if not is_run(folder):
        raise CaseError(f"{folder}: no run to be found here (there is no case.toml in it)")
    try:
        case = tomllib.loads((folder / "case.toml").read_text(encoding="utf-8"))
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise CaseError(f"{folder / 'case.toml'}: not a readable TOML file: {error}") from error
    maps, contacts, floes = read_archive(folder / "run.h5")
    return RunFolder(
        path=folder,
        case=case,
        summary=read_summary(folder / "summary.json"),
        forces=split_by_structure(read_table(folder / "forces.csv"), case),
        energy=read_table(folder / "energy.csv"),
        snapshots=list_snapshots(folder, case),
        load_maps=maps,
        contacts=contacts,
        floes=floes,
    )


def row_count(table: Table) -> int:
    return len(next(iter(table.values()))) if table else 0


def read_table(path: Path) -> Table:
    """A CSV file by columns, without a last line that was cut short; no file gives no columns."""
    if not path.is_file():
        return {}
    text = path.read_text(encoding="utf-8", errors="replace")
    text = text[: text.rfind("\n") + 1]  # without its line end a number may lack its last digits
    lines = list(csv.reader(text.splitlines()))
    if not lines:
        return {}
    header, *rows = lines
    rows = [row for row in rows if len(row) == len(header)]
    columns = zip(*rows, strict=True) if rows else [()] * len(header)
    return {name: as_numbers(column) for name, column in zip(header, columns, strict=True)}


def as_numbers(column: tuple[str, ...]) -> np.ndarray:
    try:
        return np.array([float(text) if text else math.nan for text in column], dtype=np.float64)
    except ValueError:
        return np.array(column, dtype=object)


def split_by_structure(table: Table, case: dict[str, Any]) -> dict[str, Table]:
    """Rows of forces.csv by the structure they belong to, structures in the order of the case."""
    if not row_count(table) or "structure" not in table:
        return {}
    label = np.array([as_name(value) for value in table["structure"]], dtype=object)
    known = [str(structure.get("name")) for structure in case.get("structure", [])]
    names = [name for name in known if name in label] + sorted(set(label) - set(known))
    numeric = [name for name in table if name != "structure"]
    return {name: {column: table[column][label == name] for column in numeric} for name in names}


def as_name(value: Any) -> str:
    """A structure may be called `1`, which as_numbers has turned into 1.0."""
    return str(int(value)) if isinstance(value, float) and value.is_integer() else str(value)


def read_summary(path: Path) -> dict[str, Any]:
    """summary.json, or an empty dict where there is none or it cannot be read."""
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}
    return content if isinstance(content, dict) else {}


def list_snapshots(folder: Path, case: dict[str, Any]) -> list[tuple[float, Path]]:
    """Times and files of the snapshots, from ice.pvd; where that is missing, from the files' numbers."""
    found: list[tuple[float, Path]] = []
    try:
        tree = ElementTree.parse(folder / "ice.pvd")
        for entry in tree.iter("DataSet"):
            found.append((float(entry.get("timestep", "nan")), folder / entry.get("file", "")))
    except (OSError, ElementTree.ParseError, ValueError):
        interval = float(case.get("output", {}).get("snapshot_interval", 1.0))
        for file in sorted((folder / "snapshots").glob("ice_*.vtu")):
            number = file.stem.removeprefix("ice_")
            if number.isdigit():
                found.append((int(number) * interval, file))
    return sorted((time, file) for time, file in found if math.isfinite(time) and file.is_file())


def read_archive(path: Path) -> tuple[dict[str, LoadMap], dict[str, ContactStatistics], FloeTable | None]:
    """Load maps, contact statistics and floe table of run.h5; what is missing or unreadable stays empty."""
    maps: dict[str, LoadMap] = {}
    contacts: dict[str, ContactStatistics] = {}
    floes = None
    try:
        with h5py.File(path, "r") as archive:
            for name, group in archive.get("load_map", {}).items():
                maps[name] = read_load_map(name, group)
            for pair, group in archive.get("contacts", {}).items():
                if isinstance(group, h5py.Group):
                    contacts[pair] = read_contacts(archive["contacts"], group)
            if "floes" in archive:
                floes = read_floes(archive["floes"])
    except (OSError, KeyError):
        pass
    return maps, contacts, floes


def read_load_map(name: str, group: h5py.Group) -> LoadMap:
    place = "angle_edges_deg" if "angle_edges_deg" in group else "distance_edges_m"
    kind = group.attrs.get("kind", "pile" if place == "angle_edges_deg" else "plane")
    return LoadMap(
        structure=name,
        kind=as_text(kind),
        impulse=group["impulse_Ns"][()],
        place_edges=group[place][()],
        height_edges=group["height_edges_m"][()],
        duration=float(group.attrs.get("duration_s", math.nan)),
        radius=float(group.attrs.get("radius_m", math.nan)),
    )


def read_contacts(parent: h5py.Group, group: h5py.Group) -> ContactStatistics:
    names = parent["mode_names"][()] if "mode_names" in parent else parent.attrs["mode_names"]
    columns = {name: np.asarray(data[()], dtype=np.float64) for name, data in group.items()}
    return ContactStatistics([as_text(name) for name in names], columns)


def read_floes(group: h5py.Group) -> FloeTable:
    points, start = group["outline_points"][()], group["outline_start"][()]
    outlines = [points[first:last] for first, last in zip(start[:-1], start[1:], strict=True)]
    return FloeTable(outlines, group["plan_area_m2"][()], group["mass_kg"][()])


def as_text(value: Any) -> str:
    return value.decode() if isinstance(value, bytes) else str(value)

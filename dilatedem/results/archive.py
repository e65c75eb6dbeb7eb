"""run.h5: load maps, contact statistics and the table of floes; what is missing stays empty."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from dilatedem.results.hits import KeptHit, read_hits
from dilatedem.results.soundness import damaged, require_array
from dilatedem.results.tables import Table

#: of contacts, by mode
COUNTED = ("steps", "impulse_Ns", "max_force_N", "max_overlap_m")
#: of `floes`, what is no column of the table: outlines and their dimensions
OUTLINES = frozenset({"outline_points", "outline_start", "point", "xy"})


@dataclass(frozen=True)
class LoadMap:
    """Impulse that a structure took up, by place: around a pile or along a plane, and over height."""

    structure: str
    kind: str  # of the structure, as in the case file
    impulse: np.ndarray  # (places, heights) [N s], normal to the surface
    place_edges: np.ndarray  # (places + 1,): degrees or metres, as `unit` says
    height_edges: np.ndarray  # (heights + 1,) [m], 0 is the water level
    duration: float  # s over which the impulse was gathered
    radius: float  # m, of the surface that angles run around; nan otherwise
    place: str = "angle"  # what place_edges are: "angle" | "distance"
    unit: str = "deg"  # of place_edges
    label: str = ""  # the first axis in words
    attributes: dict[str, Any] = field(default_factory=dict)  # all that run.h5 says of the map


@dataclass(frozen=True)
class PlanOutline:
    """A structure in plan, at the water level."""

    outline: np.ndarray  # (corners, 2) [m]; none where the water level does not cut it
    bounded: bool  # whether the outline closes around it; else its first side is its face, and the solid goes on behind it
    place: np.ndarray = field(default_factory=lambda: np.zeros(2))  # [m] about which it turns where it moves

    def moved(self, shift: np.ndarray, yaw: float) -> PlanOutline:
        """The same after moving by `shift` (2,) [m] and turning by `yaw` [rad] about its place."""
        s, c = math.sin(yaw), math.cos(yaw)
        arm = self.outline - self.place
        turned = np.column_stack([c * arm[:, 0] - s * arm[:, 1], s * arm[:, 0] + c * arm[:, 1]])
        return PlanOutline(turned + self.place + shift, self.bounded, self.place + shift)


@dataclass(frozen=True)
class FloeTable:
    """The floes as they were at the start."""

    outlines: list[np.ndarray]  # each (vertices, 2) [m], world coordinates at t = 0
    plan_area: np.ndarray  # (n,) [m2]
    mass: np.ndarray  # (n,) [kg]
    columns: Table = field(default_factory=dict)  # every column of run.h5, by its name there


@dataclass(frozen=True)
class ContactStatistics:
    """Counts and extremes of the contacts by mode, for one kind of pair."""

    mode: list[str]
    columns: Table  # steps, impulse_Ns, max_force_N, max_overlap_m, each (modes,)


@dataclass
class Archive:
    """All of run.h5."""

    load_maps: dict[str, LoadMap] = field(default_factory=dict)  # by structure
    contacts: dict[str, ContactStatistics] = field(default_factory=dict)  # by "ice_ice", "ice_structure"
    floes: FloeTable | None = None
    outlines: dict[str, PlanOutline] = field(default_factory=dict)  # by structure
    energy_labels: dict[str, str] = field(default_factory=dict)  # terms of energy.csv in words
    hits: list[KeptHit] = field(default_factory=list)  # the highest load events, the highest first


def read_archive(path: Path) -> Archive:
    """What there is of it; nothing of a file that is no HDF5. Raises CaseError for contents that no run has written."""
    try:
        file = h5py.File(path, "r")
    except OSError:
        return Archive()
    try:
        return _read(file)
    except (ValueError, KeyError, TypeError, IndexError, AttributeError, OSError, RuntimeError) as error:  # as h5py raises them
        raise damaged(path, f"its contents cannot be read ({error})") from error
    finally:
        file.close()


def _read(archive: h5py.File) -> Archive:
    """Raises whatever Python and h5py do where something is not what it should be."""
    found = Archive()
    terms = (archive.attrs.get(name, ()) for name in ("energy_terms", "energy_labels"))
    found.energy_labels = dict(zip(*(map(as_text, names) for names in terms), strict=True))
    for name, group in groups_with(archive.get("load_map", {}), "impulse_Ns"):
        found.load_maps[name] = read_load_map(name, group)
    for pair, group in archive.get("contacts", {}).items():
        if isinstance(group, h5py.Group):
            found.contacts[pair] = read_contacts(archive["contacts"], group)
    if "floes" in archive:
        found.floes = read_floes(archive["floes"])
    if "hits" in archive:
        found.hits = read_hits(archive["hits"], [as_text(name) for name in archive["contacts"].attrs["mode_names"]])
    for name, group in groups_with(archive.get("structures", {}), "outline_m"):
        outline = require_array(group["outline_m"][()], (None, 2), f"the outline of {name}")
        place = require_array(group.attrs.get("place_m", np.zeros(2)), (2,), f"the place of {name}")
        found.outlines[name] = PlanOutline(outline, bool(group.attrs["bounded"]), place)
    return found


def groups_with(parent: h5py.Group, dataset: str, prefix: str = "") -> Iterator[tuple[str, h5py.Group]]:
    """Names and groups that have a dataset of this name; that of a structure's part is called `structure/part`."""
    for name, group in parent.items():
        if isinstance(group, h5py.Group):
            if dataset in group:
                yield f"{prefix}{name}", group
            yield from groups_with(group, dataset, f"{prefix}{name}/")


def read_load_map(name: str, group: h5py.Group) -> LoadMap:
    edges = next((key for key in group if "_edges_" in key and key != "height_edges_m"), "place_edges_m")
    place, unit = edges.split("_edges_")
    attributes = {key: as_text(value) if isinstance(value, bytes | str) else value for key, value in group.attrs.items()}
    of = f"the load map of {name}: "
    places = require_array(group[edges][()], (None,), of + edges)
    heights = require_array(group["height_edges_m"][()], (None,), of + "height_edges_m")
    impulse = require_array(group["impulse_Ns"][()], (len(places) - 1, len(heights) - 1), of + "impulse_Ns")
    if not (np.diff(places) > 0.0).all() or not (np.diff(heights) > 0.0).all():
        raise ValueError(of + "its edges do not go up")
    return LoadMap(
        structure=name,
        kind=as_text(group.attrs.get("kind", "pile" if place == "angle" else "plane")),
        impulse=impulse,
        place_edges=places,
        height_edges=heights,
        duration=float(group.attrs.get("duration_s", math.nan)),
        radius=float(group.attrs.get("radius_m", math.nan)),
        place=place,
        unit=unit,
        label=as_text(group.attrs.get("axis_label", "")),
        attributes=attributes,
    )


def read_contacts(parent: h5py.Group, group: h5py.Group) -> ContactStatistics:
    names = parent["mode_names"][()] if "mode_names" in parent else parent.attrs["mode_names"]
    found = {name: data[()] for name, data in group.items() if name in COUNTED or data.dtype.kind in "iuf"}
    columns = {name: require_array(np.asarray(found[name]), (len(names),), f"contacts: {name}") for name in (*COUNTED, *found)}
    columns = {name: column.astype(np.float64) for name, column in columns.items()}
    return ContactStatistics([as_text(name) for name in names], columns)


def read_floes(group: h5py.Group) -> FloeTable:
    points, start = require_array(group["outline_points"][()], (None, 2), "floes: outline_points"), group["outline_start"][()]
    require_array(start, (None,), "floes: outline_start")
    if start.dtype.kind == "f" or (np.diff(start) < 0).any() or not len(start) or start[0] != 0 or start[-1] != len(points):
        raise ValueError("floes: outline_start does not tell where outlines begin")
    for name in {"plan_area_m2", "mass_kg", *group} - OUTLINES:
        require_array(group[name][()], (len(start) - 1,), f"floes: {name}")
    outlines = [points[first:last] for first, last in zip(start[:-1], start[1:], strict=True)]
    columns = {name: data[()] for name, data in group.items() if name not in OUTLINES}
    return FloeTable(outlines, group["plan_area_m2"][()], group["mass_kg"][()], columns)


def as_text(value: Any) -> str:
    return value.decode() if isinstance(value, bytes) else str(value)

"""run.h5: where on each structure the load acted, how floes touched, and the table of floes.

At every checkpoint a whole new file takes the old one's place in one step: it is small (a load map is some thousand numbers), so
that is safer than editing an HDF5 file in place. It is laid out once, in memory, where only the numbers that have changed are put
in: laying it out anew takes HDF5 some 15 ms each time.

The file describes itself: every dataset has `units` and `long_name`, and its dimensions have names and coordinates.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import h5py
import numpy as np

from dilatedem import __version__
from dilatedem.files.atomic import write_bytes
from dilatedem.output import dimensions, folder
from dilatedem.output.kept_hits import write_hits
from dilatedem.state.modes import MODE_NAMES

CONVENTIONS = (
    "SI units, that of a dataset in its attribute units, that of an attribute at the end of its name; "
    "z up from the water level; directions in degrees from +x, counter-clockwise seen from above"
)
#: units and meaning of the datasets
FLOES = {
    "x0_m": ("m", "x of the centroid at t = 0"),
    "y0_m": ("m", "y of the centroid at t = 0"),
    "plan_area_m2": ("m2", "plan area of the rounded floe"),
    "mass_kg": ("kg", "mass of the rounded body"),
    "volume_m3": ("m3", "volume of the rounded body"),
    "vertices": ("1", "number of vertices of the core"),
}
CONTACTS = {
    "steps": ("1", "contacts times steps since t = 0"),
    "impulse_Ns": ("N s", "normal force times time step, summed since t = 0"),
    "max_force_N": ("N", "largest normal force of one contact in one step"),
    "max_overlap_m": ("m", "largest overlap, at the point where the force acts"),
}


@dataclass(frozen=True)
class LoadMap:
    """Normal impulse on one structure, summed over the run in bins of position.

    structure    name
    kind         of the structure, as in the case file
    impulse      (bins, height bins) [N s]
    place        what the first axis is: "angle" [deg] or "distance" [m]
    label, zero  that axis in words, and where its zero lies
    edges        (bins + 1,) bounds of the first axis
    height_edges (height bins + 1,) [m]
    duration_s   time over which the impulse was summed
    center       (2,) the structure's centre in plan, or (3,) the point that distances are measured from [m]
    radius       of the surface that angles run around [m]; None for distances
    axis         (3,) unit vector along which distances are measured; None where they are not along a line
    upstream_deg where the current comes from, an angle of the first axis [deg]; nan in still water
    """

    structure: str
    kind: str
    impulse: np.ndarray
    place: str
    label: str
    zero: str
    edges: np.ndarray
    height_edges: np.ndarray
    duration_s: float
    center: Sequence[float]
    radius: float | None = None
    axis: Sequence[float] | None = None
    upstream_deg: float = math.nan


class PlanOutline(NamedTuple):
    """A structure in plan, at the water level.

    structure: name; kind: as in the case file; outline (k, 2) [m], none (0, 2) where the water level does not cut it; bounded:
    whether the outline closes around it; else its first side is its face, and the solid goes on behind it; place (2,) [m]: about
    which it turns where it moves, at t = 0.
    """

    structure: str
    kind: str
    outline: np.ndarray
    bounded: bool
    place: np.ndarray


class ContactStatistics(NamedTuple):
    """What went on in each contact mode, in the order of MODE_NAMES.

    steps (modes,) contact-steps; impulse (modes,) [N s], max_force (modes,) [N], max_overlap (modes,) [m]
    """

    steps: np.ndarray
    impulse: np.ndarray
    max_force: np.ndarray
    max_overlap: np.ndarray


@dataclass(frozen=True)
class FloeTable:
    """The bodies at t = 0, one entry each.

    body (n,) number; x0, y0 (n,) [m] centroid; plan_area (n,) [m2]; mass (n,) [kg]; volume (n,) [m3];
    vertices (n,) of the core; floe (n,): number of the first part of the floe that it is part of; outlines: n arrays (k, 2) [m],
    outer, world coordinates, counter-clockwise
    """

    body: np.ndarray
    x0: np.ndarray
    y0: np.ndarray
    plan_area: np.ndarray
    mass: np.ndarray
    volume: np.ndarray
    vertices: np.ndarray
    floe: np.ndarray
    outlines: Sequence[np.ndarray]

    def rows(self, which: np.ndarray) -> "FloeTable":
        """The bodies in the rows `which` (m,)."""
        return FloeTable(**{
            name: [values[i] for i in which] if name == "outlines" else values[which] for name, values in vars(self).items()
        })

    @classmethod
    def of(cls, tables: "Sequence[FloeTable]") -> "FloeTable":
        """Several tables, one after the other."""
        columns = {name: [getattr(table, name) for table in tables] for name in vars(tables[0])}
        return cls(**{
            name: [outline for some in parts for outline in some] if name == "outlines" else np.concatenate(parts)
            for name, parts in columns.items()
        })


class RunArchive:
    """run.h5 in memory, to be brought up to date and written again and again.

    load_maps           of all structures
    contact_statistics  of "ice_ice" and "ice_structure"
    floes               of the run's begin
    outlines            of all structures in plan
    about               attributes of the file, such as `title`, `seed`; `current_velocity_m_s` (2,) gives its direction, too
    hits                the highest load events, by the names of `kept_hits.DATASETS`; dt: time step [s]

    Raises ValueError for load maps or statistics of the wrong shape; `update` does so, too.
    """

    def __init__(
        self, load_maps: Sequence[LoadMap], contact_statistics: dict[str, ContactStatistics], floes: FloeTable, *,
        outlines: Sequence[PlanOutline] = (), about: Mapping[str, Any] | None = None, hits: Mapping[str, np.ndarray] | None = None,
        dt: float = math.nan,
    ):  # fmt: skip
        changing = _changing(load_maps, contact_statistics, hits or {})
        self._file = h5py.File(folder.RUN_ARCHIVE, "w", driver="core", backing_store=False)
        _write_about(self._file, about or {})
        maps = self._file.create_group("load_map", track_order=True)
        for load_map in load_maps:
            _write_load_map(maps.create_group(load_map.structure), load_map)
        structures = self._file.create_group("structures", track_order=True)
        for outline in outlines:
            _write_outline(structures.create_group(outline.structure), outline)
        contacts = self._file.create_group("contacts")
        contacts.attrs["mode_names"] = list(MODE_NAMES)
        for partners, statistics in contact_statistics.items():
            _write_statistics(contacts.create_group(partners), statistics)
        if hits:
            write_hits(self._file.create_group("hits"), hits, [outline.structure for outline in outlines], dt)
        self._datasets = {name: self._file[name].id for name in changing}  # h5py's lower level writes ten times as fast
        _write_floes(self._file.create_group("floes"), floes)

    def update(
        self, load_maps: Sequence[LoadMap], contact_statistics: dict[str, ContactStatistics],
        hits: Mapping[str, np.ndarray] | None = None,
    ) -> None:  # fmt: skip
        """Put in what changes in the course of a run: impulses, the time they were summed over, statistics, load events."""
        changing = _changing(load_maps, contact_statistics, hits or {})
        for load_map in load_maps:
            self._file["load_map"][load_map.structure].attrs.modify("duration_s", load_map.duration_s)
        for name, values in changing.items():
            self._datasets[name].write(h5py.h5s.ALL, h5py.h5s.ALL, np.ascontiguousarray(values))

    def write(self, path) -> None:
        """Replace the file at `path`, atomically."""
        self._file.flush()
        write_bytes(path, self._file.id.get_file_image())

    def close(self) -> None:
        """Give the memory back."""
        self._file.close()


def direction(x: float, y: float) -> float:
    """Angle [deg] of a vector in plan from +x, counter-clockwise seen from above, -180 to 180; nan of one without length."""
    return math.degrees(math.atan2(y + 0.0, x + 0.0)) if math.hypot(x, y) > 0.0 else math.nan


def _write_about(file: h5py.File, about: Mapping[str, Any]) -> None:
    """Attributes of the whole file."""
    current = about.get("current_velocity_m_s")
    if current is not None:
        about = {**about, "current_velocity_m_s": np.array(current, dtype=float), "current_direction_deg": direction(*current)}
    file.attrs.update({"program": "dilatedem", "version": __version__, "conventions": CONVENTIONS, **about})


def _write_load_map(group: h5py.Group, load_map: LoadMap) -> None:
    """A load map with its coordinates: the centres of the bins; their bounds lie along dimensions of their own."""
    unit, short = ("degree", "deg") if load_map.place == "angle" else ("m", "m")
    axes = []
    for name, edges, edges_name, units, meaning in (
        (load_map.place, load_map.edges, f"{load_map.place}_edges_{short}", unit, load_map.zero),
        ("height", load_map.height_edges, "height_edges_m", "m", "height above the water level"),
    ):
        centres = 0.5 * (np.asarray(edges)[1:] + np.asarray(edges)[:-1])
        axes.append(dimensions.coordinate(group, name, centres, units, meaning))
        dimensions.coordinate(group, edges_name, edges, units, f"bounds of the bins of {name}")
    dimensions.write(group, "impulse_Ns", load_map.impulse, "N s", "normal impulse since t = 0, by place and height", axes)
    group.attrs["structure"] = load_map.structure
    group.attrs["kind"] = load_map.kind
    group.attrs["duration_s"] = load_map.duration_s
    group.attrs["center_m"] = np.asarray(load_map.center, dtype=float)
    group.attrs["first_axis"] = load_map.zero
    group.attrs["axis_label"] = load_map.label
    if load_map.place == "angle":
        group.attrs["upstream_deg"] = load_map.upstream_deg
    if load_map.radius is not None:
        group.attrs["radius_m"] = load_map.radius
    if load_map.axis is not None:
        group.attrs["axis"] = np.asarray(load_map.axis, dtype=float)


def _write_outline(group: h5py.Group, outline: PlanOutline) -> None:
    corner, xy = dimensions.dimension(group, "corner", len(outline.outline)), ["x", "y"]
    axes = [corner, dimensions.coordinate(group, "xy", xy, "1", "component")]
    dimensions.write(group, "outline_m", outline.outline, "m", "outline in plan at the water level, counter-clockwise", axes)
    group.attrs["kind"] = outline.kind
    group.attrs["bounded"] = int(outline.bounded)
    group.attrs["place_m"] = outline.place


def _write_statistics(group: h5py.Group, statistics: ContactStatistics) -> None:
    mode = dimensions.coordinate(group, "mode", MODE_NAMES, "1", "what touches what")
    for (name, description), values in zip(CONTACTS.items(), statistics, strict=True):
        dimensions.write(group, name, values, *description, [mode])


def _changing(
    load_maps: Sequence[LoadMap], contact_statistics: dict[str, ContactStatistics], hits: Mapping[str, np.ndarray]
) -> dict[str, np.ndarray]:
    """The datasets that change in the course of a run."""
    found = {f"hits/{name}": values for name, values in hits.items()}
    for load_map in load_maps:
        bins = (len(load_map.edges) - 1, len(load_map.height_edges) - 1)
        if np.shape(load_map.impulse) != bins:
            raise ValueError(f"load map of {load_map.structure}: shape {np.shape(load_map.impulse)}, not {bins}")
        found[f"load_map/{load_map.structure}/impulse_Ns"] = load_map.impulse
    for partners, statistics in contact_statistics.items():
        if any(np.shape(values) != (len(MODE_NAMES),) for values in statistics):
            raise ValueError(f"contact statistics of {partners}: one value for each of the modes")
        for name, values in zip(CONTACTS, statistics, strict=True):
            found[f"contacts/{partners}/{name}"] = values
    return found


def _write_floes(group: h5py.Group, floes: FloeTable) -> None:
    body = dimensions.coordinate(group, "body", np.asarray(floes.body, dtype=np.int64), "1", "number of the body")
    columns = (floes.x0, floes.y0, floes.plan_area, floes.mass, floes.volume, np.asarray(floes.vertices, dtype=np.int64))
    for (name, description), values in zip(FLOES.items(), columns, strict=True):
        dimensions.write(group, name, values, *description, [body])
    if (np.asarray(floes.floe) != floes.body).any():
        dimensions.write(group, "floe", floes.floe, "1", "number of the first part of the floe that the body is part of", [body])
    # Outlines differ in length: all points in one table, and where each body's points start.
    counts = [len(outline) for outline in floes.outlines]
    points = np.concatenate([np.zeros((0, 2)), *floes.outlines])
    axes = [dimensions.dimension(group, "point", len(points)), dimensions.coordinate(group, "xy", ["x", "y"], "1", "component")]
    meaning = "outer outlines in plan at t = 0, counter-clockwise, one body after the other"
    dimensions.write(group, "outline_points", points, "m", meaning, axes)
    start = np.concatenate([[0], np.cumsum(counts, dtype=np.int64)]).astype(np.int64)
    dimensions.coordinate(group, "outline_start", start, "1", "first of each outline in outline_points; last, their number")

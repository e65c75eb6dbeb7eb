"""run.h5: where on each structure the load acted, how floes touched, and the table of floes.

At every checkpoint a whole new file takes the old one's place in one step: it is small (a load map is some thousand numbers), so
that is safer than editing an HDF5 file in place. It is laid out once, in memory, where only the numbers that have changed are put
in: laying it out anew takes HDF5 4 ms each time.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import h5py
import numpy as np

from dilatedem.output import folder
from dilatedem.output.atomic import replacing
from dilatedem.state.modes import MODE_NAMES

ANGLE_ORIGIN = "angle about the pile's centre: 0 = +x, the lee side; -180 and 180 = -x, the upstream side"
DISTANCE_ORIGIN = "horizontal coordinate along the plane, from center_m in the direction of axis"


@dataclass(frozen=True)
class LoadMap:
    """Normal impulse on one structure, summed over the run in bins of position.

    structure    name
    kind         "pile" (first axis: angle) or "plane" (first axis: distance)
    impulse      (bins, height bins) [N s]
    edges        (bins + 1,) bounds of the first axis: [deg], -180 to 180, for a pile; [m] for a plane
    height_edges (height bins + 1,) [m]
    duration_s   time over which the impulse was summed
    center       (2,) centre of a pile in plan, or (3,) a plane's origin of distance [m]
    radius       of a pile [m]; None for a plane
    axis         (3,) unit vector along which a plane's distance is measured; None for a pile
    """

    structure: str
    kind: str
    impulse: np.ndarray
    edges: np.ndarray
    height_edges: np.ndarray
    duration_s: float
    center: Sequence[float]
    radius: float | None = None
    axis: Sequence[float] | None = None


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
    vertices (n,) of the core; outlines: n arrays (k, 2) [m], outer, world coordinates, counter-clockwise
    """

    body: np.ndarray
    x0: np.ndarray
    y0: np.ndarray
    plan_area: np.ndarray
    mass: np.ndarray
    volume: np.ndarray
    vertices: np.ndarray
    outlines: Sequence[np.ndarray]


class RunArchive:
    """run.h5 in memory, to be brought up to date and written again and again.

    load_maps           of all structures
    contact_statistics  of "ice_ice" and "ice_structure"
    floes               of the run's begin

    Raises ValueError for load maps or statistics of the wrong shape; `update` does so, too.
    """

    def __init__(self, load_maps: Sequence[LoadMap], contact_statistics: dict[str, ContactStatistics], floes: FloeTable):
        self._file = h5py.File(folder.RUN_ARCHIVE, "w", driver="core", backing_store=False)
        maps = self._file.create_group("load_map", track_order=True)
        for load_map in load_maps:
            _write_load_map(maps.create_group(load_map.structure), load_map)
        contacts = self._file.create_group("contacts")
        contacts.attrs["mode_names"] = list(MODE_NAMES)
        changing = _changing(load_maps, contact_statistics)
        for name, values in changing.items():
            self._file[name] = values
        self._datasets = {name: self._file[name].id for name in changing}  # h5py's lower level writes ten times as fast
        _write_floes(self._file.create_group("floes"), floes)

    def update(self, load_maps: Sequence[LoadMap], contact_statistics: dict[str, ContactStatistics]) -> None:
        """Put in what changes in the course of a run: impulses, the time they were summed over, statistics."""
        changing = _changing(load_maps, contact_statistics)
        for load_map in load_maps:
            self._file["load_map"][load_map.structure].attrs.modify("duration_s", load_map.duration_s)
        for name, values in changing.items():
            self._datasets[name].write(h5py.h5s.ALL, h5py.h5s.ALL, np.ascontiguousarray(values))

    def write(self, path) -> None:
        """Replace the file at `path`, atomically."""
        self._file.flush()
        with replacing(path) as temporary:
            temporary.write_bytes(self._file.id.get_file_image())

    def close(self) -> None:
        """Give the memory back."""
        self._file.close()


def _write_load_map(group: h5py.Group, load_map: LoadMap) -> None:
    """All of a load map but its impulse."""
    on_pile = load_map.kind == "pile"
    group["angle_edges_deg" if on_pile else "distance_edges_m"] = load_map.edges
    group["height_edges_m"] = load_map.height_edges
    group.attrs["kind"] = load_map.kind
    group.attrs["duration_s"] = load_map.duration_s
    group.attrs["center_m"] = np.asarray(load_map.center, dtype=float)
    group.attrs["first_axis"] = ANGLE_ORIGIN if on_pile else DISTANCE_ORIGIN
    if load_map.radius is not None:
        group.attrs["radius_m"] = load_map.radius
    if load_map.axis is not None:
        group.attrs["axis"] = np.asarray(load_map.axis, dtype=float)


def _changing(load_maps: Sequence[LoadMap], contact_statistics: dict[str, ContactStatistics]) -> dict[str, np.ndarray]:
    """The datasets that change in the course of a run."""
    found = {}
    for load_map in load_maps:
        bins = (len(load_map.edges) - 1, len(load_map.height_edges) - 1)
        if np.shape(load_map.impulse) != bins:
            raise ValueError(f"load map of {load_map.structure}: shape {np.shape(load_map.impulse)}, not {bins}")
        found[f"load_map/{load_map.structure}/impulse_Ns"] = load_map.impulse
    for partners, statistics in contact_statistics.items():
        if any(np.shape(values) != (len(MODE_NAMES),) for values in statistics):
            raise ValueError(f"contact statistics of {partners}: one value for each of the modes")
        for name, values in zip(("steps", "impulse_Ns", "max_force_N", "max_overlap_m"), statistics, strict=True):
            found[f"contacts/{partners}/{name}"] = values
    return found


def _write_floes(group: h5py.Group, floes: FloeTable) -> None:
    group["body"] = np.asarray(floes.body, dtype=np.int64)
    group["x0_m"] = floes.x0
    group["y0_m"] = floes.y0
    group["plan_area_m2"] = floes.plan_area
    group["mass_kg"] = floes.mass
    group["volume_m3"] = floes.volume
    group["vertices"] = np.asarray(floes.vertices, dtype=np.int64)
    # Outlines differ in length: all points in one table, and where each body's points start.
    counts = [len(outline) for outline in floes.outlines]
    group["outline_points"] = np.concatenate([np.zeros((0, 2)), *floes.outlines])
    group["outline_start"] = np.concatenate([[0], np.cumsum(counts, dtype=np.int64)]).astype(np.int64)

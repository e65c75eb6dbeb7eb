"""The floes of one moment in plan, from a VTU snapshot."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import shapely

from dilatedem.results.soundness import require_array


@dataclass(frozen=True)
class Snapshot:
    """Floes at one time; every array has one row per floe, in the order of their numbers."""

    time: float  # s
    outlines: list[np.ndarray]  # each (vertices, 2) [m]: outline of the floe seen from above
    body: np.ndarray  # (n,) body numbers
    speed: np.ndarray  # (n,) [m/s]
    velocity: np.ndarray  # (n, 3) [m/s]
    angular_velocity: np.ndarray  # (n, 3) [rad/s], world axes
    contact_force: np.ndarray  # (n, 3) [N]: sum of all contact forces on the floe at this instant
    contacts: np.ndarray  # (n,) number of its contacts


def read_snapshot(path: Path, time: float) -> Snapshot:
    """Read one VTU file of polyhedra. Raises OSError when the file is cut short or damaged."""
    import meshio  # here: it loads much, and runs write snapshots without it

    try:
        return _read(meshio.read(path), time)
    except (SystemExit, Exception) as error:  # meshio raises what its parsers raise, and exits on some faults
        raise OSError(f"{path}: not a readable snapshot: {error}") from error


def _read(mesh, time: float) -> Snapshot:
    """mesh: as meshio reads it. Raises whatever NumPy and meshio do where something is not what it should be."""
    # Blocks and their data agree because a run writes its cells by their number of corners; see output.snapshots.vtu.
    cells = [np.concatenate(faces) for block in mesh.cells for faces in block.data]
    count = len(cells)
    owner = np.repeat(np.arange(count), [len(corners) for corners in cells])
    corners = mesh.points[np.concatenate(cells), :2] if cells else np.zeros((0, 2))
    require_array(corners, (None, 2), "its points")
    outlines = plan_outlines(corners, owner, count)
    body = gather(mesh, "body", (count,)).astype(np.int64)
    order = np.argsort(body, kind="stable")
    return Snapshot(
        time=time,
        outlines=[outlines[i] for i in order],
        body=body[order],
        speed=gather(mesh, "speed", (count,))[order],
        velocity=gather(mesh, "velocity", (count, 3))[order],
        angular_velocity=gather(mesh, "angular_velocity", (count, 3))[order],
        contact_force=gather(mesh, "contact_force", (count, 3))[order],
        contacts=gather(mesh, "contacts", (count,)).astype(np.int64)[order],
    )


def nearest_snapshot(listed: Iterable[tuple[float, Path]], time: float) -> Snapshot:
    """The readable snapshot nearest to `time` [s] of those listed; the last may have been cut short when the run was killed.

    Raises OSError when none can be read.
    """
    for at, path in sorted(listed, key=lambda entry: abs(entry[0] - time)):
        try:
            return read_snapshot(path, at)
        except OSError:
            continue
    raise OSError("no readable snapshot")


def gather(mesh, name: str, shape: tuple[int, ...]) -> np.ndarray:
    """Cell data of all blocks of a mesh of meshio, one after the other; zeros where the file lacks this array."""
    if name not in mesh.cell_data:
        return np.zeros(shape)
    values = np.concatenate([np.asarray(block) for block in mesh.cell_data[name]]).reshape(shape)
    return require_array(values, shape, name)


def plan_outlines(corners: np.ndarray, owner: np.ndarray, count: int) -> list[np.ndarray]:
    """Outlines (k, 2) [m] of convex bodies seen from above: the convex hulls of their corners.

    corners: (m, 2) [m], body after body; owner: (m,) the body each belongs to, of `count`.
    """
    if count == 0:
        return []
    hulls = shapely.convex_hull(shapely.multipoints(shapely.points(corners), indices=owner))
    # A body seen edge-on leaves a line; its two ends are drawn as nothing, which is right.
    points, index = shapely.get_coordinates(hulls, return_index=True)
    ends = np.searchsorted(index, np.arange(count + 1))
    return [points[first : max(last - 1, first + 1)] for first, last in zip(ends[:-1], ends[1:], strict=True)]

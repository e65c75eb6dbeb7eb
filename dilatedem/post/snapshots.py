"""The floes of one moment in plan, from a VTU snapshot."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import meshio
import numpy as np
import shapely

from dilatedem.post.read import RunFolder


@dataclass(frozen=True)
class Snapshot:
    """Floes at one time; every array has one row per floe, in the order of the file."""

    time: float  # s
    outlines: list[np.ndarray]  # each (vertices, 2) [m]: outline of the floe seen from above
    body: np.ndarray  # (n,) body numbers
    speed: np.ndarray  # (n,) [m/s]
    velocity: np.ndarray  # (n, 3) [m/s]


def read_snapshot(path: Path, time: float) -> Snapshot:
    """Read one VTU file of polyhedra. Raises OSError when the file is cut short or damaged."""
    try:
        mesh = meshio.read(path)
    except (SystemExit, Exception) as error:  # meshio raises what its parsers raise, and exits on some faults
        raise OSError(f"{path}: not a readable snapshot: {error}") from error
    # Blocks and their data agree because a run writes its cells by their number of corners; see output.vtu.
    cells = [np.concatenate(faces) for block in mesh.cells for faces in block.data]
    owner = np.repeat(np.arange(len(cells)), [len(corners) for corners in cells])
    corners = mesh.points[np.concatenate(cells), :2] if cells else np.zeros((0, 2))
    return Snapshot(
        time=time,
        outlines=plan_outlines(corners, owner, len(cells)),
        body=gather(mesh, "body", (len(cells),)).astype(np.int64),
        speed=gather(mesh, "speed", (len(cells),)),
        velocity=gather(mesh, "velocity", (len(cells), 3)),
    )


def gather(mesh: meshio.Mesh, name: str, shape: tuple[int, ...]) -> np.ndarray:
    """Cell data of all blocks, one after the other; zeros where the file lacks this array."""
    if name not in mesh.cell_data:
        return np.zeros(shape)
    return np.concatenate([np.asarray(block) for block in mesh.cell_data[name]]).reshape(shape)


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


def snapshots_at(run: RunFolder, fractions: tuple[float, ...]) -> list[Snapshot]:
    """The readable snapshots nearest to these fractions of the snapshots' time span, in order, none twice."""
    remaining = list(run.snapshots)
    if not remaining:
        return []
    first, last = remaining[0][0], remaining[-1][0]
    chosen: dict[float, Snapshot] = {}
    for fraction in fractions:
        wanted = first + fraction * (last - first)
        while remaining:
            time, path = min(remaining, key=lambda entry: abs(entry[0] - wanted))
            if time in chosen:
                break
            try:
                chosen[time] = read_snapshot(path, time)
                break
            except OSError:
                remaining.remove((time, path))  # cut short when the run was killed: take its neighbour
    return [chosen[time] for time in sorted(chosen)]

"""A closed surface from a file, as convex solids: its connected pieces, and those that are not convex split into some that are."""

from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import numpy as np

from dilatedem.geometry.polyhedron import Polyhedron, convex_hull, volume
from dilatedem.numerics.plain import determinant

#: distance over the extent within which corners are one: files of single precision give them to 6e-8
SAME_CORNER = 1e-6
#: share of its hull's volume that a convex piece may lack
CONVEX = 1e-3
#: corners of a convex piece, at most: what a contact can search in microseconds
MOST_CORNERS = 2000
#: pieces, at most
MOST_PIECES = 500
#: what to install for surfaces that are not convex
EXTRA = "pip install 'dilatedem[mesh]'"


@dataclass(frozen=True, eq=False)
class Pieces:
    """Convex solids in the coordinates of a file; surfaces: closed ones in the file; split: those of them that were not convex;
    enclosed: volume within the surfaces, in units of the file."""

    solids: tuple[Polyhedron, ...]
    surfaces: int
    split: int
    enclosed: float

    @property
    def volume(self) -> float:
        """Of all solids."""
        return float(sum(volume(solid) for solid in self.solids))


@lru_cache(maxsize=16)
def pieces_of(file: str, sha256: str) -> Pieces:
    """The pieces of an STL or OBJ file whose content has this digest. Raises ValueError for what is no closed surface."""
    points, corners = _joined(*_triangles(file))
    _require_closed(corners)
    owner = _surface_of(len(points), corners)
    solids: list[Polyhedron] = []
    enclosed, split = 0.0, 0
    numbers = np.unique(owner[corners[:, 0]])
    for number in numbers:
        own = corners[owner[corners[:, 0]] == number]
        inside = _enclosed(points, own)
        hull = convex_hull(points[np.unique(own)])
        whole = float(volume(hull))
        if whole <= 0.0 or abs(inside) <= CONVEX * CONVEX * whole:
            raise ValueError("holds a surface that encloses nothing")
        if inside < 0.0:
            raise ValueError("holds a surface that is inside out, as that of a cavity: turn its triangles around, or leave it out")
        convex = whole - inside <= CONVEX * whole
        solids += [hull] if convex else _split(points, own)
        enclosed, split = enclosed + inside, split + (not convex)
    most = max(len(solid.vertices) for solid in solids)
    if most > MOST_CORNERS:
        raise ValueError(f"has a convex piece of {most} corners, and at most {MOST_CORNERS} can be handled: take a coarser mesh")
    if len(solids) > MOST_PIECES:
        raise ValueError(f"has {len(solids)} convex pieces, and at most {MOST_PIECES} can be handled: take a simpler mesh")
    return Pieces(tuple(solids), len(numbers), split, enclosed)


def _triangles(file: str) -> tuple[np.ndarray, np.ndarray]:
    """Points (n, 3) and triangles (k, 3) of a file. Raises ValueError where it has none."""
    import meshio  # it takes a quarter of a second to load, and few cases need it

    try:
        with np.errstate(over="ignore"):  # it takes the first bytes of a text for a number
            mesh = meshio.read(file, file_format=Path(file).suffix[1:].lower())
    except (Exception, SystemExit) as error:  # meshio lets through whatever its readers meet
        raise ValueError(f"cannot be read as {Path(file).suffix[1:].upper()}: {error or type(error).__name__}") from error
    faces = [cells.data for cells in mesh.cells if cells.dim == 2]
    fans = [data[:, [0, i, i + 1]] for data in faces for i in range(1, data.shape[1] - 1)]
    points = np.asarray(mesh.points, dtype=float)
    if not fans or points.ndim != 2 or points.shape[1] != 3:
        raise ValueError("holds no surface")
    corners = np.concatenate(fans).astype(np.int64)
    if not np.isfinite(points).all() or corners.min() < 0 or corners.max() >= len(points):
        raise ValueError("holds corners that are no points")
    return points, corners


def _joined(points: np.ndarray, corners: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The same with corners of one place made one, and triangles of no area left out."""
    from scipy.spatial import cKDTree  # what few cases need is loaded for them alone

    size = float(np.ptp(points[corners.ravel()], axis=0).max())
    pairs = cKDTree(points).query_pairs(SAME_CORNER * size, output_type="ndarray")
    count, place = _connected(pairs[:, 0], pairs[:, 1], len(points))
    first = np.full(count, len(points))
    np.minimum.at(first, place, np.arange(len(points)))
    corners = place[corners]
    a, b, c = corners.T
    return points[first], corners[(a != b) & (b != c) & (c != a)]


def _require_closed(corners: np.ndarray) -> None:
    """Raises ValueError unless every edge has a triangle on either side, and both run the same way around."""
    start, end = corners.ravel(), np.roll(corners, -1, axis=1).ravel()
    _, shared = np.unique(np.column_stack((np.minimum(start, end), np.maximum(start, end))), axis=0, return_counts=True)
    loose = int(np.count_nonzero(shared != 2))
    if not len(shared) or loose:
        raise ValueError(f"has a surface that is not closed: {loose} of {len(shared)} edges do not have a triangle on either side")
    if len(np.unique(np.column_stack((start, end)), axis=0)) < len(start):
        raise ValueError("has triangles that do not run the same way around: have a mesh program make its normals consistent")


def _connected(start: np.ndarray, end: np.ndarray, count: int) -> tuple[int, np.ndarray]:
    """How many groups links from start (k,) to end (k,) make of `count` things, and (count,) the number of each one's group."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    return connected_components(coo_array((np.ones(len(start)), (start, end)), shape=(count, count)), directed=False)


def _surface_of(count: int, corners: np.ndarray) -> np.ndarray:
    """(count,) number of the connected surface that each corner belongs to."""
    start, end = corners.ravel(), np.roll(corners, -1, axis=1).ravel()
    return _connected(start, end, count)[1]


def _enclosed(points: np.ndarray, corners: np.ndarray) -> float:
    """Volume within a closed surface; negative if it is inside out."""
    return float(determinant(points[corners] - points[corners[0, 0]]).sum()) / 6.0


def _split(points: np.ndarray, corners: np.ndarray) -> list[Polyhedron]:
    """A closed surface that is not convex as convex solids (CoACD: Wei et al. 2022), the same ones at every call."""
    try:
        import coacd
    except ImportError:
        raise ValueError(
            f"is not convex, and to split it into convex pieces takes a package that is not installed: {EXTRA}; or draw it as some"
        ) from None
    coacd.set_log_level("error")
    used, renumbered = np.unique(corners, return_inverse=True)
    pieces = coacd.run_coacd(coacd.Mesh(points[used], renumbered.reshape(-1, 3)), preprocess_mode="off", seed=0)
    return [convex_hull(np.asarray(vertices, dtype=float)) for vertices, _ in pieces]

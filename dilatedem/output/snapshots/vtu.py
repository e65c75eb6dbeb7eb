"""Snapshots for ParaView: the floes' outer shapes as VTK polyhedra, one cell a body.

Written here rather than by meshio, which codes the connectivity anew each time although it never changes: 200
floes take 8.0 ms that way and 1.4 ms this way.
VTK and meshio read the files alike. Their time is not in them but in the PVD collection.
"""

import base64
import struct
import sys
import zlib
from collections.abc import Sequence
from html import escape  # that of xml.sax loads half of the web with it

import numpy as np

from dilatedem.files.atomic import write_bytes, write_text
from dilatedem.geometry.packing import PackedPolyhedra, pack_polyhedra, selected
from dilatedem.geometry.polyhedron import Polyhedron
from dilatedem.geometry.shapes import Hulls
from dilatedem.numerics.frames import matrix_from_quaternion
from dilatedem.numerics.plain import turned

# Cell data of every snapshot: name -> (type, components).
CELL_DATA = {
    "body": (np.int64, 1),
    "velocity": (np.float64, 3),
    "speed": (np.float64, 1),
    "angular_velocity": (np.float64, 3),
    "contact_force": (np.float64, 3),
    "contacts": (np.int64, 1),
}


VTK_TRIANGLE, VTK_POLYHEDRON = 5, 42
COMPRESSION = 1  # zlib level: coordinates are nearly random digits, a higher one saves 1 % for twice the time


_END = b"</CellData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n"


def _begin(points: int, cells: int) -> bytes:
    return (
        f'<?xml version="1.0"?>\n<VTKFile type="UnstructuredGrid" version="0.1" header_type="UInt32" '
        f'byte_order="{"LittleEndian" if sys.byteorder == "little" else "BigEndian"}" '
        f'compressor="vtkZLibDataCompressor">\n<UnstructuredGrid>\n'
        f'<Piece NumberOfPoints="{points}" NumberOfCells="{cells}">\n<Points>\n'
    ).encode()


class SnapshotWriter:
    """Writes one set of bodies again and again; the connectivity is set up once.

    outers  body-frame outer shapes with the origin at the centroid: single bodies or stacks
    order   (n,) number of each body, stack by stack; as they come unless given

    Cells stand in the file by their number of vertices, whose body is in the array `body`: meshio (5.3) sorts
    polyhedra like that when it reads, but not their data, so that it fails on, or mixes up, any other order.
    """

    def __init__(self, outers: Sequence[Polyhedron], order: np.ndarray | None = None):
        self._lay_out(pack_polyhedra(outers, order))

    @classmethod
    def of_hulls(cls, hulls: Hulls) -> "SnapshotWriter":
        """For the outer shapes of all bodies that float."""
        self = cls.__new__(cls)
        self._lay_out(hulls)
        return self

    def _lay_out(self, bodies: PackedPolyhedra | Hulls) -> None:
        corners = np.diff(bodies.vertex_start)
        self._order = np.argsort(corners, kind="stable")
        packed = selected(bodies, self._order)
        self._vertices = packed.vertex
        self._owner = np.repeat(self._order, corners[self._order])
        self._begin = _begin(len(self._owner), len(self._order))
        self._cells = b"</Points>\n" + _cells_element(packed) + b"<CellData>\n"

    def write(self, path, position, orientation, cell_data: dict[str, np.ndarray]) -> None:
        """Write the bodies in the pose given, atomically.

        position     (n, 3) [m] of the centroids
        orientation  (n, 4) unit quaternions (w, x, y, z), body to world
        cell_data    the arrays of CELL_DATA, n entries each

        Raises ValueError for an array that is missing, foreign, or of the wrong shape.
        """
        self._write(path, position, orientation, _checked(cell_data, len(self._order)))

    def _write(self, path, position, orientation, cell_data: dict[str, np.ndarray]) -> None:
        rotation = matrix_from_quaternion(np.reshape(orientation, (-1, 4)))
        points = turned(rotation[self._owner], self._vertices) + np.asarray(position)[self._owner]
        parts = [
            self._begin,
            _data_array("Points", points),
            self._cells,
            *(_data_array(name, array[self._order]) for name, array in cell_data.items()),
            _END,
        ]
        write_bytes(path, b"".join(parts))


def write_shapes(path, outers: Sequence[Polyhedron], position, orientation, cell_data: dict, order=None) -> None:
    """Write bodies in a pose with whatever cell data (float64 or int64, one row a body), atomically; order as SnapshotWriter's."""
    SnapshotWriter(outers, order)._write(path, position, orientation, cell_data)


def write_structures(path, drawings: Sequence[Sequence[Polyhedron]]) -> None:
    """Write the pieces of each structure (world coordinates), atomically; cell data: `structure`, the structures' order."""
    outers = [piece for pieces in drawings for piece in pieces]
    count = len(outers)
    orientation = np.tile([1.0, 0.0, 0.0, 0.0], (count, 1))
    number = np.repeat(np.arange(len(drawings)), [len(pieces) for pieces in drawings]).astype(np.int64)
    write_shapes(path, outers, np.zeros((count, 3)), orientation, {"structure": number})


def write_surfaces(path, points, triangles: Sequence[np.ndarray], point_data: dict, cell_data: dict) -> None:
    """Write surfaces of triangles, atomically.

    points (p, 3) [m], one surface's after the other's; triangles (t, 3) of each surface, numbers of its own points; point_data: p
    entries each; cell_data: an entry a surface.
    """
    sizes = [int(each.max()) + 1 for each in triangles]
    corners = np.concatenate([each + first for each, first in zip(triangles, np.cumsum([0, *sizes[:-1]]), strict=True)])
    counts, cells = [len(each) for each in triangles], len(corners)
    arrays = {"connectivity": corners.ravel(), "offsets": 3 * np.arange(1, cells + 1), "types": np.full(cells, VTK_TRIANGLE)}
    parts = [
        _begin(len(points), cells), _data_array("Points", points), b"</Points>\n<Cells>\n",
        *(_data_array(name, array.astype(np.int64)) for name, array in arrays.items()), b"</Cells>\n<PointData>\n",
        *(_data_array(name, array) for name, array in point_data.items()), b"</PointData>\n<CellData>\n",
        *(_data_array(name, np.repeat(array, counts)) for name, array in cell_data.items()), _END,
    ]  # fmt: skip
    write_bytes(path, b"".join(parts))


def write_pvd(path, snapshots: Sequence[tuple[float, str]]) -> None:
    """Write the collection: (time [s], file relative to the folder of `path`) per snapshot, atomically."""
    entries = "".join(
        f'    <DataSet timestep="{time_s:.9g}" group="" part="0" file="{escape(str(file))}"/>\n' for time_s, file in snapshots
    )
    write_text(
        path,
        '<?xml version="1.0"?>\n'
        '<VTKFile type="Collection" version="0.1" byte_order="LittleEndian">\n'
        f"  <Collection>\n{entries}  </Collection>\n"
        "</VTKFile>\n",
    )


def wrapped(position, size, periodic) -> np.ndarray:
    """`position` (n, 3) [m] put into the domain, `size` (2,) [m] about the origin, along periodic axes."""
    position = np.array(position, dtype=float)
    for axis in range(2):
        if periodic[axis]:
            position[:, axis] -= size[axis] * np.floor(position[:, axis] / size[axis] + 0.5)
    return position


def _checked(cell_data: dict[str, np.ndarray], count: int) -> dict[str, np.ndarray]:
    if set(cell_data) != set(CELL_DATA):
        raise ValueError(f"a snapshot holds {', '.join(CELL_DATA)}, not {', '.join(cell_data)}")
    arrays = {}
    for name, (kind, components) in CELL_DATA.items():
        array = np.ascontiguousarray(cell_data[name], dtype=kind)
        if array.shape != ((count,) if components == 1 else (count, components)):
            raise ValueError(f"snapshot array {name}: shape {array.shape} for {count} bodies")
        arrays[name] = array
    return arrays


def _cells_element(packed: PackedPolyhedra | Hulls) -> bytes:
    """The Cells element: per cell its vertices, and its faces as [faces, (vertices, vertex, ...) of each]."""
    cells, faces = len(packed.vertex_start) - 1, np.diff(packed.face_start)
    cell = np.repeat(np.arange(cells), faces)  # of each face
    corners = np.diff(packed.loop_start)
    # in the stream every face has its number of vertices before it, every cell its number of faces
    face_at = packed.loop_start[:-1] + np.arange(len(corners)) + cell + 1
    cell_at = packed.loop_start[packed.face_start] + packed.face_start + np.arange(cells + 1)
    stream = np.empty(cell_at[-1], dtype=np.int64)
    stream[cell_at[:-1]] = faces
    stream[face_at] = corners
    stream[np.arange(len(packed.loop)) + np.repeat(np.arange(len(corners)) + 1 + cell + 1, corners)] = packed.loop
    arrays = {
        "connectivity": np.arange(packed.vertex_start[-1]),
        "offsets": packed.vertex_start[1:],
        "types": np.full(cells, VTK_POLYHEDRON),
        "faces": stream,
        "faceoffsets": cell_at[1:],
    }
    content = b"".join(_data_array(name, array.astype(np.int64)) for name, array in arrays.items())
    return b"<Cells>\n" + content + b"</Cells>\n"


def _data_array(name: str, array: np.ndarray) -> bytes:
    """A DataArray: header (number of blocks, block size, last block's, compressed sizes), then the blocks."""
    kind = {"f": "Float64", "i": "Int64"}[array.dtype.kind]
    components = f' NumberOfComponents="{array.shape[1]}"' if array.ndim == 2 else ""
    blocks = [zlib.compress(np.ascontiguousarray(array), COMPRESSION)] if array.size else []
    header = struct.pack(f"={3 + len(blocks)}I", len(blocks), array.nbytes, array.nbytes, *map(len, blocks))
    begin = f'<DataArray type="{kind}" Name="{name}"{components} format="binary">'.encode()
    return b"".join([begin, *map(base64.b64encode, (header, *blocks)), b"</DataArray>\n"])

"""Snapshots are read back with VTK, ParaView's own reader."""

import xml.etree.ElementTree as ElementTree

import meshio
import numpy as np
import pytest

from dilatedem.geometry.outer import outer_polyhedron
from dilatedem.geometry.polyhedron import convex_hull, prism, volume
from dilatedem.numerics.frames import matrix_from_quaternion
from dilatedem.output.folder import snapshot_name
from dilatedem.output.snapshots.vtu import (
    SnapshotWriter,
    wrapped,
    write_pvd,
    write_structures,
)
from dilatedem.structures.kind import CIRCLE_SIDES
from dilatedem.structures.pile import Pile
from dilatedem.structures.plane import PLATE_THICKNESS, plate

vtk = pytest.importorskip("vtk")
from vtk.util.numpy_support import vtk_to_numpy  # noqa: E402

WHOLE = {"long", "long long"}  # 64 bits, whatever the platform calls them


def floes(count, rng):
    outers = []
    for i in range(count):
        angle = np.sort(rng.uniform(0, 2 * np.pi, 3) / 3 + np.arange(3) * 2 * np.pi / 3)
        if i % 3 == 2:
            outers.append(convex_hull(rng.normal(size=(14, 3))))
        else:
            outers.append(prism(1.5 * np.column_stack([np.cos(angle), np.sin(angle)]), -0.25, 0.25))
    return outers


def data(count, rng):
    velocity = rng.normal(size=(count, 3))
    return {
        "body": np.arange(count),
        "velocity": velocity,
        "speed": np.linalg.norm(velocity, axis=1),
        "angular_velocity": rng.normal(size=(count, 3)),
        "contact_force": rng.normal(size=(count, 3)) * 1e4,
        "contacts": rng.integers(0, 5, size=count),
    }


def read(path):
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    assert reader.GetErrorCode() == 0
    return reader.GetOutput()


def volumes(grid):
    """By VTK's division of each cell into tetrahedra; exact for prisms, spheres and capsules."""
    sizes = vtk.vtkCellSizeFilter()
    sizes.SetInputData(grid)
    sizes.ComputeVolumeOn()
    sizes.Update()
    return vtk_to_numpy(sizes.GetOutput().GetCellData().GetArray("Volume"))


def enclosed_volumes(grid):
    """By the flux through each cell's faces as VTK holds them, for shapes whose tetrahedra VTK gets wrong."""
    found = []
    for number in range(grid.GetNumberOfCells()):
        cell = grid.GetCell(number)
        surface, points, polygons = vtk.vtkPolyData(), vtk.vtkPoints(), vtk.vtkCellArray()
        points.SetDataTypeToDouble()
        for face in (cell.GetFace(k) for k in range(cell.GetNumberOfFaces())):
            polygons.InsertNextCell(face.GetNumberOfPoints())
            for k in range(face.GetNumberOfPoints()):
                polygons.InsertCellPoint(points.InsertNextPoint(face.GetPoints().GetPoint(k)))
        surface.SetPoints(points)
        surface.SetPolys(polygons)
        triangles, mass = vtk.vtkTriangleFilter(), vtk.vtkMassProperties()
        triangles.SetInputData(surface)
        mass.SetInputConnection(triangles.GetOutputPort())
        mass.Update()
        found.append(mass.GetVolume())
    return np.array(found)


@pytest.fixture
def scene():
    rng = np.random.default_rng(5)
    count = 12
    orientation = rng.normal(size=(count, 4))
    orientation /= np.linalg.norm(orientation, axis=1)[:, None]
    return floes(count, rng), rng.uniform(-20, 20, (count, 3)), orientation, data(count, rng)


def test_vtk_reads_cells_volumes_and_arrays(tmp_path, scene):
    outers, position, orientation, cell_data = scene
    SnapshotWriter(outers).write(tmp_path / "a.vtu", position, orientation, cell_data)
    grid = read(tmp_path / "a.vtu")
    assert grid.GetNumberOfCells() == len(outers)
    assert {grid.GetCellType(i) for i in range(len(outers))} == {vtk.VTK_POLYHEDRON}
    body = vtk_to_numpy(grid.GetCellData().GetArray("body"))
    assert sorted(body) == list(range(len(outers)))
    expected = np.array([volume(outers[number]) for number in body])
    np.testing.assert_allclose(enclosed_volumes(grid), expected, rtol=1e-9)
    # VTK 9.7 loses up to 16 % of a general hull when it cuts it into tetrahedra; floes are prisms.
    prisms = body % 3 != 2
    np.testing.assert_allclose(volumes(grid)[prisms], expected[prisms], rtol=1e-9)
    found = grid.GetCellData()
    assert {found.GetArrayName(i) for i in range(found.GetNumberOfArrays())} == set(cell_data)
    for name, values in cell_data.items():
        array = found.GetArray(name)
        assert array.GetDataTypeAsString() in (WHOLE if name in ("body", "contacts") else {"double"})
        np.testing.assert_array_equal(vtk_to_numpy(array), values[body])


def test_spheres_capsules_and_irregular_floes_have_their_volume(tmp_path):
    rng = np.random.default_rng(8)
    outers = [
        outer_polyhedron(convex_hull([[0.0, 0, 0]]), 0.5, 0.6),
        outer_polyhedron(convex_hull([[0.0, 0, 0], [1.0, 0, 0]]), 0.2, 0.2),
    ]
    for count in range(4, 14):
        angle = np.sort(rng.uniform(0, 2 * np.pi, count))
        outline = np.column_stack([1.4 * np.cos(angle), np.sin(angle)])
        outers.append(prism(outline - outline.mean(axis=0), -0.25, 0.25))
    count = len(outers)
    orientation = np.tile([1.0, 0, 0, 0], (count, 1))
    SnapshotWriter(outers).write(tmp_path / "a.vtu", np.zeros((count, 3)), orientation, data(count, rng))
    grid = read(tmp_path / "a.vtu")
    expected = [volume(outers[number]) for number in vtk_to_numpy(grid.GetCellData().GetArray("body"))]
    np.testing.assert_allclose(volumes(grid), expected, rtol=1e-9)


def test_vertices_are_turned_and_moved(tmp_path, scene):
    outers, position, orientation, cell_data = scene
    SnapshotWriter(outers).write(tmp_path / "a.vtu", position, orientation, cell_data)
    grid = read(tmp_path / "a.vtu")
    points = vtk_to_numpy(grid.GetPoints().GetData())
    for cell, body in enumerate(vtk_to_numpy(grid.GetCellData().GetArray("body"))):
        ids = grid.GetCell(cell).GetPointIds()
        found = points[[ids.GetId(i) for i in range(ids.GetNumberOfIds())]]
        expected = [_turn(orientation[body], vertex) + position[body] for vertex in outers[body].vertices]
        np.testing.assert_allclose(found, expected, atol=1e-13)


def _turn(q, v):
    """v + 2 w (u x v) + 2 u x (u x v): the textbook form, not the matrix."""
    w, u = q[0], q[1:]
    return v + 2 * w * np.cross(u, v) + 2 * np.cross(u, np.cross(u, v))


def test_rotation_matrices_are_rotations(scene):
    matrices = matrix_from_quaternion(scene[2])
    unit = np.broadcast_to(np.eye(3), matrices.shape)
    np.testing.assert_allclose(matrices @ np.moveaxis(matrices, 1, 2), unit, atol=1e-14)
    np.testing.assert_allclose(np.linalg.det(matrices), 1.0, rtol=1e-14)


def test_writer_is_reusable_and_replaces_atomically(tmp_path, scene):
    outers, position, orientation, cell_data = scene
    writer = SnapshotWriter(outers)
    path = tmp_path / "a.vtu"
    writer.write(path, position + 1.0, orientation, cell_data)
    (tmp_path / "a.vtu.tmp").write_bytes(b"<VTKFile")  # left by a kill
    writer.write(path, position, orientation, cell_data)
    SnapshotWriter(outers).write(tmp_path / "b.vtu", position, orientation, cell_data)
    assert path.read_bytes() == (tmp_path / "b.vtu").read_bytes()
    assert sorted(file.name for file in tmp_path.iterdir()) == ["a.vtu", "b.vtu"]


def test_meshio_reads_the_same(tmp_path, scene):
    # It cannot with cells in any order: this guards the order in the file.
    outers, position, orientation, cell_data = scene
    assert np.any(np.diff([len(outer.vertices) for outer in outers]) < 0)
    SnapshotWriter(outers).write(tmp_path / "a.vtu", position, orientation, cell_data)
    mesh = meshio.read(tmp_path / "a.vtu")
    body = np.concatenate(mesh.cell_data["body"])
    assert sorted(body) == list(range(len(outers)))
    for name, values in cell_data.items():
        np.testing.assert_array_equal(np.concatenate(mesh.cell_data[name]), values[body])
    cells = [cell for block in mesh.cells for cell in block.data]
    for cell, number in zip(cells, body, strict=True):
        assert len(cell) == len(outers[number].faces)
        points = mesh.points[np.unique(np.concatenate(cell))]
        expected = outers[number].vertices.mean(axis=0)
        middle = (points.mean(axis=0) - position[number]) @ matrix_from_quaternion(orientation)[number]
        np.testing.assert_allclose(middle, expected, atol=1e-12)


def test_wrong_arrays_are_refused(tmp_path, scene):
    outers, position, orientation, cell_data = scene
    writer = SnapshotWriter(outers)
    with pytest.raises(ValueError, match="a snapshot holds"):
        writer.write(tmp_path / "a.vtu", position, orientation, {"body": cell_data["body"]})
    with pytest.raises(ValueError, match="velocity"):
        writer.write(tmp_path / "a.vtu", position, orientation, {**cell_data, "velocity": np.zeros((3, 3))})
    assert not list(tmp_path.iterdir())


def test_collection_lists_times_and_files(tmp_path, scene):
    outers, position, orientation, cell_data = scene
    (tmp_path / "snapshots").mkdir()
    times = [0.0, 0.30000000000000004, 12.5]
    snapshots = [(time_s, snapshot_name(i)) for i, time_s in enumerate(times)]
    for _, name in snapshots:
        SnapshotWriter(outers).write(tmp_path / name, position, orientation, cell_data)
    write_pvd(tmp_path / "ice.pvd", snapshots[:1])
    write_pvd(tmp_path / "ice.pvd", snapshots)
    entries = ElementTree.parse(tmp_path / "ice.pvd").getroot().findall("./Collection/DataSet")
    np.testing.assert_allclose([float(entry.get("timestep")) for entry in entries], times, rtol=1e-9)
    for entry in entries:
        assert read(tmp_path / entry.get("file")).GetNumberOfCells() == len(outers)


def test_structures(tmp_path):
    pile = Pile(kind="pile", center=(10.0, -1.0), radius=2.0)
    write_structures(tmp_path / "structures.vtu", [
        pile.drawing(50.0), [plate((3.0, 0.0, 0.0), (-1.0, 0.0, 0.0), 50.0)], [plate((0.0, 0.0, -4.0), (0.0, 0.0, 2.0), 50.0)],
    ])  # fmt: skip
    grid = read(tmp_path / "structures.vtu")
    column = 0.5 * CIRCLE_SIDES * np.sin(2 * np.pi / CIRCLE_SIDES) * 2.0**2 * 5.0
    plates = [50.0 * 5.0 * PLATE_THICKNESS, 50.0 * 50.0 * PLATE_THICKNESS]
    number = vtk_to_numpy(grid.GetCellData().GetArray("structure"))
    assert sorted(number) == [0, 1, 2]
    np.testing.assert_allclose(volumes(grid), np.array([column, *plates])[number], rtol=1e-9)


def test_plates_lie_on_the_solid_side():
    normal = np.array([-1.0, 0.0, 1.0]) / np.sqrt(2.0)
    point = np.array([4.0, 1.0, 0.0])
    height = (plate(point, normal, 40.0).vertices - point) @ normal
    assert height.max() == pytest.approx(0.0, abs=1e-12)
    assert height.min() == pytest.approx(-PLATE_THICKNESS)


def test_positions_are_wrapped_along_periodic_axes_only():
    position = np.array([[26.0, 26.0, 0.3], [-76.0, -24.9, 0.0], [0.0, 25.0, 0.0]])
    found = wrapped(position, (50.0, 50.0), (False, True))
    np.testing.assert_allclose(found, [[26.0, -24.0, 0.3], [-76.0, -24.9, 0.0], [0.0, -25.0, 0.0]])
    assert position[0, 1] == 26.0


def test_no_bodies(tmp_path):
    empty = {name: values[:0] for name, values in data(1, np.random.default_rng(0)).items()}
    SnapshotWriter([]).write(tmp_path / "a.vtu", np.zeros((0, 3)), np.zeros((0, 4)), empty)
    assert read(tmp_path / "a.vtu").GetNumberOfCells() == 0

"""A structure from a file: what is read, what comes out of it, what is refused; a box drawn as a mesh is met as a box."""

import shutil

import numpy as np
import pytest

from dilatedem.case.load import Source, build, load
from dilatedem.case.schema import Case
from dilatedem.case.write import dump
from dilatedem.errors import CaseError
from dilatedem.geometry.polyhedron import convex_hull, triangles, volume
from dilatedem.run.simulation import Simulation
from dilatedem.state.clock import Status
from dilatedem.structures.mesh import Mesh
from dilatedem.structures.surface import pieces_of

CORNERS = np.array([[x, y, z] for x in (-1.0, 1.0) for y in (-0.6, 0.6) for z in (-1.0, 1.0)])
#: an L in plan, 4 by 3 with arms 1 wide: an area of 6
BRACKET = np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 1.0], [1.0, 1.0], [1.0, 3.0], [0.0, 3.0]])


def surface(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Corners (n, 3) and triangles (k, 3) of a convex hull."""
    hull = convex_hull(points)
    return hull.vertices, triangles(hull)[0]


def bracket() -> tuple[np.ndarray, np.ndarray]:
    """The L between z = -1 and 1."""
    count, around = len(BRACKET), range(len(BRACKET))
    flat = [(0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 5)]
    faces = [(c, b, a) for a, b, c in flat] + [(a + count, b + count, c + count) for a, b, c in flat]
    for i in around:
        j = (i + 1) % count
        faces += [(i, j, j + count), (i, j + count, i + count)]
    return np.array([[*point, z] for z in (-1.0, 1.0) for point in BRACKET]), np.array(faces)


def write_stl(path, points, faces):
    """Text, as of any mesh program: every triangle with corners of its own."""
    lines = ["solid drawn"]
    for face in faces:
        corners = [f"vertex {x!r} {y!r} {z!r}" for x, y, z in points[face].tolist()]
        lines += ["facet normal 0 0 0", "outer loop", *corners, "endloop", "endfacet"]
    path.write_text("\n".join([*lines, "endsolid drawn"]) + "\n", encoding="utf-8")
    return path


def write_obj(path, points, faces):
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in points.tolist()]
    lines += [f"f {a} {b} {c}" for a, b, c in (np.asarray(faces) + 1).tolist()]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


def mesh(path, **keys) -> Mesh:
    return Mesh.model_validate({"kind": "mesh", "file": str(path)} | keys)


@pytest.mark.parametrize("model", ["liu2015", "consistent"])
def test_a_box_drawn_as_a_mesh_is_met_as_a_box(model, tmp_path):
    """Turned by 20 degrees, in millimetres: the same forces in every step of the hit to 1e-6 of the highest."""
    path = write_stl(tmp_path / "box.stl", *surface(1e3 * CORNERS))
    turn = 20.0
    box = {
        "kind": "box", "center": [1.0, 0.2], "size": [2.0, 1.2], "rotation": turn, "bottom": -1.0, "top": 1.0,
        "dilated_radius": 0.1,
    }  # fmt: skip
    drawn = {
        "kind": "mesh", "file": str(path), "scale": 1e-3, "position": [1.0, 0.2, 0.0],
        "rotation": [0.0, 0.0, float(np.radians(turn))], "dilated_radius": 0.1,
    }  # fmt: skip
    histories = []
    for structure in (box, drawn):
        simulation = Simulation.of_case(Case.model_validate({
            "field": {"source": "bodies"}, "water": {"enabled": False}, "gravity": {"acceleration": 0.0},
            "contact": {"model": model}, "time": {"step": 2e-5}, "structure": [structure],
            "body": [{
                "vertices": [[x, y, z] for x in (-0.3, 0.3) for y in (-0.4, 0.4) for z in (-0.2, 0.2)],
                "dilated_radius": 0.05, "position": [-0.6, 0.1, 0.05], "velocity": [2.0, 0.3, 0.0],
            }],
        }))  # fmt: skip
        loads = []
        for _ in range(8000):
            assert simulation.advance(1) == Status.DONE
            loads.append(simulation.structures[structure["kind"]].load)
        histories.append(np.array(loads))
    highest = np.abs(histories[0]).max(axis=0)
    assert highest[0] > 1e4
    np.testing.assert_allclose(histories[1], histories[0], rtol=0.0, atol=1e-6 * highest.max())


@pytest.mark.parametrize(("suffix", "write"), [("stl", write_stl), ("obj", write_obj)])
def test_convex_surfaces_of_a_file_are_its_pieces(suffix, write, tmp_path):
    points, faces = surface(CORNERS)
    both = np.concatenate([points, points + [5.0, 0.0, 0.0]]), np.concatenate([faces, faces + len(points)])
    structure = mesh(write(tmp_path / f"two.{suffix}", *both), dilated_radius=0.1)
    assert len(structure.parts()) == 2 and len(structure.obstacles(0.5)) == 2
    assert [volume(piece) for piece in structure.drawing(30.0)] == pytest.approx([4.8, 4.8])
    assert structure.remarks() == ["2 closed surfaces of 9.6 m3, all convex"]
    around = structure.sketch(30.0).outline  # of both
    assert np.ptp(around, axis=0) == pytest.approx([7.0, 1.2])


def test_it_is_scaled_then_turned_then_moved(tmp_path):
    path = write_obj(tmp_path / "box.obj", *surface(CORNERS))
    structure = mesh(path, scale=2.0, rotation=[0.0, 0.0, np.pi / 2.0], position=[10.0, 1.0, 0.5], dilated_radius=0.2)
    (piece,) = structure.drawing(30.0)
    np.testing.assert_allclose(piece.vertices.min(axis=0), [10.0 - 1.2, 1.0 - 2.0, 0.5 - 2.0], atol=1e-12)
    np.testing.assert_allclose(structure.place, [10.0, 1.0, 0.0])
    (part,) = structure.parts()
    assert part.heights == pytest.approx((-1.5, 2.5))


def test_what_is_not_convex_is_split_and_told(tmp_path):
    pytest.importorskip("coacd")
    structure = mesh(write_stl(tmp_path / "bracket.stl", *bracket()))
    pieces = structure.drawing(30.0)
    assert 2 <= len(pieces) <= 4
    assert sum(map(volume, pieces)) == pytest.approx(12.0, rel=0.01)
    (told,) = structure.remarks()
    assert told.startswith("1 closed surface of 12 m3, 1 not convex: taken as ") and "convex pieces of 12.0" in told
    pieces_of.cache_clear()
    again = mesh(tmp_path / "bracket.stl").drawing(30.0)
    for one, other in zip(pieces, again, strict=True):
        np.testing.assert_array_equal(other.vertices, one.vertices)
    outline = structure.sketch(30.0).outline
    assert len(outline) >= 6 and np.ptp(outline, axis=0) == pytest.approx([4.0, 3.0], rel=0.01)


def test_without_the_extra_it_says_what_to_install(tmp_path, monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "coacd", None)
    pieces_of.cache_clear()
    with pytest.raises(ValueError, match=r"bracket.stl is not convex, .* pip install 'dilatedem\[mesh\]'"):
        mesh(write_stl(tmp_path / "bracket.stl", *bracket())).parts()


def broken(kind: str):
    points, faces = surface(CORNERS)
    if kind == "open":
        return points, faces[1:]
    if kind == "inside out":
        return points, faces[:, ::-1]
    if kind == "mixed":
        return points, np.concatenate([faces[:1, ::-1], faces[1:]])
    return points * [1.0, 1.0, 0.0], faces


@pytest.mark.parametrize(
    ("kind", "sentence"),
    [
        ("open", "bad.obj has a surface that is not closed: 3 of 18 edges do not have a triangle on either side"),
        ("inside out", "bad.obj holds a surface that is inside out"),
        ("mixed", "bad.obj has triangles that do not run the same way around"),
        ("flat", "bad.obj "),
    ],
)
def test_bad_surfaces_are_refused(kind, sentence, tmp_path):
    with pytest.raises(ValueError, match=sentence):
        mesh(write_obj(tmp_path / "bad.obj", *broken(kind))).parts()


@pytest.mark.parametrize("text", ["", "solid nothing\nendsolid nothing\n", "no mesh at all", "facet\nvertex 1 2\n"])
@pytest.mark.parametrize("suffix", ["stl", "obj"])
def test_files_that_hold_no_surface_are_refused(text, suffix, tmp_path):
    path = tmp_path / f"bad.{suffix}"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(ValueError, match=rf"bad.{suffix} (holds|cannot be read)"):
        mesh(path).parts()


def test_edges_that_are_rounded_too_much_are_refused(tmp_path):
    path = write_obj(tmp_path / "box.obj", *surface(CORNERS))
    with pytest.raises(ValueError, match=r"dilated_radius = 0.7: must be less than 0.6 m, the radius of the largest ball in it"):
        mesh(path, dilated_radius=0.7).parts()


def test_a_path_starts_at_the_case_file_and_the_case_as_run_repeats_it(tmp_path):
    (tmp_path / "cases").mkdir()
    path = write_obj(tmp_path / "cases" / "box.obj", *surface(CORNERS))
    case_file = tmp_path / "cases" / "bow.toml"
    case_file.write_text('[[structure]]\nkind = "mesh"\nfile = "box.obj"\n', encoding="utf-8")
    case = load(case_file)
    assert case.structure[0].file == str(path)
    elsewhere = tmp_path / "case.toml"
    elsewhere.write_text(dump(case), encoding="utf-8")
    assert load(elsewhere) == case
    write_obj(path, *surface(2.0 * CORNERS))
    with pytest.raises(CaseError, match=r"structure.0.file = .*: is another than it was"):
        load(elsewhere)
    assert load(case_file).structure[0].sha256 != case.structure[0].sha256


def test_files_that_are_not_there_or_of_another_kind_are_told(tmp_path):
    with pytest.raises(CaseError, match=r'structure.0.file = "no.stl": there is no such file: .*no.stl'):
        build(Source("x.toml", '[[structure]]\nkind = "mesh"\nfile = "no.stl"\n'))
    path = write_obj(tmp_path / "box.obj", *surface(CORNERS))
    other = shutil.copy(path, tmp_path / "box.ply")
    with pytest.raises(ValueError, match="must be an STL or OBJ file"):
        mesh(other)

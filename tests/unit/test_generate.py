import json
import math

import matplotlib.image
import meshio
import numpy as np
import pytest

from dilatedem.case.load import load
from dilatedem.errors import CaseError
from dilatedem.generate import generate

CASE = """
[domain]
size = [20.0, 16.0]
y_boundary = "periodic"
[field]
floe_count = 40
concentration = 0.7
seed = 3
[[structure]]
kind = "pile"
center = [4.0, 7.5]
radius = 1.5
[[structure]]
kind = "plane"
name = "slope"
point = [9.0, 0.0, 0.0]
normal = [-1.0, 0.0, 0.5]
[[body]]
outline = [[-3.0, -2.0], [0.0, -2.0], [0.0, 1.0], [-3.0, 1.0]]
[[body]]
vertices = [[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]]
dilated_radius = 0.3
position = [-7.0, 4.0, 0.2]
rotation = [0.0, 0.0, 1.5707963267948966]
"""


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    folder = tmp_path_factory.mktemp("field")
    (folder / "case.in.toml").write_text(CASE)
    case = load(folder / "case.in.toml")
    return case, folder / "out", generate(case, folder / "out")


def shapes(folder):
    """Vertices (k, 3) of each body in field.vtu, by body number."""
    mesh = meshio.read(folder / "field.vtu")
    cells = [mesh.points[np.unique(np.concatenate(cell))] for block in mesh.cells for cell in block.data]
    return dict(zip(np.concatenate(mesh.cell_data["body"]), cells, strict=True))


def test_the_three_files_and_nothing_else(made):
    _, folder, facts = made
    assert sorted(file.name for file in folder.iterdir()) == ["field.json", "field.png", "field.vtu"]
    assert json.loads((folder / "field.json").read_text()) == facts
    assert matplotlib.image.imread(folder / "field.png").shape[0] > 400


def test_facts(made):
    case, folder, facts = made
    assert facts["seed"] == 3 and facts["explicit_bodies"] == 2
    assert facts["count"] + facts["left_out_at_structures"] == 40
    assert facts["left_out_at_structures"] > 0
    assert facts["concentration"] == pytest.approx(0.7, rel=1e-12)
    size = facts["floe_size_m"]
    assert size["min"] < size["median"] < size["max"]
    covered = facts["count"] * size["root_of_mean_area"] ** 2 / (20.0 * 16.0)
    assert facts["concentration_without_left_out"] == pytest.approx(covered)


def test_bodies_stand_where_they_should(made):
    case, folder, facts = made
    bodies = shapes(folder)
    assert sorted(bodies) == list(range(facts["count"] + 2))
    draft = 0.5 * case.ice.density / case.water.density
    for number, corners in bodies.items():
        if number == 1:
            continue
        assert corners[:, 2].min() == pytest.approx(-draft, abs=2e-3)
        assert np.ptp(corners[:, 2]) == pytest.approx(0.5, abs=2e-3)
    np.testing.assert_allclose(bodies[0][:, :2].min(axis=0), [-3.0, -2.0], atol=5e-3)
    # The capsule lies along y after its quarter turn.
    np.testing.assert_allclose(np.ptp(bodies[1], axis=0), [0.6, 2.6, 0.6], rtol=0.01)
    np.testing.assert_allclose(bodies[1].mean(axis=0), [-7.0, 4.0, 0.2], atol=1e-6)


def test_floes_keep_clear_of_structures_at_every_height(made):
    case, folder, facts = made
    normal = np.array([-1.0, 0.0, 0.5]) / math.sqrt(1.25)
    for number, corners in shapes(folder).items():
        if number > 1:
            assert ((corners - [9.0, 0.0, 0.0]) @ normal).min() > 0.0
            for image in (-16.0, 0.0, 16.0):
                assert np.hypot(*(corners[:, :2] - [4.0, 7.5 + image]).T).min() > 1.5


def test_only_explicit_bodies(tmp_path):
    path = tmp_path / "one.toml"
    path.write_text(
        '[field]\nsource = "bodies"\n[[body]]\nvertices = [[0.0, 0.0, 0.0]]\ndilated_radius = 0.5\n'
    )
    facts = generate(load(path), tmp_path / "out")
    assert facts["count"] == 1 and facts["seed"] is None
    assert facts["floe_size_m"]["mean"] == pytest.approx(0.5 * math.sqrt(math.pi), rel=0.01)


def test_a_field_is_replaced_but_never_a_run(tmp_path):
    path = tmp_path / "small.toml"
    path.write_text("[domain]\nsize = [6.0, 6.0]\n[field]\nfloe_count = 4\n")
    out = tmp_path / "out"
    generate(load(path), out)
    first = (out / "field.vtu").read_bytes()
    generate(load(path), out)
    assert (out / "field.vtu").read_bytes() == first
    generate(load(path, ["field.seed=2"]), out)
    assert (out / "field.vtu").read_bytes() != first
    (out / "forces.csv").write_text("time_s\n")
    before = (out / "field.json").read_bytes()
    with pytest.raises(CaseError, match="holds a run"):
        generate(load(path), out)
    assert (out / "field.json").read_bytes() == before


def test_an_impossible_field_is_one_sentence_and_writes_nothing(tmp_path):
    path = tmp_path / "tight.toml"
    path.write_text("[domain]\nsize = [6.0, 6.0]\n[field]\nfloe_count = 2000\n")
    with pytest.raises(CaseError, match="ice field cannot be built: .*dilated radius"):
        generate(load(path), tmp_path / "out")
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("name", ["field.vtu", "field.png", "field.json", "field.vtu.tmp"])
def test_a_file_that_is_no_field_is_left_alone(name, tmp_path):
    path, out = tmp_path / "small.toml", tmp_path / "out"
    path.write_text("[domain]\nsize = [6.0, 6.0]\n[field]\nfloe_count = 4\n")
    out.mkdir()
    (out / name).write_text('{"mine": 1}')
    with pytest.raises(CaseError, match=f"{name}: stands in the way: .* holds no field"):
        generate(load(path), out)
    assert [(file.name, file.read_text()) for file in out.iterdir()] == [(name, '{"mine": 1}')]


def test_a_field_is_not_written_through_links(tmp_path):
    path, out = tmp_path / "small.toml", tmp_path / "out"
    path.write_text("[domain]\nsize = [6.0, 6.0]\n[field]\nfloe_count = 4\n")
    generate(load(path), out)
    (out / "field.png").unlink()
    (out / "field.png").symlink_to(path)
    before = path.read_bytes()
    with pytest.raises(CaseError, match="field.png: is a link"):
        generate(load(path), out)
    assert path.read_bytes() == before

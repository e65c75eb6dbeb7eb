"""A field from a file: floes with what the file says of them, clear of structures; what was changed; bad cases in one sentence."""

import json

import numpy as np
import pytest
import shapely

from dilatedem.case.load import build, load, read
from dilatedem.case.write import dump
from dilatedem.errors import CaseError
from dilatedem.generate import generate
from dilatedem.run.foretell import check
from dilatedem.run.simulation import Simulation
from dilatedem.scene.place import compose

BOXES = {(-6.0, 0.0): {"thickness": 0.8, "density": 880.0, "elastic_modulus": 2.0e9}, (0.0, 0.0): {"velocity": [0.5, 0.1]},
         (6.0, 0.0): {}, (6.0, 8.9): {}}  # fmt: skip
CASE = """
[domain]
size = [24.0, 20.0]
y_boundary = "wall"
[field]
source = "file"
file = "floes.geojson"
[[structure]]
kind = "pile"
center = [7.5, 1.0]
radius = 1.0
[time]
duration = 0.02
"""


def write(tmp_path, case=CASE, boxes=BOXES):
    features = [
        {"type": "Feature", "properties": told, "geometry": json.loads(shapely.to_geojson(shapely.box(x, y, x + 2.0, y + 2.0)))}
        for (x, y), told in boxes.items()
    ]
    (tmp_path / "floes.geojson").write_text(json.dumps({"type": "FeatureCollection", "features": features}))
    (tmp_path / "case.toml").write_text(case)
    return tmp_path / "case.toml"


def test_floes_have_what_the_file_says_of_them(tmp_path):
    simulation = Simulation.of_case(load(write(tmp_path)))
    scene, solids = simulation.scene, simulation.model.solids
    assert scene.count == 2 and scene.field.left_out == 1  # one stands in the pile, one in the wall
    assert scene.ice.thickness.tolist() == [0.8, 0.5]
    assert solids.mass[:2] == pytest.approx([880.0 * 0.8 * 4.0, 915.0 * 0.5 * 4.0], rel=5e-3)
    assert solids.compliance[:2].tolist() == [0.91 / 2.0e9, 0.91 / 1.0e9]
    assert simulation.state.bodies.velocity[:2].tolist() == [[0.3, 0.0, 0.0], [0.5, 0.1, 0.0]]
    bottom = [scene.position[i, 2] + shape.outer.stacked().vertices[0, :, 2].min() for i, shape in enumerate(scene.shapes)]
    if len(scene.shapes) == 2:
        assert -np.array(bottom) == pytest.approx([0.8 * 880.0 / 1025.0, 0.5 * 915.0 / 1025.0], rel=2e-3)
    assert simulation.model.charts.heights.max() == pytest.approx(0.8)  # load maps reach as high as the thickest floe


def test_what_was_changed_is_told_by_generate_check_and_the_summary(tmp_path, capsys):
    from dilatedem.run.loop import run  # loads the kernels

    case = load(write(tmp_path))
    told = generate(case, tmp_path / "field")["file"]
    assert told["path"] == str(tmp_path / "floes.geojson")
    assert (told["polygons"], told["floes"], told["area_before_m2"], told["area_after_m2"]) == (4, 3, 16.0, 12.0)
    assert told["changes"] == {"at_walls": {"outlines": 1, "area_before_m2": 4.0, "area_after_m2": 0.0}}
    facts = check(case)
    assert facts["file"] == told and facts["floes"] == 2 and facts["concentration"] == pytest.approx(12.0 / 480.0, rel=2e-3)
    run(case, tmp_path / "run")
    assert "floes.geojson: outlines left out at walls: 1, of 4 m2, now 0 m2" in capsys.readouterr().err
    assert json.loads((tmp_path / "run" / "summary.json").read_text())["field"]["file"] == told


def test_the_case_of_a_run_repeats_it_as_long_as_the_file_is_the_same(tmp_path):
    path = write(tmp_path)
    case = load(path)
    (tmp_path / "elsewhere").mkdir()
    again = tmp_path / "elsewhere" / "case.toml"
    again.write_text(dump(case))
    assert load(again) == case and build(read(again)).field.sha256 == case.field.sha256
    write(tmp_path, boxes={(0.0, 0.0): {}})
    with pytest.raises(CaseError, match="field.file = .*: is another than it was"):
        load(again)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (('file = "floes.geojson"', ""), 'field.source = "file": needs a file of outlines'),
        (('source = "file"', ""), 'field.file = "floes.geojson": belongs to source = "file"'),
        (('"floes.geojson"', '"floe.geojson"'), "there is no such file"),
        (('"floes.geojson"', '"case.toml"'), "must be a GeoJSON, WKT or CSV file, by its name, too"),
        (('source = "file"', 'source = "file"\norigin = "middle"'), 'must be "centred" or a list of 2 numbers'),
        (('source = "file"', 'source = "file"\nscale = 0'), "field.scale = 0: must be greater than 0"),
        (('source = "file"', 'source = "file"\nfloe_size = 3'), 'field.floe_size = 3: belongs to source = "voronoi"'),
    ],
)
def test_bad_cases_are_named(tmp_path, change, message):
    with pytest.raises(CaseError) as fault:
        load(write(tmp_path, CASE.replace(*change)))
    assert message in str(fault.value)


def test_faults_of_the_file_are_named(tmp_path):
    with pytest.raises(CaseError, match=r"field.file: .*floes.geojson feature 0: thickness = -1: must be a number"):
        compose(load(write(tmp_path, boxes={(0.0, 0.0): {"thickness": -1}})))
    with pytest.raises(CaseError, match=r"field.file: 1 of 3 floes are no thicker than twice the dilated radius, 0.08 m"):
        compose(load(write(tmp_path, boxes={**BOXES, (-6.0, 0.0): {"thickness": 0.05}})))


def test_a_file_of_which_nothing_is_left_says_where_its_outlines_lie(tmp_path):
    said = r"\(outlines left out that lie outside of the domain: 1\): its outlines lie at x = 50 to 52 m and y = 0 to 2 m"
    with pytest.raises(CaseError, match=f"field.file: .*floes.geojson leaves no floe in the domain {said}"):
        compose(load(write(tmp_path, boxes={(50.0, 0.0): {}})))


def test_points_and_lines_of_a_file_are_told(tmp_path):
    path = write(tmp_path, CASE.replace("floes.geojson", "floes.csv"))
    (tmp_path / "floes.csv").write_text("floe,x,y\n0,0,0\n0,2,0\n0,2,2\n1,5,5\n1,7,5\n")
    report = compose(load(path)).report
    assert report.facts()["no_areas"] == 1 and report.facts()["entries"] == 2
    assert report.sentences() == [
        "1 outline of 2 m2 became 1 floe of 2 m2 (3 points, now 3)", "entries left out that are points or lines, no areas: 1",
    ]  # fmt: skip


def test_too_many_corners_name_the_tolerance(tmp_path):
    path = write(tmp_path, CASE.replace("size = [24.0, 20.0]", "size = [90.0, 90.0]"))
    disk = shapely.Point(-20.0, 0.0).buffer(20.0, quad_segs=200)
    (tmp_path / "floes.geojson").write_text(shapely.to_geojson(disk))
    with pytest.raises(CaseError, match=r"field.tolerance = 0.001: leaves an outline with \d+ corners, and at most 127"):
        compose(load(path, ["field.tolerance=0.001"]))
    assert compose(load(path, ["field.tolerance=0.05"])).count == 1

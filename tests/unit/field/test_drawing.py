"""Outlines of files: what is read of GeoJSON, WKT and CSV, and how a bad file is named."""

import json

import pytest
import shapely

from dilatedem.field.drawing import read

SQUARE = [[[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0], [0.0, 0.0]]]


def write(tmp_path, name, content):
    path = tmp_path / name
    path.write_text(content if isinstance(content, str) else json.dumps(content), encoding="utf-8")
    return path


def feature(properties=None, **geometry):
    return {"type": "Feature", "properties": properties, "geometry": {"type": "Polygon", "coordinates": SQUARE, **geometry}}


def collection(*features):
    return {"type": "FeatureCollection", "features": list(features)}


def test_geojson_gives_areas_and_what_it_says_of_them(tmp_path):
    told = {"thickness": 0.7, "density": 900, "velocity": [0.1, -0.2], "name": "A", "age": None}
    point = {"type": "Feature", "properties": {}, "geometry": {"type": "Point", "coordinates": [1.0, 1.0]}}
    nowhere = {"type": "Feature", "properties": {}, "geometry": None}
    drawn = read(write(tmp_path, "floes.geojson", collection(feature(told), feature(), point, nowhere)))
    assert (len(drawn.outlines), drawn.entries, drawn.unused) == (2, 3, ("name",))
    assert drawn.outlines[0].properties == {"thickness": 0.7, "density": 900.0, "velocity": (0.1, -0.2)}
    assert drawn.outlines[1].properties == {}
    assert drawn.outlines[0].area.equals(shapely.box(0.0, 0.0, 2.0, 2.0))


@pytest.mark.parametrize(
    "content",
    [
        {"type": "Polygon", "coordinates": SQUARE},
        {"type": "GeometryCollection", "geometries": [{"type": "Polygon", "coordinates": SQUARE}]},
        feature({"thickness": 1.0}),
    ],
)
def test_a_bare_geometry_is_geojson_too(tmp_path, content):
    assert len(read(write(tmp_path, "floes.json", content)).outlines) == 1


def test_wkt_has_a_geometry_a_line(tmp_path):
    text = "# two\nPOLYGON ((0 0, 2 0, 2 2, 0 2, 0 0))\n\nMULTIPOLYGON Z (((5 5 1, 6 5 1, 6 6 1, 5 5 1)))\nPOINT (1 1)\n"
    drawn = read(write(tmp_path, "floes.wkt", text))
    assert (len(drawn.outlines), drawn.entries) == (2, 3)
    assert shapely.get_coordinates(drawn.outlines[1].area).shape == (4, 2)


def test_csv_has_a_row_a_point(tmp_path):
    text = "floe, x, y, thickness, remark\na,0,0,0.7,old\na,2,0,,\nb,5,5,,\na,2,2,,\nb,6,5,,\nb,6,6,,\nc,1,1,,\n"
    drawn = read(write(tmp_path, "floes.csv", text))
    assert (len(drawn.outlines), drawn.entries, drawn.unused) == (2, 3, ("remark",))
    assert [outline.area.area for outline in drawn.outlines] == [2.0, 0.5]
    assert [outline.properties for outline in drawn.outlines] == [{"thickness": 0.7}, {}]


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("a.geojson", "{", "is not GeoJSON"),
        ("a.geojson", "[1, 2]", "holds no feature and no geometry"),
        ("a.geojson", collection(), "is empty"),
        ("a.geojson", collection(7), "feature 0 is no feature and no geometry"),
        ("a.geojson", collection(feature(coordinates=[[[0, 0], [1, 1]]])), "feature 0: its geometry cannot be understood"),
        ("a.geojson", collection(feature(type="Blob")), "feature 0: its geometry cannot be understood"),
        ("a.geojson", collection(feature({"thickness": -1})), "feature 0: thickness = -1: must be a number greater than 0"),
        ("a.geojson", collection(feature(), feature({"density": "hard"})), "feature 1: density = hard: must be a number"),
        ("a.geojson", collection(feature({"poisson_ratio": 0.5})), "poisson_ratio = 0.5: must be a number from 0 up to 0.5"),
        ("a.geojson", collection(feature({"velocity": 3})), "feature 0: velocity = 3: must be a list of 2 numbers"),
        ("a.geojson", collection(feature([1])), "feature 0: its properties are no table"),
        ("a.geojson", json.dumps(feature()).replace("0.0", "NaN"), "feature 0: "),
        ("a.wkt", "POINT (1 1)", "holds no area: 1 entries, none of them a polygon"),
        ("a.wkt", "POLYGON ((0 0, 1 0, 1 1, 0 0))\nPOLYGON ((0 0", "line 2 is not WKT"),
        ("a.wkt", "POLYGON ((0 0, 1 nan, 1 1, 0 0))", "line 1: holds a coordinate that is not finite"),
        ("a.csv", "", "must begin with a line that names the columns floe, x, y; floe is not there once"),
        ("a.csv", "floe,x\n1,2\n", "y is not there once"),
        ("a.csv", "floe,x,y\n1,2,three\n", "line 2: y = three: must be a number"),
        ("a.csv", "floe,x,y\n1,2\n", "line 2: y = None: must be a number"),
        ("a.csv", "floe,x,y\n1,inf,2\n", "line 2: x = inf: must be finite"),
        ("a.csv", "floe,x,y,thickness\n1,0,0,0\n", "line 2: thickness = 0.0: must be a number greater than 0"),
    ],
)
def test_a_bad_file_is_named(tmp_path, name, content, message):
    with pytest.raises(ValueError) as fault:
        read(write(tmp_path, name, content))
    assert message in str(fault.value)


def test_a_file_that_is_no_text(tmp_path):
    (tmp_path / "a.csv").write_bytes(b"floe,x,y\n\xff\xfe")
    with pytest.raises(ValueError, match="is not UTF-8 text"):
        read(tmp_path / "a.csv")
    with pytest.raises(ValueError, match="cannot be read"):
        read(tmp_path / "none.csv")

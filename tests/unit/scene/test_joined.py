"""Floes of several parts: mass, inertia, place and water loads of the whole, whatever it is cut into."""

import json

import numpy as np
import pytest
import shapely

from dilatedem.case.load import case_from
from dilatedem.events.repack import whole_floes
from dilatedem.output.record import floe_table
from dilatedem.run.hits import hit_log
from dilatedem.scene.arrays import build_model
from dilatedem.scene.facts import field_facts
from dilatedem.scene.place import compose
from dilatedem.state.bodies import joined_rows
from dilatedem.water.floating import submerged_prism

BAY = shapely.Polygon([(0, 0), (4, 0), (4, 4), (3, 4), (3, 1), (1, 1), (1, 4), (0, 4)])
DENSITY, THICKNESS = 915.0, 0.5


def built(tmp_path, *areas, radius=1e-4, **overrides):
    collection = {"type": "GeometryCollection", "geometries": [json.loads(shapely.to_geojson(area)) for area in areas]}
    (tmp_path / "floes.geojson").write_text(json.dumps(collection))
    field = {"source": "file", "file": str(tmp_path / "floes.geojson"), "tolerance": 0.0}
    case = case_from({"domain": {"size": [40.0, 40.0]}, "field": field, "ice": {"dilated_radius": radius}}, overrides)
    return case, compose(case)


def second_moments(polygon):
    """Of a polygon's area about its centroid: int x^2, int y^2, by the triangles of a triangulation."""
    middle, total = np.array(polygon.centroid.coords[0]), np.zeros((2, 2))
    for triangle in shapely.get_parts(shapely.constrained_delaunay_triangles(polygon)):
        corners = shapely.get_coordinates(triangle)[:3] - middle
        centre = corners.sum(axis=0)
        total += triangle.area / 12.0 * (sum(np.outer(c, c) for c in corners) + np.outer(centre, centre))
    return total


def test_parts_have_mass_and_inertia_of_the_whole(tmp_path):
    case, scene = built(tmp_path, shapely.box(10, 10, 12, 12), BAY)
    model = build_model(case, scene)
    solids, mass = model.solids, DENSITY * THICKNESS * BAY.area
    assert scene.joints.floe.tolist() == [-1, 1, 1, 1] and model.joined.tolist() == [[1, 4]]
    assert solids.mass[1:].sum() == pytest.approx(mass, rel=2e-3)
    assert solids.inverse_mass[1:] == pytest.approx([1.0 / mass] * 3, rel=2e-3)
    moments, slab = DENSITY * THICKNESS * second_moments(BAY), mass * THICKNESS**2 / 12.0
    expected = np.diag([moments[1, 1] + slab, moments[0, 0] + slab, moments[0, 0] + moments[1, 1]])
    expected[0, 1] = expected[1, 0] = -moments[0, 1]
    for part in (1, 2, 3):
        assert np.allclose(solids.inertia[part], expected, atol=3e-3 * expected.max())
        assert np.allclose(solids.inverse_inertia[part] @ solids.inertia[part], np.eye(3), atol=1e-12)
        assert scene.position[part, :2] == pytest.approx(BAY.centroid.coords[0], abs=1e-4)
    # cores lie where they were drawn
    start = model.shapes.vertex_start
    for part, outline in zip((1, 2, 3), list(scene.outlines)[1:], strict=True):
        core = model.shapes.vertex[start[part] : start[part + 1], :2] + scene.position[part, :2]
        assert np.abs(core.min(axis=0) - outline.min(axis=0)).max() < 3e-4


def test_a_floe_of_one_part_is_as_before(tmp_path):
    case, scene = built(tmp_path, shapely.box(0, 0, 2, 2), BAY, **{"field.not_convex": "hull"})
    model = build_model(case, scene)
    assert model.joined.shape == (0, 2) and (model.solids.floe == -1).all() and (model.hulls.plan[:, 8:] == 0.0).all()
    assert not scene.joints.seat.any()


@pytest.mark.parametrize("up", [(0.0, 0.0, 1.0), (0.02, -0.01, 0.9997), (-0.03, 0.04, 0.9988)])
def test_water_on_the_parts_is_that_on_the_whole(tmp_path, up):
    """A box cut in two at x = 1 by a notch that is closed again: both parts together against the closed form of the box."""
    notched = shapely.Polygon([(0, 0), (1, 0), (1, 1e-3), (1.001, 0), (4, 0), (4, 2), (0, 2)])
    found = []
    for shapes in ([notched], [shapely.box(0, 0, 4, 2)]):
        case, scene = built(tmp_path, *shapes)
        hulls, total = build_model(case, scene).hulls, np.zeros(5)
        for part in range(scene.count):
            valid, volume, cx, cy, cz, wetted = submerged_prism.py_func(0.03, *up, hulls.plan, hulls.height, part)
            assert valid
            total += [volume, volume * cx, volume * cy, volume * cz, wetted]
        found.append(total)
        assert scene.count == (3 if shapes[0] is notched else 1) or shapes[0] is notched
    scale = [4.0, 8.0, 8.0, 2.0, 12.0]
    assert np.abs((found[0] - found[1]) / scale).max() < 1e-3


def test_sizes_and_left_out_count_floes_not_parts(tmp_path):
    pile = {"kind": "pile", "center": [0.5, 3.0], "radius": 0.3}
    collection = {"structure": [pile]}
    case, scene = built(tmp_path, BAY, shapely.box(10, 10, 12, 12))
    facts = field_facts(case, scene)
    assert (facts["count"], facts["parts"], facts["file"]["floes"]) == (2, 4, 2)
    assert facts["floe_size_m"]["max"] == pytest.approx(BAY.area**0.5, rel=1e-3)
    case = case_from(case.model_dump(exclude_none=True) | collection, {})
    scene = compose(case)
    assert scene.count == 1 and scene.field.left_out == 1  # the pile stands in one part, and the floe goes as a whole


def test_load_events_and_the_table_of_floes_know_whole_floes(tmp_path):
    case, scene = built(tmp_path, shapely.box(10, 10, 12, 12), BAY)
    model = build_model(case, scene)
    one, several = model.solids.mass[0], model.solids.mass[1:].sum()
    assert hit_log(case, model, 1e-3).threshold == pytest.approx(0.5 * (one + several))  # 1 m/s2 of the mean floe
    table = floe_table(scene)
    assert table.floe.tolist() == [0, 1, 1, 1] and table.body.tolist() == [0, 1, 2, 3]


def test_rows_of_floes_and_what_leaves_as_a_whole():
    floe = np.array([-1, 4, 4, 4, -1, -1, 7, 7, 2, 2])
    assert joined_rows(floe).tolist() == [[1, 4], [6, 8], [8, 10]]
    assert joined_rows(np.full(3, -1)).shape == (0, 2) and joined_rows(np.zeros(0, np.int64)).shape == (0, 2)

    class Model:
        joined = joined_rows(floe)

    chosen = np.array([True, True, False, True, True, False, True, True, False, False])
    assert whole_floes(chosen, Model).tolist() == [True, False, False, False, True, False, True, True, False, False]

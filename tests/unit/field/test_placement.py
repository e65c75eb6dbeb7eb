"""Ice fields: concentration, obstacles, the seam, floating height, and what cannot be built."""

import time

import numpy as np
import pytest
import shapely

from dilatedem.field.obstacles import Disk, HalfPlane, Region
from dilatedem.field.placement import equilibrium_height, ice_field
from dilatedem.geometry.mass import dilated_solid
from dilatedem.geometry.outer import outer_polyhedron
from dilatedem.geometry.outline import area, centroid, erode, perimeter
from dilatedem.geometry.polyhedron import prism

PAPER = {"periodic": (False, True), "seed": 1, "dilated_radius": 0.04}


def dilated_area(outline, radius):
    core = erode(outline, radius)
    return area(core) + perimeter(core) * radius + np.pi * radius**2


@pytest.mark.parametrize("count", [200, 500])
def test_concentration_is_exact(count):
    field = ice_field((50.0, 50.0), count, 0.64, **PAPER)
    ice = sum(dilated_area(outline, 0.04) for outline in field.outlines)
    assert ice == pytest.approx(0.64 * 2500.0, rel=1e-12)
    assert field.concentration == pytest.approx(0.64, rel=1e-12)
    assert field.plan_area.sum() == pytest.approx(ice, rel=1e-12)
    assert (len(field.outlines), field.left_out) == (count, 0)


def test_centroids_lie_inside_a_periodic_domain():
    field = ice_field((20.0, 20.0), 60, 0.9, periodic=(True, True), seed=4, dilated_radius=0.02)
    middles = np.array([centroid(outline) for outline in field.outlines])
    assert np.abs(middles).max() <= 10.0
    assert max(np.abs(outline).max() for outline in field.outlines) > 10.0


def test_sharp_floes_need_no_search():
    field = ice_field((50.0, 50.0), 50, 0.64, periodic=(False, True), seed=1, dilated_radius=0.0)
    assert field.factor == pytest.approx(0.8, rel=1e-14)


def test_floes_at_a_pile_are_left_out():
    everywhere = ice_field((50.0, 50.0), 200, 0.64, **PAPER)
    field = ice_field((50.0, 50.0), 200, 0.64, **PAPER, obstacles=[Disk((10.0, 0.0), 2.0)])
    pile = shapely.Point(10.0, 0.0)
    distance = np.array([pile.distance(shapely.Polygon(outline)) for outline in everywhere.outlines])
    assert field.left_out == (distance <= 2.0).sum() > 0
    assert len(field.plan_area) == len(field.outlines) == (distance > 2.0).sum()
    assert field.concentration == everywhere.concentration


def test_pile_on_the_seam_is_met_from_both_sides():
    field = ice_field((50.0, 50.0), 200, 0.64, **PAPER, obstacles=[Disk((0.0, 24.5), 2.0)])
    floes = shapely.union_all([shapely.Polygon(outline) for outline in field.outlines])
    assert min(floes.distance(shapely.Point(0.0, y)) for y in (24.5, -25.5)) > 2.0
    shifted = ice_field((50.0, 50.0), 200, 0.64, **PAPER, obstacles=[Disk((0.0, 24.5 - 150.0), 2.0)])
    assert shifted.left_out == field.left_out


def test_wall_and_body():
    wall = HalfPlane(point=(15.0, 0.0), normal=(-1.0, 0.0))
    body = Region(np.array([[-5.0, -3.0], [1.0, -3.0], [1.0, 2.0], [-5.0, 2.0]]))
    field = ice_field((50.0, 50.0), 200, 0.64, **PAPER, obstacles=[wall, body])
    assert max(outline[:, 0].max() for outline in field.outlines) < 15.0
    assert not any(
        shapely.Polygon(outline).intersects(shapely.Polygon(body.outline)) for outline in field.outlines
    )
    assert field.left_out + len(field.outlines) == 200


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"dilated_radius": 0.5}, "too narrow for the dilated radius 0.5 m"),
        ({"concentration": 0.99999}, "cannot be reached.*at most 0.999"),
        ({"concentration": 1.0}, "between 0 and 1"),
        ({"count": 0}, "at least 1"),
    ],
)
def test_impossible_fields_are_refused(change, message):
    wanted = {"count": 200, "concentration": 0.64, **PAPER, **change}
    with pytest.raises(ValueError, match=message):
        ice_field((50.0, 50.0), wanted.pop("count"), wanted.pop("concentration"), **wanted)


def test_floe_floats_at_its_draft():
    # 2.8 x 2.8 x 0.5 m sharp box: draft 0.44634 m
    box = prism([[-1.4, -1.4], [1.4, -1.4], [1.4, 1.4], [-1.4, 1.4]], -0.25, 0.25)
    assert 0.25 - equilibrium_height(box, 915.0, 1025.0) == pytest.approx(0.44634, abs=5e-6)
    core = prism([[-1.0, -1.0], [1.4, -1.2], [0.9, 1.4]], -0.21, 0.21)
    solid = dilated_solid(core, 0.04)
    outer = outer_polyhedron(core.translated(-solid.centroid), 0.04, solid.volume)
    height = equilibrium_height(outer, 915.0, 1025.0)
    submerged = -(outer.vertices[:, 2].min() + height) * area(outer.vertices[outer.faces[1], :2])
    assert 1025.0 * submerged == pytest.approx(915.0 * solid.volume, rel=1e-12)
    with pytest.raises(ValueError, match="to float"):
        equilibrium_height(box, 1025.0, 1025.0)


def test_large_field_takes_seconds():
    start = time.perf_counter()
    field = ice_field((500.0, 500.0), 20_000, 0.64, **PAPER)
    assert field.concentration == pytest.approx(0.64, rel=1e-12)
    assert time.perf_counter() - start < 30.0  # 1 s on two cores; per-floe loops would take minutes

"""From areas to floes: each change, its counts and areas; what comes out is convex, apart and in the domain."""

import numpy as np
import pytest
import shapely
from shapely.affinity import rotate, translate

from dilatedem.field.drawing import Drawing, Outline
from dilatedem.field.survey import Wishes, surveyed
from dilatedem.geometry.outline import area, prepare

SIZE = np.array([40.0, 30.0])
SQUARE = shapely.box(0.0, 0.0, 2.0, 2.0)
BAY = shapely.Polygon([(0, 0), (4, 0), (4, 4), (3, 4), (3, 1), (1, 1), (1, 4), (0, 4)])
AS_DRAWN = Wishes(scale=1.0, origin=(0.0, 0.0), tolerance=0.0, smallest=0.0, parts=False)


def survey(*areas, wishes=AS_DRAWN, periodic=(False, False), walls=(False, False), radius=0.05):
    drawing = Drawing([Outline(shape, {"density": 900.0 + k}) for k, shape in enumerate(areas)], len(areas))
    found = surveyed(drawing, wishes, SIZE, periodic, walls, radius)
    return found.outlines, found.properties, found.report


def changes(report):
    return {name: change["outlines"] for name, change in report.facts()["changes"].items()}


def test_what_is_convex_and_apart_stays_as_it_was_drawn():
    outlines, told, report = survey(SQUARE, translate(SQUARE, 5.0))
    assert [area(outline) for outline in outlines] == [4.0, 4.0]
    assert told == [{"density": 900.0}, {"density": 901.0}]
    assert (changes(report), report.points, report.area, report.floes) == ({}, (8, 8), (8.0, 8.0), 2)


def test_scale_and_origin():
    wishes = [Wishes(2.0, origin, 0.0, 0.0, False) for origin in ((-3.0, 1.0), None)]
    shifted = [survey(SQUARE, translate(SQUARE, 5.0), wishes=each)[0] for each in wishes]
    assert np.array_equal(shifted[0][0].min(axis=0), [-3.0, 1.0]) and area(shifted[0][0]) == 16.0
    assert np.array_equal(shifted[1].points.min(axis=0), -shifted[1].points.max(axis=0))


def test_multipolygons_are_split_and_each_part_has_the_properties():
    both = shapely.MultiPolygon([SQUARE, translate(SQUARE, 5.0)])
    outlines, told, report = survey(translate(SQUARE, -5.0), both)
    assert len(outlines) == 3 and [each["density"] for each in told] == [900.0, 901.0, 901.0]
    assert changes(report) == {"multipolygons": 1} and report.polygons == 3


def test_outlines_that_cross_themselves_are_mended():
    bow = shapely.Polygon([(0, 0), (4, 4), (4, 0), (0, 4)])
    outlines, told, report = survey(translate(SQUARE, -5.0), bow)
    assert sorted(area(outline) for outline in outlines) == pytest.approx([4.0, 4.0, 4.0])
    assert changes(report) == {"mended": 1} and [each["density"] for each in told] == [900.0, 901.0, 901.0]


def test_holes_are_filled():
    report = survey(shapely.box(0, 0, 4, 4).difference(shapely.box(1, 1, 2, 2)))[2]
    assert report.facts()["changes"] == {"holes": {"outlines": 1, "area_before_m2": 15.0, "area_after_m2": 16.0}}


def test_points_within_the_tolerance_are_left_out():
    circle = shapely.Point(0.0, 0.0).buffer(3.0, quad_segs=100)
    outlines, _, report = survey(circle, wishes=Wishes(1.0, (0.0, 0.0), 0.01, 0.0, False))
    assert report.points == (400, len(outlines[0])) and 35 < len(outlines[0]) < 70
    thinned = report.facts()["changes"]["thinned"]
    assert thinned["area_before_m2"] == pytest.approx(circle.area)
    assert circle.area - 0.01 * circle.length < thinned["area_after_m2"] < circle.area
    assert shapely.Polygon(outlines[0]).hausdorff_distance(circle) <= 0.01


def test_outlines_that_are_not_convex_are_replaced_by_their_hulls():
    outlines, _, report = survey(BAY)
    assert area(outlines[0]) == 16.0
    assert report.facts()["changes"] == {"hulls": {"outlines": 1, "area_before_m2": BAY.area, "area_after_m2": 16.0}}


def test_two_that_overlap_are_cut_along_the_line_through_their_crossings():
    outlines, _, report = survey(SQUARE, translate(SQUARE, 1.5, 0.5))
    # the outlines cross at (1.5, 2) and (2, 0.5); each loses the half of what they share on the other's side
    first, second = (shapely.Polygon(outline) for outline in outlines)
    assert shapely.area(shapely.intersection(first, second)) < 1e-12
    line = shapely.LineString([(1.5, 2.0), (2.0, 0.5)])
    assert first.distance(line) < 1e-12 and second.distance(line) < 1e-12
    assert first.area + second.area == pytest.approx(8.0 - 0.75)
    assert first.area == pytest.approx(4.0 - 0.5 * 0.5 * 1.5)
    assert changes(report) == {"overlaps": 2}
    for outline in outlines:
        prepare(outline)


@pytest.mark.parametrize(
    "other",
    [
        shapely.box(0.5, 0.5, 1.5, 1.5),  # inside
        translate(SQUARE, 0.2, 0.3),  # nearly the same
        SQUARE,  # the same
        shapely.box(-1.0, 0.9, 3.0, 1.1),  # across
    ],
)
def test_of_two_that_share_too_much_or_cross_the_smaller_one_is_left_out(other):
    outlines, _, report = survey(shapely.box(0.0, 0.0, 2.0, 2.1), other)
    assert [area(outline) for outline in outlines] == pytest.approx([4.2])
    assert changes(report) == {"covered": 1}


def test_overlaps_across_the_seam_are_cut_too():
    left, right = shapely.box(-19.9, 0.0, -17.0, 2.0), shapely.box(17.0, 0.0, 20.5, 2.0)
    outlines, _, report = survey(left, right, periodic=(True, False))
    first, second = (shapely.Polygon(outline) for outline in outlines)
    assert shapely.area(shapely.intersection(translate(first, 40.0), second)) < 1e-12
    assert changes(report) == {"overlaps": 2}
    assert changes(survey(left, right)[2]) == {}


def test_small_and_narrow_ones_are_left_out():
    speck, needle = shapely.box(5.0, 5.0, 5.3, 5.3), shapely.box(0.0, 5.0, 4.0, 5.09)
    outlines, told, report = survey(SQUARE, speck, needle, wishes=Wishes(1.0, (0.0, 0.0), 0.0, 0.5, False))
    assert len(outlines) == 1 and told == [{"density": 900.0}]
    gone = report.facts()["changes"]["slivers"]
    assert (gone["outlines"], gone["area_before_m2"], gone["area_after_m2"]) == (2, pytest.approx(0.09 + 0.36), 0.0)
    assert len(survey(SQUARE, speck, needle)[0]) == 2


def test_what_lies_outside_or_at_a_wall_is_left_out():
    far, crossing = translate(SQUARE, 50.0), translate(SQUARE, 18.5)
    assert changes(survey(SQUARE, far, crossing)[2]) == {"outside": 1}
    assert changes(survey(SQUARE, far, crossing, walls=(True, False))[2]) == {"outside": 1, "at_walls": 1}


def pieces(found):
    """Each floe of a survey as one area."""
    polygons = np.array([shapely.Polygon(outline) for outline in found.outlines])
    return [shapely.union_all(polygons[found.floe == floe], grid_size=1e-9) for floe in range(len(found.properties))]


def in_parts(*areas, tolerance=0.0, periodic=(False, False)):
    drawing = Drawing([Outline(shape, {}) for shape in areas], len(areas))
    return surveyed(drawing, Wishes(1.0, (0.0, 0.0), tolerance, 0.3, True), SIZE, periodic, (False, False), 0.05)


def test_outlines_that_are_not_convex_are_cut_into_parts():
    found = in_parts(BAY, translate(SQUARE, 6.0))
    assert found.floe.tolist() == [0, 0, 0, 1]
    assert pieces(found)[0].equals_exact(shapely.normalize(BAY), 1e-9) or pieces(found)[0].symmetric_difference(BAY).area < 1e-9
    assert found.report.facts()["changes"] == {
        "parts": {"outlines": 1, "area_before_m2": pytest.approx(BAY.area), "area_after_m2": pytest.approx(BAY.area)}
    }
    for outline in found.outlines:
        prepare(outline)
    # sides within the floe are there twice: all sides less those are the outline
    sides = sum(np.linalg.norm(np.roll(outline, -1, axis=0) - outline, axis=1).sum() for outline in found.outlines[:3])
    assert sides - found.inner[:3, 0].sum() == pytest.approx(BAY.length)
    assert found.inner[3].tolist() == [0.0, 0.0, 0.0]


def test_of_two_the_smaller_loses_what_they_share_where_one_is_not_convex():
    found = in_parts(BAY, translate(SQUARE, -1.0, 1.0))
    first, second = pieces(found)
    assert first.symmetric_difference(BAY).area < 1e-9
    assert second.symmetric_difference(translate(SQUARE, -1.0, 1.0).difference(BAY)).area < 1e-9
    assert changes(found.report) == {"parts": 1, "overlaps": 1}


@pytest.mark.parametrize("parts", [False, True])
def test_a_crowd_comes_out_convex_and_apart(parts):
    rng = np.random.default_rng(5)
    crowd = []
    for _ in range(150):
        corners = rng.random((7, 2)) * rng.uniform(0.5, 5.0)
        crowd.append(translate(rotate(shapely.Polygon(corners).buffer(0.1), rng.uniform(0, 360)), *((rng.random(2) - 0.5) * SIZE)))
    drawing = Drawing([Outline(shape, {}) for shape in crowd], len(crowd))
    found = surveyed(drawing, Wishes(1.0, (0.0, 0.0), 0.02, 0.3, parts), SIZE, (True, True), (False, False), 0.05)
    assert len(found.properties) > 60 and (found.floe.max() == len(found.properties) - 1) and (np.diff(found.floe) >= 0).all()
    for outline in found.outlines:
        prepare(outline)
    shifts = [SIZE * [i, j] for i in (-1, 0, 1) for j in (-1, 0, 1)]
    copies = np.array([shapely.Polygon(outline + shift) for shift in shifts for outline in found.outlines])
    a, b = shapely.STRtree(copies).query(copies, predicate="intersects")
    assert shapely.area(shapely.intersection(copies[a[a != b]], copies[b[a != b]])).max() < 1e-9
    facts = found.report.facts()
    assert facts["floes"] == len(found.properties)
    assert facts["area_after_m2"] == pytest.approx(sum(area(outline) for outline in found.outlines))
    assert ("parts" in facts["changes"]) == parts == (len(found.outlines) > len(found.properties))

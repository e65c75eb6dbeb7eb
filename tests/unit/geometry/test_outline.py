"""Outlines in plan: checks, inward and outward offsets."""

import numpy as np
import pytest

from dilatedem.geometry.outline import MITRE_LIMIT, Outlines, area, centroid, erode, mitred, perimeter, prepare, thinned
from dilatedem.geometry.polyhedron import convex_hull

RECTANGLE = np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 2.0], [0.0, 2.0]])


def clipped(outline, distance):
    """Oracle: the outline cut by the half-plane of every side moved inwards (Sutherland-Hodgman)."""
    left = outline
    for start, end in zip(outline, np.roll(outline, -1, axis=0), strict=True):
        along = (end - start) / np.linalg.norm(end - start)
        inward = np.array([-along[1], along[0]])
        kept = []
        for p, q in zip(left, np.roll(left, -1, axis=0), strict=True):
            height_p, height_q = ((x - start) @ inward - distance for x in (p, q))
            if height_p >= 0.0:
                kept.append(p)
            if height_p * height_q < 0.0:
                kept.append(p + (q - p) * height_p / (height_p - height_q))
        if not kept:
            return np.zeros((0, 2))
        left = np.array(kept)
    return left


def random_outline(seed, count):
    points = np.random.default_rng(seed).normal(size=(count, 2)) * [2.0, 1.0]
    return convex_hull(np.column_stack((points, np.zeros(count)))).vertices[:, :2]


def counter_clockwise(outline):
    return outline if area(outline) > 0.0 else outline[::-1]


def test_rectangle():
    assert erode(RECTANGLE, 0.5).tolist() == [[0.5, 0.5], [3.5, 0.5], [3.5, 1.5], [0.5, 1.5]]
    assert mitred(erode(RECTANGLE, 0.5), 0.5) == pytest.approx(RECTANGLE)
    assert (area(RECTANGLE), perimeter(RECTANGLE), centroid(RECTANGLE).tolist()) == (8.0, 12.0, [2.0, 1.0])
    assert erode(RECTANGLE, 0.0).tolist() == RECTANGLE.tolist()


@pytest.mark.parametrize("distance", [1.0 - 1e-9, 1.0, 1.0 + 1e-9, 5.0])
def test_nothing_left(distance):
    with pytest.raises(ValueError, match="too narrow"):
        erode(RECTANGLE, distance)


@pytest.mark.parametrize("seed", range(30))
def test_erosion_agrees_with_clipping(seed):
    outline = counter_clockwise(random_outline(seed, 40))
    for distance in np.linspace(0.01, 1.6, 25):
        expected = clipped(outline, distance)
        expected_area = area(expected) if len(expected) >= 3 else 0.0
        try:
            eroded = erode(outline, distance)
        except ValueError:
            assert expected_area < 1e-12
            continue
        assert area(eroded) == pytest.approx(expected_area, abs=1e-12)
        assert perimeter(eroded) == pytest.approx(perimeter(expected), abs=1e-7)
        prepare(eroded)  # still convex
        assert len(eroded) <= len(outline)


def test_short_sides_vanish():
    # a corner of the rectangle cut off by 0.1 is gone once the sides beside it meet: 0.1 < d (2 - sqrt(2))
    cut = np.array([[0.0, 0.0], [3.9, 0.0], [4.0, 0.1], [4.0, 2.0], [0.0, 2.0]])
    assert len(erode(cut, 0.17)) == 5
    assert erode(cut, 0.18) == pytest.approx(erode(RECTANGLE, 0.18))


def test_mitred_needle_is_bevelled():
    needle = np.array([[0.0, 0.0], [10.0, -0.1], [10.0, 0.1]])
    outer = mitred(needle, 0.1)
    assert len(outer) == 4
    assert outer[:, 0].min() == pytest.approx(-0.1 * MITRE_LIMIT)
    assert centroid(outer)[1] == pytest.approx(0.0, abs=1e-15)
    prepare(outer)


def test_prepare_cleans():
    messy = [[0, 0], [1, 0], [1, 0], [2, 0], [2, 1], [2, 2], [0, 2], [0, 1e-12], [0, 0]]
    assert prepare(messy) == pytest.approx(np.array([[0, 0], [2, 0], [2, 2], [0, 2]]), abs=1e-11)
    assert area(prepare(messy)) == pytest.approx(4.0)
    assert area(prepare(messy[::-1])) == pytest.approx(4.0)


@pytest.mark.parametrize(
    ("outline", "message"),
    [
        ([[0, 0], [1, 0]], "at least three"),
        ([[0, 0], [1, 0], [np.nan, 1]], "not finite"),
        ([[1, 1], [1, 1], [1, 1]], "coincide"),
        ([[0, 0], [1, 1], [2, 2]], "no area"),
        ([[0, 0], [2, 0], [0, 2], [2, 2]], "crosses itself"),
        ([[0, 0], [2, 0], [2, 2], [1, 0.5]], "not convex"),
        ([[np.cos(0.8 * np.pi * k), np.sin(0.8 * np.pi * k)] for k in range(5)], "crosses itself"),
    ],
)
def test_unusable_outlines_are_refused(outline, message):
    with pytest.raises(ValueError, match=message):
        prepare(outline)


def test_outlines_read_as_a_list_and_work_as_arrays():
    each = [np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]) + k for k in range(4)]
    each.insert(2, np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]))
    outlines = Outlines.of(each)
    assert len(outlines) == 5 and outlines.sides.tolist() == [3, 3, 4, 3, 3]
    for found, expected in zip(outlines, each, strict=True):
        np.testing.assert_array_equal(found, expected)
    np.testing.assert_array_equal(outlines[-1], each[-1])
    assert [len(outline) for outline in outlines[1:3]] == [3, 4]
    with pytest.raises(IndexError):
        outlines[5]
    (three, corners), (four, _) = outlines.by_sides()
    assert three.tolist() == [0, 1, 3, 4] and four.tolist() == [2]
    np.testing.assert_array_equal(corners[2], each[3])
    kept = outlines.where(np.array([False, True, True, False, False]))
    np.testing.assert_array_equal(kept.points, np.concatenate(each[1:3]))
    assert len(Outlines.of([])) == 0 and Outlines.of([]).by_sides() == []


@pytest.mark.parametrize("tolerance", [1e-6, 1e-3, 0.05, 0.5, 10.0])
def test_thinning_leaves_corners_out_and_moves_none(tolerance):
    angle = np.arange(128) * (2.0 * np.pi / 128)
    outline = 14.0 * np.column_stack((np.cos(angle), np.sin(angle)))
    left = thinned(outline, tolerance)
    assert 3 <= len(left) <= 128
    assert (len(left) < 128) == (tolerance > 14.0 * (1.0 - np.cos(angle[1])))
    assert {tuple(corner) for corner in left} <= {tuple(corner) for corner in outline}
    assert prepare(left).tolist() == left.tolist()  # convex and counter-clockwise still
    side = np.roll(left, -1, axis=0) - left
    outward = np.column_stack((side[:, 1], -side[:, 0])) / np.linalg.norm(side, axis=1)[:, None]
    assert np.einsum("ijk,jk->ij", outline[:, None] - left, outward).max() <= tolerance + 1e-12

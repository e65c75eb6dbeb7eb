"""Cells of prescribed areas: they have them, tile the domain, and belong to the point that is nearest in the power distance."""

import numpy as np
import pytest
import shapely

from dilatedem.field.laguerre import cells_of_weights, nuclei_of_areas, power_diagram
from dilatedem.field.tessellation import cells_of_points
from dilatedem.geometry.outline import area, prepare

BOUNDARIES = [(False, False), (True, False), (False, True), (True, True)]
SIZE = np.array([30.0, 20.0])


def drawn(count, seed):
    rng = np.random.default_rng(seed)
    return (rng.random((count, 2)) - 0.5) * SIZE, rng


@pytest.mark.parametrize("periodic", BOUNDARIES)
@pytest.mark.parametrize("count", [1, 2, 5, 120])
def test_cells_have_the_areas_asked_for_and_tile_the_domain(count, periodic):
    points, rng = drawn(count, count)
    areas = np.exp(rng.standard_normal(count))
    areas *= SIZE.prod() / areas.sum()
    nuclei, weights = nuclei_of_areas(points, areas, SIZE, periodic, 0)
    cells = cells_of_weights(nuclei, weights, SIZE, periodic)
    assert np.allclose([area(cell) for cell in cells], areas, rtol=1e-8)
    shifts = [np.array([i, j]) * SIZE for i in (-1, 0, 1) for j in (-1, 0, 1) if (periodic[0] or not i) and (periodic[1] or not j)]
    copies = [shapely.Polygon(cell + shift) for shift in shifts for cell in cells]
    covered = shapely.union_all(copies).intersection(shapely.box(*(-0.5 * SIZE), *(0.5 * SIZE)))
    assert covered.area == pytest.approx(SIZE.prod(), rel=1e-9)
    for cell in cells:
        prepare(cell)  # convex, counter-clockwise


def images(points, weights, periodic):
    """Points and weights with their copies on all sides: moved by a period, or mirrored."""
    for axis in range(2):
        moved = [points]
        for sign in (-1.0, 1.0):
            copy = points.copy()
            copy[:, axis] = copy[:, axis] + sign * SIZE[axis] if periodic[axis] else sign * SIZE[axis] - copy[:, axis]
            moved.append(copy)
        points, weights = np.concatenate(moved), np.tile(weights, 3)
    return points, weights


@pytest.mark.parametrize("periodic", BOUNDARIES)
def test_a_place_belongs_to_the_point_of_least_power(periodic):
    points, rng = drawn(40, 3)
    weights = 2.0 * rng.random(40)
    cells = power_diagram(points, weights, SIZE, periodic)
    around, all_weights = images(points, weights, periodic)
    places = (rng.random((500, 2)) - 0.5) * SIZE
    power = ((places[:, None] - around) ** 2).sum(axis=2) - all_weights
    owner = power.argmin(axis=1) % 40
    outlines = [shapely.Polygon(cells.corners[a:b]) for a, b in zip(cells.start[:-1], cells.start[1:], strict=True)]
    shifts = [np.array([i, j]) * SIZE for i in (-1, 0, 1) for j in (-1, 0, 1)]
    for place, own in zip(places, owner, strict=True):
        assert any(outlines[own].covers(shapely.Point(place + shift)) for shift in shifts)


def test_equal_weights_are_voronoi_cells():
    points, _ = drawn(60, 4)
    plain = cells_of_points(points, SIZE, (False, True))
    weighted = cells_of_weights(points, np.full(60, 3.0), SIZE, (False, True))
    assert np.allclose([area(cell) for cell in plain], [area(cell) for cell in weighted], rtol=1e-10)


def test_the_newton_step_is_the_derivative_of_the_areas():
    points, rng = drawn(30, 5)
    weights, step = rng.random(30), 1e-5 * rng.standard_normal(30)
    before, after = (power_diagram(points, w, SIZE, (False, True)) for w in (weights - step, weights + step))
    middle = power_diagram(points, weights, SIZE, (False, True))
    flow = middle.coupling * (step[middle.first] - step[middle.second])
    assert np.allclose(after.area - before.area, 2.0 * np.bincount(middle.first, flow, 30), atol=1e-9)


def test_a_point_of_too_little_weight_is_named():
    points = np.array([[0.0, 0.0], [1.0, 0.0]])
    with pytest.raises(ValueError, match="1 of 2 cells are empty"):
        cells_of_weights(points, np.array([0.0, 1000.0]), SIZE, (False, False))

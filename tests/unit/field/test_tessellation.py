"""Voronoi cells tile the domain, across the seam too, and each belongs to its point."""

import numpy as np
import pytest
import shapely

from dilatedem.field.recipe import Recipe
from dilatedem.field.tessellation import cells_of_points, order_in_space
from dilatedem.geometry.outline import area, prepare

BOUNDARIES = [(False, False), (True, False), (False, True), (True, True)]


def voronoi_cells(size, count, periodic, seed):
    size = np.asarray(size, float)
    return Recipe().nuclei(size, count, periodic, np.random.default_rng(seed)).cells(size, periodic)


def images(size, periodic):
    """Shifts to the neighbouring copies of a periodic domain."""
    steps = [(-2, -1, 0, 1, 2) if is_periodic else (0,) for is_periodic in periodic]
    return [np.array([i, j]) * size for i in steps[0] for j in steps[1]]


@pytest.mark.parametrize("periodic", BOUNDARIES)
@pytest.mark.parametrize("count", [1, 2, 3, 40, 400])
def test_cells_tile_the_domain(count, periodic):
    size = np.array([50.0, 20.0])
    cells = voronoi_cells(size, count, periodic, seed=count)
    assert len(cells) == count
    assert sum(area(cell) for cell in cells) == pytest.approx(1000.0, rel=1e-12)
    for axis in range(2):
        reach = max(np.abs(cell[:, axis]).max() for cell in cells)
        assert periodic[axis] or reach == 0.5 * size[axis]
    copies = [shapely.Polygon(cell + shift) for shift in images(size, periodic) for cell in cells]
    covered = shapely.union_all(copies).intersection(shapely.box(*(-0.5 * size), *(0.5 * size)))
    assert covered.area == pytest.approx(1000.0, rel=1e-9)
    for cell in cells[:40]:
        prepare(cell)


@pytest.mark.parametrize("periodic", BOUNDARIES)
def test_cells_hold_what_is_nearest_to_their_point(periodic):
    size, rng = np.array([10.0, 7.0]), np.random.default_rng(8)
    points = (rng.random((12, 2)) - 0.5) * size
    cells = cells_of_points(points, size, periodic)
    places = (rng.random((300, 2)) - 0.5) * size
    shifts = images(size, periodic)
    copies = np.concatenate([points + shift for shift in shifts])
    nearest = np.linalg.norm(places[:, None] - copies, axis=2).argmin(axis=1) % len(points)
    for place, owner in zip(places, nearest, strict=True):
        assert any(shapely.Polygon(cells[owner]).covers(shapely.Point(place - shift)) for shift in shifts)


def test_regular_points_give_square_cells():
    # four cells meet at every corner, and the domain's edge mirrors them: degenerate for the hull underneath
    line = np.arange(5) - 2.0
    points = np.stack(np.meshgrid(line, line), axis=-1).reshape(-1, 2)
    for periodic in BOUNDARIES:
        cells = cells_of_points(points, np.array([5.0, 5.0]), periodic)
        assert all(len(cell) == 4 for cell in cells)
        assert all(area(cell) == pytest.approx(1.0) for cell in cells)


def test_seed_fixes_the_cells():
    first, again, other = (voronoi_cells((50.0, 50.0), 30, (False, True), seed) for seed in (1, 1, 2))
    assert all((a == b).all() for a, b in zip(first, again, strict=True))
    assert not np.array_equal(first[0], other[0])


def test_cells_are_numbered_along_a_curve_that_leaves_nothing_out():
    """Hilbert's curve goes from a square of the grid to one beside it: of all squares of a grid, each step is one square long."""
    grid = np.stack(np.meshgrid(np.arange(16.0), np.arange(16.0)), axis=-1).reshape(-1, 2)
    shuffled = np.random.default_rng(1).permutation(grid + 0.5)
    order = order_in_space(np.vstack([shuffled, [[16.0, 16.0]]]))  # a corner, so that squares of the grid are squares of the curve
    along = shuffled[order[order < len(shuffled)]]
    assert np.array_equal(np.unique(along, axis=0), np.unique(grid + 0.5, axis=0))
    assert np.array_equal(np.abs(np.diff(along, axis=0)).sum(axis=1), np.ones(255))


@pytest.mark.parametrize("size", [(100.0, 100.0), (200.0, 50.0)])
def test_neighbours_have_numbers_that_are_near(size):
    cells = voronoi_cells(size, 1000, (False, True), seed=3)
    centre = np.array([outline.mean(axis=0) for outline in cells])
    spacing = np.sqrt(size[0] * size[1] / 1000)
    assert np.median(np.linalg.norm(np.diff(centre, axis=0), axis=1)) < 1.5 * spacing

"""Recipes of fields: lattices, Lloyd's steps, sizes asked for and reached, ragged ends; and what is cut from any of them."""

import numpy as np
import pytest
import shapely

from dilatedem.field.distribution import Lognormal, Moments, PowerLaw
from dilatedem.field.lattice import HEXAGON
from dilatedem.field.placement import ice_field
from dilatedem.field.recipe import Recipe
from dilatedem.geometry.outline import area, centroid

SIZE = np.array([50.0, 40.0])
POWER = PowerLaw(kind="power_law", exponent=1.9, min=1.5, max=9.0)
RECIPES = {
    "plain": Recipe(),
    "lloyd": Recipe(regularity=5),
    "power law": Recipe(sizes=POWER),
    "lognormal": Recipe(sizes=Lognormal(kind="lognormal", spread=0.4), regularity=2),
    "square": Recipe("square"),
    "hexagon": Recipe("hexagon"),
}
BOUNDARIES = [(False, False), (True, False), (False, True), (True, True)]


def cells(recipe, count=150, periodic=(False, True), seed=1):
    return recipe.nuclei(SIZE, count, periodic, np.random.default_rng(seed)).cells(SIZE, periodic)


@pytest.mark.parametrize("periodic", BOUNDARIES)
@pytest.mark.parametrize("name", RECIPES)
def test_cells_of_any_recipe_tile_the_domain(name, periodic):
    made = cells(RECIPES[name], periodic=periodic)
    assert len(made) == RECIPES[name].count(SIZE, 150, periodic)
    assert sum(area(cell) for cell in made) == pytest.approx(2000.0, rel=1e-12)
    for axis in range(2):
        assert periodic[axis] or max(np.abs(cell[:, axis]).max() for cell in made) == 0.5 * SIZE[axis]


def test_cells_of_a_lattice_are_alike():
    squares = [area(cell) for cell in cells(RECIPES["square"])]
    assert np.ptp(squares) < 1e-9 and all(len(cell) == 4 for cell in cells(RECIPES["square"]))
    hexagons = cells(RECIPES["hexagon"], periodic=(True, True))
    assert np.ptp([area(cell) for cell in hexagons]) < 1e-9 and all(len(cell) == 6 for cell in hexagons)


def test_hexagons_are_regular_where_whole_ones_fit():
    size = 3.0 * np.array([16.0 * HEXAGON, 12.0])
    regular = Recipe("hexagon").nuclei(size, 192, (True, True), np.random.default_rng(1)).cells(size, (True, True))
    sides = np.concatenate([np.linalg.norm(np.roll(cell, -1, axis=0) - cell, axis=1) for cell in regular])
    assert len(regular) == 192 and np.allclose(sides, sides[0], rtol=1e-9)


def test_steps_of_lloyd_make_cells_more_alike():
    spread = [np.std([area(cell) for cell in cells(Recipe(regularity=steps))]) for steps in (0, 1, 5, 30)]
    assert (np.diff(spread) < 0.0).all() and spread[0] > 4.0 * spread[3]


@pytest.mark.parametrize("concentration", [0.6, 0.95])
@pytest.mark.parametrize("sizes", [POWER, Lognormal(kind="lognormal", spread=0.4)])
def test_floes_have_the_distribution_and_the_concentration_asked_for(sizes, concentration):
    size = sizes.floe_size or 2.8
    count = round(concentration * 2000.0 / size**2)
    field = ice_field(SIZE, count, concentration, periodic=(False, True), seed=2, dilated_radius=0.04, recipe=Recipe(sizes=sizes))
    asked, reached = sizes.moments(size), Moments.of_areas(field.every_area)
    assert field.concentration == pytest.approx(concentration, rel=1e-12)
    assert reached.root_of_mean_area == pytest.approx(size, rel=0.5 / count)
    assert reached.mean == pytest.approx(asked.mean, rel=0.01)
    assert reached.deviation == pytest.approx(asked.deviation, rel=0.03)


@pytest.mark.parametrize("name", RECIPES)
def test_floes_of_any_recipe_are_apart_at_95_percent(name):
    field = ice_field(SIZE, 150, 0.95, periodic=(False, True), seed=1, dilated_radius=0.02, recipe=RECIPES[name])
    assert field.concentration == pytest.approx(0.95, rel=1e-12)
    floes = np.array([shapely.Polygon(outline + [0.0, shift]) for shift in (-40.0, 0.0, 40.0) for outline in field.outlines])
    first, second = shapely.STRtree(floes).query(floes, predicate="intersects")
    assert (first == second).all()


def test_ragged_ends_are_whole_cells_and_hold_as_much_ice():
    straight, ragged = (
        ice_field(SIZE, 150, 0.8, periodic=(False, True), seed=3, dilated_radius=0.02, ragged=(end, False)) for end in (False, True)
    )
    assert ragged.plan_area.sum() == pytest.approx(straight.plan_area.sum(), rel=1e-12)
    assert max(np.abs(outline[:, 0]).max() for outline in straight.outlines) < 25.0
    reach = np.array([np.abs(outline[:, 0]).max() for outline in ragged.outlines])
    assert reach.max() > 25.5
    assert max(abs(centroid(outline)[0]) for outline in ragged.outlines) <= 25.0
    at_the_end = [len({*np.round(outline[:, 0], 6)}) == len(outline) for outline in ragged.outlines]
    assert all(at_the_end)  # no side along the end of the domain


def test_the_same_seed_gives_the_same_field():
    for recipe in RECIPES.values():
        first, again = cells(recipe, seed=7), cells(recipe, seed=7)
        assert np.array_equal(first.points, again.points)


def test_neighbours_have_numbers_that_are_near():
    for recipe in RECIPES.values():
        middle = np.array([centroid(cell) for cell in cells(recipe)])
        assert np.median(np.linalg.norm(np.diff(middle, axis=0), axis=1)) < 2.0 * np.sqrt(2000.0 / 150)


def test_no_cells():
    with pytest.raises(ValueError, match="at least 1"):
        cells(Recipe(), count=0)

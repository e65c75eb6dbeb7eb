"""Ice without an end: strips that fit each other, whichever is asked for first, with the statistics of a field that ends."""

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from dilatedem.field.distribution import Lognormal, Moments, PowerLaw
from dilatedem.field.endless import Course
from dilatedem.field.recipe import PLAIN, Recipe
from dilatedem.field.stream import Stream
from dilatedem.geometry import outline as plan

RECIPES = {
    "plain": PLAIN,
    "lloyd": Recipe(regularity=3),
    "power law": Recipe(sizes=PowerLaw(kind="power_law", exponent=1.9, min=1.5, max=5.0)),
    "lognormal": Recipe(sizes=Lognormal(kind="lognormal", spread=0.4), regularity=1),
    "square": Recipe("square"),
    "hexagon": Recipe("hexagon"),
}
PERIODIC = Course((30.0, 20.0), 0, -1, True)
COURSES = [PERIODIC, Course((30.0, 20.0), 0, 1, False), Course((20.0, 30.0), 1, 1, True), Course((20.0, 30.0), 1, -1, False)]


def stream(course: Course = PERIODIC, seed: int = 1, radius: float = 0.04, recipe: str = "plain") -> Stream:
    return Stream(course, 80, 0.7, seed=seed, radius=radius, recipe=RECIPES[recipe])


def ground(some: Stream, numbers: range) -> np.ndarray:
    """The cells of strips, in the frame of the domain."""
    cells = []
    for number in numbers:
        place = some.course.along((number + 0.5) * some.width - 0.5 * some.course.length)
        cells += [shapely.Polygon(cell + place) for cell in some._cells.of(number)]
    return np.array(cells)


def covered(course: Course, cells: np.ndarray, band: shapely.Polygon) -> float:
    """Area of a band [m2] that cells and their periodic images cover, each time it is covered."""
    shifts = [np.zeros(2)]
    if course.whole:
        period = np.where(np.arange(2) == course.axis, 0.0, course.size)
        shifts += [period, -period]
    return sum(
        float(shapely.area(shapely.intersection(shapely.transform(cells, lambda xy, by=shift: xy + by), band)).sum())
        for shift in shifts
    )


@pytest.mark.parametrize("course", COURSES)
@pytest.mark.parametrize("recipe", RECIPES)
def test_cells_of_all_strips_tile_the_plane_without_a_seam(course, recipe):
    some = stream(course, recipe=recipe)
    cells, width = ground(some, range(2, 12)), some.width
    corners = np.array([-0.5 * np.array(course.size), 0.5 * np.array(course.size)])
    ends = [course.upstream * (way - 0.5 * course.length) for way in (4.0 * width, 10.0 * width)]
    corners[:, course.axis] = min(ends), max(ends)
    band = shapely.box(*corners.ravel())
    assert covered(course, cells, band) == pytest.approx(band.area, rel=1e-9)
    assert shapely.union_all(cells).area == pytest.approx(shapely.area(cells).sum(), rel=1e-9), "no cell lies in another"


@given(st.lists(st.integers(-20, 60), min_size=1, max_size=6), st.integers(0, 2**62))
@settings(max_examples=20, deadline=None)
def test_a_strip_is_a_function_of_seed_and_number_alone(asked, seed):
    one, other = stream(seed=seed), stream(seed=seed)
    for number in asked:
        one.strip(number)
    found, again = one.strip(asked[0]), other.strip(asked[0])
    np.testing.assert_array_equal(found.outlines.points, again.outlines.points)
    np.testing.assert_array_equal(found.which, again.which)


@pytest.mark.parametrize("recipe", RECIPES)
def test_no_ice_comes_twice_and_every_cell_has_one_number(recipe):
    some = stream(recipe=recipe)
    strips = [some.strip(number) for number in range(30)]
    outlines = [outline - outline.mean(axis=0) for strip in strips for outline in strip.outlines]
    own = {np.round(outline[np.lexsort(outline.T)], 9).tobytes() for outline in outlines}
    assert len(own) == len(outlines) or RECIPES[recipe].shape != "voronoi"
    which = np.concatenate([strip.which for strip in strips])
    np.testing.assert_array_equal(which, np.arange(len(which)))
    assert all(some.strip_of(cell) == number for number, strip in enumerate(strips) for cell in strip.which)


@pytest.mark.parametrize("recipe", RECIPES)
def test_floes_are_apart_and_have_the_concentration(recipe):
    some = stream(recipe=recipe)
    floes = some.floes(range(40))
    outlines = np.array([shapely.Polygon(outline) for outline in floes.outlines])
    first, second = shapely.STRtree(outlines).query(outlines, predicate="dwithin", distance=1e-3)
    assert np.array_equal(first, second), "each is near itself alone"
    asked = 0.7 * shapely.area(ground(some, range(40))).sum()
    assert floes.plan_area.sum() == pytest.approx(asked, rel=1e-4)
    assert some.concentration == pytest.approx(0.7, rel=1e-12)


def test_cells_have_the_areas_of_a_poisson_voronoi_tessellation():
    """Their variance is 0.2802 of the square of the mean (Gilbert 1962); a Voronoi of fixed numbers in a box has a little less."""
    areas = []
    for seed in range(4):
        some = Stream(Course((60.0, 60.0), 0, -1, True), 400, 0.7, seed=seed, radius=0.04)
        areas += [plan.area(corners) for number in range(24) for _, corners in some._cells.of(number).by_sides()]
    areas, mean = np.concatenate(areas), 9.0
    assert len(areas) > 4000 and areas.mean() == pytest.approx(mean, rel=0.02)
    assert areas.var() / mean**2 == pytest.approx(0.275, abs=0.015)


def test_narrow_cells_are_open_water_and_keep_their_numbers():
    some = stream(radius=0.35)
    strips = [some.strip(number) for number in range(30)]
    assert sum(strip.narrow for strip in strips) > 0
    for number, strip in enumerate(strips):
        assert len(strip.outlines) + strip.narrow == some.first(number + 1) - some.first(number)


def test_what_is_there_at_the_start_reaches_as_far_as_asked():
    some = stream()
    numbers = some.until(33.0)
    assert some.begins(numbers.stop) > 33.0 >= some.begins(numbers.stop - 1)
    ahead = [PERIODIC.ahead(some.strip(number).outlines.points).max() for number in (numbers.start - 1, numbers.start)]
    assert ahead[0] <= 0.0 < ahead[1]


@pytest.mark.parametrize("recipe", ["lloyd", "power law", "lognormal"])
def test_a_strip_of_any_recipe_is_a_function_of_its_number_alone(recipe):
    one, other = stream(recipe=recipe), stream(recipe=recipe)
    for number in (40, -7, 3):
        one.strip(number)
    for number in (3, -7):
        np.testing.assert_array_equal(one.strip(number).outlines.points, other.strip(number).outlines.points)


def test_points_that_have_moved_have_the_areas_of_a_field_that_ends():
    """Also where blocks meet: the variance of areas there is that of all others."""
    recipe, size = Recipe(regularity=3), np.array([30.0, 30.0])
    generator = np.random.default_rng(1)
    ends = [recipe.nuclei(size, 100, (True, True), generator).cells(size, (True, True)) for _ in range(16)]
    asked = np.array([[plan.area(cell) for cell in cells] for cells in ends])
    some = Stream(Course((30.0, 30.0), 0, -1, True), 100, 0.7, seed=1, radius=0.04, recipe=recipe)
    cells = [cell for number in range(16 * some._strips) for cell in some._cells.of(number)]
    areas = np.array([plan.area(cell) for cell in cells]).reshape(16, 100)  # mean of an error: by as many fields
    error = asked.std(axis=1).std(ddof=1) / 4.0
    assert abs(areas.std(axis=1).mean() - asked.std(axis=1).mean()) < 3.0 * error
    assert areas.mean() == pytest.approx(9.0, rel=2e-3)
    seam = np.array([some._strips * block + strip for block in range(16) for strip in (0, some._strips - 1)])
    there = np.concatenate([[plan.area(cell) for cell in some._cells.of(number)] for number in seam])
    assert there.std() == pytest.approx(asked.std(), rel=0.15)


@pytest.mark.parametrize("sizes", [RECIPES["power law"].sizes, Lognormal(kind="lognormal", spread=0.4)])
def test_floes_have_the_sizes_asked_for(sizes):
    size = sizes.floe_size or 2.8
    count = round(0.7 * 900.0 / size**2)
    some = Stream(Course((30.0, 30.0), 0, -1, True), count, 0.7, seed=1, radius=0.04, recipe=Recipe(sizes=sizes))
    asked, reached = sizes.moments(size), Moments.of_areas(some.floes(range(8 * some._strips)).plan_area)
    assert reached.root_of_mean_area == pytest.approx(asked.root_of_mean_area, rel=0.01)
    assert reached.mean == pytest.approx(asked.mean, rel=0.02)
    assert reached.deviation == pytest.approx(asked.deviation, rel=0.03)


@pytest.mark.parametrize(("name", "sides"), [("square", 4), ("hexagon", 6)])
@pytest.mark.parametrize("course", [course for course in COURSES if course.whole])
def test_a_lattice_goes_on_in_its_rows_and_columns(name, sides, course):
    some = stream(course, recipe=name)
    cells = [cell for number in range(2 * some._strips) for cell in some._cells.of(number)]
    assert len(cells) == 2 * some.count and all(len(cell) == sides for cell in cells)
    assert np.ptp([plan.area(cell) for cell in cells]) < 1e-9

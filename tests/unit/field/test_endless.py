"""Blocks of nuclei: each by its number alone, areas met between two belts, and what is done at the end of a belt is not felt."""

import numpy as np
import pytest

from dilatedem.field.distribution import Lognormal
from dilatedem.field.endless import Blocks, Course, natural
from dilatedem.field.laguerre import power_diagram
from dilatedem.field.recipe import Recipe

COURSE = Course((24.0, 18.0), 0, -1, True)
SIZES = Recipe(sizes=Lognormal(kind="lognormal", spread=0.3))


def laid_out(blocks: Blocks, numbers: range) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Points [m] and weights of blocks side by side about the origin, and the size of all together."""
    nuclei = [blocks.nuclei(number) for number in numbers]
    middle = 0.5 * (numbers.start + numbers.stop - 1)
    points = [
        (COURSE.turned(each.points) - 0.5) * COURSE.size + COURSE.along((number - middle) * COURSE.length)
        for number, each in zip(numbers, nuclei, strict=True)
    ]
    return np.concatenate(points), np.concatenate([each.weights for each in nuclei]), COURSE.rectangle(len(numbers) * COURSE.length)


def test_areas_are_met_where_a_block_fits_between_two_belts_and_nearly_so_beside():
    blocks = Blocks(COURSE, SIZES, 40, 1)
    points, weights, size = laid_out(blocks, range(-1, 6))
    found = power_diagram(points, weights, size, (True, True)).area.reshape(7, blocks.count)
    for number, areas in zip(range(-1, 6), found, strict=True):
        asked = blocks._drawn(number)[1]
        assert np.sort(asked) == pytest.approx(np.sort(blocks._drawn(0)[1]), rel=1e-12), "of every block the same"
        if 0 <= number <= 4:
            np.testing.assert_allclose(areas, asked, rtol=1e-6 if number % 2 else 0.15)


def test_the_end_of_a_belt_is_not_felt():
    blocks, longer = (Blocks(COURSE, Recipe(regularity=6), 40, 2) for _ in range(2))
    longer._beside += 2
    away = blocks._settled(0)[0] - longer._settled(0)[0]
    away -= COURSE.size * np.round(away / COURSE.size)
    assert np.abs(away).max() < 0.02 * blocks.spacing


def test_blocks_are_told_by_numbers_of_both_signs():
    assert sorted(natural(number) for number in range(-4, 5)) == list(range(9))
    blocks = Blocks(COURSE, Recipe(), 40, 3)
    assert len(blocks.nuclei(-2).points) == 40 and not np.array_equal(blocks.nuclei(-2).points, blocks.nuclei(2).points)

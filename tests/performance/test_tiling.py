"""A scene repeated from its packed arrays is the scene that the program would build, and its copies do what the scene does."""

import numpy as np
import pytest

from benchmarks.scenes import SCENES, pitch_of, scene_simulation, tiled, tiles_for
from benchmarks.tiling import repeated_hulls, repeated_shapes
from dilatedem.geometry.polyhedron import convex_hull
from dilatedem.geometry.shapes import BodyShape, pack_hulls, pack_shapes
from dilatedem.state.clock import Status
from dilatedem.structures.pile import HALF_LENGTH


def test_repeated_arrays_are_those_of_repeated_shapes():
    tile = scene_simulation("jam")
    floes = tile.scene.shapes
    column = BodyShape.of_core(convex_hull(np.array([[0.0, 0.0, -HALF_LENGTH], [0.0, 0.0, HALF_LENGTH]])), 2.0)[0]
    repeated = pack_shapes(3 * floes + 3 * [column], [])
    repeated.plan_reach[-3:] = 2.0
    for made, packed in (
        (repeated_shapes(tile.model.shapes, len(floes), 3), repeated),
        (repeated_hulls(tile.model.hulls, 3), pack_hulls(3 * floes)),
    ):
        for name, expected in packed._asdict().items():
            np.testing.assert_array_equal(getattr(made, name), expected, err_msg=name)
            assert getattr(made, name).dtype == expected.dtype, name


@pytest.mark.parametrize("name", SCENES)
def test_every_copy_moves_like_the_scene(name):
    tile = scene_simulation(name)
    many = tiled(scene_simulation(name), 2, 2)
    for simulation in (tile, many):
        simulation.evaluate()
        assert simulation.advance(200) == Status.DONE
    floating = tile.model.floating
    corner = many.state.bodies.position[:floating] + [*(0.5 * pitch_of(tile)), 0.0]
    np.testing.assert_allclose(corner, tile.state.bodies.position[:floating], rtol=0.0, atol=1e-9)
    assert many.contacts == 4 * tile.contacts
    assert many.model.floating == 4 * floating and len(many.state.loads.contact_sum) == 4 * len(tile.state.loads.contact_sum)


@pytest.mark.parametrize(("floes", "expected"), [(200, (1, 1)), (2000, (3, 3)), (10_000, (7, 7)), (100_000, (22, 23))])
def test_sizes_are_met_by_a_rectangle_that_is_nearly_square(floes, expected):
    assert tiles_for(floes, 196) == expected

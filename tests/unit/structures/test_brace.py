"""A brace is a pile at any tilt: its hits, where no floe may start, its outline and its chart."""

import math

import numpy as np
import pytest
import shapely

from dilatedem.case.schema import Case
from dilatedem.field.obstacles import Disk
from dilatedem.run.simulation import Simulation
from dilatedem.state.clock import Status
from dilatedem.structures.brace import Brace
from dilatedem.structures.pile import Pile

THICKNESS = 0.5
#: ends of axes: upright, raked, at 45 degrees, nearly level, level, ending in the ice and above it
AXES = [
    ((2.0, 1.0, -9.0), (2.0, 1.0, 6.0)), ((0.0, 0.0, -10.0), (3.0, -1.0, 5.0)), ((-3.0, 1.0, 4.0), (4.0, 1.0, -3.0)),
    ((-5.0, 0.0, -0.4), (5.0, 3.0, 0.6)), ((-2.0, 0.0, 0.3), (2.0, 1.0, 0.3)), ((0.0, 0.0, -8.0), (1.0, 0.0, -0.3)),
    ((0.0, 0.0, 8.0), (2.0, 1.0, 0.7)),
]  # fmt: skip


def brace(start, end, radius: float = 0.4) -> Brace:
    return Brace.model_validate({"kind": "brace", "from": start, "to": end, "radius": radius})


def thrown(structure: dict, model: str, position=(-1.0, 0.1, 0.05)) -> Simulation:
    """A block that flies at what stands there, without water and weight."""
    return Simulation.of_case(Case.model_validate({
        "field": {"source": "bodies"}, "water": {"enabled": False}, "gravity": {"acceleration": 0.0},
        "contact": {"model": model}, "time": {"step": 2e-5}, "structure": [structure],
        "body": [{
            "vertices": [[x, y, z] for x in (-0.3, 0.3) for y in (-0.4, 0.4) for z in (-0.2, 0.2)], "dilated_radius": 0.05,
            "position": list(position), "velocity": [2.0, 0.3, 0.0],
        }],
    }))  # fmt: skip


@pytest.mark.parametrize("model", ["liu2015", "consistent"])
def test_upright_it_is_met_as_a_pile(model):
    pile = {"kind": "pile", "center": [0.5, 0.0], "radius": 0.4}
    upright = {"kind": "brace", "from": [0.5, 0.0, -200.0], "to": [0.5, 0.0, 200.0], "radius": 0.4}
    found = [thrown(structure, model) for structure in (pile, upright)]
    for simulation in found:
        assert simulation.advance(20_000) == Status.DONE
    np.testing.assert_array_equal(found[1].state.bodies.velocity, found[0].state.bodies.velocity)
    np.testing.assert_array_equal(found[1].state.loads.impulse_map, found[0].state.loads.impulse_map)
    assert found[0].state.bodies.velocity[0, 0] < 1.0, "it was hit"
    one, other = Pile(kind="pile", center=(0.5, 0.0), radius=0.4), brace((0.5, 0.0, -200.0), (0.5, 0.0, 200.0))
    assert one.obstacles(THICKNESS) == other.obstacles(THICKNESS)
    np.testing.assert_allclose(other.place, one.place)


@pytest.mark.parametrize("axis", AXES)
def test_no_floe_starts_where_it_is_between_the_heights_of_the_ice(axis):
    """Oracle: points of its surface, of which those between the heights all lie in the obstacle, and reach its border."""
    structure = brace(*axis)
    rng = np.random.default_rng(1)
    start, end = np.array(axis)
    directions = rng.normal(size=(200_000, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    points = start + rng.uniform(size=(200_000, 1)) * (end - start) + structure.radius * directions
    points = points[np.abs(points[:, 2]) <= THICKNESS, :2]
    (obstacle,) = structure.obstacles(THICKNESS)
    if isinstance(obstacle, Disk):
        solid, reach = shapely.Point(obstacle.center), obstacle.radius
    else:
        solid, reach = shapely.convex_hull(shapely.multipoints(obstacle.outline)), obstacle.reach
    away = shapely.distance(solid, shapely.points(points))
    assert away.max() <= reach + 1e-9
    if np.abs(np.linspace(start[2], end[2], 1001)).min() < THICKNESS:  # else its round end alone is in the ice
        assert away.max() > 0.98 * reach


def test_out_of_the_ice_it_is_no_obstacle():
    assert brace((0.0, 0.0, 1.0), (4.0, 0.0, 6.0)).obstacles(THICKNESS) == []
    assert brace((0.0, 0.0, -9.0), (4.0, 0.0, -1.0)).obstacles(THICKNESS) == []
    assert brace((0.0, 0.0, 1.0), (4.0, 0.0, 6.0)).sketch(30.0) is None


def test_the_water_level_cuts_an_ellipse_out_of_it():
    """Half axes r and r/sin(a), a the angle of rise."""
    outline = brace((-4.0, 0.0, -3.0), (4.0, 0.0, 3.0), radius=0.5).sketch(30.0).outline
    assert np.abs(outline[:, 0]).max() == pytest.approx(0.5 / 0.6, rel=2e-3)
    assert np.abs(outline[:, 1]).max() == pytest.approx(0.5, rel=2e-3)
    ellipse = (outline[:, 0] * 0.6 / 0.5) ** 2 + (outline[:, 1] / 0.5) ** 2
    np.testing.assert_allclose(ellipse, 1.0, atol=5e-3)


def test_a_hit_is_charted_around_the_axis_at_its_own_height():
    """The axis leans to +y, and 1.5 m above the water a block comes straight at it from -x."""
    leaning = {"kind": "brace", "from": [0.5, -3.2, -4.0], "to": [0.5, 3.2, 4.0], "radius": 0.4}
    simulation = thrown(leaning, "liu2015", position=(-1.0, 1.2 - 0.07, 1.5))
    assert simulation.advance(20_000) == Status.DONE
    hit = np.flatnonzero(simulation.state.loads.impulse_map[0].sum(axis=1))
    middles = -180.0 + 5.0 * hit + 2.5
    assert len(hit) and np.abs(middles).min() > 120.0


def test_a_flat_one_is_charted_along_its_axis_in_plan():
    chart = brace((-3.0, 0.0, -1.0), (3.0, 0.0, 1.0), radius=0.3).chart(30.0)
    assert chart.place == "distance" and chart.half == pytest.approx(3.3)
    np.testing.assert_allclose(chart.axis, [1.0, 0.0, 0.0], atol=1e-12)
    steep = brace((0.0, 0.0, -5.0), (1.0, 0.0, 5.0)).chart(30.0)
    assert steep.place == "angle" and steep.lean == pytest.approx((0.1, 0.0))


def test_its_place_is_where_the_axis_meets_the_water():
    np.testing.assert_allclose(brace((0.0, 2.0, -10.0), (3.0, 2.0, 5.0)).place, [2.0, 2.0, 0.0])
    (part,) = brace((0.0, 2.0, -10.0), (3.0, 2.0, 5.0)).parts()
    assert part.heights == pytest.approx((-10.4, 5.4)) and part.plan_reach == pytest.approx(1.9)


def test_an_axis_without_length_is_refused():
    with pytest.raises(ValueError, match=r"to: must be at least 0.001 m from the other end"):
        brace((1.0, 1.0, 0.0), (1.0, 1.0, 0.0))
    assert math.dist(*brace(*AXES[0])._axis) == pytest.approx(15.0)

"""A pier of any convex outline: its solid as drawn and rounded, where no floe may start, what is refused."""

import numpy as np
import pytest

from dilatedem.geometry.polyhedron import volume
from dilatedem.structures.box import Box
from dilatedem.structures.pier import Pier

SQUARE = [(2.0, 2.0), (-2.0, 2.0), (-2.0, -2.0), (2.0, -2.0)]
#: pointed at both ends: 60 degrees at either
HEXAGON = [(4.0, 0.0), (2.0, 1.0), (-2.0, 1.0), (-4.0, 0.0), (-2.0, -1.0), (2.0, -1.0)]


def pier(outline=SQUARE, **keys) -> Pier:
    return Pier.model_validate({"kind": "pier", "outline": outline} | keys)


def test_upright_on_a_rectangle_it_is_a_box():
    (box,), (found,) = Box(kind="box", center=(0.0, 0.0)).parts(), pier().parts()
    corners = [part.shape.core.vertices[np.lexsort(np.round(part.shape.core.vertices, 6).T)] for part in (box, found)]
    np.testing.assert_allclose(corners[1], corners[0], atol=1e-14)
    assert found.plan_reach <= box.plan_reach
    np.testing.assert_array_equal(pier().sketch(30.0).outline, SQUARE)


@pytest.mark.parametrize(("slope", "growth"), [(60.0, -1.0), (-60.0, 1.0), (120.0, 1.0)])
def test_its_sides_are_drawn_at_their_slope(slope, growth):
    """A square of half side 2 at z = 0 that gains or loses z/tan(60 degrees): volume of the frustum, in closed form."""
    tapered = pier(slope=slope, bottom=-1.0, top=2.0)
    low, high = (4.0 + growth * 2.0 * z / np.sqrt(3.0) for z in (-1.0, 2.0))
    (solid,) = tapered.drawing(30.0)
    assert volume(solid) == pytest.approx(3.0 * (low * low + low * high + high * high) / 3.0, rel=1e-12)
    assert np.ptp(solid.vertices[solid.vertices[:, 2] > 1.9, 0]) == pytest.approx(high)


def test_the_rounded_solid_touches_the_sides_of_the_one_drawn():
    structure = pier(HEXAGON, slope=70.0, top=1.0, dilated_radius=0.2)
    (solid,), (part,) = structure.drawing(30.0), structure.parts()
    core = part.shape.core.vertices + part.position
    for loop, normal in zip(solid.faces, solid.normals, strict=True):
        assert (core @ normal).max() + 0.2 == pytest.approx(solid.vertices[loop[0]] @ normal, abs=1e-12)


def test_a_short_side_may_vanish_before_the_narrow_end():
    """The sides at a blunt corner, 0.1 m long, meet 1 m above the water; the core and the drawing go on above."""
    blunt = [(2.0, 2.0), (-2.0, 2.0), (-2.0, -2.0), (1.9, -2.0), (2.0, -1.9)]
    (solid,) = pier(blunt, slope=80.0).drawing(30.0)
    assert solid.vertices[:, 2].max() == pytest.approx(3.0)


def test_no_floe_starts_where_it_is_widest_in_the_ice():
    (obstacle,) = pier(slope=45.0, top=1.0).obstacles(0.5)
    np.testing.assert_allclose(obstacle.outline.max(axis=0), [2.5, 2.5])
    assert pier(bottom=0.6).obstacles(0.5) == [] == pier(top=-0.6).obstacles(0.5)


@pytest.mark.parametrize(
    ("keys", "sentence"),
    [
        ({"outline": [(0.0, 0.0), (2.0, 0.0), (0.5, 0.5), (0.0, 2.0)]}, "outline: the outline is not convex"),
        ({"outline": [(0.0, 0.0), (1.0, 0.0), (2.0, 0.0)]}, "outline: the outline has no area"),
        ({"top": -3.0}, "top: must be above bottom, -3 m"),
        ({"slope": 3.0}, "slope: must be from 5 to 175, or from -90 to -5"),
        ({"slope": 45.0}, "slope: makes its sides meet before its top, 3 m"),
        ({"slope": -45.0}, "slope: makes its sides meet before its bottom, -3 m"),
        ({"slope": 60.0, "dilated_radius": 0.5}, "dilated_radius: leaves nothing of its narrowest level, at its top"),
        ({"dilated_radius": 2.0}, "dilated_radius: leaves nothing of its narrowest level"),
        ({"dilated_radius": 3.0}, "dilated_radius: must be less than half of the height, 3 m"),
    ],
)
def test_impossible_piers_are_refused(keys, sentence):
    with pytest.raises(ValueError, match=sentence):
        pier(keys.pop("outline", SQUARE), **keys)

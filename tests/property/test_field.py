"""Any ice field meets its concentration, has no overlap, also across the seam, and follows from its seed."""

import numpy as np
import shapely
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from dilatedem.field.obstacles import Disk
from dilatedem.field.placement import ice_field

FIELDS = st.fixed_dictionaries(
    {
        "size": st.tuples(st.floats(20.0, 80.0), st.floats(20.0, 80.0)),
        "count": st.integers(1, 120),
        "concentration": st.floats(0.1, 0.95),
        "periodic": st.tuples(st.booleans(), st.booleans()),
        "seed": st.integers(0, 2**32 - 1),
        "dilated_radius": st.sampled_from([0.0, 0.01, 0.04]),
    }
)
SETTINGS = settings(max_examples=40, deadline=None, derandomize=True)


def field_or_skip(wanted, **more):
    try:
        return ice_field(wanted["size"], wanted["count"], wanted["concentration"], **more, **rest(wanted))
    except ValueError as fault:  # a floe too small for the dilated radius is an honest refusal
        assume("too narrow" not in str(fault))
        raise


def rest(wanted):
    return {key: wanted[key] for key in ("periodic", "seed", "dilated_radius")}


def with_images(outlines, wanted):
    """Polygons of the floes and of their periodic images."""
    steps = [(-1, 0, 1) if is_periodic else (0,) for is_periodic in wanted["periodic"]]
    shifts = [np.array([i, j]) * wanted["size"] for i in steps[0] for j in steps[1]]
    return np.array([shapely.Polygon(outline + shift) for shift in shifts for outline in outlines])


@SETTINGS
@given(FIELDS)
def test_concentration_is_exact_for_the_round_floes(wanted):
    field = field_or_skip(wanted)
    ice_area = wanted["concentration"] * np.prod(wanted["size"])
    assert abs(field.plan_area.sum() / ice_area - 1.0) < 1e-9
    # shapely's own idea of a floe: the outline eroded, then dilated with round corners
    radius = wanted["dilated_radius"]
    outlines = np.array([shapely.Polygon(outline) for outline in field.outlines])
    core = shapely.buffer(outlines, -radius, join_style="mitre", mitre_limit=100.0)
    dilated = shapely.area(shapely.buffer(core, radius, quad_segs=64)) if radius else shapely.area(core)
    assert abs(dilated.sum() / ice_area - 1.0) < 1e-4


@SETTINGS
@given(FIELDS)
def test_floes_do_not_overlap(wanted):
    polygons = with_images(field_or_skip(wanted).outlines, wanted)
    assert shapely.is_valid(polygons).all()
    first, second = shapely.STRtree(polygons).query(polygons, predicate="intersects")
    assert (first == second).all()


@SETTINGS
@given(FIELDS, st.floats(0.5, 8.0))
def test_no_floe_touches_a_pile(wanted, radius):
    pile = Disk((0.3 * wanted["size"][0], -0.49 * wanted["size"][1]), radius)
    field = field_or_skip(wanted, obstacles=[pile])
    assert field.left_out + len(field.outlines) == wanted["count"]
    if field.outlines:
        distance = shapely.distance(with_images(field.outlines, wanted), shapely.Point(pile.center))
        assert distance.min() > radius


@SETTINGS
@given(FIELDS)
def test_seed_fixes_the_field(wanted):
    first, again = field_or_skip(wanted), field_or_skip(wanted)
    assert first.factor == again.factor
    assert all((a == b).all() for a, b in zip(first.outlines, again.outlines, strict=True))

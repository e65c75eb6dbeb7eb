"""Generated ice of a case: thicknesses, each floe at its own draught, walls with their own friction, what is asked and reached."""

import numpy as np
import pytest

from dilatedem.case.load import case_from
from dilatedem.errors import CaseError
from dilatedem.scene.arrays import build_model
from dilatedem.scene.facts import field_facts
from dilatedem.scene.place import compose

CASE = {"domain": {"size": [30.0, 24.0], "y_boundary": "wall"}, "field": {"floe_count": 60, "concentration": 0.7}}


def built(**overrides):
    case = case_from(CASE, overrides)
    return case, compose(case)


def test_each_floe_floats_at_its_own_draught():
    case, scene = built(**{"ice.thickness_spread": 0.3})
    assert np.ptp(scene.ice.thickness) > 0.5
    ends = np.cumsum([shape.count for shape in scene.shapes])
    for shape, order in zip(scene.shapes, np.split(scene.order, ends[:-1]), strict=True):
        z = shape.outer.stacked().vertices[..., 2]
        height, bottom = np.ptp(z, axis=1), scene.position[order, 2] + z.min(axis=1)
        assert np.allclose(-bottom, height * 915.0 / 1025.0, rtol=1e-12)
        assert np.allclose(height, scene.ice.thickness[order], rtol=2e-3)  # sharp edges hold what the round ones lack
    weight = scene.mass().sum() / (915.0 * scene.plan_area.sum())
    assert weight == pytest.approx(np.average(scene.ice.thickness, weights=scene.plan_area), rel=5e-3)
    facts = field_facts(case, scene)["thickness_m"]
    assert (facts["mean"], facts["spread"]) == pytest.approx((0.5, 0.3), rel=0.05)


def test_a_spread_of_thickness_leaves_the_field_in_plan_as_it_is():
    (_, plain), (_, varied) = built(), built(**{"ice.thickness_spread": 0.3})
    assert np.array_equal(plain.outlines.points, varied.outlines.points)
    assert "thickness_m" not in field_facts(case_from(CASE, {}), plain)


def test_floes_thinner_than_their_round_edges_are_refused():
    with pytest.raises(CaseError, match=r"[1-9]\d* of 60 floes are thinner than twice the dilated radius, 0.4 m"):
        built(**{"ice.thickness_spread": 0.5, "ice.dilated_radius": 0.2})


def test_walls_have_a_friction_of_their_own():
    case, scene = built(**{"domain.wall_friction": 0.02})
    friction = build_model(case, scene).solids.friction
    assert (friction[: scene.count] == case.contact.friction).all() and (friction[scene.count :] == 0.02).all()
    case, scene = built()
    assert (build_model(case, scene).solids.friction == case.contact.friction).all()


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"domain.wall_friction": 0.1, "domain.y_boundary": "open"}, "domain.wall_friction = 0.1: needs a side that is a wall"),
        ({"field.front": "ragged", "domain.x_boundary": "wall"}, 'field.front = "ragged": must be "straight" where no side is'),
        ({"field.shape": "square", "field.regularity": 2}, 'field.regularity = 2: belongs to shape = "voronoi"'),
        ({"field.size_distribution": {"kind": "power_law", "min": 1.0, "max": 5.0}}, "field.floe_count = 60: must be left out"),
        ({"field.size_distribution": {"kind": "power_law", "min": 1.0}}, "field.size_distribution.max: is missing"),
        ({"field.size_distribution": {"kind": "normal"}}, 'kind = "normal": must be "power_law" or "lognormal"'),
        ({"field.size_distribution": {"kind": "lognormal", "sprad": 1.0}}, 'sprad: unknown key; did you mean "spread"?'),
    ],
)
def test_bad_recipes_are_named(change, message):
    case = {table: dict(keys) for table, keys in CASE.items()}
    for key, value in change.items():
        table, _, name = key.partition(".")
        case[table][name] = value
    with pytest.raises(CaseError) as fault:
        case_from(case, {})
    assert message in str(fault.value)


def test_what_a_power_law_reaches_stands_beside_what_was_asked():
    case = {"domain": CASE["domain"], "field": {"size_distribution": {"kind": "power_law", "min": 1.0, "max": 8.0}}}
    told = field_facts(case_from(case, {}), compose(case_from(case, {})))
    distribution = told["size_distribution"]
    assert told["floe_size_m"]["asked"] == pytest.approx(distribution["asked_m"]["root_of_mean_area"])
    for name, value in distribution["asked_m"].items():
        assert distribution["reached_m"][name] == pytest.approx(value, rel=0.02)

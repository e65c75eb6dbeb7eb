"""Defaults are those of the paper's Table 1; what a body leaves out it takes from [ice]."""

import json
from pathlib import Path

import pytest
from pydantic import ValidationError

from dilatedem.case.load import load
from dilatedem.case.schema import Case, json_schema

CASES = Path(__file__).parents[3] / "cases"


def test_empty_case_has_every_default():
    case = Case()
    assert case.domain.size == (50.0, 50.0)
    assert (case.domain.x_boundary, case.domain.y_boundary) == ("open", "open")
    assert (case.field.source, case.field.floe_size, case.field.floe_count) == ("voronoi", 2.8, None)
    assert (case.field.concentration, case.field.seed) == (0.64, 1)
    assert (case.ice.density, case.ice.thickness, case.ice.dilated_radius) == (915.0, 0.5, 0.04)
    assert (case.ice.elastic_modulus, case.ice.poisson_ratio) == (1e9, 0.3)
    assert case.ice.initial_velocity == "current"
    assert (case.water.enabled, case.water.density, case.water.velocity) == (True, 1025.0, (0.3, 0.0))
    assert (case.water.drag_force_coefficient, case.water.drag_moment_coefficient) == (0.6, 0.1)
    assert case.gravity.acceleration == 9.81
    assert (case.structure, case.body) == ([], [])
    assert (case.contact.model, case.contact.damping) == ("liu2015", 0.36)
    assert (case.contact.friction, case.contact.stiffness_ratio) == (0.1, 0.7)
    assert (case.time.duration, case.time.step, case.time.step_fraction) == (100.0, "auto", 0.1)
    output = case.output
    assert (output.snapshot_interval, output.force_interval, output.energy_interval) == (1.0, 0.01, 0.1)
    assert (output.track, output.track_interval, output.checkpoint_interval) == ([], 0.01, 10.0)


def test_the_papers_laws_have_the_papers_dashpot():
    assert Case().contact.damping_law == "viscous"
    assert Case.model_validate({"contact": {"model": "consistent", "damping_law": "touch"}}).contact.damping_law == "touch"
    with pytest.raises(ValidationError, match='damping_law: must be "viscous" with contact.model = "liu2015"'):
        Case.model_validate({"contact": {"damping_law": "touch"}})


def test_structures_have_the_elasticity_of_steel():
    plane = {"kind": "plane", "point": [1, 2, 3], "normal": [0, 0, 1]}
    pile, plane = Case.model_validate({"structure": [{"kind": "pile"}, plane]}).structure
    assert (pile.name, pile.center, pile.radius) == ("pile", (10.0, 0.0), 2.0)
    assert (plane.name, plane.point, plane.normal) == ("plane", (1.0, 2.0, 3.0), (0.0, 0.0, 1.0))
    for structure in (pile, plane):
        assert (structure.elastic_modulus, structure.poisson_ratio) == (210e9, 0.3)


def test_the_papers_cases():
    large, small = load(CASES / "pile.toml"), load(CASES / "pile_small.toml")
    assert (large.domain.x_boundary, large.domain.y_boundary) == ("open", "periodic")
    assert (large.field.floe_count, small.field.floe_count) == (200, 500)
    fields = {"title", "field"}
    assert large.model_dump(exclude=fields) == small.model_dump(exclude=fields)
    assert [structure.name for structure in large.structure] == ["pile"]
    assert large.time == Case().time.model_copy(update={"error_check": True, "step_fraction": 0.4})
    fields |= {"structure", "domain", "time"}
    assert large.model_dump(exclude=fields) == Case().model_dump(exclude=fields)
    assert large.field.concentration == Case().field.concentration


def test_bodies_take_from_ice_what_they_leave_out():
    outline = [[0, 0], [1, 0], [0, 1]]
    case = Case.model_validate(
        {
            "ice": {"density": 900, "thickness": 0.4, "poisson_ratio": 0.2},
            "body": [
                {"vertices": [[0, 0, 0]]},
                {"outline": outline, "density": 800, "thickness": 0.3, "dilated_radius": 0.15},
                {"outline": outline, "position": [1, 2]},
            ],
        }
    )
    sphere, own, floe = case.body
    assert (sphere.dilated_radius, sphere.density, sphere.elastic_modulus) == (0.04, 900.0, 1e9)
    assert (sphere.thickness, sphere.position, sphere.poisson_ratio) == (None, (0.0, 0.0, 0.0), 0.2)
    assert (own.density, own.thickness, own.dilated_radius, own.position) == (800.0, 0.3, 0.15, None)
    assert (floe.density, floe.thickness, floe.dilated_radius) == (900.0, 0.4, 0.04)
    assert floe.position == (1.0, 2.0)


def test_a_case_does_not_change():
    with pytest.raises(ValidationError):
        Case().ice.density = 1.0


def test_faults_between_keys_are_told_without_a_file_too():
    with pytest.raises(ValidationError, match="dilated_radius: must be at most half the thickness"):
        Case.model_validate({"ice": {"thickness": 0.05}})


def test_json_schema_describes_every_key_and_knows_no_null():
    schema = json_schema()
    for table in schema["$defs"].values():
        assert table["additionalProperties"] is False
        for name, key in table["properties"].items():
            assert key["description"], name
            assert "unit" in key
    assert "null" not in json.dumps(schema)

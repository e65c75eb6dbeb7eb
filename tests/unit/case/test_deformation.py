"""What of a case can bend, and what not yet."""

import pytest
from pydantic import ValidationError

from dilatedem.case.schema import Case

DRY = {"field": {"source": "bodies"}, "water": {"enabled": False}, "body": [{"outline": [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]}]}


def test_bodies_are_rigid_unless_told():
    assert not Case.model_validate(DRY).bends
    assert Case.model_validate(DRY | {"deformation": {"modes": 6}}).bends
    assert Case.model_validate(DRY | {"body": [DRY["body"][0] | {"modes": 2}]}).bends


@pytest.mark.parametrize(("more", "said"), [
    ({"water": {"enabled": True, "added_mass": True}}, "added mass"),
    ({"domain": {"x_boundary": "outflow"}}, "bodies come or go"),
    ({"wind": {"velocity_table": [[0.0, 1.0, 0.0], [1.0, 2.0, 0.0]]}}, "wind that varies"),
])  # fmt: skip
def test_what_would_not_load_the_modes_is_refused(more, said):
    with pytest.raises(ValidationError, match=said):
        Case.model_validate(DRY | {"deformation": {"modes": 6}} | more)

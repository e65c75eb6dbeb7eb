"""Floe counts and sizes of the paper's fields."""

import pytest

from dilatedem.field.sizes import floe_count, floe_size


def test_sizes_of_the_paper():
    assert floe_size((50.0, 50.0), 0.64, 200) == pytest.approx(2.83, abs=5e-3)
    assert floe_size((50.0, 50.0), 0.64, 500) == pytest.approx(1.79, abs=5e-3)
    assert floe_count((50.0, 50.0), 0.64, floe_size((50.0, 50.0), 0.64, 200)) == 200
    assert floe_count((50.0, 50.0), 0.64, 2.8) == 204


def test_floe_larger_than_all_the_ice():
    assert floe_count((10.0, 10.0), 0.64, 9.0) == 1
    with pytest.raises(ValueError, match="at most 8 m"):
        floe_count((10.0, 10.0), 0.64, 20.0)

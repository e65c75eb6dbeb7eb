"""Tables in kernels: what lies between their rows, and its integral, as NumPy has them."""

import numpy as np
import pytest

from dilatedem.numerics.series import integral, linear, sums_from
from tests.kernels import door

at, summed = door(linear), door(integral)
TIMES = np.array([-1.0, 0.5, 0.7, 4.0])
VALUES = np.array([[2.0, 1.0], [3.0, -1.0], [3.0, 0.0], [-2.0, 5.0]])


@pytest.mark.parametrize("column", [0, 1])
def test_between_rows_it_is_linear_and_beyond_them_held(column):
    for time in (-7.0, -1.0, -0.3, 0.5, 0.6, 0.7, 3.0, 4.0, 9.0):
        assert at(TIMES, VALUES, column, time) == pytest.approx(np.interp(time, TIMES, VALUES[:, column]), abs=1e-15)


@pytest.mark.parametrize("origin", [-3.0, 0.0, 0.6, 6.0])
def test_its_integral_begins_at_the_origin(origin):
    sums = sums_from(origin, TIMES, VALUES)
    for time in (-5.0, -1.0, 0.2, 0.7, 3.3, 4.0, 8.0):
        places = np.linspace(origin, time, 200_001)
        for column in (0, 1):
            expected = np.trapezoid(np.interp(places, TIMES, VALUES[:, column]), places)
            assert summed(TIMES, VALUES, sums, column, time) == pytest.approx(expected, abs=1e-8)


def test_one_row_holds_always():
    times, values = np.zeros(1), np.array([[0.3]])
    sums = sums_from(0.0, times, values)
    assert at(times, values, 0, -4.0) == at(times, values, 0, 9.0) == 0.3
    assert summed(times, values, sums, 0, 10.0) == 3.0

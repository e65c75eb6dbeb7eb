import math

import pytest
from scipy.optimize import brentq

from dilatedem.numerics.root import bracketed_root

FUNCTIONS = [
    (lambda x: x**3 - 2.0, 0.0, 2.0),
    (lambda x: math.cos(x) - x, 0.0, 3.0),
    (lambda x: math.exp(-20.0 * x) - 1e-6, 0.0, 5.0),
    (lambda x: math.copysign(abs(x - 0.3) ** 0.2, x - 0.3), -1.0, 2.0),
    (lambda x: (x - 1.0) ** 3 + 1e-3, 0.0, 3.0),
    (lambda x: -1.0 if x < 0.7 else 1.0, 0.0, 1.0),
    (lambda x: x, 0.0, 1.0),
    (lambda x: x - 1.0, 0.0, 1.0),
]


@pytest.mark.parametrize("function, low, high", FUNCTIONS)
@pytest.mark.parametrize("absolute, relative", [(1e-15, 1e-15), (1e-6, 1e-12)])
def test_step_for_step_as_scipy(function, low, high, absolute, relative):
    met = [[], []]
    found = bracketed_root(lambda x: met[0].append(x) or function(x), low, high, absolute=absolute, relative=relative)
    expected = brentq(lambda x: met[1].append(x) or function(x), low, high, xtol=absolute, rtol=relative)
    assert found == expected
    assert met[0] == met[1]


def test_no_change_of_sign():
    with pytest.raises(ValueError, match="no change of sign between 1 and 2"):
        bracketed_root(lambda x: x, 1.0, 2.0, absolute=1e-9, relative=1e-9)

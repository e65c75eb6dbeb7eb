"""A floe that crushes on a pile that gives way, by the program and by the equations of validation/compliant: without a spring
(M/(m + M))^(1/3) of the fixed pile's force, F = (6 R m v^2 p^2 h^2)^(1/3) to leading order of the nominal area.
"""

import pytest

from validation.compliant.reference import MASS, fixed, peak
from validation.compliant.run import ALLOWED, simulated


@pytest.mark.parametrize("mass", [2e5, 5e5, 1e12])
def test_without_a_spring(mass):
    assert peak(mass, 0.0, leading=True).force / fixed() == pytest.approx((mass / (MASS + mass)) ** (1 / 3), rel=1e-7)


def test_on_a_spring():
    assert fixed() == pytest.approx(675_924.7, rel=1e-7)
    found = peak(5e5, 5e7, leading=True)
    assert found == pytest.approx((617_137.9, 0.042318, 0.007806), rel=1e-4)
    assert peak(5e5, 5e7).force < found.force, "the whole chord is shorter"


@pytest.mark.parametrize(("mass", "stiffness"), [(5e5, 5e8), (5e5, 1e7), (2e5, 0.0)])
def test_the_program_agrees(mass, stiffness):
    found, expected = simulated(mass, stiffness), peak(mass, stiffness)
    assert found.force == pytest.approx(expected.force, rel=ALLOWED)
    assert found.crushed == pytest.approx(expected.crushed, rel=0.01)
    assert found.shift == pytest.approx(expected.shift, rel=0.02)

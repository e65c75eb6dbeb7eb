"""The equations of validation/compliant: (M/(m + M))^(1/3) without a spring, and the fixed pile's force on a stiff or heavy one.

F = (6 R m v^2 p^2 h^2)^(1/3) on a fixed pile, to leading order of the nominal area.
"""

import pytest

from validation.compliant.reference import MASS, fixed, peak


@pytest.mark.parametrize("mass", [2e5, 5e5, 1e12])
def test_without_a_spring(mass):
    assert peak(mass, 0.0, leading=True).force / fixed() == pytest.approx((mass / (MASS + mass)) ** (1 / 3), rel=1e-7)


def test_on_a_spring():
    assert fixed() == pytest.approx(675_924.7, rel=1e-7)
    found = peak(5e5, 5e7, leading=True)
    assert found == pytest.approx((617_137.9, 0.042318, 0.007806), rel=1e-4)
    assert peak(5e5, 5e7).force < found.force, "the whole chord is shorter"

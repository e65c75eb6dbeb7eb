"""Distributions of floe sizes and thicknesses: their moments, and that n shares of them have those moments."""

import numpy as np
import pytest
from pydantic import ValidationError
from scipy.integrate import quad

from dilatedem.field.distribution import Lognormal, Moments, PowerLaw, thicknesses


def power_law(exponent, least=1.0, most=20.0):
    return PowerLaw(kind="power_law", exponent=exponent, min=least, max=most)


@pytest.mark.parametrize("exponent", [0.5, 1.0, 1.9, 2.0, 3.5])
def test_moments_of_a_power_law_are_the_integrals(exponent):
    law, (least, most) = power_law(exponent), (1.0, 20.0)
    scale = exponent / (least**-exponent - most**-exponent)
    mean, square = (quad(lambda d, k=k: scale * d ** (k - exponent - 1.0), least, most)[0] for k in (1, 2))
    found = law.moments(law.floe_size)
    assert (found.mean, found.root_of_mean_area) == pytest.approx((mean, square**0.5), rel=1e-9)
    assert found.deviation == pytest.approx((square - mean**2) ** 0.5, rel=1e-7)


@pytest.mark.parametrize("exponent", [1.0, 1.9, 2.0, 3.0])
def test_as_many_floes_are_larger_as_the_power_says(exponent):
    law = power_law(exponent)
    size = np.sqrt(law.shares(20_000)) * law.floe_size
    assert size[0] >= 1.0 and size[-1] <= 20.0
    for limit in (1.5, 3.0, 10.0):
        share = (limit**-exponent - 20.0**-exponent) / (1.0 - 20.0**-exponent)
        assert np.mean(size > limit) == pytest.approx(share, abs=1e-4)


@pytest.mark.parametrize("law", [power_law(1.9), Lognormal(kind="lognormal", spread=0.4)])
def test_shares_have_the_moments_of_the_distribution(law):
    asked = law.moments(2.8)
    for count, tolerance in ((50, 0.03), (2000, 2e-3)):
        areas = asked.root_of_mean_area**2 * law.shares(count)
        found = Moments.of_areas(areas)
        assert found.root_of_mean_area == pytest.approx(asked.root_of_mean_area, rel=1e-8)  # exact but for the digits kept
        assert found.mean == pytest.approx(asked.mean, rel=tolerance)
        assert found.deviation == pytest.approx(asked.deviation, rel=2.0 * tolerance)
        assert (np.diff(areas) > 0.0).all()


def test_logarithms_of_lognormal_sizes_are_normal():
    size = np.sqrt(Lognormal(kind="lognormal", spread=0.4).shares(5000))
    logarithm = np.log(size / np.median(size))
    assert logarithm.std() == pytest.approx(0.4, rel=2e-3)
    assert np.mean(np.abs(logarithm) < 0.4) == pytest.approx(0.6827, abs=1e-3)


@pytest.mark.parametrize("spread", [0.1, 0.3, 0.6])
def test_thicknesses_have_the_mean_and_spread_asked_for(spread):
    thickness = thicknesses(400, 0.5, spread, np.random.default_rng(1))
    assert thickness.mean() == pytest.approx(0.5, rel=1e-9)
    assert thickness.std() == pytest.approx(0.5 * spread, rel=0.03)
    assert thickness.min() > 0.0
    assert abs(np.corrcoef(thickness[1:], thickness[:-1])[0, 1]) < 0.15  # in no order


def test_no_spread_is_one_thickness():
    assert (thicknesses(5, 0.5, 0.0, np.random.default_rng(1)) == 0.5).all()


def test_bounds_in_the_wrong_order_are_refused():
    with pytest.raises(ValidationError, match="must be more than min"):
        power_law(1.9, 3.0, 2.0)

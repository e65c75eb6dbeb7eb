"""Means, standard deviations and percentiles, and how often their bands hold what they should."""

import math

import numpy as np
import pytest
from scipy import stats

from dilatedem.statistics import Band, deviation, difference, enough_for, growth, mean, needed, quantile
from dilatedem.statistics.bands import skewness

ENSEMBLES = 400
#: three standard errors of a share of 95 % in so many ensembles
ERROR = 3.0 * math.sqrt(0.95 * 0.05 / ENSEMBLES)


def held(estimate, law, count, true):
    """Share of ensembles of the law whose band holds what is true."""
    random = np.random.default_rng(11)
    bands = (estimate(law.rvs(count, random_state=random)) for _ in range(ENSEMBLES))
    return np.mean([band.low <= true <= band.high for band in bands])


@pytest.mark.parametrize(("law", "count"), [(stats.norm(3.0, 1.0), 10), (stats.gumbel_r(10.0, 3.0), 25)], ids=["normal", "Gumbel"])
def test_bands_hold_in_95_percent(law, count):
    """The whole study, with its record: validation/statistics."""
    assert held(mean, law, count, law.mean()) == pytest.approx(0.95, abs=0.02 + ERROR)
    assert held(deviation, law, count, law.std()) == pytest.approx(0.95, abs=0.02 + ERROR)
    assert held(lambda values: quantile(values, 0.5), law, count, law.median()) == pytest.approx(0.95, abs=0.01 + ERROR)
    assert held(lambda values: quantile(values, 0.9), law, count, law.ppf(0.9)) == pytest.approx(0.95, abs=0.02 + ERROR)


def test_without_skewness_the_band_of_a_mean_is_students():
    values = np.array([-2.0, -1.0, 0.0, 1.0, 2.0, 3.0]) + 7.0
    assert skewness(values) == pytest.approx(0.0, abs=1e-12)
    found = mean(values)
    reach = stats.t.ppf(0.975, 5) * values.std(ddof=1) / math.sqrt(6.0)
    assert (found.low, found.value, found.high) == pytest.approx((7.5 - reach, 7.5, 7.5 + reach))


def test_band_of_a_mean_turns_round_halls_transformation():
    values = np.array([1.0, 1.2, 1.3, 1.7, 2.9, 1.1, 1.4])
    found, n, skew = mean(values), 7, skewness(values)
    assert skew > 0.87
    skew = 0.8 * math.sqrt(n) / stats.t.ppf(0.975, n - 1)  # the most for so few
    for end, side in ((found.low, 1.0), (found.high, -1.0)):
        t = (values.mean() - end) / values.std(ddof=1)
        assert t + skew * t**2 / 3 + skew**2 * t**3 / 27 + skew / (6 * n) == pytest.approx(
            side * stats.t.ppf(0.975, n - 1) / math.sqrt(n)
        )  # fmt: skip
    assert found.high - found.value > found.value - found.low  # the long tail is above


def test_one_value_far_out_does_not_fold_the_band_of_a_mean():
    values = np.concatenate([np.linspace(0.9, 1.1, 19), [3.0]])
    assert mean(values).high < values.mean() + values.std(ddof=1)
    five = np.array([1.0, 1.1, 0.9, 1.0, 2.5])
    assert mean(five).high < five.mean() + 2.2 * five.std(ddof=1)  # Student's: 1.24


def test_difference_of_means_whose_variances_are_alike():
    """Of as many values and one variance it is Student's of 2 (n - 1) degrees of freedom: t(8) = 2.306 (Welch 1947)."""
    one = np.array([1.0, 2.0, 3.0, 4.0, 5.0])
    reach = 2.30600 * math.sqrt(2.5 * 2.0 / 5.0)
    found = difference(one + 10.0, one)
    assert (found.low, found.value, found.high) == pytest.approx((10.0 - reach, 10.0, 10.0 + reach), rel=1e-5)
    assert difference([2.0] * 5, [1.0] * 6) == Band(5, 1.0, 1.0, 1.0)
    assert difference([1.0, 2.0], [1.0, 1.5]) == Band(2, 0.25)


def test_differences_of_unlike_variances_hold_in_95_percent():
    random = np.random.default_rng(5)
    bands = [difference(random.normal(2.0, 1.0, 8), random.normal(1.0, 4.0, 20)) for _ in range(ENSEMBLES)]
    assert np.mean([band.low <= 1.0 <= band.high for band in bands]) == pytest.approx(0.95, abs=ERROR)


def test_bands_that_touch_are_not_apart():
    assert not Band(9, 1.0, 0.5, 1.5).is_apart(Band(9, 2.0, 1.5, 2.5))
    assert Band(9, 1.0, 0.5, 1.5).is_apart(Band(9, 2.0, 1.51, 2.5)) and Band(9, 2.0, 1.51, 2.5).is_apart(Band(9, 1.0, 0.5, 1.5))
    assert not Band(2, 1.0).is_apart(Band(2, 5.0))  # nothing is known


def test_ends_of_a_median_are_ranks_where_these_have_the_chance():
    """Of 10 values the 2nd and the 9th hold the median with 97.9 %, the 3rd and 8th with 89.1 %: the ends lie in between."""
    found = quantile(np.arange(1.0, 11.0), 0.5)
    assert 2.0 < found.low < 3.0 and 8.0 < found.high < 9.0
    assert found.low + found.high == pytest.approx(11.0)


@pytest.mark.parametrize(("count", "closed"), [(35, False), (36, True)])
def test_a_90_percent_quantile_has_an_upper_end_from_36_values_on(count, closed):
    found = quantile(np.arange(float(count)), 0.9)  # 0.9^36 = 0.0225, 0.9^35 = 0.0250...
    assert (0.9**count < 0.025) == closed == found.closed
    assert math.isfinite(found.low)


@pytest.mark.parametrize(("share", "least"), [(0.5, 1), (0.9, 7), (0.1, 7), (0.95, 13), (0.99, 67)])
def test_a_quantile_beyond_the_extreme_values_has_no_value(share, least):
    """Where the largest of few values would pass for it; that it is no less than some of them is known all the same."""
    values = np.arange(float(least)) + 1.0
    assert enough_for(share) == least
    assert 1.0 <= quantile(values, share).value <= least
    if least > 1:
        fewer = quantile(values[:-1], share)
        assert math.isnan(fewer.value) and fewer.n == least - 1
        assert math.isfinite(fewer.low if share > 0.5 else fewer.high)


def test_too_few_or_equal_values():
    assert mean([1.0, 2.0]) == Band(2, 1.5)
    assert not mean([1.0, 2.0, 4.0]).closed and math.isnan(mean([]).value)
    assert mean([2.0] * 6) == Band(6, 2.0, 2.0, 2.0)
    assert deviation([2.0] * 6).high == 0.0 and math.isnan(deviation([1.0]).value)
    assert quantile([], 0.5).n == 0
    assert mean([1.0, math.nan, 3.0]).n == 2


def test_runs_that_are_needed():
    values = stats.norm.ppf((np.arange(20) + 0.5) / 20) * 0.3 + 1.0  # scatter near 30 %
    count = needed(values, 0.1)
    spread = values.std(ddof=1)
    for n, enough in ((count, True), (count - 1, False)):
        assert (stats.t.ppf(0.975, n - 1) * spread / math.sqrt(n) <= 0.1) == enough
    assert needed(values[:3], 0.1) is None
    assert [band.n for band in growth([3.0, math.nan, 4.0])] == [1, 2]

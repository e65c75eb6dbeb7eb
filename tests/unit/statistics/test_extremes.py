"""Gumbel's, the generalized extreme value and the generalized Pareto law: scipy's fits, and what their bands are."""

import math

import numpy as np
import pytest
from scipy import optimize, stats

from dilatedem.statistics import fit_gev, fit_gumbel, fit_pareto, mean_excess, peaks_above, suitable_threshold
from dilatedem.statistics.gumbel import fit_rows, reduced
from dilatedem.statistics.likelihood import critical


def test_gumbels_law_is_scipys_fit_and_moves_with_the_unit():
    values = stats.gumbel_r(100.0, 25.0).rvs(25, random_state=1)
    found = fit_gumbel(values)
    assert (found.location.value, found.scale.value) == pytest.approx(stats.gumbel_r.fit(values), rel=1e-5)
    assert found.level(100).value == pytest.approx(stats.gumbel_r(found.location.value, found.scale.value).ppf(0.99))
    other = fit_gumbel(1e3 * values + 7.0).level(10)
    assert (other.low, other.high) == pytest.approx((1e3 * found.level(10).low + 7.0, 1e3 * found.level(10).high + 7.0))
    assert fit_gumbel(values[:4]) is None and fit_gumbel([3.0] * 9) is None


def test_values_of_which_a_third_are_the_same_have_no_gev():
    """Runs that no ice met: their likelihood grows without bounds as the scale shrinks around them."""
    loads = stats.gumbel_r(10.0, 3.0).rvs(20, random_state=2)
    assert fit_gev(np.concatenate([loads, np.zeros(10)])) is None
    few = fit_gev(np.concatenate([loads, np.zeros(5)]))
    assert few is not None and few.scale > 0.1 and few.value(10) > 5.0


def test_gumbels_bands_are_exact():
    """Of samples that were not the ones that bands are made of, 95 % hold the true level, whatever the number of runs."""
    random, true = np.random.default_rng(5), float(stats.gumbel_r(3.0, 2.0).ppf(0.99))
    bands = [fit_gumbel(random.gumbel(3.0, 2.0, 7)).level(100) for _ in range(1000)]
    assert np.mean([band.low <= true <= band.high for band in bands]) == pytest.approx(0.95, abs=0.02)


def test_a_law_that_fits_is_told_from_one_that_does_not():
    good = stats.gumbel_r.ppf((np.arange(40) + 0.5) / 40)
    bad = np.concatenate([np.linspace(0.0, 0.1, 38), [5.0, 9.0]])
    assert fit_gumbel(good).correlation > 0.99 and fit_gumbel(good).chance > 0.5
    assert fit_gumbel(bad).chance < 0.01


def test_rows_are_fitted_as_one_by_one():
    rows = np.random.default_rng(2).gumbel(size=(6, 9))
    location, scale = fit_rows(rows)
    for k in range(6):
        assert (location[k], scale[k]) == pytest.approx(stats.gumbel_r.fit(rows[k]), rel=1e-4, abs=1e-4)


@pytest.mark.parametrize("shape", [-0.2, 0.0, 0.2])
def test_gev_is_scipys_fit_and_its_band_ends_where_the_likelihood_does(shape):
    values = stats.genextreme(-shape, 10.0, 3.0).rvs(60, random_state=3)
    found = fit_gev(values)
    by_scipy = stats.genextreme.fit(values, 0.0, loc=10.0, scale=3.0)
    assert (-found.shape.value, found.location, found.scale) == pytest.approx(by_scipy, rel=2e-3, abs=2e-3)
    level = found.level(20)
    best = -stats.genextreme.nnlf((-found.shape.value, found.location, found.scale), values)
    for end in (level.low, level.high):
        least = min(_gev_cost(values, end, 20, bend) for bend in np.linspace(found.shape.value - 0.6, found.shape.value + 0.6, 61))
        assert 2.0 * (least + best) == pytest.approx(critical(60, 3), abs=0.05)


def _gev_cost(values, level, runs, shape):
    """Least unlikelihood of a shape at a fixed level, over all scales."""
    shape = shape if abs(shape) > 1e-9 else 1e-9
    place = ((-math.log1p(-1.0 / runs)) ** -shape - 1.0) / shape
    def cost(scale):
        return min(1e6, stats.genextreme.nnlf((-shape, level - scale * place, scale), values))

    return float(optimize.minimize_scalar(cost, bounds=(1.0, 9.0), method="bounded").fun)


@pytest.mark.parametrize("law", [stats.uniform(), stats.beta(2.0, 0.7), stats.genpareto(0.8)], ids=["uniform", "edge", "heavy"])
def test_gev_of_values_that_are_none_of_it_has_bands(law):
    """Values that crowd at an upper end have their best likelihood at the edge of the shapes, where searches end short of it."""
    for seed in range(4):
        found = fit_gev(law.rvs(20, random_state=seed))
        for band in (found.shape, found.level(100)):
            assert band.low <= band.value <= band.high


def test_gev_needs_twenty_runs():
    assert fit_gev(np.arange(19.0)) is None and fit_gev([1.0] * 30) is None


def test_pareto_is_scipys_fit_and_tells_what_runs_exceed():
    law = stats.genpareto(0.1, 20.0, 5.0)
    peaks = law.rvs(400, random_state=4)
    found = fit_pareto(peaks, 20.0, 80)
    shape, _, scale = stats.genpareto.fit(peaks - 20.0, floc=0.0)
    assert (found.shape.value, found.scale) == pytest.approx((shape, scale), rel=2e-3, abs=2e-3)
    assert found.rate.value == 5.0 and found.rate.low < 5.0 < found.rate.high
    level = found.level(10)
    # a run has none above the level with a chance of 9 in 10: exp(-rate P(peak > level))
    assert math.exp(-5.0 * stats.genpareto(shape, 20.0, scale).sf(level.value)) == pytest.approx(0.9, abs=1e-3)
    assert level.low < float(law.isf(-math.log(0.9) / 5.0)) < level.high
    assert found.chance > 0.05
    assert fit_pareto(peaks[:19], 20.0, 4) is None


def test_pareto_knows_no_level_below_its_threshold():
    found = fit_pareto(stats.genpareto(0.0, 20.0, 5.0).rvs(30, random_state=5), 20.0, 60)
    assert math.isnan(found.level(2).value) and found.level(100).value > 20.0


def test_hits_are_apart_by_the_gap():
    """Two peaks 0.3 s apart are one hit for a gap of 0.5 s, two for one of 0.2 s."""
    end = np.arange(1, 11) / 10.0
    force = np.array([0.0, 5.0, 1.0, 1.0, 1.0, 7.0, 0.0, 0.0, 0.0, 0.0])
    assert peaks_above(end - 0.1, end, force, 4.0, 0.5).tolist() == [7.0]
    assert peaks_above(end - 0.1, end, force, 4.0, 0.2).tolist() == [5.0, 7.0]
    assert peaks_above(end - 0.1, end, force, 8.0, 0.2).tolist() == []


def test_mean_excess_of_an_exponential_law_is_its_scale():
    peaks = 20.0 + stats.expon.ppf((np.arange(400) + 0.5) / 400) * 5.0
    found = mean_excess(peaks)
    assert all(band.low < 5.0 < band.high for threshold, band in found if threshold > 20.0)
    assert mean_excess(peaks[:5]) == []


def test_threshold_leaves_out_what_is_no_tail():
    """A law above 20, and hits of another kind below."""
    random = np.random.default_rng(6)
    tail = stats.genpareto(0.1, 20.0, 5.0).rvs(150, random_state=random)
    mixed = np.concatenate([tail, random.uniform(4.0, 5.0, 150)])
    assert suitable_threshold(tail) < 23.0
    assert 15.0 < suitable_threshold(mixed) < 23.0
    assert suitable_threshold(tail[:15]) is None


def test_gumbels_variate():
    assert reduced(1.0 / (1.0 - math.exp(-1.0))) == pytest.approx(0.0)
    assert reduced(np.array([10.0, 100.0])) == pytest.approx([2.250367, 4.600149], rel=1e-6)

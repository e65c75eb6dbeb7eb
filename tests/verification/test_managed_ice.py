"""What the study of managed ice makes of its runs: bands of a mean over fields, pieces of a way, and floes of one size.

The mean of n normal values is within t(n - 1) s/sqrt(n) of the true one in 95 of 100 cases (Student 1908); of two values +-1 the
band is 12.706 s/sqrt(2), s = sqrt(2). For the difference of two means see Welch (1947).
"""

import numpy as np
import pytest
import shapely

from validation.managed_ice import runs
from validation.managed_ice.bands import Band, band, difference
from validation.managed_ice.fields import SHAPES, drawn
from validation.managed_ice.runs import Found, Point, measured

TANK = (30.0, 24.0)


def test_band_of_two_values():
    assert band(np.array([-1.0, 1.0])) == pytest.approx((0.0, 12.7062), rel=1e-5)


def test_bands_hold_the_true_mean_as_often_as_they_say():
    draws = np.random.default_rng(3).normal(2.0, 0.7, (4000, 10))
    holds = [abs(told.mean - 2.0) <= told.half for told in map(band, draws)]
    assert np.mean(holds) == pytest.approx(0.95, abs=0.01)  # three standard errors


def test_difference_of_means_whose_variances_are_alike():
    """Of as many values and one variance it is Student's of 2 (n - 1) degrees of freedom: t(8) = 2.306."""
    one = np.array([1.0, 2.0, 3.0, 4.0, 5.0])
    assert difference(one + 10.0, one) == pytest.approx((10.0, 2.30600 * np.sqrt(2.5 * 2.0 / 5.0)), rel=1e-5)
    assert difference(np.full(3, 2.0), np.full(3, 1.0)) == (1.0, 0.0)


def test_bands_that_touch_are_not_apart():
    assert not Band(1.0, 0.5).is_apart(Band(2.0, 0.5))
    assert Band(1.0, 0.5).is_apart(Band(2.0, 0.49))


def test_loads_of_a_way():
    """A load that grows with the way x as 3 x has the mean 3 x over a piece, and the spread of an even distribution."""
    way = np.arange(1, 3001) * 0.01  # farther than what counts
    load = 3.0 * (way - 0.005)
    mean, spread, peak, history = measured(way, load, load + 1.0)
    assert mean == pytest.approx(3.0 * 12.5)
    assert spread == pytest.approx(3.0 * 15.0 / np.sqrt(12.0), rel=1e-5)
    assert peak == pytest.approx(3.0 * 19.995 + 1.0)
    assert history == pytest.approx(3.0 * runs.PIECE * (np.arange(8) + 0.5))


def test_what_is_recorded_is_read_back(tmp_path, monkeypatch):
    monkeypatch.setattr(runs, "RECORD", tmp_path / "runs.csv")
    known = {
        Point("square", 0.8, seed=2): Found(1.0, 2.0, 3.0, 12.0, 0.25, 1e-5, (4.0, 5.0)),
        Point("irregular", 0.9, 0.5, 7.0): Found(6.0, 7.0, 8.0, 13.0, 0.5, 2e-5, (9.0, 10.0)),
    }
    assert runs.recorded() == {}
    runs.record(known)
    assert runs.recorded() == known


@pytest.mark.parametrize("shape", SHAPES)
def test_floes_have_one_size_and_lie_apart(shape, monkeypatch):
    monkeypatch.setattr("validation.managed_ice.fields.ROUNDS", 5)
    floes = shapely.polygons([shapely.linearrings(floe) for floe in drawn(shape, TANK, 3.0, 0.8, 7)])
    area = shapely.area(floes)
    assert area.sum() == pytest.approx(0.8 * TANK[0] * TANK[1], rel=1e-8)
    assert np.ptp(area) < 1e-6
    assert shapely.area(shapely.union_all(floes)) == pytest.approx(area.sum(), rel=1e-12)
    assert shapely.box(-15.0, -12.0, 15.0, 12.0).covers(floes).all()


def test_a_field_is_its_seed(monkeypatch):
    monkeypatch.setattr("validation.managed_ice.fields.ROUNDS", 2)
    one, again, other = (np.concatenate(drawn("square", TANK, 3.0, 0.8, seed)) for seed in (1, 1, 2))
    assert np.array_equal(one, again)
    assert not np.allclose(one, other)

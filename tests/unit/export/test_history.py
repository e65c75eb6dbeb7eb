"""Samples of a load against closed forms: impulse to round-off, its place in time, peaks to their stated bound."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dilatedem.export.history import Windows, deposited, sampled


def windows_of(impulse, peak, ends) -> Windows:
    """Windows of a load: impulse(t) [N s] its integral, peak(from, to) its extremes."""
    edges = np.concatenate([[0.0], ends])
    mean = np.diff([impulse(t) for t in edges]) / np.diff(edges)
    low, high = np.array([peak(a, b) for a, b in zip(edges[:-1], edges[1:], strict=True)]).T
    return Windows(np.asarray(ends), mean, low, high)


def half_sine(height: float, length: float, start: float, ends) -> Windows:
    """P sin(pi (t - start) / T) over T: impulse 2 P T / pi."""

    def impulse(t):
        x = min(max((t - start) / length, 0.0), 1.0)
        return height * length / math.pi * (1.0 - math.cos(math.pi * x))

    def extremes(a, b):
        times = [min(max(t, start), start + length) for t in (a, b, start + 0.5 * length)]
        inside = [t for t in times if a <= t <= b]
        values = [max(height * math.sin(math.pi * (t - start) / length), 0.0) for t in inside] or [0.0]
        outside = a < start or b > start + length
        values = [*values, 0.0] if outside else values
        return min(values), max(values)

    return windows_of(impulse, extremes, ends)


ENDS = 0.01 * np.arange(1, 401)  # 4 s


@pytest.mark.parametrize("start", [1.0, 1.0037, 1.017, 1.333])
@pytest.mark.parametrize("step", [0.01, 0.013, 0.02, 0.05, 0.1, 0.4])
@pytest.mark.parametrize("length", [0.015, 0.04, 0.2])
def test_a_hit_keeps_its_impulse_and_its_peak_where_both_fit(length, step, start):
    """J = 2 P T / pi; the peak is P where J >= P step, else J / step: no lines between samples >= 0 of that impulse are higher."""
    height = 1e5
    history = sampled(half_sine(height, length, start, ENDS), step)
    weight = np.full(len(history.value), step)
    weight[[0, -1]] /= 2
    whole = 2.0 * height * length / math.pi
    assert math.fsum(history.value * weight) == pytest.approx(whole, rel=1e-13)
    assert history.value.max() == pytest.approx(min(height, whole / step), rel=1e-9)
    assert history.value.min() >= -1e-9 * height
    assert history.cost.impulse_error < 1e-13
    assert history.cost.peaks == 1 and history.cost.kept == (whole / step >= height * (1.0 - 1e-9))
    assert history.cost.largest_loss == pytest.approx(max(0.0, 1.0 - whole / step / height), abs=1e-9)
    at = history.time[history.value.argmax()]
    assert abs(at - (start + 0.5 * length)) <= 0.5 * step + 0.01, "a peak is where it was, to half a step"


@pytest.mark.parametrize("step", [0.01, 0.025, 0.1])
def test_a_push_the_other_way_is_the_mirror_image(step):
    there = half_sine(1e5, 0.06, 1.017, ENDS)
    back = Windows(there.end, -there.mean, -there.high, -there.low)
    assert np.array_equal(sampled(back, step).value, -sampled(there, step).value)


def test_a_constant_and_a_ramp_stay_what_they_are():
    constant = Windows(ENDS, np.full(400, 7.0), np.full(400, 7.0), np.full(400, 7.0))
    assert sampled(constant, 0.05).value == pytest.approx(np.full(81, 7.0), rel=1e-14)
    ramp = windows_of(lambda t: 0.5 * t * t, lambda a, b: (a, b), ENDS)
    value, _ = deposited(ramp, 0.05)
    assert value[1:-1] == pytest.approx(0.05 * np.arange(1, 80), rel=1e-12)


def test_the_centroid_in_time_is_kept_by_hats():
    """Hats of one step reproduce t itself: the first moment of the load is that of the windows."""
    windows = half_sine(1e5, 0.06, 1.0037, ENDS)
    value, weight = deposited(windows, 0.05)
    middle = windows.end - 0.005
    assert math.fsum(value * weight * 0.05 * np.arange(81)) == pytest.approx(math.fsum(windows.mean * 0.01 * middle), rel=1e-13)


def test_what_is_kept_can_be_chosen():
    windows = half_sine(1e5, 0.02, 1.0, ENDS)
    impulse, peaks = sampled(windows, 0.1, "impulse"), sampled(windows, 0.1, "peaks")
    whole = 2.0 * 1e5 * 0.02 / math.pi
    assert peaks.value.max() == windows.high.max() and peaks.cost.kept == 1
    assert peaks.cost.impulse_error == pytest.approx((1e5 * 0.1 - impulse.value.max() * 0.1) / whole, rel=1e-9)
    assert impulse.cost.impulse_error < 1e-13 and impulse.value.max() <= whole / 0.1 * (1.0 + 1e-12)


def test_a_jam_keeps_its_base():
    """On 50 kN a hit of 30 kN more: what gives for the peak is what lies above the least of the windows there, and no more."""
    hit = half_sine(3e4, 0.04, 1.003, ENDS)
    history = sampled(Windows(hit.end, hit.mean + 5e4, hit.low + 5e4, hit.high + 5e4), 0.02)
    assert history.value.max() == pytest.approx(8e4, rel=1e-6)
    assert history.value[1:-1].min() >= 5e4 * (1.0 - 1e-9)


def test_the_last_window_may_be_shorter():
    windows = Windows(np.array([0.01, 0.02, 0.024]), np.array([0.0, 0.0, 5.0]), np.zeros(3), np.array([0.0, 0.0, 5.0]))
    history = sampled(windows, 0.01)
    assert len(history.value) == 4 and history.cost.impulse_error < 1e-14


def newtons(least: float):
    """Loads to the milli-newton: of an impulse of next to nothing between large extremes no more than their round-off is left."""
    return st.integers(int(1e3 * least), 10**9).map(lambda load: 1e-3 * load)


@settings(derandomize=True, deadline=None, max_examples=60)
@given(
    loads=st.lists(st.tuples(newtons(-1e6), newtons(0.0), newtons(0.0)), min_size=1, max_size=60),
    ratio=st.floats(1.0, 20.0),
)
def test_any_load_keeps_its_impulse_within_the_bounds_of_its_windows(loads, ratio):
    mean, below, above = (np.array(column) for column in zip(*loads, strict=True))
    windows = Windows(0.01 * np.arange(1, len(mean) + 1), mean, mean - below, mean + above)
    history = sampled(windows, 0.01 * ratio)
    assert history.cost.impulse_error < 1e-12
    least, most = min(windows.low.min(), 0.0), max(windows.high.max(), 0.0)
    slack = 1e-9 * max(most, -least)
    assert history.value.min() >= least - slack and history.value.max() <= most + slack

"""Statistics of a force history that was made up so that every figure is known."""

import math

import numpy as np
import pytest

from dilatedem.post.figures_energy import residual_share
from dilatedem.post.loads import (
    angular_statistics,
    line_load,
    load_statistics,
    mean_force_by_place,
    window_lengths,
)
from dilatedem.results.archive import LoadMap


def history_of(fx, *, window=0.01, start=0.0, fy=None):
    """A history with these window means, whose extremes are 1.5 times as large."""
    fx = np.asarray(fx, dtype=float)
    fy = np.zeros_like(fx) if fy is None else np.asarray(fy, dtype=float)
    return {
        "time_s": start + window * np.arange(1, len(fx) + 1),
        "fx_N": fx,
        "fy_N": fy,
        "fx_min_N": np.minimum(0.0, 1.5 * fx),
        "fx_max_N": np.maximum(0.0, 1.5 * fx),
        "fy_min_N": np.minimum(0.0, 1.5 * fy),
        "fy_max_N": np.maximum(0.0, 1.5 * fy),
        "fh_max_N": 1.5 * np.hypot(fx, fy),
        "contacts": (np.hypot(fx, fy) > 0).astype(float),
    }


def test_headline_figures():
    force = [0.0] * 90 + [1000.0, 2000.0, 1000.0] + [0.0] * 4 + [-400.0, 400.0, 0.0]
    statistics = load_statistics(history_of(force, fy=[300.0] + [0.0] * 99))
    assert statistics["windows"] == 100
    assert statistics["window_s"] == pytest.approx(0.01)
    assert statistics["fh"]["peak_N"] == 3000.0
    assert statistics["fh"]["peak_time_s"] == pytest.approx(0.92)
    assert (statistics["fx"]["min_N"], statistics["fx"]["max_N"]) == (-600.0, 3000.0)
    assert statistics["fx"]["mean_N"] == pytest.approx(40.0)
    assert statistics["fx"]["std_of_window_means_N"] == pytest.approx(np.std(force))
    assert statistics["fx"]["impulse_Ns"] == pytest.approx(40.0)
    assert statistics["fy"]["impulse_Ns"] == pytest.approx(3.0)
    assert statistics["contact_time_fraction"] == pytest.approx(0.06)
    quantiles = statistics["fh"]["quantiles_of_window_maxima_N"]
    assert list(quantiles) == ["50", "90", "95", "99", "99.9"]
    assert quantiles["50"] == 0.0
    assert quantiles["99.9"] == pytest.approx(np.percentile([0.0] * 98 + [1500.0, 3000.0], 99.9))


def test_peaks_are_unbroken_rows_of_windows_above_a_tenth_of_the_highest():
    force = [5000.0, 0.0, 400.0, 600.0, 700.0, 0.0, 600.0]  # 400 is below a tenth of 5000
    peaks = load_statistics(history_of(force))["peaks"]
    assert peaks["threshold_N"] == pytest.approx(750.0)
    assert peaks["count"] == 3
    assert peaks["longest_duration_s"] == pytest.approx(0.02)
    assert peaks["mean_duration_s"] == pytest.approx(0.04 / 3.0)


def test_nothing_touched():
    statistics = load_statistics(history_of(np.zeros(10)))
    assert statistics["peaks"]["count"] == 0
    assert statistics["contact_time_fraction"] == 0.0
    assert load_statistics({}) == {"windows": 0}


def test_window_lengths_of_an_ordinary_a_late_and_a_short_history():
    assert window_lengths(np.array([0.1, 0.2, 0.25])) == pytest.approx([0.1, 0.1, 0.05])
    assert window_lengths(np.array([7.1, 7.2, 7.3])) == pytest.approx([0.1, 0.1, 0.1])
    assert window_lengths(np.array([0.1])) == pytest.approx([0.1])
    assert len(window_lengths(np.zeros(0))) == 0


def pile_map(force_at, sectors=36):
    """A map of 10 s on a pile of radius 2 m; force_at: mean force on a sector by its middle [deg]."""
    edges = np.linspace(-180.0, 180.0, sectors + 1)
    force = np.array([force_at(middle) for middle in 0.5 * (edges[1:] + edges[:-1])])
    impulse = 10.0 * np.outer(force, [0.25, 0.75])
    return LoadMap("pile", "pile", impulse, edges, np.array([-0.5, -0.25, 0.0]), 10.0, 2.0)


def test_line_load_adds_up_to_the_force():
    load_map = pile_map(lambda angle: 100.0 + angle)
    arc = 2.0 * math.radians(10.0)
    assert np.sum(line_load(load_map) * arc) == pytest.approx(3600.0)
    assert mean_force_by_place(load_map)[0] == pytest.approx(-75.0)


def test_load_sits_where_it_was_put():
    load_map = pile_map(lambda angle: max(0.0, -math.cos(math.radians(angle - 20.0))))
    found = angular_statistics(load_map, 180.0)
    assert found["centre_of_load_deg"] == pytest.approx(-160.0)
    assert found["share_within_90_deg_of_upstream"] < 1.0
    seen_from_its_middle = angular_statistics(load_map, -160.0)
    assert seen_from_its_middle["share_within_90_deg_of_upstream"] == pytest.approx(1.0)
    assert seen_from_its_middle["share_within_45_deg_of_upstream"] == pytest.approx(math.sin(math.pi / 4), abs=0.06)
    assert "share_within_45_deg_of_upstream" not in angular_statistics(load_map, None)
    assert angular_statistics(pile_map(lambda angle: 0.0), 180.0) == {}


def test_residual_is_measured_against_the_work_of_the_current():
    energy = {"time_s": np.arange(3.0), "work_drag": np.array([0.0, -2000.0, 500.0])}
    energy["residual"] = np.array([0.0, 1.0, -4.0])
    assert residual_share(energy) == pytest.approx(0.002)
    energy["work_drag"] = np.zeros(3)
    assert residual_share(energy) is None

"""Statistics of a force history that was made up so that every figure is known."""

import math

import numpy as np
import pytest

from dilatedem.post.figures.energy import residual_share
from dilatedem.post.loads import (
    along_and_across,
    angular_statistics,
    hit_statistics,
    hit_threshold,
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


def pulses(*starts, force=5000.0, windows=400):
    """A history of 4 s with a pulse of 30 ms at each of these times [s]."""
    values = np.zeros(windows)
    for start in starts:
        values[round(start / 0.01) :][:3] = force
    return history_of(values)


def test_pulses_within_a_second_are_one_hit():
    hits = hit_statistics(pulses(0.5, 0.6, 1.2, 2.23, 3.5), 1000.0)
    assert (hits["threshold_N"], hits["gap_s"], hits["count"]) == (1000.0, 1.0, 3)  # 1.23 to 2.23 s is a second
    assert hits["longest_duration_s"] == pytest.approx(0.73)
    assert hits["mean_duration_s"] == pytest.approx((0.73 + 0.03 + 0.03) / 3.0)
    assert hits["mean_time_above_s"] == pytest.approx(5 * 0.03 / 3.0)
    assert hit_statistics(pulses(0.5, 1.52), 1000.0)["count"] == 1
    assert hit_statistics(pulses(0.5, 0.6, 1.2), 1000.0, gap=0.0)["count"] == 3
    assert hit_statistics(pulses(0.0, 3.97), 1000.0)["count"] == 2


def test_what_counts_as_a_hit_depends_on_the_ice_and_not_on_the_highest_load():
    masses = np.array([3000.0, 4000.0])
    assert hit_threshold(masses) == pytest.approx(3500.0)
    assert hit_threshold(None) == hit_threshold(np.zeros(0)) == 1000.0
    small, with_a_giant = pulses(0.5, 2.5), pulses(0.5, 2.5)
    for name in ("fx_N", "fx_max_N", "fh_max_N"):
        with_a_giant[name] = with_a_giant[name] + 100.0 * (np.arange(400) == 390) * 5000.0
    assert hit_statistics(small, hit_threshold(masses))["count"] == 2
    assert hit_statistics(with_a_giant, hit_threshold(masses))["count"] == 3


@pytest.mark.parametrize("count", [0, 1, 100])
def test_a_load_below_the_threshold_is_no_hit(count):
    hits = hit_statistics(history_of(np.full(count, 10.0)), 1000.0)
    assert hits["count"] == 0 and hits["longest_duration_s"] == hits["mean_duration_s"] == hits["mean_time_above_s"] == 0.0


def test_forces_along_and_across_the_current():
    history = history_of([3.0, 0.0], fy=[0.0, 5.0])
    for current, along, across in (((0.0, 0.3), [0.0, 5.0], [-3.0, 0.0]), ((-0.2, 0.0), [-3.0, 0.0], [0.0, -5.0])):
        for found, expected in zip(along_and_across(history, current), (along, across), strict=True):
            assert found == pytest.approx(expected)
    assert [force.tolist() for force in along_and_across(history, (0.0, 0.0))] == [[3.0, 0.0], [0.0, 5.0]]
    statistics = load_statistics(history, (0.0, 0.3))
    assert statistics["along_current"]["mean_N"] == pytest.approx(2.5)
    assert statistics["across_current"]["impulse_Ns"] == pytest.approx(-0.03)
    assert "along_current" not in load_statistics(history)


def test_nothing_touched():
    statistics = load_statistics(history_of(np.zeros(10)))
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
    assert found["centre_of_load_from_zero_deg"] == pytest.approx(20.0)  # -160 degrees from +x
    assert found["zero_of_angles"] == "upstream; counter-clockwise seen from above"
    still = angular_statistics(load_map, None)
    assert still["centre_of_load_from_zero_deg"] == pytest.approx(-160.0) and still["zero_of_angles"].startswith("+x (still water)")
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

"""Which part of a run is looked at: a drift of the ice, or a time."""

import math

import pytest

from dilatedem.errors import CaseError
from dilatedem.post.ensembles.part import Part, drift, read_part, time_of_drift


def case(**water):
    return {"water": {"enabled": True, "velocity": [0.3, 0.4]} | water, "ice": {"initial_velocity": "current"}}


def test_ends_as_typed():
    assert read_part(None, None) is None
    assert read_part("5m", "30 m") == Part(5.0, 30.0, "m")
    assert read_part(None, "1e2s") == Part(0.0, 100.0, "s")
    assert read_part("5m", None) == Part(5.0, math.inf, "m")


@pytest.mark.parametrize(
    ("start", "end", "fault"),
    [("5", None, "--from 5: must be a drift"), ("5m", "30s", "must both be"), ("9m", "9m", "beyond"), (None, "-3m", "--to -3m")],
)
def test_what_is_no_part(start, end, fault):
    with pytest.raises(CaseError, match=fault):
        read_part(start, end)


def test_ice_drifts_with_the_current():
    assert time_of_drift(case(), 5.0, until=100.0) == pytest.approx(10.0)
    assert Part(5.0, 30.0, "m").times(case(), simulated=100.0) == pytest.approx((10.0, 60.0))
    assert Part(5.0, 60.0, "m").times(case(), simulated=100.0) is None  # it ends before
    assert Part(5.0, math.inf, "m").times(case(), simulated=100.0) == pytest.approx((10.0, 100.0))
    assert Part(2.0, 4.0, "s").times(case(), simulated=100.0) == (2.0, 4.0)
    assert Part(2.0, 400.0, "s").times(case(), simulated=100.0) is None


def test_a_current_that_grows():
    """0.1 m/s2 from rest: 5 m after 10 s, then steady at 1 m/s."""
    grows = case(velocity_table=[[0.0, 0.0, 0.0], [10.0, 1.0, 0.0]])
    assert time_of_drift(grows, 5.0, until=50.0) == pytest.approx(10.0, rel=1e-5)
    assert time_of_drift(grows, 15.0, until=50.0) == pytest.approx(20.0, rel=1e-5)
    assert time_of_drift(grows, 5.0 * 0.25, until=50.0) == pytest.approx(5.0, rel=1e-3)


def test_still_water_and_driven_structures():
    still = case(enabled=False)
    assert drift(still, 10.0)[1][-1] == 0.0 and math.isinf(time_of_drift(still, 1.0, until=10.0))
    assert Part(0.0, 1.0, "m").times(still, simulated=10.0) is None
    thrown = still | {"ice": {"initial_velocity": [0.5, 0.0, 0.0]}}
    assert time_of_drift(thrown, 1.0, until=10.0) == pytest.approx(2.0)
    ship = still | {"structure": [{"support": {"kind": "driven", "velocity": [0.0, 2.0]}}]}
    assert time_of_drift(ship, 1.0, until=10.0) == pytest.approx(0.5)


def test_a_part_in_words():
    assert Part().words() == "whole runs"
    assert Part(5.0, 30.0, "m").words() == "drift from 5 to 30 m"
    assert Part(2.5, math.inf, "s").words() == "time from 2.5 s on"

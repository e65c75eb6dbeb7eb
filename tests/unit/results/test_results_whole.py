"""Floes of several parts put together again, from the table of bodies and from snapshots."""

import numpy as np
import pytest
import shapely

from dilatedem.results.archive import FloeTable
from dilatedem.results.snapshots import Snapshot
from dilatedem.results.whole import together, whole_snapshot, whole_table


def corners(*box: float) -> np.ndarray:
    return shapely.get_coordinates(shapely.box(*box))[:-1]


#: an L of bodies 1 and 2, a gap of 4 mm between them, beside bodies 0 and 3, which are floes alone
OUTLINES = [corners(5, 5, 6, 6), corners(0, 0, 1, 3), corners(1.004, 0, 3, 1), corners(8, 0, 9, 2)]
FLOE = np.array([0, 1, 1, 3])


def table() -> FloeTable:
    area = np.array([shapely.Polygon(outline).area for outline in OUTLINES])
    return FloeTable(OUTLINES, area, 400.0 * area, {"body": np.arange(4), "mass_kg": 400.0 * area, "floe": FLOE})


def snapshot(*there: int) -> Snapshot:
    there = np.array(there)
    speed = np.array([0.1, 0.2, 0.2, 0.4])[there]
    velocity = np.column_stack([speed, 0 * speed, 0 * speed])
    force = np.eye(4, 3)[there]
    return Snapshot(1.0, [OUTLINES[k] for k in there], there, speed, velocity, velocity, force, 1 + there)


def test_parts_become_one_row_of_the_table():
    whole = whole_table(table())
    assert whole.plan_area == pytest.approx([1.0, 3.0 + 1.996, 2.0]) and whole.mass == pytest.approx(400.0 * whole.plan_area)
    assert whole.columns["body"].tolist() == [0, 1, 3]
    bent = shapely.Polygon(whole.outlines[1])
    assert bent.area == pytest.approx(5.0, abs=2e-3), "the gap is closed, and nothing is added around it but at the inward corner"
    assert shapely.convex_hull(bent).area == pytest.approx(7.0) and len(whole.outlines[1]) <= 8
    np.testing.assert_array_equal(whole.outlines[0], OUTLINES[0])


def test_a_table_without_parts_stays_as_it_is():
    plain = table()
    del plain.columns["floe"]
    assert whole_table(plain) is plain
    now = snapshot(0, 1, 2, 3)
    assert whole_snapshot(now, plain) is now and whole_snapshot(now, None) is now


def test_a_snapshot_has_a_row_for_each_floe_that_is_there():
    now = whole_snapshot(snapshot(1, 2, 3), table())  # body 0 has left
    assert now.body.tolist() == [1, 3] and now.speed.tolist() == [0.2, 0.4] and now.contacts.tolist() == [5, 4]
    assert now.contact_force.tolist() == [[0, 1, 1], [0, 0, 0]]
    assert shapely.Polygon(now.outlines[0]).area == pytest.approx(5.0, abs=2e-3)


def test_a_part_seen_edge_on_has_no_outline():
    line = np.array([[0.0, 0.0], [1.0, 0.0]])
    one, none = together([OUTLINES[1], line, line, line], np.array([0, 0, 1, 1]))
    assert shapely.Polygon(one).area == pytest.approx(3.0) and len(none) == 0

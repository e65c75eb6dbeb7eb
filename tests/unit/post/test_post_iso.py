"""The bound of ISO 19906 beside the loads of a run."""

from dataclasses import replace

import numpy as np
import pytest

from dilatedem.post.read import open_run
from dilatedem.post.report.iso import Bound, bound_of, bound_rows, global_pressure, width_across


@pytest.mark.parametrize(
    ("thickness", "width", "pressure", "force"),
    [(0.5, 4.0, 1.7029, 3.4058), (1.0, 4.0, 1.4419, 5.768), (0.7, 7.5, 1.4004, 7.352), (1.0, 10.0, 1.2453, 12.453)],
)
def test_global_pressure_of_level_ice(thickness, width, pressure, force):
    """p = C_R h^n (w/h)^-0.16 with C_R = 1.8 MPa [MPa], and p w h [MN]."""
    assert global_pressure(1.8e6, thickness, width) / 1e6 == pytest.approx(pressure, rel=1e-4)
    assert Bound(thickness, width).force(1.8e6) / 1e6 == pytest.approx(force, rel=1e-4)


def test_exponent_of_thick_ice_stays():
    assert global_pressure(1.0, 2.0, 4.0) / global_pressure(1.0, 1.0, 2.0) == pytest.approx(2.0**-0.3)


def test_a_load_has_the_strength_that_level_ice_would_need_for_it():
    bound = Bound(0.5, 4.0)
    assert bound.strength(bound.force(2.1e6)) == pytest.approx(2.1e6)


def test_width_is_that_across_the_current():
    outline = np.array([[-3.0, -1.0], [3.0, -1.0], [3.0, 1.0], [-3.0, 1.0]])
    assert width_across(outline, (0.3, 0.0)) == width_across(outline, (-0.3, 0.0)) == pytest.approx(2.0)
    assert width_across(outline, (0.0, 0.2)) == pytest.approx(6.0)
    assert width_across(outline, (0.1, 0.1)) == pytest.approx(8.0 / np.sqrt(2.0))
    assert width_across(outline, (0.0, 0.0)) == pytest.approx(np.hypot(6.0, 2.0))


def test_bound_of_a_pile_and_of_a_plane(make_run, tmp_path):
    plane = {"kind": "plane", "name": "quay", "point": [9.0, 0.0, 0.0], "normal": [-1.0, 0.0, 0.0]}
    pile = {"kind": "pile", "name": "pile", "center": [4.0, 0.0], "radius": 1.5}
    run = open_run(make_run(tmp_path / "run", structures=(pile, plane), duration=1.0, snapshots=False))
    assert bound_of(run, "pile").width == pytest.approx(3.0, rel=1e-2)
    assert bound_of(run, "quay") is None and bound_of(run, "total") is None
    assert bound_of(replace(run, case=run.case | {"ice": {}}), "pile") is None
    rows = bound_rows(Bound(0.5, 4.0), peak=340_580.0, quantile=34_058.0)
    assert rows[0][1] == "3406" and "is 10 % of it" in rows[0][2]
    assert [row[1] for row in rows[2:]] == ["0.18", "0.018"]

"""What the study of managed ice makes of its runs: pieces of a way, what is noted of them, and floes of one size."""

import numpy as np
import pytest
import shapely

from validation.managed_ice import runs
from validation.managed_ice.fields import SHAPES, drawn
from validation.managed_ice.runs import Found, Point, measured

TANK = (30.0, 24.0)


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


def test_a_case_of_a_point_is_a_case(tmp_path, monkeypatch):
    monkeypatch.setattr("validation.managed_ice.fields.ROUNDS", 1)
    case = Point("square", 0.8, thickness=0.5, floe=10.0, seed=3).case(tmp_path)
    assert (case.field.source, case.field.seed, case.ice.thickness) == ("file", 3, 0.5)
    assert case.structure[0].support.kind == "driven"

"""Snapshots: what a run writes comes back, floe by floe, however many corners each has."""

import numpy as np
import pytest

from dilatedem.geometry.polyhedron import prism
from dilatedem.output.snapshots.vtu import CELL_DATA, SnapshotWriter
from dilatedem.results.snapshots import plan_outlines, read_snapshot


def bodies(count, random):
    """Prisms of 3 to 9 sides in no order, their places, and cell data that tell them apart."""
    outers = []
    for sides in random.permutation(np.resize(np.arange(3, 10), count)):
        angle = np.arange(sides) * 2.0 * np.pi / sides
        outers.append(prism(np.column_stack([np.cos(angle), np.sin(angle)]), -0.25, 0.25))
    position = np.column_stack([10.0 * np.arange(count), np.zeros(count), np.zeros(count)])
    data = {name: random.uniform(size=(count, parts) if parts > 1 else count) for name, (_, parts) in CELL_DATA.items()}
    data["body"] = data["contacts"] = np.arange(count)
    return outers, position, data


# 700 bodies fill more than one compressed block.
@pytest.mark.parametrize("count", [1, 40, 700])
def test_snapshot_comes_back(tmp_path, count):
    outers, position, data = bodies(count, np.random.default_rng(1))
    upright = np.tile([1.0, 0.0, 0.0, 0.0], (count, 1))
    SnapshotWriter(outers).write(tmp_path / "ice.vtu", position, upright, data)
    snapshot = read_snapshot(tmp_path / "ice.vtu", 3.0)
    assert snapshot.time == 3.0
    assert snapshot.body.tolist() == list(range(count))
    for name in ("speed", "velocity", "angular_velocity", "contact_force", "contacts"):
        assert np.array_equal(getattr(snapshot, name), data[name])
    for outline, body in zip(snapshot.outlines, snapshot.body, strict=True):
        true = outers[body].vertices[:, :2] + position[body, :2]
        assert {tuple(point) for point in np.round(outline, 9)} == {tuple(point) for point in np.round(true, 9)}


def test_file_cut_short_anywhere_is_refused(tmp_path):
    outers, position, data = bodies(3, np.random.default_rng(1))
    whole = tmp_path / "ice.vtu"
    SnapshotWriter(outers).write(whole, position, np.tile([1.0, 0.0, 0.0, 0.0], (3, 1)), data)
    content = whole.read_bytes()
    for length in range(0, len(content) - 20, 97):
        whole.write_bytes(content[:length])
        with pytest.raises(OSError, match="not a readable snapshot"):
            read_snapshot(whole, 0.0)


def test_file_of_another_kind_is_refused(tmp_path):
    (tmp_path / "ice.vtu").write_text("<VTKFile><PolyData/></VTKFile>")
    with pytest.raises(OSError, match="not a readable snapshot"):
        read_snapshot(tmp_path / "ice.vtu", 0.0)
    with pytest.raises(OSError):
        read_snapshot(tmp_path / "missing.vtu", 0.0)


def test_outline_of_a_tilted_box_is_its_silhouette():
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-0.5, 0.5)], dtype=float)
    tilt = np.radians(30.0)
    seen = corners[:, 0] * np.cos(tilt) + corners[:, 2] * np.sin(tilt)
    edge_on = [[5.0, 0.0], [5.0, 1.0], [5.0, 2.0]]
    points = np.concatenate([np.column_stack([seen, corners[:, 1]]), edge_on])
    box, line = plan_outlines(points, np.array([0] * 8 + [1] * 3), 2)
    assert polygon_area(box) == pytest.approx(2.0 * (2.0 * np.cos(tilt) + np.sin(tilt)))
    assert len(line) == 1
    assert plan_outlines(np.zeros((0, 2)), np.zeros(0, dtype=int), 0) == []


def polygon_area(outline):
    x, y = outline.T
    return 0.5 * abs(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))

"""What the page's script gets: histories and pictures of the ice, packed as text."""

import base64
import json
from dataclasses import replace

import numpy as np
import pytest

from dilatedem.post.read import open_run
from dilatedem.post.report import moving
from dilatedem.post.report.histories import PANELS, history_data
from dilatedem.post.report.moving import moving_plan
from dilatedem.post.report.pack import as_json


@pytest.fixture(scope="module")
def run(make_run, tmp_path_factory):
    return open_run(make_run(tmp_path_factory.mktemp("live") / "run"))


def unpacked(text, kind):
    return np.frombuffer(base64.b64decode(text), dtype=f"<{kind}").astype(float)


def test_history_comes_through_window_by_window(run):
    history = run.forces["pile"]
    data = history_data("pile", history, 10_000)
    edges = unpacked(data["edges"], "f4")
    assert edges[0] == 0.0 and edges[1:] == pytest.approx(history["time_s"], rel=1e-6)
    assert [panel["label"] for panel in data["panels"]] == [panel[0] for panel in PANELS[:3]]  # no moments in these forces
    for panel, (_, mean, low, high) in zip(data["panels"], PANELS, strict=False):
        half = 0.51 * panel["scale"]
        assert unpacked(panel["high"], "i2") * panel["scale"] == pytest.approx(history[high] / 1e3, abs=half)
        if low:
            assert unpacked(panel["low"], "i2") * panel["scale"] == pytest.approx(history[low] / 1e3, abs=half)
            assert unpacked(panel["mean"], "i2") * panel["scale"] == pytest.approx(history[mean] / 1e3, abs=half)
    assert data["peak"] == history["time_s"][np.argmax(history["fh_max_N"])]


def test_joined_windows_keep_extremes_and_impulse(run):
    history = run.forces["pile"]
    data = history_data("pile", history, 130)
    edges, panel = unpacked(data["edges"], "f4"), data["panels"][0]
    assert len(edges) - 1 <= 130 and edges[-1] == pytest.approx(history["time_s"][-1])
    assert unpacked(panel["high"], "i2").max() * panel["scale"] == pytest.approx(history["fx_max_N"].max() / 1e3, rel=1e-4)
    impulse = np.sum(unpacked(panel["mean"], "i2") * panel["scale"] * np.diff(edges))
    assert impulse == pytest.approx(np.sum(history["fx_N"]) * 0.01 / 1e3, rel=1e-3)


def test_history_without_load_is_flat(run):
    still = {name: np.zeros_like(column) for name, column in run.forces["pile"].items()} | {"time_s": run.forces["pile"]["time_s"]}
    data = history_data("pile", still, 100)
    assert all(unpacked(panel["high"], "i2").max() == 0.0 for panel in data["panels"])


def test_pictures_hold_every_floe_at_its_place(run):
    data = moving_plan(run)
    assert [one["time"] for one in data["pictures"]] == [0.0, 5.0, 10.0] and data["of"] == 3
    counts = unpacked(data["pictures"][0]["corners"], "u2")
    points = unpacked(data["pictures"][0]["points"], "i2").reshape(-1, 2) * data["unit"]
    assert len(counts) == len(run.floes.outlines) and counts.sum() == len(points)
    middle = points.reshape(-1, 2).mean(axis=0)
    assert middle == pytest.approx(np.concatenate(run.floes.outlines).mean(axis=0), abs=0.3)
    assert unpacked(data["pictures"][0]["speeds"], "u1").max() == 255.0
    assert data["periodic"] == [False, True] and len(data["structures"]) == 1


def test_pictures_are_as_many_as_there_is_room_for(run, monkeypatch):
    monkeypatch.setattr(moving, "PICTURES", 2)
    assert [one["time"] for one in moving_plan(run)["pictures"]] == [0.0, 10.0]


def test_a_snapshot_that_was_cut_short_is_left_out(make_run, tmp_path):
    folder = make_run(tmp_path / "run")
    last = folder / "snapshots/ice_000002.vtu"
    last.write_bytes(last.read_bytes()[:500])
    assert [one["time"] for one in moving_plan(open_run(folder))["pictures"]] == [0.0, 5.0]
    (folder / "snapshots/ice_000001.vtu").unlink()
    assert moving_plan(open_run(folder)) is None


def test_json_may_stand_in_a_page():
    text = as_json({"name": "</script><b>\u2028"})
    assert "<" not in text and "\u2028" not in text
    assert json.loads(text) == {"name": "</script><b>\u2028"}


def test_structures_go_along_where_they_move(run):
    time = np.array([0.0, 10.0])
    motion = {"time_s": time, "x_m": 0.2 * time, "y_m": 0.0 * time, "yaw_rad": 0.0 * time}
    pictures = moving_plan(replace(run, motion={"pile": motion}))["pictures"]
    middles = [np.mean(one["structures"][0]["outline"], axis=0)[0] for one in pictures]
    assert np.diff(middles) == pytest.approx([1.0, 1.0], abs=2e-3)
    assert "structures" not in moving_plan(run)["pictures"][0]  # of one that stands still once is enough

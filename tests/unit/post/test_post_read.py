"""A run folder is read as far as it goes, whatever a killed run left out or cut short."""

import h5py
import numpy as np
import pytest

from dilatedem.errors import CaseError
from dilatedem.post.read import open_run
from dilatedem.post.report.limits import limits
from dilatedem.post.snapshots import snapshots_at
from dilatedem.results.snapshots import read_snapshot
from dilatedem.results.tables import row_count

PLANE = {"kind": "plane", "name": "quay, north", "point": [9.0, 0.0, 0.0], "normal": [-1.0, 0.0, 0.0]}


def test_forces_are_split_by_structure_in_the_order_of_the_case(make_run, tmp_path):
    run = open_run(make_run(tmp_path / "run", structures=(PLANE, pile("2"), pile("1")), duration=2.0))
    assert list(run.forces) == ["2", "1"] or list(run.forces) == ["quay, north", "2", "1"]
    assert all(row_count(history) == 200 for history in run.forces.values())


def pile(name):
    return {"kind": "pile", "name": name, "center": [0.0, 0.0], "radius": 1.0}


def test_whole_folder(make_run, tmp_path):
    run = open_run(make_run(tmp_path / "run"))
    assert [time for time, _ in run.snapshots] == [0.0, 5.0, 10.0]
    assert run.upstream_angle == pytest.approx(180.0)
    assert run.simulated == 10.0
    assert run.load_maps["pile"].radius == 1.5
    assert run.contacts["ice_ice"].mode[3] == "edge-edge crossing"
    assert len(run.floes.outlines) == len(run.floes.mass) == 45


def test_snapshot_gives_true_outlines_and_speeds(make_run, tmp_path):
    run = open_run(make_run(tmp_path / "run"))
    first, last = snapshots_at(run, (0.0, 1.0))
    assert (first.time, last.time) == (0.0, 10.0)
    given = run.floes.outlines
    assert sorted(first.body) == list(range(45))
    for drawn, body in zip(first.outlines, first.body, strict=True):
        assert rounded(drawn) <= rounded(given[body])
    middle = np.array([given[body].mean(axis=0) for body in first.body])
    assert np.allclose(first.speed[np.hypot(middle[:, 0] - 2.0, middle[:, 1]) < 3.5], 0.09)
    moved = np.array([outline.mean(axis=0) for outline in last.outlines])
    start = np.array([outline.mean(axis=0) for outline in first.outlines])
    assert np.allclose(moved - start, [3.0, 0.0])
    assert set(np.round(first.speed, 6)) == {0.09, 0.3}


def rounded(outline):
    return {tuple(point) for point in np.round(outline, 9)}


def test_snapshots_without_a_collection_go_by_their_numbers(make_run, tmp_path):
    folder = make_run(tmp_path / "run")
    (folder / "ice.pvd").unlink()
    assert [time for time, _ in open_run(folder).snapshots] == [0.0, 5.0, 10.0]


def test_damaged_snapshot_is_replaced_by_its_neighbour(make_run, tmp_path):
    folder = make_run(tmp_path / "run")
    last = folder / "snapshots/ice_000002.vtu"
    last.write_bytes(last.read_bytes()[:3000])
    with pytest.raises(OSError, match="not a readable snapshot"):
        read_snapshot(last, 10.0)
    assert [snapshot.time for snapshot in snapshots_at(open_run(folder), (0.0, 0.5, 1.0))] == [0.0, 5.0]


def test_case_alone_is_enough(make_run, tmp_path):
    whole = make_run(tmp_path / "run", snapshots=False)
    folder = tmp_path / "bare"
    folder.mkdir()
    (folder / "case.toml").write_bytes((whole / "case.toml").read_bytes())
    (folder / "run.h5").write_bytes(b"not HDF5")
    (folder / "summary.json").write_text('{"status": "runn')
    run = open_run(folder)
    assert run.forces == run.summary == run.load_maps == {}
    assert run.snapshots == []
    assert run.floes is None
    assert run.simulated == 0.0


def test_archive_without_some_groups(make_run, tmp_path):
    folder = make_run(tmp_path / "run", snapshots=False)
    with h5py.File(folder / "run.h5", "a") as archive:
        del archive["contacts"], archive["floes"]
    run = open_run(folder)
    assert list(run.load_maps) == ["pile"]
    assert run.contacts == {}


def test_folder_without_a_case_is_refused(tmp_path):
    with pytest.raises(CaseError, match="no case.toml"):
        open_run(tmp_path)
    (tmp_path / "case.toml").write_text("title = ")
    with pytest.raises(CaseError, match="not a readable TOML file"):
        open_run(tmp_path)


def test_what_a_case_has_of_a_sea_is_told(make_run, tmp_path):
    """Arrows stand for the start where a table goes on; limits are those of the water that the case has."""
    folder = make_run(tmp_path / "run", snapshots=False)
    assert list(open_run(folder).flows) == ["current"]
    assert any("without waves" in each.text and "the whole wetted surface" in each.text for each in limits(open_run(folder)))
    text = (folder / "case.toml").read_text(encoding="utf-8")
    more = 'drag = "skin_form"\nvelocity_table = [[0.0, 0.3, 0.0], [9.0, 0.5, 0.0]]\n'
    (folder / "case.toml").write_text(text.replace("[water]\n", f"[water]\n{more}") + "\n[[wave]]\namplitude = 0.1\nperiod = 5.0\n")
    run = open_run(folder)
    assert list(run.flows) == ["current at the start"]
    assert any(each.text.startswith("Waves ride on a current") for each in limits(run))
    assert not any("without waves" in each.text or "the whole wetted surface" in each.text for each in limits(run))

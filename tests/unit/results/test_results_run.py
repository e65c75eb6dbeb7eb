"""`dilatedem.load` of a run: what is there as tables, maps, floes and snapshots; what is not, as one clear sentence."""

import json
import subprocess
import sys

import h5py
import numpy as np
import pytest

import dilatedem
from dilatedem.errors import CaseError


def test_a_folder_that_is_neither_run_nor_sweep_is_refused(tmp_path):
    with pytest.raises(CaseError, match="holds neither a run .* nor a sweep"):
        dilatedem.load(tmp_path)
    with pytest.raises(CaseError, match="missing: no such folder"):
        dilatedem.load(str(tmp_path / "missing"))
    (tmp_path / "case.toml").write_text("title = ")
    with pytest.raises(CaseError, match="not a readable TOML file"):
        dilatedem.load(tmp_path)


def test_case_and_summary_are_as_written(crowded):
    run = dilatedem.load(crowded)
    assert run.case["domain"]["size"] == [15.0, 15.0]
    assert run.summary == json.loads((crowded / "summary.json").read_text())
    assert run.case["title"] in repr(run) and "completed" in repr(run)


def test_tables_are_read_when_asked_for_and_once(crowded):
    run = dilatedem.load(str(crowded))
    assert not {"forces", "energy", "bodies"} & set(vars(run))
    assert run.forces is run.forces
    assert set(run.forces.structure) == {"pile"}
    assert run.forces.fh_max_N.max() == pytest.approx(run.summary["loads"]["pile"]["fh_max_N"])
    assert run.bodies.body.max() + 1 == len(run.floes)


def test_a_load_map_has_names_units_and_the_impulse_of_the_file(crowded):
    found = dilatedem.load(crowded).load_map("pile")
    assert found.impulse_Ns.dims == ("angle", "height") and found.impulse_Ns.shape == (72, 20)
    with h5py.File(crowded / "run.h5") as file:
        group = file["load_map/pile"]
        np.testing.assert_array_equal(found.impulse_Ns, group["impulse_Ns"])
        np.testing.assert_array_equal(found.angle_edges_deg, group["angle_edges_deg"])
        np.testing.assert_array_equal(found.height_edges_m, group["height_edges_m"])
        assert found.attrs["first_axis"] == group.attrs["first_axis"]
    assert found.angle[0] == -177.5 and found.angle.attrs["units"] == "degree" and found.height.attrs["units"] == "m"
    assert found.impulse_Ns.attrs["units"] == "N s"
    assert (found.attrs["structure"], found.attrs["kind"], found.attrs["duration_s"]) == ("pile", "pile", pytest.approx(4.0))
    upstream = found.impulse_Ns.where(abs(found.angle) > 90.0).sum()
    assert upstream > 0.9 * found.impulse_Ns.sum()
    said = found.attrs["first_axis"]
    assert "counter-clockwise seen from above" in said and "0 = +x of the world" in said
    from_side = np.degrees(np.arctan2(-0.15, -0.8))
    assert found.attrs["upstream_deg"] == pytest.approx(from_side)
    turned = found.angle_from_upstream
    assert turned.dims == ("angle",) and "upstream" in turned.attrs["long_name"]
    assert float(turned[0]) == pytest.approx(-177.5 - from_side)
    assert found.impulse_Ns.where(abs(turned) < 90.0).sum() > 0.9 * found.impulse_Ns.sum()


@pytest.mark.parametrize(("velocity", "upstream"), [([0.0, 0.3], -90.0), ([-0.3, 0.3], -45.0), ([0.0, 0.0], None)])
def test_a_load_map_says_where_the_current_comes_from(velocity, upstream, tmp_path):
    case = {"field": {"source": "bodies"}, "structure": [{"kind": "pile"}], "time": {"duration": 0.01}}
    ball = {"vertices": [[0.0, 0.0, 0.0]], "dilated_radius": 0.2}
    found = dilatedem.run(case | {"body": [ball]}, tmp_path / "run", water={"velocity": velocity}).load_map("pile")
    assert found.attrs["upstream_deg"] == (upstream if upstream is not None else pytest.approx(np.nan, nan_ok=True))
    assert ("angle_from_upstream" in found.coords) == (upstream is not None)
    if upstream is not None:
        assert float(found.angle_from_upstream.sel(angle=upstream, method="nearest")) == pytest.approx(0.0, abs=2.5)


def test_a_load_map_on_a_plane_goes_by_distance(make_run, tmp_path):
    plane = {"kind": "plane", "name": "quay", "point": [9.0, 0.0, 0.0], "normal": [-1.0, 0.0, 0.0]}
    run = dilatedem.load(make_run(tmp_path / "run", structures=(plane,), snapshots=False, duration=2.0))
    found = run.load_map("quay")
    assert found.impulse_Ns.dims == ("distance", "height") and found.distance.attrs["units"] == "m"
    assert float(found.distance[0]) == -19.5 and found.distance_edges_m.shape == (41,)
    with pytest.raises(CaseError, match="no load map of 'pile'; there are maps of quay"):
        run.load_map("pile")


def test_maps_of_the_parts_of_a_structure_have_its_name_in_front(make_run, tmp_path):
    folder = make_run(tmp_path / "run", snapshots=False, duration=2.0)
    with h5py.File(folder / "run.h5", "a") as archive:
        archive.move("load_map/pile", "load_map/legs/north")
    run = dilatedem.load(folder)
    assert run.load_map_names == ["legs/north"]
    assert run.load_map("legs/north").attrs["structure"] == "legs/north"


def test_floes_by_their_number(crowded):
    floes = dilatedem.load(crowded).floes
    assert floes.index.name == "body" and floes.index.tolist() == list(range(len(floes)))
    assert list(floes.columns) == ["mass_kg", "plan_area_m2", "vertices", "volume_m3", "x0_m", "y0_m", "outline"]
    with h5py.File(crowded / "run.h5") as file:
        np.testing.assert_array_equal(floes.mass_kg, file["floes/mass_kg"])
        start, points = file["floes/outline_start"][()], file["floes/outline_points"][()]
    for i, outline in enumerate(floes.outline):
        np.testing.assert_array_equal(outline, points[start[i] : start[i + 1]])


def test_outlines_of_one_length_stay_arrays_of_their_own(make_run, tmp_path):
    """Octagons all: pandas must not take them for one array of three dimensions."""
    floes = dilatedem.load(make_run(tmp_path / "run", snapshots=False, duration=2.0)).floes
    assert all(outline.shape == (8, 2) for outline in floes.outline)


def test_contact_statistics_by_pair_and_mode(crowded):
    contacts = dilatedem.load(crowded).contacts
    with h5py.File(crowded / "run.h5") as file:
        np.testing.assert_array_equal(contacts.loc["ice_structure", "impulse_Ns"], file["contacts/ice_structure/impulse_Ns"])
    assert contacts.loc[("ice_ice", "face-face"), "steps"] >= 0.0


def test_the_nearest_snapshot(crowded):
    run = dilatedem.load(crowded)
    np.testing.assert_allclose(run.snapshot_times, 0.25 * np.arange(17), atol=1e-4)
    snapshot = run.snapshot(1.6)
    assert snapshot.time == pytest.approx(1.5, abs=1e-4)
    assert snapshot.body.tolist() == list(range(len(run.floes)))
    assert len(snapshot.outlines) == len(snapshot.body) and snapshot.velocity.shape == (len(snapshot.body), 3)
    np.testing.assert_allclose(np.linalg.norm(snapshot.velocity, axis=1), snapshot.speed)
    tracked = run.bodies[np.isclose(run.bodies.time_s, snapshot.time, atol=1e-4)]
    np.testing.assert_allclose(tracked.vx_m_s, snapshot.velocity[:, 0], rtol=1e-7, atol=1e-12)


def test_a_killed_run_is_read_as_far_as_it_goes(make_run, tmp_path):
    folder = make_run(tmp_path / "run", duration=2.0)
    whole = dilatedem.load(folder)
    forces, energy = whole.forces, whole.energy
    for name in ("forces.csv", "energy.csv"):
        (folder / name).write_bytes((folder / name).read_bytes()[:-5])
    last = folder / "snapshots/ice_000002.vtu"
    last.write_bytes(last.read_bytes()[:3000])
    (folder / "summary.json").write_text('{"status": "runn')
    run = dilatedem.load(folder)
    assert run.forces.equals(forces.iloc[:-1]) and run.energy.equals(energy.iloc[:-1])
    assert run.summary == {} and "status unknown" in repr(run)
    assert run.snapshot(2.0).time == 1.0
    for file in folder.glob("snapshots/*.vtu"):
        file.write_bytes(b"<VTK")
    with pytest.raises(CaseError, match="none of the snapshots can be read"):
        run.snapshot(0.0)


def test_what_a_run_has_no_file_for_is_said(make_run, tmp_path):
    folder = make_run(tmp_path / "run", snapshots=False, duration=2.0)
    (folder / "energy.csv").unlink()
    run = dilatedem.load(folder)
    for name in ("energy", "bodies", "hits", "structures"):
        with pytest.raises(CaseError, match=f"run: this run has no {name}.csv"):
            getattr(run, name)
    with pytest.raises(CaseError, match="this run has no snapshots"):
        run.snapshot(0.0)
    assert len(run.snapshot_times) == 0
    (folder / "run.h5").unlink()
    for ask in (lambda: run.floes, lambda: run.contacts, lambda: run.load_map("pile")):
        with pytest.raises(CaseError, match="this run has no run.h5"):
            ask()
    (folder / "run.h5").write_bytes(b"not HDF5")
    run = dilatedem.load(folder)
    with pytest.raises(CaseError, match="no table of floes in it"):
        _ = run.floes
    with pytest.raises(CaseError, match="no contact statistics"):
        _ = run.contacts
    with pytest.raises(CaseError, match="there is none in its run.h5"):
        run.load_map("pile")


@pytest.mark.parametrize(("package", "ask"), [("pandas", lambda run: run.forces), ("xarray", lambda run: run.load_map("pile"))])
def test_a_package_that_is_missing_is_named_with_the_command_that_brings_it(make_run, tmp_path, monkeypatch, package, ask):
    run = dilatedem.load(make_run(tmp_path / "run", snapshots=False, duration=2.0))
    monkeypatch.setitem(sys.modules, package, None)  # as if it were not installed
    with pytest.raises(ImportError, match=rf"{package} is not installed.*pip install 'dilatedem\[analysis\]'"):
        ask(run)


def test_the_package_shows_its_names_and_imports_nothing_for_them():
    code = (
        "import sys, dilatedem; assert 'load' in dir(dilatedem) and 'load' in dilatedem.__all__; dilatedem.load;"
        "heavy = ('numba', 'pandas', 'xarray', 'matplotlib', 'meshio', 'shapely', 'pydantic');"
        "print([name for name in heavy if name in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
    code = "import sys, dilatedem; print([name for name in ('numpy', 'dilatedem.results') if name in sys.modules])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
    with pytest.raises(AttributeError, match="has no attribute 'laod'"):
        _ = dilatedem.laod

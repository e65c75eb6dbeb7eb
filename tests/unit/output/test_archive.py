from dataclasses import replace

import h5py
import numpy as np
import pytest

import dilatedem
from dilatedem.output.archive import ContactStatistics, FloeTable, LoadMap, RunArchive
from dilatedem.state.modes import MODE_NAMES


def content(duration=2.0):
    rng = np.random.default_rng(2)
    heights = np.linspace(-1.0, 1.0, 6)
    angles, distances = np.linspace(-180, 180, 9), np.linspace(-5, 5, 5)
    pile = LoadMap(
        "pile", "pile", rng.random((8, 5)), "angle", "Angle", "0 = +x", angles, heights, duration, (10.0, 0.0), radius=2.0
    )
    plane = LoadMap(
        "wall", "plane", rng.random((4, 5)), "distance", "Distance", "0 at center_m", distances, heights, duration, (0, 1, 0),
        axis=(0, 1, 0),
    )
    numbers = np.arange(7.0)
    statistics = {
        "ice_ice": ContactStatistics(np.arange(7), numbers, 2 * numbers, 3e-6 * numbers),
        "ice_structure": ContactStatistics(np.arange(7), numbers, numbers, numbers),
    }
    outlines = [np.array([[0, 0], [1, 0], [0, 1.0]]), np.array([[3, 0], [4, 0], [4, 1], [3, 1.0]])]
    floes = FloeTable(
        body=np.array([0, 1]),
        x0=np.array([0.3, 3.5]),
        y0=np.array([0.3, 0.5]),
        plan_area=np.array([0.5, 1.0]),
        mass=np.array([200.0, 400.0]),
        volume=np.array([0.2, 0.4]),
        vertices=np.array([6, 8]),
        floe=np.array([0, 1]),
        outlines=outlines,
    )
    return [pile, plane], statistics, floes


ABOUT = {"title": "Ice against a pile", "seed": 3, "current_velocity_m_s": (-0.3, 0.3)}


def written(path, *content):
    archive = RunArchive(*content, about=ABOUT)
    archive.write(path)
    archive.close()


def test_layout(tmp_path):
    path = tmp_path / "run.h5"
    maps, statistics, floes = content()
    written(path, maps, statistics, floes)
    with h5py.File(path) as file:
        pile, plane = file["load_map/pile"], file["load_map/wall"]
        np.testing.assert_array_equal(pile["impulse_Ns"], maps[0].impulse)
        np.testing.assert_array_equal(pile["angle_edges_deg"], maps[0].edges)
        np.testing.assert_array_equal(plane["distance_edges_m"], maps[1].edges)
        np.testing.assert_array_equal(pile["height_edges_m"], maps[0].height_edges)
        assert (pile.attrs["kind"], pile.attrs["duration_s"], pile.attrs["radius_m"]) == ("pile", 2.0, 2.0)
        np.testing.assert_array_equal(pile.attrs["center_m"], [10.0, 0.0])
        np.testing.assert_array_equal(plane.attrs["axis"], [0, 1, 0])
        assert tuple(file["contacts"].attrs["mode_names"]) == MODE_NAMES
        ice_ice = file["contacts/ice_ice"]
        np.testing.assert_array_equal(ice_ice["max_overlap_m"], statistics["ice_ice"].max_overlap)
        np.testing.assert_array_equal(file["contacts/ice_structure/steps"], np.arange(7))
        start = file["floes/outline_start"][:]
        points = file["floes/outline_points"][:]
        for i, outline in enumerate(floes.outlines):
            np.testing.assert_array_equal(points[start[i] : start[i + 1]], outline)
        np.testing.assert_array_equal(file["floes/mass_kg"], floes.mass)
        names = {"body", "x0_m", "y0_m", "plan_area_m2", "mass_kg", "volume_m3", "vertices"}
        assert set(file["floes"]) == names | {"outline_points", "outline_start", "point", "xy"}


def test_every_dataset_says_what_it_is_and_along_what(tmp_path):
    written(tmp_path / "run.h5", *content())
    with h5py.File(tmp_path / "run.h5") as file:
        assert file.attrs["program"] == "dilatedem" and file.attrs["version"] == dilatedem.__version__
        assert (file.attrs["title"], file.attrs["seed"]) == (ABOUT["title"], 3)
        np.testing.assert_array_equal(file.attrs["current_velocity_m_s"], [-0.3, 0.3])
        assert file.attrs["current_direction_deg"] == pytest.approx(135.0)
        assert "SI units" in file.attrs["conventions"]
        datasets = []
        file.visititems(lambda name, item: datasets.append(item) if isinstance(item, h5py.Dataset) else None)
        assert len(datasets) == 2 * 5 + 2 * 5 + 11
        for dataset in datasets:
            if dataset.name != "/floes/point":
                assert dataset.attrs["units"] and dataset.attrs["long_name"]
            assert dataset.is_scale or all(len(dimension) == 1 for dimension in dataset.dims)


def test_still_water_has_no_direction(tmp_path):
    archive = RunArchive(*content(), about={"current_velocity_m_s": (0.0, -0.0)})
    archive.write(tmp_path / "run.h5")
    archive.close()
    with h5py.File(tmp_path / "run.h5") as file:
        assert np.isnan(file.attrs["current_direction_deg"])


def test_xarray_opens_it_with_every_dimension_named(tmp_path):
    xarray = pytest.importorskip("xarray")
    maps, statistics, floes = content()
    written(tmp_path / "run.h5", maps, statistics, floes)

    def opened(group):
        return xarray.load_dataset(tmp_path / "run.h5", engine="h5netcdf", group=group)

    pile, wall = opened("load_map/pile"), opened("load_map/wall")
    assert pile.impulse_Ns.dims == ("angle", "height") and wall.impulse_Ns.dims == ("distance", "height")
    np.testing.assert_array_equal(pile.impulse_Ns, maps[0].impulse)
    np.testing.assert_allclose(pile.angle, np.arange(-157.5, 180.0, 45.0))
    np.testing.assert_array_equal(pile.angle_edges_deg, maps[0].edges)
    assert pile.angle.attrs == {"units": "degree", "long_name": "0 = +x"}
    assert pile.attrs["kind"] == "pile" and pile.attrs["duration_s"] == 2.0
    contacts = opened("contacts/ice_ice")
    assert contacts.max_force_N.sel(mode="face-face") == statistics["ice_ice"].max_force[6]
    table = opened("floes")
    assert table.mass_kg.dims == ("body",) and table.outline_points.dims == ("point", "xy")
    assert table.mass_kg.sel(body=1) == 400.0
    np.testing.assert_array_equal(table.outline_points.sel(xy="y")[3:], [0, 0, 1, 1])
    assert opened(None).attrs["seed"] == 3
    with h5py.File(tmp_path / "run.h5") as file:
        groups = []
        file.visititems(lambda name, item: groups.append(name) if isinstance(item, h5py.Group) else None)
    assert not [dim for group in groups for dim in opened(group).sizes if dim.startswith("phony_dim")]


def test_rewritten_whole_and_reproducibly(tmp_path):
    path = tmp_path / "run.h5"
    written(path, *content(duration=1.0))
    (tmp_path / "run.h5.tmp").write_bytes(b"left by a kill")
    written(path, *content(duration=2.0))
    written(tmp_path / "again.h5", *content(duration=2.0))
    assert path.read_bytes() == (tmp_path / "again.h5").read_bytes()
    assert sorted(file.name for file in tmp_path.iterdir()) == ["again.h5", "run.h5"]


def test_brought_up_to_date_it_is_the_file_that_is_written_anew(tmp_path):
    maps, statistics, floes = content(duration=2.0)
    begin = [replace(load_map, impulse=np.zeros(load_map.impulse.shape), duration_s=0.0) for load_map in maps]
    none = {name: ContactStatistics(np.zeros(7, np.int64), *np.zeros((3, 7))) for name in statistics}
    archive = RunArchive(begin, none, floes, about=ABOUT)
    archive.write(tmp_path / "run.h5")
    for _ in range(2):
        archive.update(maps, statistics)
        archive.write(tmp_path / "run.h5")
    archive.close()
    written(tmp_path / "anew.h5", maps, statistics, floes)
    assert (tmp_path / "run.h5").read_bytes() == (tmp_path / "anew.h5").read_bytes()


def test_wrong_shapes_are_refused(tmp_path):
    maps, statistics, floes = content()
    bad_map = LoadMap("pile", "pile", np.zeros((3, 3)), "angle", "Angle", "0 = +x", np.zeros(9), np.zeros(6), 1.0, (0, 0))
    short = {"ice_ice": ContactStatistics(*[np.zeros(6)] * 4)}
    with pytest.raises(ValueError, match="load map of pile"):
        RunArchive([bad_map], statistics, floes)
    with pytest.raises(ValueError, match="ice_ice: one value"):
        RunArchive(maps, short, floes)
    archive = RunArchive(maps, statistics, floes)
    with pytest.raises(ValueError, match="load map of pile"):
        archive.update([bad_map], statistics)
    with pytest.raises(ValueError, match="ice_ice: one value"):
        archive.update(maps, short)


def test_no_floes_and_no_structures(tmp_path):
    zeros = np.zeros(0)
    written(tmp_path / "run.h5", [], {}, FloeTable(zeros, zeros, zeros, zeros, zeros, zeros, zeros, zeros, []))
    with h5py.File(tmp_path / "run.h5") as file:
        assert file["floes/outline_points"].shape == (0, 2)
        np.testing.assert_array_equal(file["floes/outline_start"], [0])
    xarray = pytest.importorskip("xarray")
    assert xarray.load_dataset(tmp_path / "run.h5", engine="h5netcdf", group="floes").sizes["body"] == 0

"""`dilatedem export`: tables that read back to the same histories, loads by height, and what it must leave alone."""

import json

import numpy as np
import pytest
from typer.testing import CliRunner

from dilatedem.cli import app
from dilatedem.export.folder import export
from dilatedem.export.formats import COMPONENTS, PAIRS
from dilatedem.export.heights import spread_over_height
from dilatedem.output import folder
from dilatedem.results.archive import LoadMap, read_archive
from dilatedem.results.tables import read_table


def invoke(*arguments):
    return CliRunner().invoke(app, ["export", *map(str, arguments)])


@pytest.fixture
def run(make_run, tmp_path):
    return make_run(tmp_path / "run", duration=3.0, snapshots=False)


def test_the_same_numbers_in_every_format(run):
    done = invoke(run, "--step", "0.02")
    assert done.exit_code == 0, done.stderr
    assert "pile: 151 samples of 0.02 s; impulses off by " in done.stdout
    plain = np.loadtxt(run / "export" / "pile_loads.csv", delimiter=",", comments=["#", "time_s"])
    assert plain.shape == (151, 7) and np.array_equal(plain[:, 0], np.round(0.02 * np.arange(151), 10))
    assert np.array_equal(np.loadtxt(run / "export" / "pile_loads.dat", comments=["#", "!", "%"]), plain)
    amplitudes = read_amplitudes(run / "export" / "pile_loads.inp")
    assert list(amplitudes) == [f"PILE_{name.partition('_')[0].upper()}" for name in COMPONENTS]
    for column, pairs in enumerate(amplitudes.values(), start=1):
        assert np.array_equal(pairs, plain[:, [0, column]])


def read_amplitudes(path) -> dict[str, np.ndarray]:
    """As Abaqus reads them: comments after **, up to four pairs a line."""
    found: dict[str, list[float]] = {}
    for line in path.read_text().splitlines():
        if line.startswith("*AMPLITUDE"):
            assert "DEFINITION=TABULAR" in line
            numbers = found.setdefault(line.split("NAME=")[1].split(",")[0], [])
        elif line and not line.startswith("**"):
            values = [float(text) for text in line.split(",")]
            assert len(values) <= 2 * PAIRS and len(values) % 2 == 0
            numbers += values
    return {name: np.reshape(numbers, (-1, 2)) for name, numbers in found.items()}


@pytest.mark.parametrize("step", [0.01, 0.03])
def test_the_written_table_has_the_impulse_and_says_its_cost(run, step):
    """To the nine digits that are written."""
    [(path, _), *_] = export(run, step=step, formats=["csv"])
    table = np.loadtxt(path, delimiter=",", comments=["#", "time_s"])
    forces = read_table(run / "forces.csv")
    for column, name in ((1, "fx_N"), (2, "fy_N")):
        size = 0.01 * np.abs(forces[name]).sum()
        assert np.trapezoid(table[:, column], table[:, 0]) == pytest.approx(0.01 * forces[name].sum(), abs=1e-8 * size)
    head = [line for line in path.read_text().splitlines() if line.startswith("#")]
    assert any(line.startswith("# fx_N: impulse off by ") and "peaks kept" in line for line in head)
    assert any("highest horizontal load: " in line for line in head)


def test_a_real_run_with_loads_by_height(crowded, tmp_path):
    written = [path for path, _ in export(crowded, out=tmp_path)]
    maps = read_archive(crowded / "run.h5").load_maps
    name = next(name for name, load_map in maps.items() if load_map.impulse.any())
    assert tmp_path / f"{name}_heights.csv" in written
    table = np.loadtxt(tmp_path / f"{name}_heights.csv", delimiter=",", comments=["#", "z_bottom_m"])
    assert table[:, 5].sum() == pytest.approx(1.0, abs=1e-8)
    assert table[:, 3].sum() == pytest.approx(maps[name].impulse.sum(), rel=1e-8)
    assert (np.diff(table[:, 2]) > 0.0).all()
    said = next(line for line in (tmp_path / f"{name}_heights.csv").read_text().splitlines() if "on average" in line)
    by_map, by_moments = (float(said.split(word)[1].split(" m")[0]) for word in ("acts at z = ", "its moments at "))
    thickness = 0.5
    assert abs(by_map - by_moments) < 0.2 * thickness and abs(by_map) < thickness


def test_shares_by_height_of_a_known_map():
    impulse = np.array([[1.0, 0.0, 2.0], [3.0, 0.0, 6.0]])
    heights = np.array([-0.3, -0.1, 0.1, 0.3])
    spread = spread_over_height(LoadMap("pile", "pile", impulse, np.linspace(-180, 180, 3), heights, 10.0, 1.0))
    assert spread.impulse.tolist() == [4.0, 0.0, 8.0]
    assert spread.share == pytest.approx([1 / 3, 0.0, 2 / 3])
    assert spread.height == pytest.approx((-0.2 + 2 * 0.2) / 3)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--step", "0.005"], "--step 0.005: must be at least output.force_interval = 0.01 s: forces.csv holds nothing shorter"),
        (["--structure", "pyle"], "--structure pyle: there is no such structure in forces.csv; there are pile"),
        (["--format", "xlsx"], "--format xlsx: must be one of csv, openfast, abaqus"),
        (["--keep", "all"], "--keep all: must be one of both, impulse, peaks"),
    ],
)
def test_what_there_is_not(run, arguments, said):
    done = invoke(run, *arguments)
    assert (done.exit_code, done.stderr) == (2, f"{said}\n")
    assert not (run / "export").exists()


def test_a_folder_without_a_run(tmp_path):
    done = invoke(tmp_path)
    assert done.exit_code == 2 and "no run to be found here" in done.stderr


def test_its_own_files_are_replaced_and_no_others(run):
    assert invoke(run).exit_code == 0 and invoke(run, "--keep", "peaks").exit_code == 0
    (run / "export" / "pile_loads.dat").write_text("mine")
    before = (run / "export" / "pile_loads.csv").read_text()
    done = invoke(run, "--step", "0.05")
    assert done.exit_code == 2 and "pile_loads.dat: stands in the way: it is no export of dilatedem" in done.stderr
    assert (run / "export" / "pile_loads.csv").read_text() == before
    (run / "export" / "pile_loads.dat").unlink()
    (run / "export" / "pile_loads.dat").symlink_to(run / "forces.csv")
    assert invoke(run).exit_code == 2 and json.loads((run / "summary.json").read_text())


def test_a_run_that_is_replaced_takes_its_exports_with_it(run):
    assert invoke(run).exit_code == 0
    (run / "export" / "notes.csv").write_text("mine")
    folder.check(run, overwrite=True)
    folder.clear(run)
    assert [path.name for path in (run / "export").iterdir()] == ["notes.csv"]

"""Damaged run folders: one sentence that names the file, from `info`, `post` and `dilatedem.load` alike, and nothing else."""

import json

import h5py
import numpy as np
import pytest
from typer.testing import CliRunner

import dilatedem
from dilatedem.cli import app
from dilatedem.errors import CaseError
from dilatedem.post.read import open_run

WAY_ON = ": the file is damaged; restore it, or remove it to do without"


@pytest.fixture
def folder(make_run, tmp_path):
    return make_run(tmp_path / "run", snapshots=False, duration=1.0)


def told(folder, ask=None) -> str:
    """What all three doors say of a folder; `ask` of an opened one, where opening does not read the file."""
    with pytest.raises(CaseError) as caught:
        open_run(folder)
    shown = CliRunner().invoke(app, ["info", str(folder)])
    assert (shown.exit_code, shown.stdout, shown.stderr) == (2, "", f"{caught.value}\n")
    with pytest.raises(CaseError) as loaded:
        (ask or (lambda run: run.summary))(dilatedem.load(folder))
    assert str(loaded.value) == str(caught.value)
    message = str(caught.value).replace(f"{folder}/", "")
    assert "\n" not in message and message.isprintable()
    return message


def edit(path, change) -> None:
    rows = [line.split(",") for line in path.read_text().splitlines()]
    rows = change(rows) or rows
    path.write_text("\n".join(map(",".join, rows)) + "\n")


def put(row: int, column: int, cell: str):
    def change(rows):
        rows[row][column] = cell

    return change


def swap(rows):
    rows[3], rows[4] = rows[4], rows[3]


def twice(rows):
    rows.insert(3, rows[2])


@pytest.mark.parametrize("cell", ["nan", "inf", "-inf", "1e999", "", "x", "\x1b[31m"])
@pytest.mark.parametrize(
    ("name", "column"), [("forces", "fx_N"), ("forces", "time_s"), ("energy", "kinetic"), ("energy", "residual")]
)
def test_cells_that_are_no_finite_numbers(folder, name, column, cell):
    path = folder / f"{name}.csv"
    place = path.read_text().splitlines()[0].split(",").index(column)
    edit(path, put(5, place, cell))
    message = told(folder, lambda run: getattr(run, name))
    assert message.startswith(f"{name}.csv: row 5: {column} = ") and message.endswith(f" is no finite number{WAY_ON}")


@pytest.mark.parametrize("name", ["forces", "energy"])
@pytest.mark.parametrize("change", [swap, twice, lambda rows: [rows[0], *rows[:0:-1]], put(1, 0, "-1")])
def test_times_that_do_not_go_on(folder, name, change):
    edit(folder / f"{name}.csv", change)
    message = told(folder, lambda run: getattr(run, name))
    assert message.startswith(f"{name}.csv: ")
    assert "time_s does not go on from the row before" in message or "a time is negative" in message


@pytest.mark.parametrize(
    ("name", "column"), [*(("forces", k) for k in range(14)), ("energy", 0), ("energy", -1)]
)
def test_columns_that_are_missing(folder, name, column):
    path = folder / f"{name}.csv"
    missing = path.read_text().splitlines()[0].split(",")[column]
    edit(path, lambda rows: [[cell for i, cell in enumerate(row) if i != column % len(row)] for row in rows])
    assert told(folder, lambda run: getattr(run, name)) == f"{name}.csv: has no column {missing}{WAY_ON}"


@pytest.mark.parametrize("name", ["forces", "energy"])
@pytest.mark.parametrize("junk", [b"a,b\n1,2\n", b"\x00\x00\n\x00", b"\xff\xfe\n1", b"\n\n", b'"' + b"x" * 200_000 + b'"\n'])
def test_tables_of_another_kind(folder, name, junk):
    (folder / f"{name}.csv").write_bytes(junk)
    assert told(folder, lambda run: getattr(run, name)).startswith(f"{name}.csv: ")


def test_rows_of_several_structures_have_times_of_their_own(make_run, tmp_path):
    pile = {"kind": "pile", "center": [4.0, 0.0], "radius": 1.5}
    folder = make_run(tmp_path / "two", structures=[pile | {"name": "a"}, pile | {"name": "b"}], snapshots=False, duration=1.0)
    assert set(open_run(folder).forces) == {"a", "b"}
    assert len(dilatedem.load(folder).forces) == 200


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ("domain = 3", "domain: must be a table"),
        ("domain = {size = 3}", "domain.size: must be a list of 2 numbers"),
        ("domain = {size = [0, 1]}", "domain.size: must be a list of 2 numbers"),
        ("domain = {size = [nan, 1]}", "domain.size: must be a list of 2 numbers"),
        ("domain = {x_boundary = []}", "domain.x_boundary: must be text"),
        ("water = {velocity = ['x', 1]}", "water.velocity: must be a list of 2 numbers"),
        ("water = {enabled = 'no'}", "water.enabled: must be true or false"),
        ("time = {duration = 'long'}", "time.duration: must be a finite number"),
        ("time = {duration = 0}", "time.duration: must be greater than 0"),
        ("structure = 3", "structure: must be a list"),
        ("structure = [3]", "structure.0: must be a table"),
        ("structure = [{name = 3}]", "structure.0.name: must be text"),
        ("body = [{fixed = 1}]", "body.0.fixed: must be true or false"),
        ("output = {snapshot_interval = []}", "output.snapshot_interval: must be a finite number"),
        ("title = 3", "title: must be text"),
        ("contact = {model = true}", "contact.model: must be text"),
        ("field = {seed = 'x'}", "field.seed: must be a whole number"),
        (f"field = {{seed = 0x{'f' * 5000}}}", "holds a whole number of too many digits"),
        (f"x = {'[' * 60}{']' * 60}", "is nested too deeply"),
    ],
)
def test_cases_that_are_none(folder, line, expected):
    (folder / "case.toml").write_text(f"{line}\n")
    assert told(folder) == f"case.toml: {expected}{WAY_ON}"


@pytest.mark.parametrize("junk", [b"[", b"x = " + b"9" * 5000, b"x = " + b"[" * 5000, b"\xff", b"\x00"])
def test_cases_that_are_no_toml(folder, junk):
    (folder / "case.toml").write_bytes(junk)
    assert told(folder).startswith("case.toml: not a readable TOML file: ")


@pytest.mark.parametrize(
    ("key", "value", "expected"),
    [
        ("simulated_s", "x", "simulated_s: must be a finite number"),
        ("simulated_s", float("nan"), "simulated_s: must be a finite number"),
        ("dt_s", 0, "dt_s: must be greater than 0"),
        ("dt_critical_s", [], "dt_critical_s: must be a finite number"),
        ("steps", 1.5, "steps: must be a whole number"),
        ("floes", {}, "floes: must be a whole number"),
        ("status", None, "status: must be text"),
        ("message", [1], "message: must be text"),
        ("loads", [], "loads: must be a table"),
        ("loads", {"pile": 3}, "loads.pile: must be a table"),
        ("loads", {"pile": {"fx_max_N": "x"}}, "loads.pile.fx_max_N: must be a finite number"),
        ("energy", "x", "energy: must be a table"),
        ("energy", {"residual_over_work": "x"}, "energy.residual_over_work: must be a finite number"),
        ("error_check", 3, "error_check: must be a table"),
        ("error_check", {"change": {"fh_max": "x"}}, "error_check.change.fh_max: must be a finite number"),
        ("versions", [1], "versions: must be a table"),
        ("origin", {"machine": 5}, "origin.machine: must be text"),
        ("wall_s", 10**400, "holds a whole number of too many digits"),
    ],
)
def test_summaries_that_are_none(folder, key, value, expected):
    path = folder / "summary.json"
    path.write_text(json.dumps(json.loads(path.read_text()) | {key: value}))
    assert told(folder) == f"summary.json: {expected}{WAY_ON}"


@pytest.mark.parametrize("junk", ["[]", "3", "[" * 5000, '"x"', ""])
def test_summaries_of_another_kind_are_none(folder, junk):
    (folder / "summary.json").write_text(junk)
    assert open_run(folder).summary == {} == dilatedem.load(folder).summary


@pytest.mark.parametrize(
    "name",
    [
        "load_map/pile/impulse_Ns", "load_map/pile/height_edges_m", "floes/outline_points", "floes/outline_start", "floes/mass_kg",
        "contacts/ice_ice/steps", "contacts/ice_ice/max_force_N",
    ],
)  # fmt: skip
@pytest.mark.parametrize("value", ["x", np.full(4, np.nan), np.zeros((3, 1, 2)), None])
def test_archives_that_are_none(folder, name, value):
    with h5py.File(folder / "run.h5", "a") as file:
        del file[name]
        if value is not None:
            file[name] = value
    if name.endswith("impulse_Ns") and value is None:
        assert open_run(folder).load_maps == {}  # a group of another kind
        return
    message = told(folder, lambda run: run.floes)
    assert message.startswith("run.h5: its contents cannot be read (") and message.endswith(f"){WAY_ON}")


def test_post_writes_nothing_into_a_damaged_folder(folder):
    edit(folder / "forces.csv", put(5, 2, "nan"))
    before = {path: path.stat().st_mtime_ns for path in folder.rglob("*")}
    done = CliRunner().invoke(app, ["post", str(folder)])
    assert done.exit_code == 2 and done.stderr.count("\n") == 1
    assert {path: path.stat().st_mtime_ns for path in folder.rglob("*")} == before


def test_what_a_folder_says_cannot_command_a_terminal(folder):
    (folder / "case.toml").write_text('title = "\\u001b[2J"\n')
    shown = CliRunner().invoke(app, ["info", str(folder)])
    assert shown.exit_code == 0 and "\x1b" not in shown.stdout and "\\x1b[2J" in shown.stdout


@pytest.mark.parametrize(
    ("rows", "expected"),
    [
        ("k,seed,run,pile_fx_max_N\n1,1,a,nan\n", f"sweep.csv: pile_fx_max_N = nan is no finite number{WAY_ON}"),
        ("k,seed,run,pile_fx_max_N\n1,1,a,x\n", f"sweep.csv: pile_fx_max_N = x is no finite number{WAY_ON}"),
        ("k,seed,run\n" + "x" * 200_000 + ",1,a\n", "sweep.csv: not the table of a sweep (field larger than field limit (131072))"),
        ("a,b\n1,2\n", "sweep.csv: not the table of a sweep (it has no columns seed and run)"),
    ],
)
def test_tables_of_sweeps_that_are_none(tmp_path, rows, expected):
    (tmp_path / "sweep.csv").write_text(rows)
    shown = CliRunner().invoke(app, ["info", str(tmp_path)])
    assert (shown.exit_code, shown.stderr) == (2, f"{tmp_path}/{expected}\n")


@pytest.mark.parametrize("value", ["9" * 5000, "[" * 3000, "\x00"])
def test_values_of_sweeps_that_no_toml_holds_are_text(tmp_path, value):
    (tmp_path / "sweep.csv").write_text(f'k,seed,run\n"{value}",1,a\n')
    assert CliRunner().invoke(app, ["info", str(tmp_path)]).exit_code in (0, 2)
    assert dilatedem.load(tmp_path).keys == ["k"]


@pytest.mark.parametrize("value", ["x", np.full(4, np.nan), np.zeros((3, 1, 2)), np.arange(3)])
def test_any_column_of_the_floes_belongs_to_the_floes(folder, value):
    with h5py.File(folder / "run.h5", "a") as file:
        file["floes/of_a_later_version"] = value
    assert told(folder, lambda run: run.floes).startswith("run.h5: its contents cannot be read (floes: of_a_later_version ")

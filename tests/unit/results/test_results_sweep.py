"""`dilatedem.load` of a sweep: its table with vectors as numbers, and its runs, each loaded when asked for."""

import math

import pytest

import dilatedem
from dilatedem.errors import CaseError

HEADER = "water.velocity,contact.model,water.enabled,seed,run,status,steps,wall_s,pile_fx_max_N,residual_over_work,message\n"
ROWS = (
    '"[0.5, 0.0]",liu2015,true,1,a,completed,100,2.5,500.5,0.0001,\n'
    '"[0.25, -1]",consistent,false,1,b,stopped,50,1.5,250.0,,"bodies 3, 7"\n'
    '"[1.0, 0.0]",consistent,true,2,2024,waiting,,,,,\n'
)


@pytest.fixture
def swept(make_run, tmp_path):
    folder = tmp_path / "sweep"
    make_run(folder / "a", snapshots=False, duration=2.0)
    make_run(folder / "b", snapshots=False, duration=2.0, status="stopped")
    (folder / "sweep.csv").write_text(HEADER + ROWS)
    return dilatedem.load(folder)


def test_numbers_are_numbers_and_vectors_have_their_components_beside_them(swept):
    table = swept.table
    assert swept.table is table
    assert list(table.columns)[:5] == ["water.velocity", "water.velocity.0", "water.velocity.1", "contact.model", "water.enabled"]
    assert table["water.velocity"].tolist() == ["[0.5, 0.0]", "[0.25, -1]", "[1.0, 0.0]"]
    assert table["water.velocity.0"].tolist() == [0.5, 0.25, 1.0]
    assert table["water.velocity.1"].tolist() == [0.0, -1.0, 0.0]
    assert table["contact.model"].tolist() == ["liu2015", "consistent", "consistent"]
    assert table["water.enabled"].tolist() == [True, False, True]
    assert table.seed.tolist() == [1, 1, 2] and table.seed.dtype == int
    assert table.pile_fx_max_N.tolist()[:2] == [500.5, 250.0] and math.isnan(table.pile_fx_max_N[2])
    assert table.steps.dtype == float and math.isnan(table.residual_over_work[1])
    assert table.status.tolist() == ["completed", "stopped", "waiting"]
    assert table.run.tolist() == ["a", "b", "2024"]
    assert table.message.tolist() == ["", "bodies 3, 7", ""]
    assert table.groupby("contact.model")["pile_fx_max_N"].max()["liu2015"] == 500.5


def test_components_that_the_grid_varies_itself_are_left_alone(tmp_path):
    (tmp_path / "sweep.csv").write_text('water.velocity,water.velocity.0,seed,run\n"[1, 2]",7.5,1,a\n"[3]",8.5,1,b\n')
    table = dilatedem.load(tmp_path).table
    assert list(table.columns) == ["water.velocity", "water.velocity.1", "water.velocity.0", "seed", "run"]
    assert table["water.velocity.0"].tolist() == [7.5, 8.5]
    assert table["water.velocity.1"][0] == 2.0 and math.isnan(table["water.velocity.1"][1])


def test_runs_are_loaded_when_asked_for(swept):
    assert len(swept.runs) == 3 and swept.keys == ["water.velocity", "contact.model", "water.enabled"]
    assert swept.runs[0] is swept.runs["a"]
    assert swept.runs[1].summary["status"] == "stopped"
    assert [run.path.name for run in swept.runs[:2]] == ["a", "b"]
    with pytest.raises(CaseError, match="2024: no run to be found here"):
        swept.runs[2]
    with pytest.raises(CaseError, match="c: no run of this sweep; there are a, b, 2024"):
        swept.runs["c"]
    assert "3 runs over water.velocity" in repr(swept)


def test_a_moved_sweep_finds_its_runs(swept, tmp_path):
    moved = tmp_path / "moved"
    swept.path.rename(moved)
    assert dilatedem.load(moved).runs["a"].path == moved / "a"


def test_a_table_of_another_kind_is_refused(tmp_path):
    (tmp_path / "sweep.csv").write_text("x,y\n1,2\n")
    with pytest.raises(CaseError, match="not the table of a sweep"):
        _ = dilatedem.load(tmp_path).table

"""`dilatedem init`: every example case is one that runs, is written with what it names, and replaces nothing."""

import os
from pathlib import Path

import pytest
from typer.testing import CliRunner

from dilatedem import examples
from dilatedem.case.load import load
from dilatedem.cli import app
from dilatedem.errors import CaseError
from dilatedem.run.simulation import Simulation

CASES = Path(__file__).parents[2] / "cases"


def invoke(*arguments):
    return CliRunner().invoke(app, ["init", *map(str, arguments)])


def test_the_examples_are_those_of_the_folder_cases():
    assert examples.names() == sorted(path.stem for path in CASES.glob("*.toml"))
    assert {"pile", "cone", "jacket", "compliant", "hour", "legs", "small"} <= set(examples.names())


@pytest.mark.parametrize("name", examples.names())
def test_every_example_is_written_as_it_stands_and_can_be_loaded(name, tmp_path):
    written = examples.write(name, tmp_path)
    assert written[0] == tmp_path / f"{name}.toml" and examples.title(name)
    for file in written:
        assert file.read_bytes() == (CASES / file.name).read_bytes()
    assert load(written[0]).title == examples.title(name)
    text = written[0].read_text()
    assert text.count("#") >= 5, "an example explains itself"


def test_the_small_example_is_ready_for_a_sweep_of_seeds():
    for seed in range(1, 21):  # a period too short for the two largest floes of a field would refuse it
        assert Simulation.of_case(load(CASES / "small.toml", [f"field.seed={seed}"])).model.floating > 20


def test_the_paper_s_case_unless_another_is_named(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    done = invoke()
    assert done.exit_code == 0
    assert done.stdout.splitlines()[0] == "pile.toml: Broken ice against a vertical pile"
    assert [path.name for path in tmp_path.iterdir()] == ["pile.toml"]


def test_a_table_that_a_case_names_comes_with_it(tmp_path):
    written = examples.write("ship", tmp_path / "new" / "my.toml")
    assert written == [tmp_path / "new" / "my.toml", tmp_path / "new" / "ship.csv"]
    assert load(written[0]).structure[0].support.kind == "driven"


@pytest.mark.parametrize("stands", ["file", "link", "table"])
def test_nothing_is_replaced_or_written_in_part(stands, tmp_path):
    place = tmp_path / ("ship.csv" if stands == "table" else "ship.toml")
    os.symlink("nowhere", place) if stands == "link" else place.write_text("mine")
    done = invoke("ship", "--out", tmp_path)
    assert (done.exit_code, done.stdout) == (2, "")
    assert done.stderr == f"{place}: exists already, and is left as it is; choose another file with --out\n"
    assert [path.name for path in tmp_path.iterdir()] == [place.name]


@pytest.mark.parametrize(("name", "said"), [("jaket", "did you mean jacket?"), ("xyz", "there are compliant, cone, hour")])
def test_a_name_that_there_is_not(name, said, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(CaseError, match=f"init {name}: there is no such example; "):
        examples.write(name)
    done = invoke(name)
    assert done.exit_code == 2 and said in done.stderr
    assert not list(tmp_path.iterdir())

"""The same command again: a complete run has nothing to do, one that was cut short goes on, another case is refused by its keys."""

import contextlib
import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from dilatedem.cli import app

CROWDED = Path(__file__).parents[2] / "cases" / "crowded.toml"
SHORT = ("--set", "output.track=[]", "--set", "time.duration=0.2")


def run(out, *more):
    return CliRunner().invoke(app, ["run", str(CROWDED), "--out", str(out), *SHORT, *more])


@pytest.fixture
def complete(tmp_path) -> Path:
    assert run(tmp_path / "run", "--quiet").exit_code == 0
    return tmp_path / "run"


def contents(folder: Path) -> dict:
    return {path.relative_to(folder): (path.stat().st_mtime_ns, path.read_bytes()) for path in folder.rglob("*") if path.is_file()}


def test_a_complete_run_has_nothing_to_do(complete):
    before = contents(complete)
    done = run(complete)
    assert (done.exit_code, done.stderr) == (0, "nothing to do: the run is complete\n")
    assert done.stdout.startswith(f"{complete}: 0.2 s simulated in ")
    assert contents(complete) == before
    quiet = run(complete, "--quiet")
    assert (quiet.exit_code, quiet.stdout, quiet.stderr) == (0, "", "")


def test_a_run_that_was_cut_short_goes_on_to_the_same_files(complete, tmp_path, monkeypatch):
    """Interrupted half way, as by Ctrl-C: the next run of the same command goes on from there."""
    looks = iter([False, False, True])

    class Pressed(contextlib.nullcontext):
        asked = property(lambda self: next(looks))

        def __enter__(self):
            return self

    monkeypatch.setattr("dilatedem.run.loop.Interruption", Pressed)
    first = run(tmp_path / "cut", "--set", "output.checkpoint_interval=0.05")
    assert first.exit_code == 130, first.stderr
    monkeypatch.undo()
    then = run(tmp_path / "cut", "--set", "output.checkpoint_interval=0.05")
    assert then.exit_code == 0
    begun = json.loads((tmp_path / "cut" / "summary.json").read_text())
    assert begun["status"] == "completed"
    assert "goes on from t = 0." in then.stderr
    for name in ("forces.csv", "hits.csv", "energy.csv"):
        assert (tmp_path / "cut" / name).read_bytes() == (complete / name).read_bytes()


def test_a_longer_one_goes_on_and_a_shorter_one_is_refused(complete):
    assert run(complete, "--set", "time.duration=0.25").exit_code == 0
    assert json.loads((complete / "summary.json").read_text())["simulated_s"] == pytest.approx(0.25, abs=1e-3)
    before = contents(complete)
    shorter = run(complete)
    assert shorter.exit_code == 2 and "the run has come to 0.25 s already" in shorter.stderr
    assert contents(complete) == before


def test_another_case_is_refused_by_its_keys(complete):
    before = contents(complete)
    done = run(complete, "--set", "water.velocity=[0.5,0.1]", "--set", "structure.0.radius=1.1")
    assert (done.exit_code, done.stdout) == (2, "")
    assert done.stderr == (
        f"{complete}: holds a run already, of a case with another water.velocity, structure.0.radius; "
        "replace it with --overwrite, or choose another --out\n"
    )
    assert contents(complete) == before


def test_a_case_that_cannot_be_read_is_no_reason_to_replace_it(complete):
    text = (complete / "case.toml").read_text()
    (complete / "case.toml").write_text(text.replace("[water]", "[wetter]"))
    done = run(complete)
    assert done.exit_code == 2 and "holds a run already, of a case that cannot be read" in done.stderr

"""A run made longer equals one that was asked for at first, byte for byte; whatever else is changed is refused, by name."""

import json
from pathlib import Path

import pytest
from folders import CASES, in_process

from dilatedem.case.load import load
from dilatedem.errors import CaseError, Interrupted
from dilatedem.processes.interruption import Interruption
from dilatedem.results.load import load as results
from dilatedem.run import loop

TABLES = ("forces.csv", "hits.csv", "energy.csv", "bodies.csv", "ice.pvd", "case.toml")
#: a load goes on at 1.237 s, in the middle of a window; 1.9 s is none of its ends
SET = ["time.step_fraction=0.3", "water.velocity=[1.5,0.15]", "output.hit_threshold=500.0", "output.hits_in_full=3"]


def run(out: Path, *more: str, resume: bool = False) -> Path:
    return loop.run(load(CASES / "crowded.toml", [*SET, *more]), out, resume=resume, quiet=True)


def assert_alike(one: Path, other: Path) -> None:
    for name in TABLES:
        assert (one / name).read_bytes() == (other / name).read_bytes(), name
    snapshots = sorted(path.name for path in (one / "snapshots").iterdir())
    assert snapshots == sorted(path.name for path in (other / "snapshots").iterdir())
    for name in snapshots:
        assert (one / "snapshots" / name).read_bytes() == (other / "snapshots" / name).read_bytes(), name


@pytest.fixture(scope="module")
def long(tmp_path_factory) -> Path:
    return run(tmp_path_factory.mktemp("long") / "run", "time.duration=2.6")


@pytest.fixture
def stopped(tmp_path) -> Path:
    return run(tmp_path / "run", "time.duration=1.237")


def test_a_run_made_longer_twice_equals_one_that_was_asked_for_at_first(long, stopped):
    assert results(stopped).summary["status"] == "completed"
    rows = (stopped / "forces.csv").read_bytes()
    assert not (long / "forces.csv").read_bytes().startswith(rows), "the last window ends with the run"
    run(stopped, "time.duration=1.9", resume=True)
    run(stopped, "time.duration=2.6", resume=True)
    assert_alike(stopped, long)
    assert json.loads((stopped / "summary.json").read_text())["duration_s"] == 2.6


def test_a_kill_on_the_way_to_the_longer_end_costs_nothing(long, stopped, monkeypatch):
    class AtOnce(Interruption):
        asked = property(lambda self: True, lambda self, value: None)

    monkeypatch.setattr(loop, "Interruption", AtOnce)
    with pytest.raises(Interrupted):
        run(stopped, "time.duration=2.6", resume=True)
    monkeypatch.undo()
    assert results(stopped).summary["status"] == "interrupted"
    run(stopped, "time.duration=2.6", resume=True)
    assert_alike(stopped, long)


def test_the_same_end_asked_for_again_is_left_as_it_is(stopped):
    before = {path.name: path.stat().st_mtime_ns for path in stopped.iterdir() if path.is_file()}
    run(stopped, "time.duration=1.237", resume=True)
    assert {path.name: path.stat().st_mtime_ns for path in stopped.iterdir() if path.name in before} == before


def test_what_else_is_changed_is_refused_by_name_and_nothing_is_touched(stopped):
    before = {path.name: path.read_bytes() for path in stopped.iterdir() if path.is_file() and path.suffix != ".lock"}
    for changes, sentence in (
        (["water.velocity=[1.5,0.2]", "structure.0.radius=1", "time.duration=3"], "another water.velocity, structure.0.radius; "),
        (["time.duration=1.0"], r"time.duration = 1: the run has come to 1.237\d* s already; ask for more"),
        (["time.until.load_above=1e5"], "it has another time.until.load_above; "),
        (["structure=[]"], "it has another structure; "),
    ):
        with pytest.raises(CaseError, match=sentence):
            run(stopped, "time.duration=1.237", *changes, resume=True)
    assert all((stopped / name).read_bytes() == content for name, content in before.items())
    done = in_process("run", CASES / "crowded.toml", "--out", stopped, "--resume", "--set", "field.seed=9", "--quiet")
    assert done.exit_code == 2 and "field.seed" in done.stderr


def test_a_run_that_a_condition_ended_goes_on_without_it_as_if_it_had_never_been(long, tmp_path):
    out = run(tmp_path / "run", "time.duration=2.6", "time.until.load_above=2000.0")
    summary = results(out).summary
    assert summary["until"]["met"] == ["load_above"] and 1.0 <= summary["simulated_s"] < 2.1
    assert summary["status"] == "completed" and "the load on a structure has been above 2000 N" in summary["until"]["message"]
    run(out, "time.duration=2.6", "time.until.load_above=2000.0", resume=True)
    assert results(out).summary["simulated_s"] == summary["simulated_s"]
    run(out, "time.duration=2.6", resume=True)
    assert_alike(out, long)

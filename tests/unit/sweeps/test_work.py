"""A case of a sweep in whatever process: the same files as from `dilatedem run`, an answer for every end."""

import threading

import pytest

from dilatedem.case import write
from dilatedem.case.load import load
from dilatedem.processes.interruption import Interruption
from dilatedem.results.sweep import read_rows
from dilatedem.run import loop
from dilatedem.sweeps.orders import Order, outcome
from dilatedem.sweeps.sweep import sweep
from dilatedem.sweeps.work import simulate
from tests.regression.folders import CASES, assert_same_run

SHORT = ["time.duration=0.1", "output.checkpoint_interval=0.02"]


def test_the_files_are_those_of_a_run_and_its_way_is_told(tmp_path, monkeypatch):
    monkeypatch.setattr("dilatedem.sweeps.work.TELL_S", 0.0)
    case, shares = load(CASES / "crowded.toml", SHORT), []
    loop.run(case, tmp_path / "run", quiet=True)
    answer = simulate(Order(write.dump(case), str(tmp_path / "order")), shares.append)
    assert outcome(answer, stopping=False) == ("completed", "")
    assert_same_run(tmp_path / "order", tmp_path / "run")
    assert shares[0] == 0.0 and shares == sorted(shares) and shares[-1] == pytest.approx(1.0)


def test_a_run_that_is_asked_to_stop_in_another_thread_saves_its_state(tmp_path):
    case, interruption, answers = load(CASES / "crowded.toml", SHORT), Interruption(), []
    loop.run(case, tmp_path / "whole", quiet=True)

    def stop(share: float) -> None:
        interruption.asked = True

    def work(resume: bool, tell) -> None:
        answers.append(simulate(Order(write.dump(case), str(tmp_path / "order"), resume=resume), tell, interruption))

    for resume, tell in ((False, stop), (True, lambda share: None)):
        interruption.asked = False
        thread = threading.Thread(target=work, args=(resume, tell))
        thread.start()
        thread.join()
    assert [outcome(answer, stopping=False)[0] for answer in answers] == ["interrupted", "completed"]
    assert_same_run(tmp_path / "order", tmp_path / "whole")


def test_runs_that_were_made_one_by_one_are_gathered_by_a_sweep(tmp_path, capsys):
    """As tasks of an array of a batch system make them: docs/clusters.md."""
    for seed in ("1", "2"):
        loop.run(load(CASES / "crowded.toml", [*SHORT, f"field.seed={seed}"]), tmp_path / f"seed={seed}", quiet=True)
    sweep(CASES / "crowded.toml", seeds=2, out=tmp_path, overrides=[*SHORT, "field.seed=1"], resume=True)
    assert capsys.readouterr().err.endswith("all of them were completed before: nothing to do\n")
    header, rows = read_rows(tmp_path)
    assert [(row["run"], row["status"], float(row["simulated_s"])) for row in rows] == [
        (f"seed={n}", "completed", pytest.approx(0.1)) for n in (1, 2)
    ]
    assert all(float(row["pile_fh_max_N"]) >= float(row["pile_fh_p99_N"]) for row in rows)


def test_what_is_wrong_is_told_and_what_nobody_foresaw_with_its_traceback(tmp_path, monkeypatch):
    def bug(*_, **__):
        raise ZeroDivisionError("a bug")

    wrong = simulate(Order("[ice]\ndensity = -1", str(tmp_path)), print)
    assert outcome(wrong, stopping=False) == ("failed", "<sweep>:2: ice.density = -1: must be greater than 0")
    monkeypatch.setattr("dilatedem.sweeps.work.run", bug)
    unforeseen = simulate(Order(write.dump(load(CASES / "crowded.toml")), str(tmp_path)), print)
    assert outcome(unforeseen, stopping=False) == ("failed", "ZeroDivisionError: a bug") and "Traceback" in unforeseen.said

"""A run that was stopped, by Ctrl-C, by a kill or by a fault of the machine, and resumed equals one that never was."""

import json
import signal
import subprocess
import time
from pathlib import Path

import numpy as np
import pytest
from folders import CASES, assert_same_run, command, environment, in_process, saved

from dilatedem.case.load import load
from dilatedem.errors import CaseError, Interrupted
from dilatedem.processes.interruption import Interruption
from dilatedem.run import loop


class AskedAfter(Interruption):
    """Stands for a user who presses Ctrl-C after so many looks at the keyboard."""

    looks = 0

    @property
    def asked(self) -> bool:
        self.left -= 1
        return self.left < 0

    @asked.setter
    def asked(self, value: bool) -> None:
        self.left = self.looks


def interrupt_after(monkeypatch, looks: int) -> None:
    monkeypatch.setattr(loop, "Interruption", type("Asked", (AskedAfter,), {"looks": looks}))


@pytest.mark.parametrize(("name", "looks"), [("crowded", (0, 31, 60)), ("mixed", (7, 1, 9))])
def test_a_run_interrupted_three_times_equals_one_that_was_not(name, looks, request, monkeypatch, tmp_path):
    case, out = load(CASES / f"{name}.toml"), tmp_path / name
    for number, count in enumerate(looks):
        interrupt_after(monkeypatch, count)
        with pytest.raises(Interrupted, match=r"interrupted at t = \d"):
            loop.run(case, out, resume=number > 0, quiet=True)
        assert json.loads((out / "summary.json").read_text())["status"] == "interrupted"
    monkeypatch.undo()
    loop.run(case, out, resume=True, quiet=True)
    assert_same_run(out, request.getfixturevalue(name))
    summary, expected = (json.loads((path / "summary.json").read_text()) for path in (out, request.getfixturevalue(name)))
    for key in ("status", "message", "steps", "loads", "energy", "contact", "simulated_s"):
        assert summary[key] == expected[key]


def saved_time(out: Path) -> float:
    """Simulated time of the last saved state, s; summary.json is written right after it."""
    summary = out / "summary.json"
    return json.loads(summary.read_text())["simulated_s"] if summary.exists() else 0.0


def started(case: Path, out: Path) -> subprocess.Popen:
    """A run in a process of its own that has saved its state on the way."""
    process = subprocess.Popen(command("run", case, "--out", out, "--quiet"), stderr=subprocess.PIPE, text=True, env=environment())
    deadline = time.monotonic() + 300.0
    while not saved_time(out) > 0.0:
        assert process.poll() is None, process.stderr.read()
        assert time.monotonic() < deadline, "no checkpoint within 5 minutes"
        time.sleep(0.005)
    return process


def test_ctrl_c_saves_the_state_and_resume_completes_the_run(crowded, tmp_path):
    out = tmp_path / "crowded"
    process = started(CASES / "crowded.toml", out)
    process.send_signal(signal.SIGINT)
    said = process.communicate(timeout=60)[1]
    assert process.returncode == 130
    assert said.startswith("interrupted at t = ") and "--resume" in said and said.count("\n") == 1
    summary = json.loads((out / "summary.json").read_text())
    assert summary["status"] == "interrupted" and 0.0 < summary["simulated_s"] < 4.0

    done = in_process("run", CASES / "crowded.toml", "--out", out, "--resume", "--quiet")
    assert (done.exit_code, done.stderr) == (0, "")
    assert_same_run(out, crowded)


def test_a_killed_run_resumes_from_its_last_checkpoint(crowded, tmp_path):
    out = tmp_path / "crowded"
    process = started(CASES / "crowded.toml", out)
    time.sleep(0.1)  # rows and snapshots past the checkpoint, which the resumed run writes again
    process.kill()
    process.communicate()
    assert process.returncode == -signal.SIGKILL
    assert json.loads((out / "summary.json").read_text())["status"] == "running"

    done = in_process("run", CASES / "crowded.toml", "--out", out, "--resume", "--quiet")
    assert (done.exit_code, done.stderr) == (0, "")
    assert_same_run(out, crowded)


def test_rows_and_snapshots_past_the_checkpoint_are_written_again(crowded, monkeypatch, tmp_path):
    case, out = load(CASES / "crowded.toml"), tmp_path / "crowded"
    interrupt_after(monkeypatch, 40)
    with pytest.raises(Interrupted):
        loop.run(case, out, quiet=True)
    monkeypatch.undo()
    with open(out / "forces.csv", "ab") as forces:  # a kill in the middle of a row
        forces.write(b"3.9,pile,1,2")
    (out / "snapshots" / "ice_000011.vtu").write_text("half a snaps")
    (out / "snapshots" / "ice_000012.vtu.tmp").write_text("half a snaps")
    loop.run(case, out, resume=True, quiet=True)
    assert_same_run(out, crowded)


def test_a_completed_run_may_be_resumed_and_stays_as_it_is(crowded, tmp_path):
    out = tmp_path / "crowded"
    loop.run(load(CASES / "crowded.toml", ["time.duration=0.3"]), out, quiet=True)
    before = {path: path.read_bytes() for path in out.rglob("*.*v*") if path.is_file()}
    loop.run(load(out / "case.toml"), out, resume=True, quiet=True)
    assert {path: path.read_bytes() for path in before} == before


def test_resuming_needs_a_run_with_a_saved_state_of_the_same_case(crowded, tmp_path):
    with pytest.raises(CaseError, match="holds no run to resume"):
        loop.run(load(CASES / "crowded.toml"), tmp_path / "none", resume=True, quiet=True)
    with pytest.raises(CaseError, match="is not the case given"):
        loop.run(load(CASES / "crowded.toml", ["contact.friction=0.2"]), crowded, resume=True, quiet=True)
    (tmp_path / "case.toml").write_bytes((crowded / "case.toml").read_bytes())
    with pytest.raises(CaseError, match="no checkpoint to resume from"):  # nor is a lock left
        loop.run(load(CASES / "crowded.toml"), tmp_path, resume=True, quiet=True)


CHECKED = ["time.error_check=true", "time.duration=2.0"]


@pytest.fixture(scope="module")
def checked(tmp_path_factory):
    return loop.run(load(CASES / "crowded.toml", CHECKED), tmp_path_factory.mktemp("checked") / "run", quiet=True)


def error_check(out: Path) -> dict:
    """What the check of the time step found, without the time that it took."""
    found = json.loads((out / "summary.json").read_text())["error_check"]
    del found["wall_s"]
    return found


@pytest.mark.parametrize("looks", [(0, 13, 17, 41), (29, 2, 3, 1)])
def test_the_error_of_the_step_is_the_same_for_an_interrupted_run(looks, checked, monkeypatch, tmp_path):
    case, out = load(CASES / "crowded.toml", CHECKED), tmp_path / "out"
    for number, count in enumerate(looks):
        interrupt_after(monkeypatch, count)
        with pytest.raises(Interrupted, match=r"interrupted at t = \d"):
            loop.run(case, out, resume=number > 0, quiet=True)
        assert "error_check" not in json.loads((out / "summary.json").read_text())
    monkeypatch.undo()
    loop.run(case, out, resume=True, quiet=True)
    assert_same_run(out, checked)
    assert error_check(out) == error_check(checked)
    assert error_check(out)["reproduced"] is True and error_check(out)["at_dt"]["fh_max_N"] > 1e3


def test_an_interrupted_check_is_made_again(checked, monkeypatch, tmp_path):
    case, out = load(CASES / "crowded.toml", CHECKED), tmp_path / "out"
    loop.run(load(CASES / "crowded.toml", CHECKED), out, quiet=True)
    killed = json.loads((out / "summary.json").read_text()) | {"status": "running"}
    del killed["error_check"]
    (out / "summary.json").write_text(json.dumps(killed))  # as a kill in the middle of the check leaves it
    interrupt_after(monkeypatch, 2)  # after the last step there is no look at the keyboard but those of the check
    with pytest.raises(Interrupted, match=r"while the time step was checked; the run is saved, --resume checks again"):
        loop.run(case, out, resume=True, quiet=True)
    summary = json.loads((out / "summary.json").read_text())
    assert summary["status"] == "interrupted" and summary["simulated_s"] == pytest.approx(2.0)
    monkeypatch.undo()
    loop.run(case, out, resume=True, quiet=True)
    assert json.loads((out / "summary.json").read_text())["status"] == "completed"
    assert_same_run(out, checked)
    assert error_check(out) == error_check(checked)


def test_the_check_of_the_step_changes_no_other_file(checked, tmp_path):
    case = load(CASES / "crowded.toml", [*CHECKED, "time.error_check=false"])
    out = loop.run(case, tmp_path / "out", quiet=True)
    names = [path.relative_to(out) for path in out.rglob("*") if path.is_file()]
    assert sorted(names) == sorted(path.relative_to(checked) for path in checked.rglob("*") if path.is_file())
    for name in names:
        if name.name not in ("case.toml", "restart.h5", "before_end.h5", "summary.json", "run.h5"):
            assert (out / name).read_bytes() == (checked / name).read_bytes(), name
    found, wanted = saved(checked / "restart.h5"), saved(out / "restart.h5")
    assert not [name for name in wanted if not np.array_equal(found[name], wanted[name])]
    assert found.keys() > wanted.keys()

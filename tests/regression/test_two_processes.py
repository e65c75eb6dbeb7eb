"""A run folder belongs to one process at a time; a run that is complete is left as it is; a foreign folder is left alone."""

import json
import os
import signal
import subprocess
import time
from pathlib import Path

import pytest
from folders import CASES, assert_same_run, command, environment, in_process
from test_resume import interrupt_after, started

from dilatedem.case.load import load
from dilatedem.errors import Interrupted
from dilatedem.run import loop


def everything(out: Path) -> dict[Path, tuple]:
    """Names, bytes and times of all files."""
    return {path: (path.stat().st_mtime_ns, path.read_bytes() if path.is_file() else b"") for path in sorted(out.rglob("*"))}


@pytest.mark.parametrize("way", ["--resume", "--overwrite"])
def test_a_second_process_is_refused_beside_a_live_run(way, crowded, tmp_path):
    out = tmp_path / "crowded"
    process = started(CASES / "crowded.toml", out)
    process.send_signal(signal.SIGSTOP)
    os.waitid(os.P_PID, process.pid, os.WSTOPPED)  # until then its threads go on
    try:
        before = everything(out)
        second = in_process("run", CASES / "crowded.toml", "--out", out, way, "--quiet")
        assert (second.exit_code, second.stderr.count("\n")) == (2, 1)
        assert "another process is at work in it" in second.stderr
        assert everything(out) == before
    finally:
        process.send_signal(signal.SIGCONT)
    assert process.communicate(timeout=120)[1] == "" and process.returncode == 0
    assert_same_run(out, crowded)


def test_a_run_that_is_complete_is_left_as_it_is_by_resume(crowded, tmp_path):
    out = tmp_path / "crowded"
    case = load(CASES / "crowded.toml", ["time.duration=0.1"])
    loop.run(case, out, quiet=True)
    summary = json.loads((out / "summary.json").read_text())
    (out / "summary.json").write_text(json.dumps(summary | {"post": {"loads": {}}}))  # as `post` leaves it
    before = everything(out)
    loop.run(case, out, resume=True, quiet=True)
    assert everything(out) == before


def test_a_run_killed_between_its_last_state_and_its_last_summary_is_completed(tmp_path):
    out, case = tmp_path / "out", load(CASES / "crowded.toml", ["time.duration=0.1"])
    loop.run(case, out, quiet=True)
    summary = json.loads((out / "summary.json").read_text())
    (out / "summary.json").write_text(json.dumps(summary | {"status": "running"}))
    loop.run(case, out, resume=True, quiet=True)
    assert json.loads((out / "summary.json").read_text())["status"] == "completed"


@pytest.mark.parametrize("table", ["forces.csv", "energy.csv", "bodies.csv"])
def test_a_table_that_was_changed_is_refused_before_anything_is_written(table, monkeypatch, tmp_path):
    out, case = tmp_path / "out", load(CASES / "crowded.toml", ["time.duration=0.5"])
    interrupt_after(monkeypatch, 12)
    with pytest.raises(Interrupted):
        loop.run(case, out, quiet=True)
    monkeypatch.undo()
    text = (out / table).read_bytes()
    (out / table).write_bytes(text.replace(b"0", b"1", 1))
    (out / "energy.csv" if table != "energy.csv" else out / "forces.csv").open("ab").write(b"torn")
    before = everything(out)
    done = in_process("run", out / "case.toml", "--out", out, "--resume", "--quiet")
    assert (done.exit_code, done.stderr.count("\n")) == (2, 1)
    assert f"{table}: its first" in done.stderr and "was changed since" in done.stderr
    assert everything(out) == before


def test_a_checkpoint_of_another_case_is_refused(tmp_path):
    outs = [tmp_path / "a", tmp_path / "b"]
    for out, friction in zip(outs, ("0.1", "0.2"), strict=True):
        loop.run(load(CASES / "crowded.toml", ["time.duration=0.1", f"contact.friction={friction}"]), out, quiet=True)
    (outs[0] / "restart.h5").write_bytes((outs[1] / "restart.h5").read_bytes())
    done = in_process("run", outs[0] / "case.toml", "--out", outs[0], "--resume", "--quiet")
    assert (done.exit_code, done.stderr.count("\n")) == (2, 1)
    assert "restart.h5: belongs to another case" in done.stderr


@pytest.mark.parametrize("options", [[], ["--overwrite"]])
def test_nothing_of_a_folder_without_a_run_is_touched(options, tmp_path):
    out = tmp_path / "mine"
    (out / "figures").mkdir(parents=True)
    for name in ("case.toml", "energy.csv", "run.h5", "report.html", "figures/mine.svg"):
        (out / name).write_text(f"my own {name}")
    (out / "snapshots").symlink_to(out / "figures")
    before = everything(out)
    done = in_process("run", CASES / "crowded.toml", "--out", out, "--quiet", *options)
    assert (done.exit_code, done.stderr.count("\n")) == (2, 1)
    assert everything(out) == before


def test_a_closed_terminal_saves_the_state(crowded, tmp_path):
    out = tmp_path / "crowded"
    before = signal.signal(signal.SIGHUP, signal.SIG_DFL)  # the tests themselves may run under nohup
    try:
        process = started(CASES / "crowded.toml", out)
    finally:
        signal.signal(signal.SIGHUP, before)
    for _ in range(3):  # shell and system both send it
        process.send_signal(signal.SIGHUP)
    assert process.communicate(timeout=60)[1].startswith("interrupted at t = ")
    assert process.returncode == 130
    assert json.loads((out / "summary.json").read_text())["status"] == "interrupted"
    assert in_process("run", CASES / "crowded.toml", "--out", out, "--resume", "--quiet").exit_code == 0
    assert_same_run(out, crowded)


def test_a_run_under_nohup_outlives_its_terminal(crowded, tmp_path):
    out = tmp_path / "crowded"
    ignoring = ["env", "--ignore-signal=HUP", *command("run", CASES / "crowded.toml", "--out", out, "--quiet")]
    process = subprocess.Popen(ignoring, stderr=subprocess.PIPE, text=True, env=environment())
    while not (out / "summary.json").exists() and process.poll() is None:
        time.sleep(0.005)
    process.send_signal(signal.SIGHUP)
    assert (process.communicate(timeout=120)[1], process.returncode) == ("", 0)
    assert_same_run(out, crowded)


@pytest.mark.parametrize("pause_s", [0.0, 0.003, 0.03])
def test_ctrl_c_five_times_in_a_row_prints_no_traceback(pause_s, tmp_path):
    process = started(CASES / "crowded.toml", tmp_path / "out")
    for _ in range(5):
        process.send_signal(signal.SIGINT)
        time.sleep(pause_s)
    said = process.communicate(timeout=60)[1]
    # a shell says 130 of both: once Python takes itself apart, the system's own answer to Ctrl-C ends the process
    assert process.returncode in (130, -signal.SIGINT)
    assert "Traceback" not in said and "Exception ignored" not in said and said.count("\n") <= 1


def test_a_run_whose_terminal_is_gone_goes_on(tmp_path):
    """Standard error that cannot be written to is no fault of the run."""
    full = Path("/dev/full")
    if not full.exists():
        pytest.skip("no /dev/full")
    with full.open("w") as gone:
        done = subprocess.run(
            command("run", CASES / "crowded.toml", "--out", tmp_path / "out", "--set", "time.duration=0.1"),
            stderr=gone, stdout=subprocess.PIPE, env=environment(), check=False,
        )  # fmt: skip
    assert done.returncode == 0
    assert json.loads((tmp_path / "out" / "summary.json").read_text())["status"] == "completed"


SWEEP = ["sweep", CASES / "crowded.toml", "--vary", "contact.friction=0.1,0.2", "--jobs", "2", "--set", "time.duration=3000.0"]


def test_the_cases_of_a_killed_sweep_save_their_state_and_end(tmp_path):
    out = tmp_path / "sweep"
    sweep = subprocess.Popen(command(*SWEEP, "--out", out), stderr=subprocess.PIPE, text=True, env=environment())
    folders = [out / f"contact.friction={friction}" for friction in ("0.1", "0.2")]
    deadline = time.monotonic() + 240.0
    while not all((folder / "restart.h5").exists() for folder in folders):
        assert sweep.poll() is None, sweep.stderr.read()
        assert time.monotonic() < deadline
        time.sleep(0.02)
    second = in_process(*SWEEP, "--out", out, "--resume")
    assert second.exit_code == 2 and "another process is at work in it" in second.stderr
    sweep.kill()
    sweep.communicate()
    while not all(json.loads((folder / "summary.json").read_text())["status"] == "interrupted" for folder in folders):
        assert time.monotonic() < deadline
        time.sleep(0.02)

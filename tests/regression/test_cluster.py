"""A sweep on a real Dask cluster: a scheduler and two worker processes on this machine, which share no folder with the sweep."""

import csv
import json
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest
from folders import CASES, assert_same_run, command, environment, in_process

from dilatedem.case.load import load
from dilatedem.run import loop

pytest.importorskip("distributed", reason="needs the extra `cluster`")

#: a case takes some seconds where nothing else runs: what is done to it must come before it is over
SETTINGS = ["time.duration=16.0", "output.checkpoint_interval=0.25"]
FRICTIONS = ("0.1", "0.2", "0.3", "0.4")
LONG_S = 240.0  # until a test gives up; machines may be busy


class Processes:
    """A scheduler and workers; `address` of the scheduler."""

    def __init__(self, place: Path):
        self._place, self._file, self._all = place, place / "scheduler.json", []
        self.scheduler = self._start("dask_scheduler", "--host", "127.0.0.1", "--port", "0")
        until(self._file.exists)
        self.address = json.loads(self._file.read_text())["address"]

    def worker(self, name: str) -> subprocess.Popen:
        return self._start("dask_worker", "--nthreads", "1", "--no-nanny", "--local-directory", self._place / name)

    def is_running_a_case(self, name: str) -> bool:
        return any((self._place / name).glob("**/run/restart.h5"))

    def _start(self, program: str, *options) -> subprocess.Popen:
        line = [sys.executable, "-m", f"distributed.cli.{program}", "--scheduler-file", self._file, "--no-dashboard", *options]
        with (self._place / "log").open("ab") as log:
            self._all.append(subprocess.Popen(list(map(str, line)), env=environment(), stdout=log, stderr=log, cwd=self._place))
        return self._all[-1]

    def end(self) -> None:
        for process in self._all:
            process.kill()
            process.wait()


@pytest.fixture(scope="module")
def cluster(tmp_path_factory):
    processes = Processes(tmp_path_factory.mktemp("cluster"))
    yield processes
    processes.end()


def until(done: Callable[[], bool]) -> None:
    deadline = time.monotonic() + LONG_S
    while not done():
        assert time.monotonic() < deadline
        time.sleep(0.02)


def sweep(cluster: Processes, out: Path, frictions=FRICTIONS) -> subprocess.Popen:
    options = [option for setting in SETTINGS for option in ("--set", setting)]
    line = command("sweep", CASES / "crowded.toml", "--vary", f"contact.friction={','.join(frictions)}", *options, "--out", out)
    return subprocess.Popen([*line, "--scheduler", cluster.address], env=environment(), stderr=subprocess.PIPE, text=True)


def statuses(out: Path) -> dict[str, str]:
    if not (out / "sweep.csv").exists():
        return {}
    with open(out / "sweep.csv", newline="", encoding="utf-8") as file:
        return {row["run"]: row["status"] for row in csv.DictReader(file)}


def test_what_was_interrupted_goes_on_and_the_case_of_a_killed_worker_is_run_again(cluster, tmp_path):
    out, first = tmp_path / "sweep", cluster.worker("first")
    process = sweep(cluster, out)
    until(lambda: cluster.is_running_a_case("first"))
    process.send_signal(signal.SIGINT)
    assert "with 0 of 4 cases completed; --resume goes on" in process.communicate(timeout=LONG_S)[1]
    assert process.returncode == 130
    begun = [name for name in statuses(out) if (out / name / "restart.h5").exists()]
    assert len(begun) == 1 and json.loads((out / begun[0] / "summary.json").read_text())["status"] == "interrupted"

    process = sweep(cluster, out)
    until(lambda: cluster.is_running_a_case("first"))
    first.kill()
    cluster.worker("second")
    assert process.communicate(timeout=LONG_S)[1].count(": completed") == 4
    assert process.returncode == 0 and set(statuses(out).values()) == {"completed"}
    for name in (begun[0], list(statuses(out))[-1]):
        case = load(CASES / "crowded.toml", [*SETTINGS, name])
        assert_same_run(out / name, loop.run(case, tmp_path / "runs" / name, quiet=True))


def test_a_lost_scheduler_leaves_what_is_done(tmp_path):
    place = tmp_path / "cluster"
    place.mkdir()
    cluster = Processes(place)
    try:
        cluster.worker("only")
        out = tmp_path / "sweep"
        process = sweep(cluster, out, FRICTIONS[:2])
        until(lambda: "completed" in statuses(out).values())
        cluster.scheduler.kill()
        said = process.communicate(timeout=LONG_S)[1]
    finally:
        cluster.end()
    assert process.returncode == 3
    assert said.splitlines()[-1] == f"{out}: the scheduler {cluster.address} is gone with 1 of 2 cases completed; --resume goes on"
    assert sorted(statuses(out).values()) == ["completed", "waiting"]
    assert "Traceback" not in said, said


def test_no_scheduler_there_is_told_and_nothing_written(tmp_path):
    for address in ("tcp://127.0.0.1:1", "here"):
        done = in_process("sweep", CASES / "crowded.toml", "--seeds", "2", "--scheduler", address, "--out", tmp_path / "sweep")
        assert done.exit_code == 2 and done.stderr.startswith(f"--scheduler {address}: no scheduler answers there (")
        assert done.stderr.count("\n") == 1 and not (tmp_path / "sweep").exists()

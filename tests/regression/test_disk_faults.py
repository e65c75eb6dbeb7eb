"""Whatever call the disk refuses, a command ends with one sentence, and a run goes on from what was saved.

Every function that asks the system for a file is made to fail, here at some of its calls; validation/reliability takes all of them.
"""

import errno
import math
import os
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest
from disk_faults import CASE, DiskFault
from folders import assert_same_run, in_process, without_work
from test_resume import interrupt_after

from dilatedem.case.load import load
from dilatedem.errors import Interrupted
from dilatedem.run import loop

NUMBERS = (
    errno.ENOSPC, errno.EIO, errno.ENAMETOOLONG, errno.EEXIST, errno.ELOOP, errno.ENOENT, errno.EISDIR, errno.EACCES, errno.EROFS,
    errno.ENOTDIR, errno.EDQUOT,
)  # fmt: skip


@pytest.fixture(scope="module")
def case(tmp_path_factory) -> Path:
    path = tmp_path_factory.mktemp("case") / "case.toml"
    path.write_text(CASE)
    return path


@pytest.fixture(scope="module")
def whole(case, tmp_path_factory) -> Path:
    return loop.run(load(case), tmp_path_factory.mktemp("whole") / "run", quiet=True)


@pytest.fixture
def half(case, tmp_path, monkeypatch) -> Path:
    """The same run, interrupted."""
    interrupt_after(monkeypatch, 2)
    with pytest.raises(Interrupted):
        loop.run(load(case), tmp_path / "half", quiet=True)
    monkeypatch.undo()
    return tmp_path / "half"


@pytest.fixture(autouse=True)
def no_lines_now_and_then(monkeypatch):
    """A slow machine is told what is being done on standard error, where faults are looked for."""
    monkeypatch.setattr("dilatedem.commands.manners.LINE_INTERVAL_S", math.inf)


def faults_at(every: int, out: Path, prepare: Callable[[], None], *command):
    """Have the command fail at every so many of its calls, each in a folder that was prepared anew; yields what came of it."""
    shutil.rmtree(out, ignore_errors=True)
    prepare()
    with DiskFault(out) as disk:
        assert in_process(*command).exit_code == 0
    assert disk.count > 10
    for fails in range(0, disk.count, every):
        number = NUMBERS[fails // every % len(NUMBERS)]
        shutil.rmtree(out, ignore_errors=True)
        prepare()
        with DiskFault(out, number, fails) as disk:
            done = in_process(*command)
        what = f"{os.strerror(number)} at call {fails}, {disk.failed}: exit code {done.exit_code}, {done.stderr!r}"
        assert disk.failed, what
        assert done.exit_code in (0, 2, 3), what  # 0: the fault was of a look at something that need not be there
        assert done.exception is None or isinstance(done.exception, SystemExit), what
        assert (done.stderr.count("\n") == 1) if done.exit_code else done.stderr == "", what
        yield done, what


def go_on(case: Path, out: Path, whole: Path, what: str) -> None:
    """What a fault left leads to the same files as if there had been none."""
    way = ["--resume"] if (out / "restart.h5").exists() else ["--overwrite"] if out.exists() else []
    done = in_process("run", case, "--out", out, "--quiet", *way)
    assert done.exit_code == 0, f"{what}; then {done.stderr}"
    assert_same_run(out, whole)


def test_of_a_run(case, whole, tmp_path):
    out, codes = tmp_path / "out", set()
    for done, what in faults_at(13, out, lambda: None, "run", case, "--out", out, "--quiet"):
        codes.add(done.exit_code)
        if done.exit_code == 2:
            assert not out.exists(), what
        if done.exit_code == 3:
            assert "; " in done.stderr and ("--resume" if (out / "restart.h5").exists() else "--overwrite") in done.stderr
            go_on(case, out, whole, what)
    assert codes >= {2, 3}


def test_of_a_resumed_run(case, whole, half, tmp_path):
    out = tmp_path / "out"
    for _, what in faults_at(17, out, lambda: shutil.copytree(half, out), "run", case, "--out", out, "--quiet", "--resume"):
        go_on(case, out, whole, what)


def test_of_a_run_that_replaces_another(case, whole, tmp_path):
    out = tmp_path / "out"
    for _, what in faults_at(41, out, lambda: shutil.copytree(whole, out), "run", case, "--out", out, "--quiet", "--overwrite"):
        go_on(case, out, whole, what)


def test_of_a_field(case, tmp_path):
    out = tmp_path / "out"
    for done, what in faults_at(3, out, lambda: None, "generate", case, "--out", out):
        assert done.exit_code != 2 or not out.exists(), what
        assert in_process("generate", case, "--out", out).exit_code == 0, what


def test_of_figures_and_report(case, whole, tmp_path):
    out = tmp_path / "out"
    for _ in faults_at(37, out, lambda: shutil.copytree(whole, out), "post", out):
        pass


def test_of_a_sweep(case, tmp_path, monkeypatch):
    out = tmp_path / "out"
    without_work(monkeypatch)
    shutil.rmtree(out, ignore_errors=True)
    command = ("sweep", case, "--vary", "contact.friction=0.1,0.2", "--out", out)
    with DiskFault(out) as disk:
        assert in_process(*command).exit_code == 0
    codes = set()
    for fails in range(disk.count):
        shutil.rmtree(out, ignore_errors=True)
        with DiskFault(out, NUMBERS[fails % len(NUMBERS)], fails) as disk:
            done = in_process(*command)
        last = done.stderr.splitlines()[-1]
        assert done.exit_code in (0, 2, 3) and (done.exception is None or isinstance(done.exception, SystemExit)), last
        assert done.exit_code != 3 or last.endswith("; --resume goes on")
        assert done.exit_code != 2 or not out.exists(), last
        codes.add(done.exit_code)
    assert codes == {0, 2, 3}

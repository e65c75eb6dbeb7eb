"""The same case gives the same run: again, from its own case.toml, and on any number of threads."""

import json

import pytest
from folders import CASES, assert_same_run, dilatedem, in_process

from dilatedem.case.load import load
from dilatedem.run import loop


@pytest.mark.parametrize("name", ["crowded", "mixed"])
def test_a_second_run_is_the_same(name, request, tmp_path):
    first = request.getfixturevalue(name)
    loop.run(load(CASES / f"{name}.toml"), tmp_path / name, quiet=True)
    assert_same_run(tmp_path / name, first)


@pytest.mark.parametrize("name", ["crowded", "mixed"])
def test_two_threads_give_the_same_run(name, tmp_path):
    # short: on a busy machine the threads wait for each other in every step
    short = "time.duration=0.8"
    loop.run(load(CASES / f"{name}.toml", [short]), tmp_path / "one", quiet=True)
    done = in_process("run", CASES / f"{name}.toml", "--set", short, "--out", tmp_path / "two", "--threads", 2, "--quiet")
    assert (done.exit_code, done.stderr) == (0, "")
    assert_same_run(tmp_path / "two", tmp_path / "one")
    assert largest_load(tmp_path / "one") > 1e3  # there was something to get wrong


def largest_load(folder) -> float:
    loads = json.loads((folder / "summary.json").read_text())["loads"].values()
    return max(load["fh_max_N"] for load in loads)


def test_the_case_file_of_a_run_repeats_it(crowded, tmp_path):
    done = dilatedem("run", crowded / "case.toml", "--out", tmp_path / "again", "--quiet")
    assert (done.returncode, done.stderr) == (0, "")
    assert_same_run(tmp_path / "again", crowded)


def test_overwriting_leaves_nothing_of_the_run_before(mixed, tmp_path):
    out = tmp_path / "out"
    loop.run(load(CASES / "crowded.toml", ["time.duration=0.5"]), out, quiet=True)
    (out / "figures").mkdir()
    for name in ("force_pile.png", "my_own.png"):
        (out / "figures" / name).touch()
    loop.run(load(CASES / "mixed.toml"), out, overwrite=True, quiet=True)
    assert_same_run(out, mixed)
    assert [path.name for path in (out / "figures").iterdir()] == ["my_own.png"]


def test_a_case_that_a_process_runs_after_another_is_the_same_run(tmp_path):
    settings = ["--set", "time.duration=0.8", "--vary", "contact.friction=0.1,0.2", "--vary", "contact.model=consistent,liu2015"]
    done = dilatedem("sweep", CASES / "crowded.toml", *settings, "--jobs", 1, "--out", tmp_path / "sweep")
    assert done.returncode == 0, done.stderr
    last = tmp_path / "sweep" / "contact.friction=0.2__contact.model=liu2015"
    loop.run(load(last / "case.toml"), tmp_path / "run", quiet=True)
    assert_same_run(last, tmp_path / "run")
    assert largest_load(last) > 1e3

"""Runs that have to stop, and cases that must not start: exit code, one sentence, what is left on disk."""

import json
import re

import h5py
import pytest
from folders import CASES, dilatedem, in_process

from dilatedem.output import checkpoint

FLOE = "[[body]]\noutline = [[{0}, 0.0], [{1}, 0.0], [{1}, 2.0], [{0}, 2.0]]\nvelocity = [{2}, 0.0, 0.0]\n"


def bodies_case(tmp_path, *floes) -> str:
    """A case of drawn floes alone: (x from, x to, speed) of each."""
    path = tmp_path / "bodies.toml"
    path.write_text('[field]\nsource = "bodies"\n\n[time]\nduration = 0.1\n\n' + "\n".join(FLOE.format(*floe) for floe in floes))
    return path


def assert_stopped(done, out, sentence: str) -> dict:
    """The command ended as a simulation that could not go on; returns summary.json."""
    assert done.exit_code == 3
    assert "Traceback" not in done.stderr and done.stderr.count("\n") == 1
    assert re.fullmatch(sentence, done.stderr.strip()), done.stderr
    summary = json.loads((out / "summary.json").read_text())
    assert summary["status"] == "stopped" and summary["message"] == done.stderr.strip()
    groups, meta = checkpoint.load(out / "stopped.h5")
    assert groups.keys() == {"ids", "bodies", "pairs", "hits", "ledger", "loads", "clock", "excursions"}
    assert groups["clock"]["step"][0] == summary["steps"]
    with h5py.File(out / "run.h5") as file:
        assert file["floes/body"][()].size == summary["floes"]
    offsets = {name: kept["offset"] for name, kept in meta["observers"].items() if "offset" in kept}
    assert "energy" in offsets
    for name, offset in offsets.items():
        assert (out / f"{name}.csv").stat().st_size == offset
    return summary


def test_bodies_deep_in_each_other_never_start(tmp_path):
    case, out = bodies_case(tmp_path, (0.0, 2.0, 0.0), (1.0, 3.0, 0.0)), tmp_path / "out"
    done = in_process("run", case, "--out", out, "--quiet")
    assert (done.exit_code, out.exists()) == (2, False)
    head, pair = done.stderr.splitlines()
    assert head.startswith("1 pair of bodies overlaps at t = 0 and would be thrown apart; ")
    assert pair == "  body 0 at (1.00, 1.00) and body 1 at (2.00, 1.00), by 0.5 m"  # the thickness: the shortest way out is up
    assert in_process("check", case).stderr == done.stderr


def test_a_body_that_is_far_too_fast_stops_the_run(tmp_path):
    case, out = bodies_case(tmp_path, (0.0, 2.0, 0.0), (3.0, 5.0, 0.0)), tmp_path / "out"
    falling = ["--set", "gravity.acceleration=1e5", "--set", "water.enabled=false"]
    done = in_process("run", case, *falling, "--out", out, "--quiet")
    moved = r"body [01] at \(\S+, \S+\) moved \S+ m in one step, farther than .*, set time.step to at most \S+ s"
    assert_stopped(done, out, rf"stopped at t = \S+ s: {moved}; the state is saved; .*")


def test_a_run_that_stops_on_its_way_keeps_its_checkpoint_and_its_tables(tmp_path):
    out = tmp_path / "out"
    done = in_process("run", CASES / "soft_ball.toml", "--out", out, "--quiet")
    summary = assert_stopped(
        done, out, r"stopped at t = 0\.00\d+ s: body 0 at \(-\d\.\d\d, -?0\.00\) and body 1 at \(-?0\.00, -?0\.00\) overlap by .*"
    )
    assert summary["simulated_s"] > 0.004 and summary["wall_s"] > 0.0
    groups, _ = checkpoint.load(out / "restart.h5")  # the last good state; the one that failed is beside it
    assert 0 < groups["clock"]["step"][0] < summary["steps"]
    assert len((out / "energy.csv").read_text().splitlines()) > 5
    assert in_process("info", out).exit_code == 0

    # in a process of its own, whose exit code and last words are those that a shell sees
    again = dilatedem("run", CASES / "soft_ball.toml", "--out", out, "--resume", "--quiet")
    assert (again.returncode, again.stderr) == (3, done.stderr)


REFUSED = {
    "wrong key": ("contact.frictoin=0.2", r"contact\.frictoin.*did you mean.*friction"),
    "negative thickness": ("ice.thickness=-0.5", r"ice\.thickness = -0\.5: must be greater than 0"),
    "dilated radius": ("ice.dilated_radius=0.3", r"ice\.dilated_radius = 0\.3: must be at most half the thickness, 0\.25 m"),
    "step above the critical": ("time.step=1e-3", r"time\.step = 0\.001: must be at most the critical step.*time\.step = \"auto\""),
    "unknown model": ('contact.model="hertz"', r"contact\.model = \"?'?hertz.*liu2015.*consistent"),
    "two structures of one name": (
        'structure=[{kind="pile", name="a"}, {kind="pile", name="a"}]', r"structure\.1\.name = \"?a\"?: is the name of structure",
    ),
    "nothing left": ("structure.0.radius=20.0", r"no floe is clear of the structures"),
    "tracked body": ("output.track=[99]", r"output\.track: there is no body 99"),
}  # fmt: skip


@pytest.mark.parametrize("reason", REFUSED)
def test_a_wrong_case_is_refused_in_one_sentence_and_nothing_is_written(reason, tmp_path):
    override, sentence = REFUSED[reason]
    done = in_process("run", CASES / "crowded.toml", "--out", tmp_path / "out", "--set", override)
    assert done.exit_code == 2
    assert re.search(sentence, done.stderr), done.stderr
    assert "Traceback" not in done.stderr and done.stderr.count("\n") == 1
    assert not (tmp_path / "out").exists()


def test_a_folder_that_holds_a_run_is_left_as_it_is(crowded):
    before = {path: (path.stat().st_mtime_ns, path.stat().st_size) for path in crowded.rglob("*")}
    done = in_process("run", CASES / "mixed.toml", "--out", crowded)
    assert done.exit_code == 2 and done.stderr.count("\n") == 1
    assert "holds a run already" in done.stderr and "--overwrite" in done.stderr
    wrong = in_process("run", CASES / "mixed.toml", "--out", crowded, "--overwrite", "--set", "time.step=1e-3")
    assert wrong.exit_code == 2
    assert {path: (path.stat().st_mtime_ns, path.stat().st_size) for path in crowded.rglob("*")} == before

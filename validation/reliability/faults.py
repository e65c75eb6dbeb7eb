"""Every call that a command makes on files, refused by the disk, one at a time; damaged states, one after the other.

    python -m validation.reliability.faults FOLDER COMMAND ENOSPC EVERY    COMMAND: run, resume, overwrite, generate, post, sweep
    python -m validation.reliability.faults FOLDER damage restart.h5 COUNT

in a process of its own, which a crash of a library would end. The last line is what was found, in JSON.
"""

import errno
import json
import os
import shutil
import sys
from pathlib import Path
from random import Random

from pytest import MonkeyPatch

from tests.regression.disk_faults import CASE, DiskFault
from tests.regression.folders import assert_same_run, in_process, without_work

COMMANDS = ("run", "resume", "overwrite", "generate", "post", "sweep")
#: ways to damage a file
DAMAGES = ("a bit turned", "its end cut off", "a block of zeros", "a block of another part of the file", "bytes put in")
BLOCK = 512  # bytes


class Places:
    """The folders that the commands start from, in one folder."""

    def __init__(self, folder: Path):
        self.case, self.whole, self.half, self.out = (folder / name for name in ("case.toml", "whole", "half", "out"))
        if not self.whole.exists():
            folder.mkdir(parents=True, exist_ok=True)
            self.case.write_text(CASE)
            assert in_process("run", self.case, "--out", self.whole, "--quiet").exit_code == 0
            self._interrupt_a_run()

    def _interrupt_a_run(self) -> None:
        """Its disk is full when it wants to save its state for the third time."""
        for fails in range(0, 10_000, 10):
            shutil.rmtree(self.half, ignore_errors=True)
            with DiskFault(self.half, errno.ENOSPC, fails):
                in_process("run", self.case, "--out", self.half, "--quiet")
            summary = self.half / "summary.json"
            if summary.exists() and 0.0 < json.loads(summary.read_text())["simulated_s"] < 0.04:
                return
        raise SystemExit("no call leaves a state on the way")

    def prepare(self, command: str) -> tuple:
        """`out` as the command finds it; returns the command line."""
        shutil.rmtree(self.out, ignore_errors=True)
        begin = {"resume": self.half, "overwrite": self.whole, "post": self.whole}.get(command)
        if begin:
            shutil.copytree(begin, self.out)
        if command == "post":
            return "post", self.out
        if command == "generate":
            return "generate", self.case, "--out", self.out
        if command == "sweep":
            return "sweep", self.case, "--vary", "contact.friction=0.1,0.2", "--out", self.out
        way = {"resume": ["--resume"], "overwrite": ["--overwrite"]}.get(command, [])
        return "run", self.case, "--out", self.out, "--quiet", *way

    def goes_on(self) -> str:
        """Whether what lies in `out` leads to the files of the whole run; what differs, "" for nothing."""
        way = ["--resume"] if (self.out / "restart.h5").exists() else ["--overwrite"] if self.out.exists() else []
        done = in_process("run", self.case, "--out", self.out, "--quiet", *way)
        if done.exit_code:
            return done.stderr
        try:
            assert_same_run(self.out, self.whole)
        except AssertionError as difference:
            return str(difference)
        return ""


def refuse_all(places: Places, command: str, number: int, every: int) -> dict:
    """Refuse one of so many of its calls at a time.

    Returns counts of calls and exit codes, and what was wrong: another end than one sentence, or files that cannot be gone on with.
    """
    without_work(MonkeyPatch())  # a sweep's own files, not those of its cases
    line = places.prepare(command)
    with DiskFault(places.out) as disk:
        in_process(*line)
    found: dict = {"calls": len(range(0, disk.count, every)), "codes": {}, "wrong": []}
    for fails in range(0, disk.count, every):
        line = places.prepare(command)
        with DiskFault(places.out, number, fails) as disk:
            done = in_process(*line)
        found["codes"][str(done.exit_code)] = found["codes"].get(str(done.exit_code), 0) + 1
        told = done.stderr.splitlines()[-1:] if command == "sweep" else done.stderr.splitlines()
        tidy = done.exception is None or isinstance(done.exception, SystemExit)
        wrong = "" if tidy and done.exit_code in (0, 2, 3) and len(told) <= 1 and "Traceback" not in done.stderr else repr(done)
        if not wrong and command in ("run", "resume", "overwrite"):
            wrong = places.goes_on()
        if wrong:
            found["wrong"].append(f"call {fails}, {disk.failed}: {wrong}")
    return found


def damage_all(places: Places, count: int) -> dict:
    """Counts of files that were refused, and of those that were taken: without harm, and with wrong results."""
    random, whole = Random(1), (places.half / "restart.h5").read_bytes()
    found = {"refused": 0, "taken, results right": 0, "taken, results wrong": 0, "wrong": []}
    for number in range(count):
        line = places.prepare("resume")
        data = damaged(whole, DAMAGES[number % len(DAMAGES)], random)
        (places.out / "restart.h5").write_bytes(data)
        before = {path: path.read_bytes() for path in places.out.rglob("*") if path.is_file()}
        done = in_process(*line)
        if done.exit_code == 2 and done.stderr.count("\n") == 1:
            found["refused"] += 1
            if before != {path: path.read_bytes() for path in places.out.rglob("*") if path.is_file()}:
                found["wrong"].append(f"{number}: refused, but something was written")
        elif done.exit_code:
            found["wrong"].append(f"{number}: exit code {done.exit_code}: {done.stderr}")
        else:
            try:
                assert_same_run(places.out, places.whole)
                found["taken, results right"] += 1
            except AssertionError as difference:
                found["taken, results wrong"] += 1
                found["wrong"].append(f"{number}: {difference}")
    return found


def damaged(whole: bytes, way: str, random: Random) -> bytes:
    """A file like this one, but for some bytes at least."""
    while True:
        data, at = bytearray(whole), random.randrange(len(whole))
        if way == "a bit turned":
            data[at] ^= 1 << random.randrange(8)
        elif way == "its end cut off":
            del data[at:]
        elif way == "a block of zeros":
            data[at : at + BLOCK] = bytes(len(data[at : at + BLOCK]))
        elif way == "a block of another part of the file":
            other = random.randrange(len(whole) - BLOCK)
            data[at : at + BLOCK] = whole[other : other + len(data[at : at + BLOCK])]
        else:
            data[at:at] = random.randbytes(random.randrange(1, 9))
        if data != whole:
            return bytes(data)


def main() -> None:
    folder, command, what, count = sys.argv[1:]
    places = Places(Path(folder))
    found = damage_all(places, int(count)) if command == "damage" else refuse_all(places, command, getattr(errno, what), int(count))
    sys.stdout.write(json.dumps(found) + os.linesep)


if __name__ == "__main__":
    main()

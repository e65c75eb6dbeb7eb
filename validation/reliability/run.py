"""Kill runs, damage their states, refuse them the disk, start two in one folder; write what came of it into README.md.

    python -m validation.reliability.run [--kills 100] [--damages 200] [--every 1] [--post-every 1] [--part kills ...]

from the root of the repository. Parts that are not asked for keep their rows.
"""

import argparse
import json
import os
import re
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from random import Random

from tests.regression.folders import environment
from validation.reliability.faults import COMMANDS
from validation.reliability.kills import ENTERING, KINDS, Kind, kill_at_random, second_process

HERE = Path(__file__).parent
FAULTS = ("ENOSPC", "EIO")
WAYS = ("--resume", "--overwrite", "")


def kills(folder: Path, given: argparse.Namespace) -> Iterator[str]:
    """A row a kind of run."""
    yield "| case, sides | model | threads | runs | SIGKILLs | runs that differ |"
    yield "| --- | --- | ---: | ---: | ---: | ---: |"
    for kind, counts in killed(KINDS, folder, given):
        yield f"| {kind.case}, {kind.sides} | `{kind.model}` | {kind.threads} | {counts} |"


def inflow(folder: Path, given: argparse.Namespace) -> Iterator[str]:
    """A row a recipe of ice that enters."""
    yield "| ice that enters | model | threads | floes that came | runs | SIGKILLs | runs that differ |"
    yield "| --- | --- | ---: | ---: | ---: | ---: | ---: |"
    for kind, counts in killed(ENTERING, folder, given):
        came = json.loads((kind.whole(folder) / "summary.json").read_text())["inflow"]["entered"]
        yield f"| {kind.sides} | `{kind.model}` | {kind.threads} | {came} | {counts} |"


def killed(kinds: list[Kind], folder: Path, given: argparse.Namespace) -> Iterator[tuple[Kind, str]]:
    """Kinds of runs, and the numbers of runs, of kills, and of runs that differ, as cells of a row."""
    random = Random(given.seed)
    share = -(-given.kills // len(kinds))
    for kind in kinds:
        kills, runs, wrong = 0, 0, []
        while kills < share:
            here, differs = kill_at_random(kind, folder, random)
            kills, runs = kills + here, runs + 1
            if differs:
                wrong.append(differs)
        report(f"{kind}: {kills} kills, {len(wrong)} differ", wrong)
        yield kind, f"{runs} | {kills} | {len(wrong)}"


def two(folder: Path, given: argparse.Namespace) -> Iterator[str]:
    """A row a way to start the second process."""
    yield "| second process | tried | refused, the first unharmed |"
    yield "| --- | ---: | ---: |"
    for way in WAYS:
        wrong = [said for said in (second_process(kind, folder, way) for kind in KINDS) if said]
        report(f"second process {way}: {len(wrong)} wrong", wrong)
        yield f"| `{' '.join(['run', way]).rstrip()}` | {len(KINDS)} | {len(KINDS) - len(wrong)} |"


def damages(folder: Path, given: argparse.Namespace) -> Iterator[str]:
    yield "| damaged restart.h5 | refused, nothing written | taken, results right | taken, results wrong | else |"
    yield "| ---: | ---: | ---: | ---: | ---: |"
    found = in_a_process(folder, "damage", "restart.h5", given.damages)
    row = " | ".join(str(found[name]) for name in ("refused", "taken, results right", "taken, results wrong"))
    yield f"| {given.damages} | {row} | {len(found['wrong'])} |"


def faults(folder: Path, given: argparse.Namespace) -> Iterator[str]:
    """A row a command and a fault."""
    yield "| command | fault | one of | calls refused | exit code 0 | 2 | 3 | traceback, crash, or other files after going on |"
    yield "| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: |"
    for command in COMMANDS:
        for fault in FAULTS:
            every = given.post_every if command == "post" else given.every
            found = in_a_process(folder, command, fault, every)
            codes = " | ".join(str(found["codes"].get(code, 0)) for code in ("0", "2", "3"))
            yield f"| {command} | {fault} | {every} | {found['calls']} | {codes} | {len(found['wrong'])} |"


def in_a_process(folder: Path, *arguments) -> dict:
    """What `faults` found; a crash of its process is one more thing that is wrong."""
    program = [sys.executable, "-X", "faulthandler", "-m", "validation.reliability.faults"]
    command = [*program, str(folder / "faults"), *map(str, arguments)]
    done = subprocess.run(command, capture_output=True, text=True, env=environment(), check=False)
    if done.returncode:
        raise SystemExit(f"{arguments}: {done.returncode}: {done.stderr}")
    found = json.loads(done.stdout.splitlines()[-1])
    report(f"{arguments}: {found | {'wrong': len(found['wrong'])}}", found["wrong"])
    return found


def report(sentence: str, wrong: list[str]) -> None:
    print(sentence, *wrong[:5], sep="\n    ", flush=True)


def write(part: str, rows: list[str]) -> None:
    """Put the rows between the marks of a part in README.md."""
    page = HERE / "README.md"
    start, end = f"<!-- {part}: written by validation/reliability/run.py -->", f"<!-- end of {part} -->"
    text = page.read_text(encoding="utf-8")
    between = "\n".join([start, "", *rows, "", end])
    page.write_text(re.sub(f"{re.escape(start)}.*?{re.escape(end)}", lambda _: between, text, flags=re.DOTALL), encoding="utf-8")


PARTS = {"kills": kills, "inflow": inflow, "two": two, "damages": damages, "faults": faults}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--kills", type=int, default=100, help="SIGKILLs, shared among the kinds of runs")
    parser.add_argument("--seed", type=int, default=1, help="of the moments of the kills")
    parser.add_argument("--damages", type=int, default=200, help="damaged restart.h5")
    parser.add_argument("--every", type=int, default=1, help="refuse one of so many calls")
    parser.add_argument("--post-every", type=int, default=1, help="the same for `post`, which takes longer")
    parser.add_argument("--part", action="append", choices=tuple(PARTS), help="only these; again for more")
    given = parser.parse_args()
    os.environ.setdefault("OMP_WAIT_POLICY", "PASSIVE")  # two threads that wait asleep, where other programs want the cores
    os.environ.setdefault("GOMP_SPINCOUNT", "0")
    for part in given.part or PARTS:
        with tempfile.TemporaryDirectory() as folder:
            rows: list[str] = []
            for row in PARTS[part](Path(folder), given):
                rows.append(row)
                write(part, rows)  # row by row: all of them take an hour


if __name__ == "__main__":
    main()

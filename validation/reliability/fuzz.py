"""What hostile cases and damaged folders do to the program: a sentence and an exit code, soon, and never a traceback.

    python -m validation.reliability.fuzz [--checks 5000] [--runs 150] [--folders 80] [--seed 1]
                                           [--doors info,post,load] [--minutes M]

from the root of the repository; each part ends after M minutes, with what it has tried. Cases are those of cases/ and tests/cases,
mutated: values replaced by extreme ones or by ones of another type, keys misspelt, left out or invented, tables multiplied, or the
text itself cut and stirred. Each command runs in a fork of this process, which has the kernels already, through the command line's
own entry, under a time limit.
"""

import argparse
import math
import os
import random
import shutil
import signal
import sys
import tempfile
import time
import tomllib
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import dilatedem
from dilatedem.cli import app
from dilatedem.errors import CaseError
from dilatedem.run.loop import compile_kernels
from validation.reliability.damage import damages
from validation.reliability.mutations import mutated_text, mutated_values

HERE = Path(__file__).parent
PAGE, START, END = HERE / "fuzz.md", "<!-- results: written by validation/reliability/fuzz.py -->", "<!-- end of the results -->"
CASES = [*sorted(Path("cases").glob("*.toml")), *sorted(Path("tests/cases").glob("*.toml"))]
#: s after which `check`, `info` and `post` hang; the runs, which may take as long as the case says, are cut to a few steps
LIMIT = {"check": 10.0, "run": 60.0, "info": 10.0, "post": 60.0, "load": 60.0}
ALLOWED = {"check": {0, 2, 3}, "run": {0, 2, 3}, "info": {0, 2}, "post": {0, 2}, "load": {0, 2}}
#: simulated time of a run
DURATION = 2e-3
#: steps of one, at most, where the case makes them short
MOST_STEPS = 1e5


@dataclass
class Tally:
    """Of one command: how often it ended how, the slowest, and what must not be."""

    codes: Counter = field(default_factory=Counter)
    slowest: float = 0.0
    wrong: list[str] = field(default_factory=list)


def in_fork(work: Callable[[], int], limit: float) -> tuple[int, float, str]:
    """Exit code of `work` in a fork of this process, its wall time [s], and all that it printed; code -9 past the limit."""
    with tempfile.TemporaryFile() as said:
        began = time.perf_counter()
        child = os.fork()
        if child == 0:
            os.dup2(said.fileno(), 1)
            os.dup2(said.fileno(), 2)
            os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
            code = 1
            try:
                code = work()
            except SystemExit as error:
                code = error.code if isinstance(error.code, int) else 1
            except BaseException:
                import traceback

                traceback.print_exc()
            finally:
                sys.stdout.flush()
                sys.stderr.flush()
                os._exit(code)
        while True:
            done, status = os.waitpid(child, os.WNOHANG)
            if done:
                break
            if time.perf_counter() - began > limit:
                os.kill(child, signal.SIGKILL)
                _, status = os.waitpid(child, 0)
                break
            time.sleep(0.002)
        took = time.perf_counter() - began
        said.seek(0)
        return os.waitstatus_to_exitcode(status), took, said.read().decode("utf-8", "replace")


def command(*arguments: str) -> Callable[[], int]:
    """The command line with these arguments."""

    def work() -> int:
        sys.argv = ["dilatedem", *arguments]
        app()
        return 0

    return work


def judge(tally: Tally, name: str, what: str, outcome: tuple[int, float, str]) -> None:
    """Note how a command ended, and what was wrong with that."""
    code, took, said = outcome
    tally.codes[code] += 1
    tally.slowest = max(tally.slowest, took)
    faults = []
    if code not in ALLOWED[name]:
        faults.append(f"exit code {code}")
    if "Traceback" in said:
        faults.append("traceback")
    if code in (2, 3) and not said.strip():
        faults.append("not a word")
    if any(ord(character) < 32 and character not in "\n\t\r" for character in said):
        faults.append("control characters")
    if faults:
        tally.wrong.append(f"{name} {what}: {', '.join(faults)} after {took:.1f} s: {said.strip().splitlines()[-1:]}")


def fuzz_cases(rng: random.Random, folder: Path, count: int, name: str, until: float) -> Tally:
    """`check` or `run` of mutated cases; those that are wrong stay in `folder`."""
    tally, texts = Tally(), [path.read_text(encoding="utf-8") for path in CASES]
    for number in range(count):
        if time.monotonic() > until:
            break
        text = rng.choice(texts)
        path = folder / f"{name}_{number:05d}.toml"
        path.write_bytes(mutated_text(rng, text) if name == "check" and rng.random() < 0.3 else mutated_values(rng, text))
        arguments = ["check", str(path)]
        if name == "run":
            out = folder / f"out_{number:05d}"
            arguments = ["run", str(path), "--out", str(out), "--quiet", *_short(path)]
        before = len(tally.wrong)
        judge(tally, name, path.name, in_fork(command(*arguments), LIMIT[name]))
        if len(tally.wrong) == before:
            path.unlink()
        if name == "run":
            shutil.rmtree(out, ignore_errors=True)
    return tally


def _short(path: Path) -> list[str]:
    """Overrides that make a run short, where the case leaves a duration to be set: a step is never longer than the force window."""
    try:
        data = tomllib.loads(path.read_text(encoding="utf-8"))
        tables = [data.get(name, {}) if isinstance(data.get(name, {}), dict) else {} for name in ("time", "output")]
        duration, window = float(tables[0].get("duration", 1.0)), float(tables[1].get("force_interval", 1.0))
    except (ValueError, TypeError):
        return []
    longest = min(DURATION, MOST_STEPS * window) if window > 0.0 else DURATION
    return [] if duration < longest else ["--set", f"time.duration={longest}"]


def fuzz_folders(folder: Path, count: int, seed: int, until: float, doors: list[str]) -> dict[str, Tally]:
    """`info`, `post` and `dilatedem.load` (those that are in `doors`) of run folders with one file damaged each."""
    whole, tallies = folder / "whole", {name: Tally() for name in doors}
    run = ["run", "tests/cases/crowded.toml", "--out", str(whole), "--quiet", "--set", "time.duration=1"]
    code, _, said = in_fork(command(*run), 600.0)
    if code:
        raise SystemExit(f"the run to be damaged ended with exit code {code}: {said}")
    for what, damage in damages(count, seed):
        if time.monotonic() > until:
            break
        for name, tally in tallies.items():
            copy = folder / "damaged"
            shutil.rmtree(copy, ignore_errors=True)
            shutil.copytree(whole, copy)
            damage(copy)
            work = command(name, str(copy)) if name != "load" else lambda copy=copy: _load_all(copy)
            judge(tally, name, what, in_fork(work, LIMIT[name]))
    return tallies


def _load_all(folder: Path) -> int:
    """Everything that Python can ask of a folder; CaseError is the only way to fail."""
    code = 0
    asked: list[Callable] = [
        repr, lambda run: run.forces, lambda run: run.energy, lambda run: run.bodies, lambda run: run.floes,
        lambda run: run.contacts, lambda run: [run.load_map(name) for name in run.load_map_names], lambda run: run.snapshot(0.5),
        lambda run: run.summary,
    ]  # fmt: skip
    for ask in asked:
        try:
            ask(dilatedem.load(folder))
        except CaseError as error:
            print(error)
            code = 2
    return code


def main() -> None:
    """Try it all, write what came of it to the page, and end with exit code 1 where anything was wrong."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    for name, usual in (("checks", 5000), ("runs", 150), ("folders", 80), ("seed", 1)):
        parser.add_argument(f"--{name}", type=int, default=usual)
    parser.add_argument("--doors", default="info,post,load", help="that damaged folders are taken to; post takes seconds")
    parser.add_argument("--minutes", type=float, default=math.inf)
    asked = parser.parse_args()
    if asked.runs or asked.folders:
        for model in ("liu2015", "consistent"):
            compile_kernels(model=model)
        import dilatedem.post.folders  # noqa: F401  (once, here, and not in every fork)

    def until() -> float:
        return time.monotonic() + 60.0 * asked.minutes

    tallies: dict[str, Tally] = {}
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        if asked.checks:
            tallies["`check` of mutated cases"] = fuzz_cases(random.Random(asked.seed), folder, asked.checks, "check", until())
        if asked.runs:
            tallies["`run` of extreme cases"] = fuzz_cases(random.Random(asked.seed + 1), folder, asked.runs, "run", until())
        if asked.folders:
            damaged = fuzz_folders(folder, asked.folders, asked.seed, until(), asked.doors.split(","))
            tallies |= {f"`{name}` of damaged folders": tally for name, tally in damaged.items()}
        wrong = [line for tally in tallies.values() for line in tally.wrong]
        for line in wrong:
            print(line)
        kept = Path("runs/fuzz")
        for path in folder.glob("*.toml"):
            kept.mkdir(parents=True, exist_ok=True)
            shutil.copy(path, kept / path.name)
    write_page(tallies, asked.seed)
    sys.exit(1 if wrong else 0)


def write_page(tallies: dict[str, Tally], seed: int) -> None:
    """The rows of the page's table that were tried, anew; the others stay."""
    text = PAGE.read_text(encoding="utf-8")
    before, after = text.partition(START)[0], text.partition(END)[2]
    kept = [line for line in text.partition(START)[2].partition(END)[0].splitlines() if line.startswith("| `")]
    rows = {line.split("|")[1].strip(): line for line in kept}
    for name, tally in tallies.items():
        counts = " | ".join(str(tally.codes[code]) for code in (0, 2, 3))
        name += f", seed {seed}"
        rows[name] = f"| {name} | {tally.codes.total()} | {counts} | {tally.slowest:.1f} | {len(tally.wrong)} |"
    head = ["| what | tried | exit 0 | exit 2 | exit 3 | slowest, s | wrong |", "| --- | ---: | ---: | ---: | ---: | ---: | ---: |"]
    table = "\n".join([*head, *rows.values()])
    print(table)
    results = f"dilatedem {dilatedem.__version__}.\n\n{table}"
    PAGE.write_text(f"{before}{START}\n\n{results}\n\n{END}{after}", encoding="utf-8")


if __name__ == "__main__":
    main()

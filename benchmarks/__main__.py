"""`python -m benchmarks`, from the repository's root: measure, write results.csv, README.md and pictures."""

import argparse
from collections.abc import Sequence
from pathlib import Path

from benchmarks import others, plots, report, results
from benchmarks.measure import Plan, line, rows_of
from benchmarks.scenes import ALL, MODELS
from benchmarks.targets import targets

HERE = Path(__file__).parent
#: columns of results.csv that say what was measured
CONFIGURATION = ("scene", "model", "size", "threads")
_EXAMPLES = """examples:
  python -m benchmarks                        all scenes, models, sizes and threads (about ten minutes on an idle machine)
  python -m benchmarks --quick                200 floes, one thread; nothing is written unless --out is given
  python -m benchmarks --scenes packed --sizes 200 10000 --threads 1
  python -m benchmarks --start --files        only these two; the page is made anew with the scenes measured before
  python -m benchmarks --all                  everything, the paper's case included
"""


def arguments(given: Sequence[str] | None = None) -> argparse.Namespace:
    """The command line, checked."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks", description="How fast the program is, on fixed scenes. Results replace those of the same "
        "configuration in --out.", epilog=_EXAMPLES, formatter_class=argparse.RawDescriptionHelpFormatter,
    )  # fmt: skip
    which = parser.add_argument_group("scenes (measured unless only other figures are asked for)")
    which.add_argument("--scenes", nargs="+", choices=ALL, metavar="SCENE", help=f"of {', '.join(ALL)}; default all")
    which.add_argument("--models", nargs="+", choices=MODELS, metavar="MODEL", help=f"of {', '.join(MODELS)}; default both")
    which.add_argument("--sizes", nargs="+", type=_positive, metavar="FLOES", help="default 200 2000 10000 100000")
    which.add_argument("--threads", nargs="+", type=_positive, metavar="N", help="default 1 2")
    which.add_argument("--repeats", type=_positive, metavar="N", help="so many in a round; default 2")
    which.add_argument("--rounds", type=_positive, metavar="N", help="best and median of all repeats of so many; default 3")
    which.add_argument("--quick", action="store_true", help="200 floes, one thread, one round unless given otherwise")
    extra = parser.add_argument_group("other figures, each in a process of its own")
    for name, function in others.OTHERS.items():
        extra.add_argument(f"--{name}", action="store_true", help=function.__doc__.partition("\n")[0])
    extra.add_argument("--all", action="store_true", help="the scenes and all of these")
    parser.add_argument("--out", type=Path, metavar="DIR", help="folder of the results; default benchmarks/, with --quick none")
    return parser.parse_args(given)


def _positive(text: str) -> int:
    number = int(text)
    if number < 1:
        raise argparse.ArgumentTypeError("must be at least 1")
    return number


def plan_of(options: argparse.Namespace) -> Plan | None:
    """The scenes to measure; None where only other figures are asked for."""
    chosen = (options.scenes, options.models, options.sizes, options.threads, options.repeats, options.rounds)
    extra = any(getattr(options, name) for name in others.OTHERS)
    if extra and not (options.all or options.quick or any(chosen)):
        return None
    sizes, threads, rounds = ((200,), (1,), 1) if options.quick else (Plan.sizes, Plan.threads, Plan.rounds)
    return Plan(
        tuple(options.scenes or ALL), tuple(options.models or MODELS), tuple(options.sizes or sizes),
        tuple(options.threads or threads), options.repeats or Plan.repeats, options.rounds or rounds,
    )  # fmt: skip


def keep(folder: Path, rows: list[dict], figures: list[dict]) -> tuple[list[dict], list[dict]]:
    """Bring new results into a folder's files; returns all that the folder has now."""
    rows = results.merged(results.read(folder / results.RESULTS), rows, CONFIGURATION)
    figures = results.merged(results.read(folder / results.OTHERS), figures, ("name",))
    if rows:
        results.write(folder / results.RESULTS, rows)
    if figures:
        results.write(folder / results.OTHERS, figures)
    return rows, figures


def make_page(folder: Path, rows: list[dict], figures: list[dict]) -> None:
    """README.md and pictures of a folder of results."""
    if rows:
        plots.cost_by_size(rows, folder / plots.COST)
        plots.cost_by_stage(rows, folder / plots.STAGE)
    report.write_page(rows, figures, folder)


def _print_targets(rows: list[dict], figures: list[dict]) -> None:
    for target in targets(rows, figures):
        if target.value is not None:
            sign, verdict = "at least" if target.at_least else "at most", target.verdict().strip("*")
            print(f"{target.what:48s}{target.value:9.4g} {target.unit:3s} {sign} {target.must:g}, aim {target.aim:g}: {verdict}")


def main(given: Sequence[str] | None = None) -> None:
    """Measure what the command line asks for; results are written as they come, the page and the pictures at the end."""
    options = arguments(given)
    plan = plan_of(options)
    folder = options.out or (None if options.quick else HERE)
    rows, figures = [], []
    for row in rows_of(plan) if plan else ():
        rows = results.merged(rows, [row], CONFIGURATION)
        print(line(row), flush=True)
        if folder:  # at once: an interrupted evening is not lost
            keep(folder, rows, [])
    for name, measure in others.OTHERS.items():
        if options.all or getattr(options, name):
            found = measure()
            figures += found
            for figure in found:
                print(f"{figure['name']:16s}{figure['value']:9.4g} {figure['unit']:3s} {figure['note']}", flush=True)
            if folder:
                keep(folder, [], found)
    if folder:
        rows, figures = keep(folder, rows, figures)
        make_page(folder, rows, figures)
    _print_targets(rows, figures)


if __name__ == "__main__":
    main()

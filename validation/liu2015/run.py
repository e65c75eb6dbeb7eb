"""The paper reproduced: runs its case over ice speeds, floe sizes, contact models and seeds, and writes figures and tables.

    python -m validation.liu2015.run

from the root of the repository. Runs that are done are kept, interrupted ones go on; --report makes the figures of what is
there, at any time, also beside a running command.
"""

import argparse
import signal
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from dilatedem.errors import CaseError
from validation.liu2015 import page
from validation.liu2015.measures import Ensemble, results
from validation.liu2015.plan import MODELS, SEED_COUNT, SPEEDS, plan
from validation.liu2015.runner import Runner, completed, estimate, say

HERE = Path(__file__).parent
RUNS = Path("runs/liu2015")
STOPPED, WRONG = 130, 2


def arguments(given: Sequence[str] | None = None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m validation.liu2015.run", description=__doc__.split("\n\n")[0])
    parser.add_argument("--models", default=",".join(MODELS), help="contact models, joined by commas (%(default)s)")
    parser.add_argument("--speeds", default=",".join(map(str, SPEEDS)), help="ice speeds of the large floes, m/s (%(default)s)")
    parser.add_argument("--seeds", type=int, default=SEED_COUNT, help="ice fields a point (%(default)s)")
    parser.add_argument("--jobs", type=int, default=2, help="runs at a time, of one thread each (%(default)s)")
    parser.add_argument("--hours", type=float, default=0.0, help="start no new run after so long; adds up with --minutes")
    parser.add_argument("--minutes", type=float, default=0.0)
    parser.add_argument("--runs", type=Path, default=RUNS, help="where the run folders are (%(default)s)")
    parser.add_argument("--out", type=Path, default=HERE, help="where README, figures and runs.csv are written (beside this file)")
    parser.add_argument(
        "--set", dest="settings", action="append", default=[], metavar="KEY=VALUE", help="for every run; again for more"
    )
    parser.add_argument("--renew", action="store_true", help="run again what was made with other sources")
    parser.add_argument("--report", action="store_true", help="run nothing; figures and tables of all runs that are done")
    parser.add_argument("--plan", action="store_true", help="run nothing; list the runs and estimate their time")
    asked = parser.parse_args(given)
    asked.models = [model for model in asked.models.split(",") if model]
    if wrong := [model for model in asked.models if model not in MODELS]:
        parser.error(f"--models {wrong[0]}: must be of {', '.join(MODELS)}")
    try:
        asked.speeds = sorted({float(speed) for speed in asked.speeds.split(",") if speed})
    except ValueError:
        parser.error(f"--speeds {asked.speeds}: must be numbers joined by commas, as in 0.1,0.3")
    if not asked.speeds or asked.speeds[0] <= 0.0 or asked.seeds < 1 or asked.jobs < 1:
        parser.error("speeds must be above 0, seeds and jobs at least 1")
    return asked


def report(root: Path, out: Path) -> int:
    """Write the page of all runs that are done; returns the exit code."""
    found = results(root)
    if not found:
        say(f"{root}: holds no completed run yet, so there is nothing to show")
        return 0
    try:
        say(f"{len(found)} completed runs: {page.write(Ensemble(found), out)}")
    except ValueError as fault:
        say(f"{root}: {fault}")
        return WRONG
    return 0


def interrupt(*_: Any) -> None:
    raise KeyboardInterrupt


def main(given: Sequence[str] | None = None) -> int:
    asked = arguments(given)
    runs = plan(asked.models, asked.speeds, asked.seeds)
    waiting = [run for run in runs if not completed(run.folder(asked.runs))]
    seconds = estimate(runs, asked.runs, asked.jobs)
    if asked.plan:
        for run in runs:
            print(f"{'waiting' if run in waiting else 'done':8} {run.name}")
        say(f"{len(runs)} runs, {len(waiting)} of them to do: about {seconds / 60.0:.0f} minutes with {asked.jobs} at a time")
        return 0
    if asked.report:
        return report(asked.runs, asked.out)
    limit = 3600.0 * asked.hours + 60.0 * asked.minutes
    signal.signal(signal.SIGTERM, interrupt)
    say(f"about {seconds / 60.0:.0f} minutes to go" + (f"; no new run after {limit / 60.0:.0f}" if limit else ""))
    runner = Runner(asked.runs, settings=asked.settings, jobs=asked.jobs, limit=limit or None, renew=asked.renew)
    try:
        runner.work(runs)
    except KeyboardInterrupt:
        say("interrupted; the same command goes on")
        return STOPPED
    except (ValueError, CaseError) as fault:
        say(str(fault))
        return WRONG
    return report(asked.runs, asked.out)


if __name__ == "__main__":
    sys.exit(main())

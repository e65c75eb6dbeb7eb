"""How long the automatic step may be: the paper's case at several shares of the critical step, its highest load replayed at dt/4.

    python -m validation.time_step.run [--models M] [--jobs N]

from the root of the repository. Runs that are done are kept.
"""

import argparse
import json
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from itertools import product
from pathlib import Path

import numpy as np

from dilatedem.case.load import load
from dilatedem.output import folder
from dilatedem.run.error_check import TAIL, replay
from dilatedem.run.loop import run
from dilatedem.run.restore import restored

HERE = Path(__file__).parent
RUNS = Path("runs/time_step")
CASE = Path("cases/pile.toml")
START, END = "<!-- results: written by validation/time_step/run.py -->", "<!-- end of the results -->"
MODELS = ("liu2015", "consistent")
FRACTIONS = (0.2, 0.3, 0.4)
#: ice fields
SEEDS = {"liu2015": 10, "consistent": 5}
#: the reference's steps in one step of the run
PARTS = 4


@dataclass(frozen=True)
class Found:
    """What a run of 100 s gave, and the window of its highest load at the run's step and at a quarter of it."""

    peak: float  # N, highest horizontal load
    impulse: float  # N s, along x, over the whole run
    window: dict[str, float]  # of `error_check.replay`, at dt
    reference: dict[str, float]  # the same at dt / PARTS


def made(model: str, fraction: float, seed: int) -> Found:
    """One run; made where it is not there."""
    out = RUNS / model / f"fraction_{fraction:g}" / f"seed_{seed:02d}"
    kept = out / "window.json"
    case = load(CASE, [
        f'contact.model="{model}"', f"field.seed={seed}", f"time.step_fraction={fraction}", "output.snapshot_interval=0",
    ])  # fmt: skip
    if not kept.exists():
        run(case, out, resume=folder.holds_run(out), quiet=True)
        simulation = restored(case, out)
        watch = simulation.state.watch
        end = min(watch.until + round(TAIL / simulation.dt), int(simulation.state.clock.step[0]))
        steps = end - watch.worst.step
        windows = [replay(simulation, steps, parts, lambda: False) for parts in (1, PARTS)]
        kept.write_text(json.dumps(windows))
    window, reference = json.loads(kept.read_text())
    loads = np.genfromtxt(out / "forces.csv", delimiter=",", names=True)
    impulse = float(loads["fx_N"].sum() * case.output.force_interval)
    return Found(float(loads["fh_max_N"].max()), impulse, window, reference)


def change(found: list[Found], name: str) -> tuple[float, float, float]:
    """By what share dt is above dt / PARTS: in the mean over all seeds, in the median, and for the worst seed."""
    at_dt, reference = (np.array([getattr(one, which)[name] for one in found]) for which in ("window", "reference"))
    each = at_dt / reference - 1.0
    return float(at_dt.mean() / reference.mean() - 1.0), float(np.median(each)), float(each[np.abs(each).argmax()])


def spread(values: list[float]) -> str:
    """Mean and its standard error, in thousands."""
    return f"{np.mean(values) / 1e3:.1f} ± {np.std(values, ddof=1) / np.sqrt(len(values)) / 1e3:.1f}"


def table(results: dict[tuple[str, float], list[Found]]) -> str:
    lines = [
        "| model | step / critical | fields | peak: mean, median, worst | impulse: mean, median, worst | peak in 100 s, kN "
        "| impulse in 100 s, kN s |",
        "| --- | ---: | ---: | ---: | ---: | ---: | ---: |",
    ]
    for (model, fraction), found in results.items():
        window = [", ".join(f"{share:+.2%}" for share in change(found, name)) for name in ("fh_max_N", "impulse_h_Ns")]
        whole = [spread([getattr(one, name) for one in found]) for name in ("peak", "impulse")]
        lines.append(
            f"| `{model}` | {fraction:g} | {len(found)} | {window[0]} | {window[1]} | {whole[0]} | {whole[1]} |"
        )
    return "\n".join(lines)


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m validation.time_step.run", description=__doc__.split("\n\n")[0])
    parser.add_argument("--models", default=",".join(MODELS), help="joined by commas (%(default)s)")
    parser.add_argument("--jobs", type=int, default=2, help="runs at a time (%(default)s)")
    asked = parser.parse_args()
    models = asked.models.split(",")
    keys = [key for model in models for key in product([model], FRACTIONS, range(1, SEEDS[model] + 1))]
    with ProcessPoolExecutor(asked.jobs) as pool:
        found = list(pool.map(made, *zip(*keys, strict=True)))
    results: dict[tuple[str, float], list[Found]] = {}
    for (model, fraction, _), one in zip(keys, found, strict=True):
        results.setdefault((model, fraction), []).append(one)
    readme = HERE / "README.md"
    before, _, rest = readme.read_text(encoding="utf-8").partition(START)
    readme.write_text(f"{before}{START}\n\n{table(results)}\n\n{END}{rest.partition(END)[2]}", encoding="utf-8")
    print(table(results))


if __name__ == "__main__":
    main()

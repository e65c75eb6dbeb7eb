"""How long idle floes may step: loads and cost of the paper's case against the longest step of floes that nothing can touch.

    python -m validation.pace.run [FOLDER]

from the root of the repository: one run after another into FOLDER (runs/pace unless given); what is in runs.csv is not made anew.
Processor times are those of the machine that ran them, with whatever else it had to do.
"""

import csv
import io
import sys
import time
from itertools import product
from pathlib import Path
from typing import NamedTuple
from unittest.mock import patch

import matplotlib

matplotlib.use("Agg")
import numpy as np
from matplotlib import pyplot

from dilatedem.case.load import case_from
from dilatedem.files.atomic import write_text
from dilatedem.results.load import load
from dilatedem.run import pace
from dilatedem.run.loop import run
from dilatedem.statistics import Band, difference, mean
from validation.loads.runner import write_between

HERE = Path(__file__).parent
RECORD, PAGE, FIGURE = HERE / "runs.csv", HERE / "README.md", HERE / "pace.png"
CASE = Path("cases/pile.toml")
START, END = "<!-- results: written by validation/pace/run.py -->", "<!-- end of the results -->"
#: s: the short step of all runs; all spans divide the window of forces.csv
STEP, WINDOW = 1.25e-4, 0.032
#: short steps in the longest step of an idle floe; that of the program is 32
SPANS, OWN, SEEDS = (1, 8, 16, 32, 64, 128), 32, range(1, 7)
#: rad/s: heave of a floe of the case, of 1.34 s
HEAVE = 2.0 * np.pi / 1.3402


class Found(NamedTuple):
    """Mean along the current [N], mean peak of load events [N], highest load [N], how many events, and processor time [s]."""

    mean: float
    peaks: float
    highest: float
    events: float
    processor: float


def found(span: int, seed: int, root: Path) -> Found:
    """What a run gives whose idle floes step as long as `span` steps of the others."""
    settings = {
        "time.step": STEP, "output.force_interval": WINDOW, "output.energy_interval": 10.0 * WINDOW,
        "output.snapshot_interval": 0.0, "field.seed": seed, "time.error_check": False,
    }  # fmt: skip
    longest = span * STEP
    with patch.multiple(pace, LONGEST_SPAN=longest, LONGEST_STEP=longest, MOST_SPAN=span):
        began = time.process_time()
        out = run(case_from(CASE, settings), root / f"span_{span}_seed_{seed}", resume=False, overwrite=True, quiet=True)
        took = time.process_time() - began
    told = load(out)
    peaks, loads = told.hits.peak_N.to_numpy(), told.summary["loads"]["pile"]
    return Found(loads["along_mean_N"], float(peaks.mean()), loads["fh_max_N"], len(peaks), took)


def recorded() -> dict[tuple[int, int], Found]:
    """What is noted, by span and seed."""
    if not RECORD.exists():
        return {}
    with RECORD.open(newline="") as file:
        return {(int(span), int(seed)): Found(*map(float, rest)) for span, seed, *rest in list(csv.reader(file))[1:]}


def record(known: dict[tuple[int, int], Found]) -> None:
    table = io.StringIO()
    heads = ("steps_in_a_span", "seed", "mean_N", "mean_peak_N", "highest_N", "events", "processor_s")
    rows = [[*key, *(f"{value:.6g}" for value in told)] for key, told in sorted(known.items())]
    csv.writer(table, lineterminator="\n").writerows([heads, *rows])
    write_text(RECORD, table.getvalue())


def collected(root: Path) -> dict[tuple[int, int], Found]:
    """Of all runs; those that are not noted are made, the spans of a field in turn, so that a busy hour slows all of them."""
    known = recorded()
    for seed, span in product(SEEDS, SPANS):
        if (span, seed) not in known:
            known[span, seed] = found(span, seed, root)
            record(known)
            print(span, seed, known[span, seed], flush=True)
    return known


def of_span(known: dict, span: int, what: str) -> np.ndarray:
    """(seeds,) of a figure."""
    return np.array([getattr(known[span, seed], what) for seed in SEEDS])


def rows(known: dict) -> list[str]:
    lines = [
        "| longest step of idle floes, ms | mean along the current, kN | mean peak of events, kN | highest, kN | load events "
        "| processor time over that of 4 ms | heave: frequency wrong by |",
        "| ---: | ---: | ---: | ---: | ---: | ---: | ---: |",
    ]
    for span in SPANS:
        cells = [said(mean(scale * of_span(known, span, what))) for what, scale in (
            ("mean", 1e-3), ("peaks", 1e-3), ("highest", 1e-3), ("events", 1.0),
        )]  # fmt: skip
        cost = np.median(of_span(known, span, "processor") / of_span(known, OWN, "processor"))
        wrong = (HEAVE * span * STEP) ** 2 / 24.0
        lines.append(f"| {1e3 * span * STEP:g} | {' | '.join(cells)} | {cost:.2f} | {wrong:.0e} |")
    return [*lines, "", *verdict(known)]


def said(told: Band) -> str:
    return f"{told.value:.3g} ({told.low:.3g} to {told.high:.3g})"


def verdict(known: dict) -> list[str]:
    """Which spans load differently from steps of one length, beyond chance, and what the longest ones save."""
    shortest, differing = SPANS[0], []
    for span, (what, named) in product(SPANS[1:], {"mean": "mean", "peaks": "mean peak", "highest": "highest"}.items()):
        between = difference(of_span(known, span, what), of_span(known, shortest, what))
        if not between.low <= 0.0 <= between.high:
            low, value, high = (1e-3 * each for each in (between.low, between.value, between.high))
            differing.append(f"{named} at {1e3 * span * STEP:g} ms ({value:+.2g}, {low:+.2g} to {high:+.2g} kN)")
    cost = {span: float(np.median(of_span(known, span, "processor") / of_span(known, OWN, "processor"))) for span in SPANS}
    tested = 3 * (len(SPANS) - 1)
    told = "; ".join(differing) if differing else "none"
    longest = SPANS[-1]
    return [
        f"- Loads that differ from those of one pace, beyond 95 % of chance (of {tested} looked at, of which chance alone passes "
        f"{0.05 * tested:.1g}): {told}.",
        f"- Against steps of 4 ms, one pace costs {cost[shortest]:.2f} times as much, and steps of {1e3 * longest * STEP:g} ms "
        f"{cost[longest]:.2f} times.",
    ]


def draw(known: dict) -> None:
    figure, panels = pyplot.subplots(1, 4, figsize=(11.0, 3.2), layout="constrained")
    ways = 1e3 * STEP * np.array(SPANS)
    shown = (("mean", 1e-3, "mean along the current (kN)"), ("peaks", 1e-3, "mean peak of events (kN)"),
             ("highest", 1e-3, "highest load (kN)"), ("processor", 1.0, "processor time of 100 s (s)"))  # fmt: skip
    for axes, (what, scale, label) in zip(panels, shown, strict=True):
        values = [scale * of_span(known, span, what) for span in SPANS]
        for way, some in zip(ways, values, strict=True):
            axes.plot(np.full(len(some), way), some, ".", color="#0072B2", alpha=0.4)
        bands = [mean(some) for some in values]
        reach = np.array([[each.value - each.low, each.high - each.value] for each in bands]).T
        axes.errorbar(ways, [each.value for each in bands], reach, color="#0072B2", capsize=3, marker="_")
        axes.axvline(1e3 * OWN * STEP, color="#D55E00", linewidth=1.0, linestyle="--")
        axes.set(xscale="log", xlabel="longest step of idle floes (ms)", ylabel=label, ylim=(0.0, None))
        axes.set_xticks(ways, [f"{way:g}" for way in ways])
        axes.minorticks_off()
        axes.grid(alpha=0.3)
    figure.savefig(FIGURE, dpi=110)


def main(root: Path) -> None:
    known = collected(root)
    draw(known)
    write_between(PAGE, START, END, "\n".join([*rows(known), "", "![Loads and cost against the longest step](pace.png)"]))


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "runs/pace"))

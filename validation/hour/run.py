"""An hour of ice, whether it stays what it was, and what its loads say: `cases/hour.toml`.

    python -m validation.hour.run [FOLDER] [--as-is | --speed]

from the root of the repository: two runs of it into FOLDER (runs/hour unless given), some minutes each, one in one piece and one
that is killed on the way; those that are there are taken as they are. Keeps their numbers in record.json, and writes table and
figure of README.md by these. With --as-is the numbers that are kept are taken; with --speed, too, but for the processor time, which
is measured anew (some minutes, on a machine that does nothing else).
"""

import argparse
import math
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import numpy as np
from matplotlib import pyplot

from validation.hour.record import BLOCK, QUARTERS, RISE, measured, recorded, timed
from validation.hour.runs import KILLS, SAMPLE
from validation.loads.runner import write_between

HERE = Path(__file__).parent
PAGE, FIGURE = HERE / "README.md", HERE / "hour.png"
START, END = "<!-- results: written by validation/hour/run.py -->", "<!-- end of the results -->"
#: of Student's distribution with 11 degrees of freedom, 97.5 %; of chi squared with 3, 95 %
STUDENT, CHI2 = 2.201, 7.815
CONCENTRATION = 0.64
#: share of the hour after which a run has taken what memory it takes
WARM = 0.1


def agree(means: np.ndarray, errors: np.ndarray) -> tuple[float, float]:
    """Their weighted mean, and chi squared of their differences from it."""
    weight = 1.0 / errors**2
    mean = float((weight * means).sum() / weight.sum())
    return mean, float((((means - mean) / errors) ** 2).sum())


def quarters(record: dict) -> tuple[list[str], list[str]]:
    """Rows of the table of quarters, and rows of verdicts."""
    found = record["blocks"]
    count = found.shape[1]
    length = count * BLOCK
    peaks = [peaks_of(record, q) for q in range(QUARTERS)]
    counts = np.array([len(some) for some in peaks], float)
    mean, error = found.mean(axis=1), found.std(axis=1, ddof=1) / math.sqrt(count)
    rows = ["| quarter | mean along the current, kN | mean of the highest of a block, kN | load events | their mean peak, kN |",
            "| --- | ---: | ---: | ---: | ---: |"]  # fmt: skip
    peak_mean = np.array([some.mean() for some in peaks])
    peak_error = np.array([some.std(ddof=1) / math.sqrt(len(some)) for some in peaks])
    for q in range(QUARTERS):
        band = [f"{mean[q, k] / 1e3:.3g} ± {STUDENT * error[q, k] / 1e3:.2g}" for k in range(2)]
        span = f"{RISE + q * length:.0f} to {RISE + (q + 1) * length:.0f} s"
        told = f"{counts[q]:.0f} ± {1.96 * math.sqrt(counts[q]):.0f}"
        rows.append(f"| {span} | {' | '.join(band)} | {told} | {peak_mean[q] / 1e3:.3g} ± {1.96 * peak_error[q] / 1e3:.2g} |")
    verdicts = []
    for name, values, errors in (
        ("mean along the current", mean[:, 0], error[:, 0]), ("highest of a block", mean[:, 1], error[:, 1]),
        ("number of load events", counts, np.sqrt(counts)), ("mean peak of load events", peak_mean, peak_error),
    ):  # fmt: skip
        chi2 = agree(values, errors)[1]
        verdicts.append(f"| quarters agree: {name}, χ² of 3 | {chi2:.2f} | below {CHI2} (95 %) | {said(chi2 < CHI2)} |")
    return rows, verdicts


def peaks_of(record: dict, quarter: int) -> np.ndarray:
    """(n,) [N] peaks of the load events of a quarter."""
    times, peaks = record["hits"]
    length = record["blocks"].shape[1] * BLOCK
    return peaks[(times > RISE) & (np.floor((times - RISE) / length) == quarter)]


def said(holds: bool) -> str:
    return "yes" if holds else "NO"


def table(record: dict) -> list[str]:
    """Rows of Markdown."""
    (_, shares), memory, inflow = record["upstream"], record["memory"], record["inflow"]
    warm = memory[memory[:, 0] > WARM * record["simulated_s"]]
    early, late = np.median(warm[: len(warm) // 5, 1]), np.median(warm[-(len(warm) // 5) :, 1])
    off, growth, other = np.abs(shares / CONCENTRATION - 1.0).max(), late / early - 1.0, record["differing"]
    busy, residual = record["processor_s"], record["residual_over_work"]
    rows, verdicts = quarters(record)
    facts = [
        f"| processor time, {record['steps']} steps, by the first {SAMPLE:.0f} s, s | {busy:.0f} | 300 | {said(busy < 300.0)} |",
        f"| ice that came, m | {inflow['ice_m']:.0f} | {0.3 * record['simulated_s']:.0f} | {said(inflow['waited_s'] == 0.0)} |",
        f"| floes that entered, left, were left out | {inflow['entered']}, {inflow['left']}, {inflow['omitted']} | | |",
        f"| concentration upstream: farthest from {CONCENTRATION} | {100 * off:.2f} % | 1 % | {said(off < 0.01)} |",
        f"| ... its mean, and spread | {shares.mean():.4f}, {shares.std():.4f} | | |",
        f"| memory, MB, and growth from the first to the last fifth | {late / 1e6:.0f}, {100 * growth:+.2f} % | 1 % | "
        f"{said(abs(growth) < 0.01)} |",
        f"| files of the run killed {KILLS} times that differ | {len(other)} | 0 | {said(not other)} |",
        f"| residual of the ledger over the work of the current | {residual:.1e} | 1e-4 | {said(residual < 1e-4)} |",
    ]
    head = ["| quantity | result | asked | met |", "| --- | ---: | ---: | --- |"]
    return [*head, *facts, *verdicts, "", *rows]


def draw(record: dict) -> None:
    (times, shares), memory, found = record["upstream"], record["memory"], record["blocks"]
    figure, ((one, two), (three, four)) = pyplot.subplots(2, 2, figsize=(10.0, 6.4), constrained_layout=True)
    one.axhspan(0.99 * CONCENTRATION, 1.01 * CONCENTRATION, color="0.9", label="within 1 %")
    one.plot(times, shares, color="C0", linewidth=1.0)
    one.set(xlabel="Time (s)", ylabel="Concentration upstream", ylim=(0.97 * CONCENTRATION, 1.03 * CONCENTRATION))
    one.legend(loc="upper right")
    count = found.shape[1]
    middle = RISE + BLOCK * (np.arange(QUARTERS * count) + 0.5)
    two.plot(middle, found[:, :, 0].ravel() / 1e3, ".", color="C0", label=f"blocks of {BLOCK:.0f} s")
    for q in range(QUARTERS):
        values = found[q, :, 0] / 1e3
        half = STUDENT * values.std(ddof=1) / math.sqrt(count)
        ends = RISE + BLOCK * count * np.array([q, q + 1])
        two.fill_between(ends, values.mean() - half, values.mean() + half, alpha=0.3, color=f"C{q}")
    two.set(xlabel="Time (s)", ylabel="Mean load along the current (kN)", ylim=(0.0, None))
    two.legend(loc="upper right")
    for q in range(QUARTERS):
        peaks = np.sort(peaks_of(record, q))[::-1] / 1e3
        higher = np.arange(1, len(peaks) + 1) * 3600.0 / (BLOCK * count)
        three.step(peaks, higher, where="post", color=f"C{q}", label=f"quarter {q + 1}")
    three.set(xlabel="Peak of a load event (kN)", ylabel="Higher events an hour", yscale="log")
    three.legend(loc="upper right")
    four.plot(memory[:, 0], memory[:, 1] / 1e6, color="C0", linewidth=1.0)
    four.set(xlabel="Time (s)", ylabel="Resident memory (MB)", ylim=(0.0, None))
    for panel in (one, two, three, four):
        panel.grid(color="0.9", linewidth=0.6)
    figure.savefig(FIGURE, dpi=110)


def main(folder: Path, as_is: bool, speed: bool) -> None:
    """Run what is not there, unless the record is taken `as_is` or with its `speed` anew, and write the page."""
    record = recorded() if as_is else timed(folder) if speed else measured(folder)
    draw(record)
    text = "\n".join([*table(record), "", "![Concentration, load, events and memory of the hour](hour.png)", ""])
    write_between(PAGE, START, END, text)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", nargs="?", type=Path, default=Path("runs/hour"))
    parser.add_argument("--as-is", action="store_true")
    parser.add_argument("--speed", action="store_true")
    args = parser.parse_args()
    main(args.folder, args.as_is, args.speed)

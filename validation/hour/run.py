"""An hour of ice, whether it stays what it was, and what its loads say: `cases/hour.toml`.

    python -m validation.hour.run [FOLDER]

from the root of the repository: two runs of it into FOLDER (runs/hour unless given), some minutes each, one in one piece and one
that is killed on the way; those that are there are taken as they are. Writes table and figure of README.md.
"""

import json
import math
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import numpy as np
import shapely
from matplotlib import pyplot

from dilatedem.results.load import load
from validation.hour.runs import KILLS, MEMORY, SAMPLE, differing, in_parts, processor_time, whole

HERE = Path(__file__).parent
PAGE, FIGURE = HERE / "README.md", HERE / "hour.png"
START, END = "<!-- results: written by validation/hour/run.py -->", "<!-- end of the results -->"
#: s at the start that are left out: until then ice that starts undisturbed runs past the pile, and a wedge builds up ahead of it
RISE = 240.0
#: s of the blocks that bands are made from; several floes pass in one
BLOCK = 70.0
QUARTERS = 4
#: of Student's distribution with 11 degrees of freedom, 97.5 %; of chi squared with 3, 95 %
STUDENT, CHI2 = 2.201, 7.815
#: m, x between which the ice upstream is weighed, and snapshots before and after one that are weighed with it
BAND, BESIDE = (-25.0, -15.0), 3
CONCENTRATION = 0.64
#: share of the hour after which a run has taken what memory it takes
WARM = 0.1


def upstream(run) -> tuple[np.ndarray, np.ndarray]:
    """Times (n,) [s] of the snapshots, and the concentration upstream.

    In slices of a metre across the drift, weighed by a squared cosine over the band, and by another over the snapshots beside: of
    the ice that goes by. Sharp ends would cut floes in halves, and say more about these than about the ice. Outlines of the
    snapshots are those of prisms of equal volume, which cover a little less than the floes do; that is made up for.
    """
    last = run.snapshot(run.summary["simulated_s"])
    drawn = np.array([shapely.Polygon(outline).area for outline in last.outlines])
    rounded = run.floes.loc[last.body, "plan_area_m2"].to_numpy().sum() / drawn.sum()
    edges = np.linspace(*BAND, round(BAND[1] - BAND[0]) + 1)
    weight = bell(len(edges) - 1)
    slices = shapely.box(edges[:-1], -25.0, edges[1:], 25.0)
    times, shares = np.arange(0.0, run.summary["simulated_s"] + 1.0, run.case["output"]["snapshot_interval"]), []
    for time in times:
        ice = np.array([shapely.Polygon(outline) for outline in run.snapshot(time).outlines])
        ice = np.concatenate([shapely.transform(ice, lambda xy, by=y: xy + [0.0, by]) for y in (-50.0, 0.0, 50.0)])
        near, which = shapely.STRtree(slices).query(ice)
        covered = np.zeros(len(slices))
        np.add.at(covered, which, shapely.area(shapely.intersection(ice[near], slices[which])))
        shares.append(rounded * float(weight @ covered / 50.0))
    return times[BESIDE:-BESIDE], np.convolve(shares, bell(2 * BESIDE + 1), "valid")


def bell(count: int) -> np.ndarray:
    """(count,) weights that fall off to nothing as a squared cosine does; they add up to 1."""
    weight = np.cos(math.pi * ((np.arange(count) + 0.5) / count - 0.5)) ** 2
    return weight / weight.sum()


def blocks(forces, duration: float) -> np.ndarray:
    """(quarters, blocks, 2) [N] of the load on the pile: its mean along the current, and its highest, of every block."""
    count = int((duration - RISE) / QUARTERS / BLOCK)
    rows = forces[forces.structure == "pile"]
    number = np.floor((rows.time_s.to_numpy() - RISE - 1e-6) / BLOCK).astype(int)
    found = np.zeros((QUARTERS * count, 2))
    for k in range(QUARTERS * count):
        some = rows[number == k]
        found[k] = some.fx_N.mean(), some.fh_max_N.max()
    return found.reshape(QUARTERS, count, 2)


def agree(means: np.ndarray, errors: np.ndarray) -> tuple[float, float]:
    """Their weighted mean, and chi squared of their differences from it."""
    weight = 1.0 / errors**2
    mean = float((weight * means).sum() / weight.sum())
    return mean, float((((means - mean) / errors) ** 2).sum())


def quarters(run) -> tuple[list[str], list[str], np.ndarray]:
    """Rows of the table of quarters, rows of verdicts, and the blocks."""
    found = blocks(run.forces, run.summary["simulated_s"])
    count = found.shape[1]
    length = count * BLOCK
    hits = run.hits
    hits = hits[(hits.structure == "pile") & (hits.peak_time_s > RISE)]
    number = ((hits.peak_time_s - RISE) / length).astype(int)
    peaks = [hits.peak_N[number == q] for q in range(QUARTERS)]
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
    return rows, verdicts, found


def said(holds: bool) -> str:
    return "yes" if holds else "NO"


def table(folder: Path, run, parts: Path) -> tuple[list[str], tuple]:
    """Rows of Markdown, and what the figure shows."""
    summary = run.summary
    times, shares = upstream(run)
    memory = np.array(json.loads((folder / MEMORY).read_text()))
    warm = memory[memory[:, 0] > WARM * summary["simulated_s"]]
    early, late = np.median(warm[: len(warm) // 5, 1]), np.median(warm[-(len(warm) // 5) :, 1])
    off = np.abs(shares / CONCENTRATION - 1.0).max()
    growth = late / early - 1.0
    other = differing(run.path, parts)
    rows, verdicts, found = quarters(run)
    busy = processor_time(folder)
    inflow, energy = summary["inflow"], summary["energy"]
    facts = [
        f"| processor time, {summary['steps']} steps, by the first {SAMPLE:.0f} s, s | {busy:.0f} | 300 | {said(busy < 300.0)} |",
        f"| ice that came, m | {inflow['ice_m']:.0f} | {0.3 * summary['simulated_s']:.0f} | {said(inflow['waited_s'] == 0.0)} |",
        f"| floes that entered, left, were left out | {inflow['entered']}, {inflow['left']}, {inflow['omitted']} | | |",
        f"| concentration upstream: farthest from {CONCENTRATION} | {100 * off:.2f} % | 1 % | {said(off < 0.01)} |",
        f"| ... its mean, and spread | {shares.mean():.4f}, {shares.std():.4f} | | |",
        f"| memory, MB, and growth from the first to the last fifth | {late / 1e6:.0f}, {100 * growth:+.2f} % | 1 % | "
        f"{said(abs(growth) < 0.01)} |",
        f"| files of the run killed {KILLS} times that differ | {len(other)} | 0 | {said(not other)} |",
        f"| residual of the ledger over the work of the current | {energy['residual_over_work']:.1e} | 1e-4 | "
        f"{said(energy['residual_over_work'] < 1e-4)} |",
    ]
    head = ["| quantity | result | asked | met |", "| --- | ---: | ---: | --- |"]
    return [*head, *facts, *verdicts, "", *rows], (times, shares, memory, found, run)


def draw(times: np.ndarray, shares: np.ndarray, memory: np.ndarray, found: np.ndarray, run) -> None:
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
    hits, length = run.hits, BLOCK * count
    for q in range(QUARTERS):
        inside = (hits.structure == "pile") & (hits.peak_time_s > RISE + q * length) & (hits.peak_time_s <= RISE + (q + 1) * length)
        peaks = np.sort(hits.peak_N[inside])[::-1] / 1e3
        three.step(peaks, np.arange(1, len(peaks) + 1) * 3600.0 / length, where="post", color=f"C{q}", label=f"quarter {q + 1}")
    three.set(xlabel="Peak of a load event (kN)", ylabel="Higher events an hour", yscale="log")
    three.legend(loc="upper right")
    four.plot(memory[:, 0], memory[:, 1] / 1e6, color="C0", linewidth=1.0)
    four.set(xlabel="Time (s)", ylabel="Resident memory (MB)", ylim=(0.0, None))
    for panel in (one, two, three, four):
        panel.grid(color="0.9", linewidth=0.6)
    figure.savefig(FIGURE, dpi=110)


def main(folder: Path) -> None:
    """Run what is not there, and write the page."""
    folder.mkdir(parents=True, exist_ok=True)
    out, parts = whole(folder), in_parts(folder)
    rows, shown = table(folder, load(out), parts)
    draw(*shown)
    before, _, rest = PAGE.read_text(encoding="utf-8").partition(START)
    text = "\n".join([START, "", *rows, "", "![Concentration, load, events and memory of the hour](hour.png)", ""])
    PAGE.write_text(f"{before}{text}\n{END}{rest.partition(END)[2]}", encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "runs/hour"))

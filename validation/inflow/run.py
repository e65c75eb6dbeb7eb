"""Ice that enters, by each recipe, against what is asked for and against fields that end: statistics, and how it looks.

    python -m validation.inflow.run

from the root of the repository, some minutes. Writes table and figures of README.md.
"""

from dataclasses import dataclass
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import numpy as np
from matplotlib import pyplot
from matplotlib.collections import PolyCollection
from matplotlib.ticker import NullFormatter

from dilatedem.case.load import load
from dilatedem.case.schema import Case
from dilatedem.field.distribution import Moments
from dilatedem.geometry.outline import area
from dilatedem.scene.ice import ice_of_stream
from dilatedem.scene.inflow import stream_of
from dilatedem.scene.recipe import recipe_of
from dilatedem.scene.room import generated_floes
from validation.loads.runner import write_between

HERE = Path(__file__).parent
PAGE, START, END = HERE / "README.md", "<!-- results: written by validation/inflow/run.py -->", "<!-- end of the results -->"
#: m, extent of the domain both ways; blocks that are looked at, and as many fields that end; seeds of these begin here
SIZE, BLOCKS, SEED = 30.0, 6, 100
#: of Student's distribution with 5 degrees of freedom, 97.5 %
STUDENT = 2.571
CONCENTRATION = 0.7
RECIPES = {
    "random points": "",
    "regularity 5": ", regularity = 5",
    "squares": ', shape = "square"',
    "hexagons": ', shape = "hexagon"',
    "power law, 1.5 to 6 m": ', size_distribution = {kind = "power_law", exponent = 1.9, min = 1.5, max = 6.0}',
    "lognormal, spread 0.4": ', size_distribution = {kind = "lognormal", spread = 0.4}',
}
#: of the mean thickness
THICKNESS_SPREAD = 0.2


@dataclass
class Found:
    """Of a recipe: outlines [m], sizes [m] and thicknesses [m] of floes; areas (blocks, cells) [m2] of cells, as they enter and of
    fields that end; ice over ground; the case."""

    outlines: list
    size: np.ndarray
    thickness: np.ndarray
    cells: np.ndarray
    ends: np.ndarray
    concentration: float
    case: Case


def case_of(recipe: str) -> Case:
    field = f"field={{concentration = {CONCENTRATION}{recipe}}}"
    return load("cases/hour.toml", [f"domain.size=[{SIZE},{SIZE}]", field, f"ice.thickness_spread={THICKNESS_SPREAD}"])


def found(recipe: str) -> Found:
    case = case_of(recipe)
    count, size, whole = generated_floes(case), np.array(case.domain.size), (True, True)
    stream = stream_of(case, count)
    numbers = range(BLOCKS * round(SIZE / stream.width))
    floes = stream.floes(numbers)
    cells = np.array([area(cell) for number in numbers for cell in stream._cells.of(number)])
    made = recipe_of(case)
    ends = [
        [area(cell) for cell in made.nuclei(size, count, whole, np.random.default_rng(SEED + k)).cells(size, whole)]
        for k in range(BLOCKS)
    ]
    thickness = ice_of_stream(case, stream, floes.which).thickness
    share = float(floes.plan_area.sum() / cells.sum())
    return Found(list(floes.outlines), np.sqrt(floes.plan_area), thickness, cells.reshape(BLOCKS, -1), np.array(ends), share, case)


def spreads(areas: np.ndarray) -> tuple[float, float]:
    """The deviation of areas (fields, cells) over their mean, and half the width of its 95 % band over the fields."""
    each = areas.std(axis=1) / areas.mean()
    return float(each.mean()), float(STUDENT * each.std(ddof=1) / np.sqrt(len(each)))


def sizes(some: Found) -> str:
    """Mean size and deviation, found and asked for [m]."""
    reached, distribution = Moments.of_areas(some.size**2), some.case.field.size_distribution
    told = f"{reached.mean:.3f}, {reached.deviation:.3f}"
    if distribution is None:
        return f"{told} | "
    asked = distribution.moments(some.case.field.asked_size)
    return f"{told} | {asked.mean:.3f}, {asked.deviation:.3f}"


def table(all_found: dict[str, Found]) -> list[str]:
    """Rows of Markdown."""
    rows = ["| recipe | floes | concentration | spread of cell areas | of fields that end | agree | size and deviation, m | "
            "asked, m | thickness, m, and spread |", "| --- | ---: | ---: | ---: | ---: | --- | ---: | ---: | ---: |"]  # fmt: skip
    for name, some in all_found.items():
        (entered, band), (ends, other) = spreads(some.cells), spreads(some.ends)
        agree = "yes" if abs(entered - ends) <= max(np.hypot(band, other), 2e-3) else "NO"
        thickness = f"{some.thickness.mean():.4f}, {some.thickness.std() / some.thickness.mean():.4f}"
        rows.append(
            f"| {name} | {len(some.size)} | {some.concentration:.4f} | {entered:.4f} ± {band:.4f} | {ends:.4f} ± {other:.4f} | "
            f"{agree} | {sizes(some)} | {thickness} |"
        )
    return rows


def draw_plans(all_found: dict[str, Found]) -> None:
    """Three domains of ice as it enters, its thickness in grey; where blocks meet is marked at the sides alone."""
    figure, panels = pyplot.subplots(len(all_found), 1, figsize=(9.0, 2.15 * len(all_found)), constrained_layout=True)
    for panel, (name, some) in zip(panels, all_found.items(), strict=True):
        floes = PolyCollection(some.outlines, array=some.thickness, cmap="Blues", edgecolor="0.3", linewidth=0.3)
        panel.add_collection(floes)
        # strip 0 lies downstream, at x = +15 m, and what comes later at lower x
        panel.set(xlim=(-2.5 * SIZE, 0.5 * SIZE), ylim=(-0.5 * SIZE, 0.5 * SIZE), aspect="equal", title=name, ylabel="y (m)")
        for end in (-1.5 * SIZE, -0.5 * SIZE):
            panel.plot([end, end], [-0.5 * SIZE, -0.45 * SIZE], "C3", linewidth=2.0)
            panel.plot([end, end], [0.45 * SIZE, 0.5 * SIZE], "C3", linewidth=2.0)
    panels[-1].set_xlabel("x (m), at t = 0")
    figure.savefig(HERE / "plans.png", dpi=90)


def draw_sizes(all_found: dict[str, Found]) -> None:
    """How many floes are larger than a size, beside what is asked for."""
    chosen = {name: some for name, some in all_found.items() if some.case.field.size_distribution is not None}
    figure, panels = pyplot.subplots(1, len(chosen), figsize=(9.0, 3.4), constrained_layout=True)
    for panel, (name, some) in zip(panels, chosen.items(), strict=True):
        count, size = len(some.size), some.case.field.asked_size
        asked = np.sqrt(size**2 * some.case.field.size_distribution.shares(count))
        share = np.arange(count, 0, -1) / count
        panel.step(np.sort(asked), share, where="post", color="0.6", linewidth=3.0, label="asked")
        panel.step(np.sort(some.size), share, where="post", color="C0", linewidth=1.0, label="entered")
        panel.set(xscale="log", yscale="log", xlabel="Floe size (m)", ylabel="Share of larger floes", title=name)
        panel.set_xticks([1.0, 2.0, 4.0, 6.0], ["1", "2", "4", "6"], minor=False)
        panel.xaxis.set_minor_formatter(NullFormatter())
        panel.grid(color="0.9", linewidth=0.6)
        panel.legend()
    figure.savefig(HERE / "sizes.png", dpi=90)


def main() -> None:
    all_found = {name: found(recipe) for name, recipe in RECIPES.items()}
    draw_plans(all_found)
    draw_sizes(all_found)
    pictures = ["![Ice as it enters, by recipe](plans.png)", "", "![Floe sizes, asked and entered](sizes.png)", ""]
    write_between(PAGE, START, END, "\n".join([*table(all_found), "", *pictures]))


if __name__ == "__main__":
    main()

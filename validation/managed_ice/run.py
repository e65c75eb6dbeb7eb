"""Square against irregular floes: loads on a wall that is towed through managed ice.

    python -m validation.managed_ice.run [FOLDER] [--as-is]

from the root of the repository: one run after another into FOLDER (runs/managed_ice unless given), ten seconds each; those that
runs.csv tells of are not made anew. Writes tables and figures of README.md; with --as-is from what is in runs.csv alone.
"""

import argparse
from collections.abc import Iterable, Iterator
from dataclasses import replace
from itertools import product
from pathlib import Path

import numpy as np

from dilatedem.statistics import Band, difference, mean
from validation.loads.runner import write_between
from validation.managed_ice.fields import SHAPES
from validation.managed_ice.figures import MEGA, Runs, draw_fields, draw_histories, draw_plans, draw_trends
from validation.managed_ice.runs import FROM, HERE, TO, Point, found, recorded

PAGE = HERE / "README.md"
CONCENTRATIONS, SEEDS = (0.8, 0.9), range(1, 11)
#: of the trends: fields of a point; what is varied, about which point, and what its axis is called
FEW = range(1, 4)
COMMON, LARGE = Point("square", 0.8), Point("square", 0.8, floe=10.0)
VARIED = {
    "concentration": ("concentration", COMMON, (0.7, 0.8, 0.9)),
    "thickness": ("thickness (m)", LARGE, (0.5, 1.0, 1.5)),
    "floe": ("floe size (m)", COMMON, (5.0, 10.0)),
}
#: what is told of a run, and how it is called; of the first two it was published that square floes have more
FIGURES = {"mean": "mean load", "spread": "spread in time", "peak": "highest load"}
PUBLISHED = ("mean load", "spread in time")


def compared() -> list[Point]:
    """Runs that say whether shapes differ, seed after seed."""
    return [Point(shape, concentration, seed=seed) for seed, concentration, shape in product(SEEDS, CONCENTRATIONS, SHAPES)]


def trends() -> dict[str, tuple[str, list[Point]]]:
    """Runs of each quantity that is varied, and the label of its axis."""
    def points(key: str, about: Point, levels: Iterable[float]) -> Iterator[Point]:
        for seed, level, shape in product(FEW, levels, SHAPES):
            yield replace(about, shape=shape, seed=seed, **{key: level})

    return {key: (label, list(points(key, about, levels))) for key, (label, about, levels) in VARIED.items()}


def there(runs: Runs, points: list[Point]) -> list[Point]:
    """Those of which the runs of both shapes are there: a field that only one has is left out."""
    return [point for point in points if all(replace(point, shape=shape) in runs for shape in SHAPES)]


def values(runs: Runs, concentration: float, shape: str, what: str) -> np.ndarray:
    """(seeds,) of a figure of the runs that are compared."""
    chosen = (point for point in there(runs, compared()) if (point.shape, point.concentration) == (shape, concentration))
    return np.array([getattr(runs[point], what) for point in chosen])


def comparison(runs: Runs) -> list[str]:
    """The table of both shapes, and what it says of the published finding."""
    lines = ["| concentration | load on the wall, MN | square | irregular | square less irregular | bands |",
             "| --- | --- | ---: | ---: | ---: | --- |"]  # fmt: skip
    verdicts = []
    for concentration in CONCENTRATIONS:
        told = {}
        for what, named in FIGURES.items():
            square, irregular = (MEGA * values(runs, concentration, shape, what) for shape in SHAPES)
            one, other, between = mean(square), mean(irregular), difference(square, irregular)
            told[named] = one, other, between
            apart = "apart" if one.is_apart(other) else "overlap"
            lines.append(f"| {concentration:g} | {named} | {said(one)} | {said(other)} | {said(between, '+')} | {apart} |")
        found_of_each = "; ".join(verdict(named, *each) for named, each in told.items())
        one, other = (said(mean(values(runs, concentration, shape, "pushed")), digits=0) for shape in SHAPES)
        pushed = f"after {TO:g} m {one} square floes go along with the wall, and {other} irregular ones"
        verdicts.append(f"- **Concentration {concentration:g}**, {len(square)} fields: {found_of_each}; {pushed}.")
    crushed, residual = ([getattr(runs[point], what) for point in there(runs, compared())] for what in ("crushed", "residual"))
    taken = f"crushing took {min(crushed):.1%} to {max(crushed):.1%}"
    ledger = f"Of the work of the wall {taken}; the ledger closes to {max(residual):.0e} of it."
    return [*lines, "", *verdicts, "", ledger]


def said(told: Band, sign: str = "", digits: int = 3) -> str:
    return f"{told.value:{sign}.{digits}f} ({told.low:{sign}.{digits}f} to {told.high:{sign}.{digits}f})"


def verdict(named: str, square: Band, irregular: Band, between: Band) -> str:
    """What two bands say, and whether that was published."""
    told = f"{named} of square floes {square.value / irregular.value:.2f} times that of irregular ones"
    if between.low <= 0.0 <= between.high:
        return f"{told}, which may be chance"
    bands = "**bands apart**" if square.is_apart(irregular) else "more than chance (95 %), though bands overlap"
    published = "" if named not in PUBLISHED else ", as published" if between.value > 0.0 else ", **against what was published**"
    return f"{told}, {bands}{published}"


def varied(runs: Runs, series: dict[str, tuple[str, list[Point]]]) -> list[str]:
    """The table of what is varied: mean over fields (lowest to highest)."""
    lines = ["| varied | | fields | mean load, MN: square | irregular | highest load, MN: square | irregular |",
             "| --- | ---: | ---: | ---: | ---: | ---: | ---: |"]  # fmt: skip
    for key, (label, points) in series.items():
        for level in sorted({getattr(point, key) for point in points}):
            cells = []
            for what, shape in product(("mean", "peak"), SHAPES):
                some = MEGA * np.array([getattr(runs[p], what) for p in points if (p.shape, getattr(p, key)) == (shape, level)])
                cells.append(f"{some.mean():.2f} ({some.min():.2f} to {some.max():.2f})")
            lines.append(f"| {label} | {level:g} | {len(some)} | {' | '.join(cells)} |")
    return lines


def main(root: Path, as_is: bool) -> None:
    """Run what is not recorded, unless it is `as_is`, and write the page."""
    chosen, series = compared(), trends()
    runs = recorded() if as_is else found([*chosen, *(point for _, points in series.values() for point in points)], root)
    first = {f"{point.shape}, concentration {point.concentration:g}": root / point.name for point in chosen[: 2 * len(SHAPES)]}
    if all((folder / "summary.json").exists() for folder in first.values()):
        draw_plans(first)
    main_runs = {point: runs[point] for point in there(runs, chosen)}
    draw_histories(main_runs, CONCENTRATIONS)
    draw_fields(main_runs, CONCENTRATIONS)
    series = {key: (label, there(runs, points)) for key, (label, points) in series.items()}
    draw_trends(runs, series)
    about = f"Loads of the way from {FROM:g} to {TO:g} m; means over fields and their 95 % bands (Hall, Welch)."
    write_between(PAGE, "<!-- shapes: written by validation/managed_ice/run.py -->", "<!-- end of shapes -->",
                  "\n".join([about, "", *comparison(runs)]))  # fmt: skip
    write_between(PAGE, "<!-- trends: written by validation/managed_ice/run.py -->", "<!-- end of trends -->",
                  "\n".join(varied(runs, series)))  # fmt: skip


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", nargs="?", type=Path, default=Path("runs/managed_ice"))
    parser.add_argument("--as-is", action="store_true")
    args = parser.parse_args()
    main(args.folder, args.as_is)

"""Coverage of the bands of `dilatedem.statistics` over ensembles of known laws: coverage.csv, table and picture of README.md.

`python -m validation.statistics.run [ensembles]`: 1000 unless said, for most of an hour on one core. What coverage.csv has
is not made anew: remove it first.
"""

from __future__ import annotations

import csv
import sys
from pathlib import Path

from validation.statistics.coverage import LEAST, MOST, cells, coverage
from validation.statistics.figure import draw

HERE = Path(__file__).parent
RECORD = HERE / "coverage.csv"
HEADER = ["band", "law", "runs", "ensembles", "coverage_percent"]
MARK = "<!-- table: written by validation/statistics/run.py -->"


def main(ensembles: int = 1000) -> None:
    if not RECORD.exists():
        RECORD.write_text(",".join(HEADER) + "\n", encoding="utf-8")
    done = {(row["law"], row["runs"], row["band"]) for row in recorded()}
    for cell in cells():
        if {(cell.law, str(cell.runs), name) for name in cell.names} <= done:
            continue
        with open(RECORD, "a", encoding="utf-8", newline="") as file:
            for name, percent in zip(cell.names, coverage(cell, ensembles), strict=True):
                csv.writer(file, lineterminator="\n").writerow([name, cell.law, cell.runs, ensembles, f"{percent:.1f}"])
    write_page()
    draw(recorded(), HERE / "coverage.png")


def recorded() -> list[dict[str, str]]:
    with open(RECORD, encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def write_page() -> None:
    page = HERE / "README.md"
    head = page.read_text(encoding="utf-8").split(MARK)[0]
    page.write_text(f"{head}{MARK}\n\n{table()}", encoding="utf-8")


def table() -> str:
    """A row per band and law, a column per number of runs; bold where it is not within LEAST and MOST."""
    rows = recorded()
    sizes = sorted({int(row["runs"]) for row in rows})
    found = {(row["band"], row["law"], int(row["runs"])): float(row["coverage_percent"]) for row in rows}
    lines = ["| band | law | " + " | ".join(f"{n} runs" for n in sizes) + " |", "| --- | --- |" + " ---: |" * len(sizes)]
    for band, law in dict.fromkeys((row["band"], row["law"]) for row in sorted(rows, key=lambda row: row["band"])):
        cells_ = [shown(found.get((band, law, n))) for n in sizes]
        lines.append(f"| {band} | {law} | " + " | ".join(cells_) + " |")
    return "\n".join(lines) + "\n"


def shown(percent: float | None) -> str:
    if percent is None:
        return ""
    return f"{percent:.1f}" if LEAST <= percent <= MOST else f"**{percent:.1f}**"


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))

"""The paper's case over ice speeds, floe sizes and seeds; writes the tables of the README beside it.

    python -m validation.liu2015.run

from the root of the repository; half an hour on one core. Runs that are there already, in runs/liu2015, are not repeated.
"""

import csv
import shutil
import statistics
import subprocess
import sys
from collections import defaultdict
from pathlib import Path

HERE = Path(__file__).parent
RUNS = Path("runs/liu2015")
START, END = "<!-- tables: written by validation/liu2015/run.py -->", "<!-- end of the tables -->"

#: folder -> case and what varies
SWEEPS = {
    "speed": ("cases/pile.toml", ["--vary", "water.velocity.0=0.1:0.9:0.2", "--seeds", "2"]),
    "size_2.8": ("cases/pile.toml", ["--seeds", "3"]),
    "size_1.79": ("cases/pile_small.toml", ["--seeds", "3"]),
}


def sweep(name: str) -> list[dict]:
    """Run a sweep, or what is missing of it; returns the rows of its sweep.csv."""
    case, options = SWEEPS[name]
    resume = ["--resume"] if (RUNS / name).exists() else []
    command = [sys.executable, "-m", "dilatedem.cli", "sweep", case, *options, "--out", str(RUNS / name), *resume]
    subprocess.run(command, check=True)
    with open(RUNS / name / "sweep.csv", newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def kilonewtons(row: dict, column: str) -> float:
    return float(row[f"pile_{column}_N"]) / 1e3


def table(title: str, groups: dict[str, list[dict]]) -> list[str]:
    """Loads of groups of runs: mean over seeds, and in brackets lowest and highest."""
    lines = [
        f"| {title} | seeds | highest Fx, kN | mean Fx, kN | highest Fy, kN | lowest Fy, kN | residual / work of the current |",
        "| --- | --- | --- | --- | --- | --- | --- |",
    ]
    for label, rows in groups.items():
        cells = [label, str(len(rows))]
        for column in ("fx_max", "fx_mean", "fy_max", "fy_min"):
            values = [kilonewtons(row, column) for row in rows]
            cells.append(f"{statistics.mean(values):.3g} ({min(values):.3g} to {max(values):.3g})")
        cells.append(f"{max(float(row['residual_over_work']) for row in rows):.1e}")
        lines.append("| " + " | ".join(cells) + " |")
    return lines


def main() -> None:
    speeds = defaultdict(list)
    for row in sweep("speed"):
        speeds[row["water.velocity.0"]].append(row)
    sizes = {name.removeprefix("size_"): sweep(name) for name in ("size_2.8", "size_1.79")}
    subprocess.run([sys.executable, "-m", "dilatedem.cli", "post", str(RUNS / "speed")], check=True)
    shutil.copy(RUNS / "speed/figures/force_by_water_velocity_0_pile.png", HERE / "force_by_speed.png")
    lines = [*table("ice speed, m/s", speeds), "", *table("floe size, m", sizes)]
    readme = HERE / "README.md"
    before, _, rest = readme.read_text(encoding="utf-8").partition(START)
    _, _, after = rest.partition(END)
    readme.write_text("\n".join([before.rstrip(), "", START, "", *lines, "", END]) + after, encoding="utf-8")


if __name__ == "__main__":
    main()

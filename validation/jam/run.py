"""Run a jam of 200 floes for 60 s and write what it did into README.md: overlaps, kinetic energy, ledger.

    python -m validation.jam.run

from the root of the repository.
"""

import csv
import json
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from dilatedem.case.load import load
from dilatedem.output import folder
from dilatedem.run.loop import run

HERE = Path(__file__).parent
RUN = Path("runs/jam")
START, END = "<!-- results: written by validation/jam/run.py -->", "<!-- end of the results -->"
#: s: instants at which the table looks at the ice
LOOKS = (5.0, 10.0, 20.0, 40.0, 60.0)


def finished() -> dict:
    """Summary of the run, which is made where it is not there; one that was broken off goes on."""
    case = load(HERE / "jam.toml")
    path = RUN / "summary.json"
    if not path.exists() or json.loads(path.read_text())["status"] != "completed":
        run(case, RUN, resume=folder.holds_run(RUN), quiet=False)
    return json.loads(path.read_text())


def energies() -> dict[str, np.ndarray]:
    with open(RUN / "energy.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    return {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}


def draw(energy: dict[str, np.ndarray]) -> None:
    figure, axes = plt.subplots(figsize=(7.0, 3.6), layout="constrained")
    time = energy["time_s"]
    for name, label in (
        ("kinetic", "kinetic energy"),
        ("elastic", "elastic energy of the contacts"),
        ("work_drag", "work of the current"),
        ("loss_damping", "lost to damping"),
        ("loss_friction", "lost to friction"),
    ):
        axes.plot(time, np.where(energy[name] > 0.0, energy[name], np.nan), label=label)
    axes.plot(time, np.abs(energy["residual"]), color="black", linewidth=0.8, linestyle=":", label="residual of the ledger, size")
    axes.set(yscale="log", xlabel="time, s", ylabel="energy, J", xlim=(0.0, time[-1]), ylim=(1e-4, None))
    axes.legend(fontsize=8, ncols=2)
    axes.grid(alpha=0.3)
    figure.savefig(HERE / "jam.png", dpi=150)


def results(summary: dict, energy: dict[str, np.ndarray]) -> str:
    radius = load(HERE / "jam.toml").ice.dilated_radius
    dissipated = energy["loss_damping"][-1] + energy["loss_friction"][-1]
    residual = np.abs(energy["residual"]).max()
    deepest = summary["contact"]["largest_overlap_m"]
    still = energy["time_s"] >= 20.0
    lines = [
        "| quantity | result | asked |",
        "| --- | ---: | ---: |",
        f"| floes | {summary['floes']} | 200, less those at the pile |",
        f"| deepest overlap of any step, mm | {1e3 * deepest:.2f} | |",
        f"| ... as a share of the dilated radius | {deepest / radius:.2%} | 5 % |",
        f"| largest residual of the ledger, J | {residual:.3g} | |",
        f"| ... as a share of what was dissipated, {dissipated / 1e3:.1f} kJ | {residual / dissipated:.2g} | 1e-3 |",
        f"| largest rise of kinetic energy after 20 s, J | {np.diff(energy['kinetic'][still]).max():.2g} | |",
        f"| open contacts at the end | {summary['contact']['open']} | |",
        f"| wall time, s, for {summary['steps']} steps | {summary['wall_s']:.0f} | |",
        "",
        "| time, s | kinetic energy, J | elastic energy, J | residual, J |",
        "| ---: | ---: | ---: | ---: |",
    ]
    for look in LOOKS:
        i = np.argmin(np.abs(energy["time_s"] - look))
        lines.append(f"| {look:g} | {energy['kinetic'][i]:.3g} | {energy['elastic'][i]:.4g} | {energy['residual'][i]:.3g} |")
    return "\n".join([*lines, "", "![Energies over time](jam.png)"])


def main() -> None:
    summary, energy = finished(), energies()
    draw(energy)
    readme = HERE / "README.md"
    before, _, rest = readme.read_text(encoding="utf-8").partition(START)
    text = f"{before}{START}\n\n{results(summary, energy)}\n\n{END}{rest.partition(END)[2]}"
    readme.write_text(text, encoding="utf-8")
    print(text)


if __name__ == "__main__":
    main()

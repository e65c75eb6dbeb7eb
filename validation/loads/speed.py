"""How the highest load grows with the speed of the ice, elastic and with ice that crushes: the pile of the paper's case.

    python -m validation.loads.speed [--jobs N] [--seeds N]

from the root of the repository. Runs that are done are kept.
"""

from itertools import product
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from validation.loads.runner import HERE, WAY, Wanted, arguments, found, write_between

START, END = "<!-- speed: written by validation/loads/speed.py -->", "<!-- end of speed -->"
SPEEDS = (0.2, 0.3, 0.5, 0.7, 1.0)
#: label, folder, settings
KINDS = {
    "elastic": ("elastic", {}),
    "crushing at 2 MPa": ("2_MPa", {"ice.crushing_pressure": 2.0e6}),
    "crushing at 1 MPa": ("1_MPa", {"ice.crushing_pressure": 1.0e6}),
}


def wanted(kind: str, speed: float, seed: int) -> Wanted:
    name, settings = KINDS[kind]
    settings = {
        "contact.model": "consistent", "contact.damping_law": "touch", "water.velocity": [speed, 0.0], "field.seed": seed,
        "time.duration": WAY / speed, **settings,
    }  # fmt: skip
    return Wanted(f"speed/{name}/{speed:g}_seed_{seed}", Path("cases/pile.toml"), settings)


def exponent(speeds: np.ndarray, loads: np.ndarray) -> tuple[float, float]:
    """Of a power law through the logarithms of loads (speeds, seeds), and its standard error."""
    x, y = np.log(np.repeat(speeds, loads.shape[1])), np.log(loads.ravel())
    (slope, _), covariance = np.polyfit(x, y, 1, cov=True)
    return float(slope), float(np.sqrt(covariance[0, 0]))


def main() -> None:
    args = arguments(__doc__)
    seeds = range(1, args.seeds + 1)
    runs = found([wanted(*each) for each in product(KINDS, SPEEDS, seeds)], args.jobs)
    figure, axes = plt.subplots(figsize=(6.4, 4.2), layout="constrained")
    powers = []
    titles = " | ".join(f"{speed:g} m/s" for speed in SPEEDS)
    lines = [f"| ice | {titles} | exponent |", "| --- |" + " ---: |" * (len(SPEEDS) + 1)]
    for kind, colour in zip(KINDS, ("#000000", "#0072B2", "#D55E00"), strict=True):
        loads = np.array([[runs[wanted(kind, speed, seed).name].peak for seed in seeds] for speed in SPEEDS])
        mean, power = loads.mean(axis=1), exponent(np.array(SPEEDS), loads)
        powers.append(f"{power[0]:.2f} ({kind})")
        cells = " | ".join(f"{1e-3 * m:.0f} ({1e-3 * low:.0f} to {1e-3 * high:.0f})" for m, low, high in zip(
            mean, loads.min(axis=1), loads.max(axis=1), strict=True
        ))  # fmt: skip
        lines.append(f"| {kind} | {cells} | {power[0]:.2f} ± {power[1]:.2f} |")
        axes.errorbar(
            SPEEDS, 1e-3 * mean, 1e-3 * np.array([mean - loads.min(axis=1), loads.max(axis=1) - mean]), color=colour, marker="o",
            capsize=3, label=f"{kind}, exponent {power[0]:.2f}",
        )  # fmt: skip
    axes.set(xscale="log", yscale="log", xlabel="speed of the current (m/s)", ylabel="highest horizontal load (kN)")
    axes.set_xticks(SPEEDS, [f"{speed:g}" for speed in SPEEDS])
    axes.minorticks_off()
    axes.grid(True, alpha=0.3)
    axes.legend(fontsize=8)
    figure.savefig(HERE / "speed.png", dpi=150)
    lines += ["", f"Loads grow with the speed to the power {', '.join(powers)}."]
    write_between(HERE / "README.md", START, END, "\n".join(lines))


if __name__ == "__main__":
    main()

"""Measured loads of broken ice that crushes beside the bound of ISO 19906 for level ice that crushes across the whole width.

    python -m validation.loads.bound [--jobs N] [--seeds N]

from the root of the repository. Runs that are done are kept.
"""

from itertools import product
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from validation.loads.runner import HERE, Wanted, arguments, found, write_between

START, END = "<!-- bound: written by validation/loads/bound.py -->", "<!-- end of bound -->"
CASE = Path("cases/pile_crushing.toml")
#: ISO 19906, A.8.2.4.3.3: coefficient for the sub-arctic [MPa], exponent of the width over the thickness
COEFFICIENT, EXPONENT = 1.8, -0.16
#: thickness [m], radius of the pile [m], mean floe size [m]
CASES = ((0.5, 2.0, 2.83), (1.0, 2.0, 2.83), (0.5, 4.0, 2.83), (0.5, 2.0, 5.0))


def bound(thickness: float, width: float, coefficient: float = COEFFICIENT) -> float:
    """Global load [N] of level ice that crushes: C_R (h/1 m)^n (w/h)^m h w, n = min(-0.3, -0.5 + h/5)."""
    n = min(-0.3, -0.5 + thickness / 5.0)
    return 1e6 * coefficient * thickness**n * (width / thickness) ** EXPONENT * thickness * width


def wanted(thickness: float, radius: float, size: float, seed: int) -> Wanted:
    count = round(0.64 * 50.0 * 50.0 / size**2)
    settings = {"ice.thickness": thickness, "structure.0.radius": radius, "field.floe_count": count, "field.seed": seed}
    return Wanted(f"bound/h{thickness:g}_r{radius:g}_l{size:g}_seed_{seed}", CASE, settings)


def main() -> None:
    args = arguments(__doc__)
    seeds = range(1, args.seeds + 1)
    runs = found([wanted(*case, seed) for case, seed in product(CASES, seeds)], args.jobs)
    lines = [
        "| thickness, m | width, m | floes, m | events | 99 % of their peaks, kN | highest, kN | bound, kN | its C_R, MPa |",
        "| ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |",
    ]
    figure, axes = plt.subplots(figsize=(6.4, 3.8), layout="constrained")
    shares, names = [], []
    for place, (thickness, radius, size) in enumerate(CASES):
        told = [runs[wanted(thickness, radius, size, seed).name] for seed in seeds]
        events, width = np.concatenate([each.events for each in told]), 2.0 * radius
        high, most = float(np.quantile(events, 0.99)), max(each.peak for each in told)
        level = bound(thickness, width)
        shares.append(most / level)
        lines.append(
            f"| {thickness:g} | {width:g} | {size:g} | {len(events)} | {1e-3 * high:.0f} | {1e-3 * most:.0f} | "
            f"{1e-3 * level:.0f} | {COEFFICIENT * high / level:.3f} |"
        )
        labels = ("load events", "99 % of them", "bound, C_R = 1.8 MPa") if place == 0 else (None, None, None)
        axes.plot(np.full(len(events), place), 1e-3 * events, ".", color="#0072B2", alpha=0.4, label=labels[0])
        axes.plot(place, 1e-3 * high, "_", color="#D55E00", ms=22, mew=2, label=labels[1])
        axes.plot(place, 1e-3 * level, "_", color="black", ms=22, mew=2, label=labels[2])
        names.append(f"h {thickness:g} m, w {width:g} m\nfloes of {size:g} m")
    axes.set(yscale="log", ylabel="peak of the horizontal load (kN)")
    axes.set_xticks(range(len(CASES)), names, fontsize=8)
    axes.set_xlim(-0.5, len(CASES) - 0.5)
    axes.grid(True, axis="y", alpha=0.3)
    axes.legend(fontsize=8, ncols=3, loc="upper center", bbox_to_anchor=(0.5, 1.13), frameon=False)
    figure.savefig(HERE / "bound.png", dpi=150)
    lines += ["", f"Every load is below its bound: the highest is {100.0 * max(shares):.1f} % of it, the least of the highest "
              f"{100.0 * min(shares):.1f} %." if max(shares) < 1.0 else
              f"NOT every load is below its bound: the highest is {max(shares):.2f} times as high."]  # fmt: skip
    write_between(HERE / "README.md", START, END, "\n".join(lines))


if __name__ == "__main__":
    main()

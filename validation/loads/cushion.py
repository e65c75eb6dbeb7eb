"""A large floe that meets a pile through small ones, and without them.

    python -m validation.loads.cushion [--jobs N] [--seeds N]

from the root of the repository. Runs that are done are kept.
"""

from itertools import product

import matplotlib.pyplot as plt
import numpy as np

from validation.loads.runner import HERE, Wanted, arguments, found, write_between

START, END = "<!-- cushion: written by validation/loads/cushion.py -->", "<!-- end of cushion -->"
CASE = HERE / "cushion.toml"
#: label, settings: nothing before the large floe, and small ones
KINDS = {"alone": {"field.source": "bodies"}, "through small floes": {}}
PRESSURES = {"elastic": {}, "crushing at 2 MPa": {"ice.crushing_pressure": 2.0e6}}


def wanted(kind: str, ice: str, seed: int) -> Wanted:
    settings = {**KINDS[kind], **PRESSURES[ice], "field.seed": seed}
    return Wanted(f"cushion/{kind}_{ice}_{seed}".replace(" ", "_"), CASE, settings)


def main() -> None:
    args = arguments(__doc__)
    seeds = {"alone": [1], "through small floes": range(1, args.seeds + 1)}
    todo = [(kind, ice, seed) for kind, ice in product(KINDS, PRESSURES) for seed in seeds[kind]]
    runs = found([wanted(*each) for each in todo], args.jobs)
    lines = ["| the large floe comes | ice | highest load, kN | of the one without small floes |", "| --- | --- | ---: | ---: |"]
    figure, axes = plt.subplots(figsize=(5.4, 3.6), layout="constrained")
    shares = {}
    for place, ice in enumerate(PRESSURES):
        alone = runs[wanted("alone", ice, 1).name].peak
        for kind, aside, colour in zip(KINDS, (-0.18, 0.18), ("#000000", "#0072B2"), strict=True):
            peaks = np.array([runs[wanted(kind, ice, seed).name].peak for seed in seeds[kind]])
            spread = f" ({1e-3 * peaks.min():.0f} to {1e-3 * peaks.max():.0f})" if len(peaks) > 1 else ""
            shares[ice] = peaks.mean() / alone
            lines.append(f"| {kind} | {ice} | {1e-3 * peaks.mean():.0f}{spread} | {shares[ice]:.2f} |")
            axes.bar(place + aside, 1e-3 * peaks.mean(), 0.34, color=colour, label=kind if place == 0 else None)
            if len(peaks) > 1:
                label = None if place else "each field"
                axes.plot(np.full(len(peaks), place + aside), 1e-3 * peaks, "o", color="#D55E00", label=label)
    axes.set(ylabel="highest horizontal load (kN)")
    axes.set_xticks(range(len(PRESSURES)), PRESSURES)
    axes.legend(fontsize=8)
    figure.savefig(HERE / "cushion.png", dpi=150)
    told = " and ".join(f"{100.0 * (1.0 - share):.0f} % ({ice})" for ice, share in shares.items())
    lines += ["", f"Small floes before it lower the highest load of the large floe by {told}."]
    write_between(HERE / "README.md", START, END, "\n".join(lines))


if __name__ == "__main__":
    main()

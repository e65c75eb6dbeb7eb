"""Push a floe up slopes, on a plane and on a cone, and write what the loads' horizontal and vertical parts are into README.md.

    python -m validation.structures.run

from the root of the repository. The closed form and what is read from each run are those of tests/verification/test_slopes.py.
"""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from tests.verification.comparison import Comparison
from tests.verification.test_slopes import KINDS, SLOPES, compare, ratio

HERE = Path(__file__).parent
START, END = "<!-- results: written by validation/structures/run.py -->", "<!-- end of the results -->"
#: degrees between which the closed form is drawn
ANGLES = np.linspace(20.0, 70.0, 101)
MARKERS = {("plane", "liu2015"): "s", ("plane", "consistent"): "D", ("cone", "liu2015"): "o", ("cone", "consistent"): "^"}


def table(found: list[Comparison]) -> str:
    lines = ["| case | model | quantity | target | result | error | allowed |", "| --- | --- | --- | ---: | ---: | ---: | ---: |"]
    for row in found:
        verdict = "" if row.holds else " **fails**"
        lines.append(
            f"| [{row.case}]({row.case}.toml) | {row.model} | {row.quantity} | {row.target:.6f} | {row.result:.6f} | "
            f"{row.error:.1e} | {row.tolerance:.0e}{verdict} |"
        )
    return "\n".join(lines)


def draw(found: list[Comparison]) -> None:
    figure, axes = plt.subplots(figsize=(7.0, 4.2), layout="constrained")
    for friction, style in ((0.0, "-"), (0.1, "--")):
        label = f"closed form, µ = {friction:g}"
        axes.plot(ANGLES, [ratio(a, friction) for a in ANGLES], style, color="black", linewidth=1.0, label=label)
    per_kind = len(SLOPES)
    for first in range(0, len(found), per_kind):
        rows = found[first : first + per_kind]
        kind, model = rows[0].case.removeprefix("slope_"), rows[0].model
        shift = 0.6 * (list(MARKERS).index((kind, model)) - 1.5)
        angles = [slope + shift for slope, _, _ in SLOPES]
        axes.plot(angles, [ratio(a, f) * r.result / r.target for a, (_, f, _), r in zip(angles, SLOPES, rows, strict=True)],
                  MARKERS[kind, model], ms=5, mfc="none", label=f"{kind}, {model}")  # fmt: skip
    axes.set(xlabel="slope from the horizontal (°)", ylabel="horizontal over vertical load", xlim=(20.0, 70.0), ylim=(0.0, None))
    axes.legend(fontsize=8)
    axes.grid(alpha=0.3)
    figure.savefig(HERE / "slopes.png", dpi=150)


def main() -> None:
    found = compare()
    assert len(found) == 2 * len(KINDS) * len(SLOPES)
    draw(found)
    readme = HERE / "README.md"
    before, rest = readme.read_text(encoding="utf-8").split(START)
    readme.write_text(f"{before}{START}\n\n{table(found)}\n\n{END}{rest.split(END)[1]}", encoding="utf-8")


if __name__ == "__main__":
    main()

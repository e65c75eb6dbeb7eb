"""The highest force of a floe that crushes on a pile that gives way, by the program and by the equations of `reference`.

    python -m validation.compliant.run

from the root of the repository: some minutes. Writes the table of README.md.
"""

from pathlib import Path

import numpy as np

from dilatedem.case.schema import Case
from dilatedem.run.simulation import Simulation
from validation.compliant.reference import MASS, PRESSURE, RADIUS, SPEED, THICKNESS, Peak, peak

PAGE = Path(__file__).parent / "README.md"
START, END = "<!-- table: written by validation/compliant/run.py -->", "<!-- end of the table -->"
#: mass [kg] and stiffness [N/m] of the pile
PILES = ((5e5, 5e8), (5e5, 5e7), (5e5, 1e7), (5e5, 0.0), (2e5, 0.0))
#: elastic modulus of the ice [Pa]: so high that elasticity has no share
MODULUS = 1e11
#: gap between floe and pile at the start, m
GAP = 1e-4
#: share of the highest force by which program and equations may differ
ALLOWED = 5e-3


def simulated(mass: float, stiffness: float) -> Peak:
    """The same by the program: a square floe that meets the pile with the middle of a side."""
    side = float(np.sqrt(MASS / (915.0 * THICKNESS)))
    back, front = -RADIUS - GAP - side, -RADIUS - GAP
    simulation = Simulation.of_case(Case.model_validate({
        "field": {"source": "bodies"}, "water": {"enabled": False}, "gravity": {"acceleration": 0.0},
        "ice": {"thickness": THICKNESS, "elastic_modulus": MODULUS, "crushing_pressure": PRESSURE},
        "contact": {"model": "consistent", "damping": 0.0, "friction": 0.0},
        "structure": [{
            "kind": "pile", "center": [0.0, 0.0], "radius": RADIUS,
            "support": {"kind": "sprung", "mass": mass, "stiffness": [stiffness, stiffness], "damping_ratio": 0.0},
        }],
        "body": [{"outline": [[back, -side / 2], [front, -side / 2], [front, side / 2], [back, side / 2]],
                  "velocity": [SPEED, 0.0, 0.0]}],
    }))  # fmt: skip
    start, pile, highest = simulation.floes.position[0, 0], simulation.structures["pile"], Peak(0.0, 0.0, 0.0)
    while simulation.floes.velocity[0, 0] > pile.velocity[0]:
        simulation.step(1)
        if pile.load[0] > highest.force:
            shift = float(pile.displacement[0])
            highest = Peak(float(pile.load[0]), float(simulation.floes.position[0, 0] - start - GAP - shift), shift)
    return highest


def table() -> list[str]:
    """Rows of Markdown."""
    head = ["M, kg", "K, N/m", "leading order: F, N", "crushed, m", "u, m", "whole chord: F, N", "crushed, m", "u, m"]
    head += ["dilatedem: F, N", "crushed, m", "u, m", "error of F"]
    rows = [head, ["---:"] * len(head)]
    for mass, stiffness in PILES:
        expected = peak(mass, stiffness)
        found = simulated(mass, stiffness)
        error = found.force / expected.force - 1.0
        row = [f"{mass:g}", f"{stiffness:g}", *_figures(peak(mass, stiffness, leading=True)), *_figures(expected), *_figures(found)]
        rows.append([*row, f"{100 * error:+.3f} %{'' if abs(error) <= ALLOWED else ': too far off'}"])
    return [f"| {' | '.join(row)} |" for row in rows]


def _figures(found: Peak) -> list[str]:
    return [f"{found.force:.1f}", f"{found.crushed:.6f}", f"{found.shift:.6f}"]


def main() -> None:
    """Write the table into the page."""
    before, _, rest = PAGE.read_text(encoding="utf-8").partition(START)
    text = "\n".join([START, "", *table(), ""])
    PAGE.write_text(f"{before}{text}\n{END}{rest.partition(END)[2]}", encoding="utf-8")


if __name__ == "__main__":
    main()

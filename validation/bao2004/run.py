"""Modes, bending and their convergence, into the table of README.md.

    python -m validation.bao2004.run

from the root of the repository: half a minute on a free processor.
"""

import time
from pathlib import Path

import numpy as np

from tests.verification.test_free_modes import plate_numbers
from validation.bao2004 import reference
from validation.bao2004.bending import floating, recovered_moment, sagging
from validation.bao2004.bodies import beam, block, deformable, plate, upright

PAGE = Path(__file__).parent / "README.md"
START, END = "<!-- tables: written by validation/bao2004/run.py -->", "<!-- end of the tables -->"
#: sizes of elements [m]
BEAM_SIZES, PLATE_SIZES, FLOE_SIZES = (1.0, 0.5, 0.25), (0.2, 0.1, 0.05), (0.5, 0.25)
#: a floe of the paper's field [m]
FLOE = (2.8, 2.8, 0.5)


def table(head: list[str], rows: list[list[str]]) -> list[str]:
    return [f"| {' | '.join(row)} |" for row in (head, ["---:"] * len(head), *rows)] + [""]


def percent(found: np.ndarray, target: np.ndarray) -> list[str]:
    return [f"{value:.4f} ({100.0 * (value / aim - 1.0):+.2f} %)" for value, aim in zip(found, target, strict=True)]


def beams() -> list[str]:
    rows = [["Timoshenko", "", *(f"{value:.4f}" for value in reference.timoshenko()), "", ""]]
    for size in BEAM_SIZES:
        body = beam(size, 12)
        found = body.modes.frequency[upright(body.modes)[:3]] / (2.0 * np.pi)
        twist = np.abs(body.modes.twist).max()
        row = [f"{size:g}", str(len(body.elements.nodes)), *percent(found, reference.timoshenko())]
        rows.append([*row, f"{twist:.4f}", f"{body.mesh.quality:.2f}"])
    head = ["elements, m", "nodes", "f1, Hz", "f2, Hz", "f3, Hz", "largest ∫ρ φi × φj", "quality of the mesh"]
    return ["## A free beam, bending up and down", "", *table(head, rows)]


def plates() -> list[str]:
    rows = [["Leissa", "", *(f"{value:.2f}" for value in reference.PLATE)]]
    for size in PLATE_SIZES:
        body = plate(size, 3)
        rows.append([f"{size:g}", str(len(body.elements.nodes)), *percent(plate_numbers(body.modes), np.array(reference.PLATE))])
    return ["## A free square plate, a² ω √(ρh/D) at h/a = 1/50", "", *table(["elements, m", "nodes", "1", "2", "3"], rows)]


def sags() -> list[str]:
    body = beam(0.5, 60)
    bent, (bending, shear) = sagging(body), reference.sagging()
    rows = []
    for count, error in reference.SERIES.items():
        found = bent.by_modes[count] / bent.whole - 1.0
        rows.append([str(count), f"{100.0 * error:+.3f} %", f"{100.0 * found:+.3f} %"])
    text = f"Middle deflection by the mesh {bent.whole:.6f} m, by theory {bending:.6f} m and {shear:.6f} m of shear; stress of the"
    text += f" middle by mode acceleration {bent.stress / 1e6:.4f} MPa, by theory {reference.sagging_stress() / 1e6:.4f} MPa."
    head = ["symmetric modes", "error of a series of Euler-Bernoulli's modes", "of those of the mesh, against all of them"]
    return ["## A beam on its ends, under its weight", "", text, "", *table(head, rows)]


def floats() -> list[str]:
    body, rows = beam(0.5, 1), []
    force = floating(body, 1000.0)
    for place in (1.0, 2.0, reference.LENGTH / 3.0, 5.0, 7.0):
        target = float(reference.floating_moment(place, 1000.0))
        rows.append([f"{place:.3f}", f"{target:.1f}", *percent([recovered_moment(body, force, place)], [target])])
    head = ["from the loaded end, m", "P x (1 - x/L)², N m", "from the stress of the mesh, N m"]
    return ["## A rigid floe on water, 1000 N on its end", "", *table(head, rows)]


def floes() -> list[str]:
    rows = []
    for size in FLOE_SIZES:
        started = time.process_time()
        body = deformable(block(*FLOE), size, 6)
        taken = time.process_time() - started
        hertz = (f"{value:.2f}" for value in body.modes.frequency / (2.0 * np.pi))
        rows.append([f"{size:g}", str(len(body.elements.nodes)), *hertz, f"{taken:.1f}"])
    head = ["elements, m", "nodes", *(f"f{k}, Hz" for k in range(1, 7)), "processor, s"]
    return ["## A floe of 2.8 m x 2.8 m x 0.5 m", "", *table(head, rows)]


def main() -> None:
    """Write the tables into the page."""
    before, _, rest = PAGE.read_text(encoding="utf-8").partition(START)
    lines = [line for part in (beams, plates, sags, floats, floes) for line in part()]
    PAGE.write_text("\n".join([before + START, "", *lines, END]) + rest.partition(END)[2], encoding="utf-8")


if __name__ == "__main__":
    main()

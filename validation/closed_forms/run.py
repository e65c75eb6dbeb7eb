"""Regenerate the table of validation/README.md: run every case file of this folder and set its results against their closed forms.

    python -m validation.closed_forms.run

from the root of the repository. The closed forms, and what is read from each case, are those of tests/verification.
"""

import importlib
import time
from math import isinf
from pathlib import Path

import dilatedem
from tests.verification.comparison import CASES, Comparison

README = Path(__file__).parents[1] / "README.md"
START, END = "<!-- table: written by validation/closed_forms/run.py -->", "<!-- end of the table -->"

#: module of tests/verification -> what the closed form is about
FORMS = {
    "test_floating_box": "Floating box",
    "test_drift": "Drift from rest",
    "test_spin_decay": "Spin decay",
    "test_torque_free_box": "Torque-free box",
    "test_order": "Order of the integrator",
    "test_hertz_impact": "Hertz impact",
    "test_chung_ooi_normal": "Chung & Ooi (2011), tests 1-3",
    "test_chung_ooi_oblique": "Chung & Ooi (2011), tests 4-8",
    "test_oblique_impact": "Oblique impact at psi = 1 to 8",
    "test_impact_on_plate": "Central impacts of corners, edges and faces: elastic, and restitution",
    "test_oblique_edge_face": "Oblique impacts of edges and faces",
    "test_incline": "Incline",
    "test_rolling": "Rolling",
    "test_stack": "Resting stacks",
    "test_collision": "Momentum of a collision",
    "test_forces_by_mode": "Force by contact mode at 0.1 mm overlap",
}


def number(value: float) -> str:
    """Six significant digits, short."""
    return "0" if value == 0 else f"{value:.6g}"


def row(comparison: Comparison) -> str:
    case = f"[{comparison.case}](closed_forms/{comparison.case}.toml)"
    allowed = "recorded" if isinf(comparison.tolerance) else f"{comparison.tolerance:.1e}"
    verdict = "" if comparison.holds else " **fails**"
    cells = (
        case,
        comparison.model or "any",
        comparison.quantity,
        number(comparison.target),
        number(comparison.result),
        f"{comparison.error:.1e}",
        f"{allowed}{verdict}",
    )
    return "| " + " | ".join(cells) + " |"


def table() -> str:
    """The whole table in Markdown, one section for each closed form."""
    lines = [
        f"dilatedem {dilatedem.__version__}. Error: relative to the target; where that is 0 or a difference of large numbers, "
        "to the scale of the quantity. Model: that of the contacts; any, where nothing touches. Recorded: a known limit of the "
        "model, for which there is no bound."
    ]
    for module, title in FORMS.items():
        started = time.perf_counter()
        comparisons = importlib.import_module(f"tests.verification.{module}").compare()
        print(f"{title}: {len(comparisons)} results, {time.perf_counter() - started:.1f} s", flush=True)
        lines += ["", f"### {title}", "", f"Equations: [{module}.py](../tests/verification/{module}.py)", ""]
        lines += [
            "| case | model | quantity | target | result | error | allowed |",
            "| --- | --- | --- | ---: | ---: | ---: | ---: |",
        ]
        lines += [row(comparison) for comparison in comparisons]
    return "\n".join(lines)


def main() -> None:
    before, rest = README.read_text(encoding="utf-8").split(START)
    after = rest.split(END)[1]
    README.write_text(f"{before}{START}\n\n{table()}\n\n{END}{after}", encoding="utf-8")
    covered = {path.stem for path in CASES.glob("*.toml")}
    missing = {stem for stem in covered if f"closed_forms/{stem}.toml" not in README.read_text(encoding="utf-8")}
    if missing:
        raise SystemExit(f"{README}: no row for {', '.join(sorted(missing))}")


if __name__ == "__main__":
    main()

"""Regenerate the table of validation/README.md: run every case file of this folder and set its results against their closed forms.

    python -m validation.closed_forms.run [MODULE ...]

from the root of the repository. The closed forms, and what is read from each case, are those of tests/verification; MODULE: one of
FORMS, to write its section alone anew. What is asked of `consistent` has no case file here: its rows name the folder that has them.
"""

import importlib
import sys
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
    "test_skin_form": "Drag by skin and form, wind, shear",
    "test_added_mass": "Water taken along",
    "test_waves": "Waves",
    "test_sea_ledger": "The ledger in a sea",
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
    "test_free_modes": "Free vibration of a beam and of a plate",
    "test_bending": "Beams and floes that bend at rest",
    "test_modal_cases": "Bodies that bend, case by case",
    "test_consistent_bounds": "What is asked of `consistent`",
}


def number(value: float) -> str:
    """Six significant digits, short."""
    return "0" if value == 0 else f"{value:.6g}"


def source(case: str) -> str:
    """Link to a case file of this folder, or to another folder of validation."""
    place = f"closed_forms/{case}.toml" if (CASES / f"{case}.toml").exists() else f"{case}/README.md"
    return f"[{case}]({place})"


def row(comparison: Comparison) -> str:
    allowed = "recorded" if isinf(comparison.tolerance) else f"{comparison.tolerance:.1e}"
    verdict = "" if comparison.holds else " **fails**"
    cells = (
        source(comparison.case),
        comparison.model or "any",
        comparison.quantity,
        number(comparison.target),
        number(comparison.result),
        f"{comparison.error:.1e}",
        f"{allowed}{verdict}",
    )
    return "| " + " | ".join(cells) + " |"


def section(module: str) -> str:
    """The section of one closed form in Markdown, its title first."""
    started = time.perf_counter()
    comparisons = importlib.import_module(f"tests.verification.{module}").compare()
    print(f"{FORMS[module]}: {len(comparisons)} results, {time.perf_counter() - started:.1f} s", flush=True)
    lines = [f"### {FORMS[module]}", "", f"Equations: [{module}.py](../tests/verification/{module}.py)", ""]
    lines += ["| case | model | quantity | target | result | error | allowed |", "| --- | --- | --- | ---: | ---: | ---: | ---: |"]
    return "\n".join(lines + [row(comparison) for comparison in comparisons])


def table(written: dict[str, str], asked: list[str]) -> str:
    """The whole table in Markdown: sections by title, those asked for anew."""
    head = (
        f"dilatedem {dilatedem.__version__}. Error: relative to the target; where that is 0 or a difference of large numbers, "
        "to the scale of the quantity. Model: that of the contacts; any, where nothing touches. Recorded: a known limit of the "
        "model, for which there is no bound."
    )
    parts = [section(module) if module in asked else written.get(title, "") for module, title in FORMS.items()]
    return "\n\n".join([head, *(part for part in parts if part)])


def main() -> None:
    asked = sys.argv[1:] or list(FORMS)
    unknown = [module for module in asked if module not in FORMS]
    if unknown:
        raise SystemExit(f"there is no {unknown[0]}; the modules are {', '.join(FORMS)}")
    before, rest = README.read_text(encoding="utf-8").split(START)
    old, after = rest.split(END)
    sections = [f"### {part.strip()}" for part in f"\n{old}".split("\n### ")[1:]]
    written = {part.splitlines()[0].removeprefix("### "): part for part in sections}
    README.write_text(f"{before}{START}\n\n{table(written, asked)}\n\n{END}{after}", encoding="utf-8")
    covered = {path.stem for path in CASES.glob("*.toml")}
    missing = {stem for stem in covered if f"closed_forms/{stem}.toml" not in README.read_text(encoding="utf-8")}
    if missing:
        raise SystemExit(f"{README}: no row for {', '.join(sorted(missing))}")


if __name__ == "__main__":
    main()

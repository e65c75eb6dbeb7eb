"""Crushing against closed forms, in random collisions and in a jam: figures, and the tables of the README beside this file.

    python -m validation.crushing.run [PART ...]

from the root of the repository. PART: stiff, convergence, series, histories, collisions, jam; all of them unless given.
"""

import argparse
import csv
import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from dilatedem.case.load import load
from dilatedem.output import folder
from dilatedem.post.figures.canvas import BLACK, BLUE, VERMILION, new_figure, styled
from dilatedem.post.labels import number
from dilatedem.run.loop import run
from validation.contact_lab.drawing import save_png
from validation.contact_lab.run import put_table
from validation.crushing import closed_forms, collisions, hits

HERE = Path(__file__).parent
JAM = Path("runs/crushing_jam")
MODELS = ("liu2015", "consistent")
MODULI = (1e9, 1e10, 1e11)
#: of histories: MPa (None: elastic), colour
PRESSURES = ((None, BLACK), (2.0, BLUE), (1.0, VERMILION))
#: cases of histories, at the ice's own modulus
DRAWN = (("side on the pile", "side_on_pile"), ("corner on the pile", "corner_on_pile"))
OWN = "ice.elastic_modulus=1e9"


def percent(found: float, expected: float) -> str:
    return f"{100.0 * (found / expected - 1.0):+.2f}"


def stiff() -> list[str]:
    lines = [
        "| | hit | force, N | depth, m | time to it, s | force, % off | depth, % off | time, % off | peak/P(d) − 1 | loss/∫P − 1 | "
        "residual |",
        "| --- | --- |" + " ---: |" * 9,
    ]
    for each in closed_forms.RIGID:
        hit = each.hit()
        due, crushing = each.rigid(hit.mass), each.crushing
        off = [percent(hit.peak, due.force), percent(hit.depth, due.depth), percent(hit.rise, due.time)]
        own = [hit.peak / crushing.bears(hit.depth) - 1.0, hit.lost / crushing.costs(hit.depth) - 1.0, hit.residual]
        lines.append(
            f"| {each.name} | {each.what} | {due.force:.0f} | {due.depth:.6f} | {due.time:.5f} | {' | '.join(off)} | "
            f"{' | '.join(f'{value:.1e}' for value in own)} |"
        )
    return lines


def convergence() -> list[str]:
    lines = ["| | " + " | ".join(f"E = {modulus:.0e} Pa" for modulus in MODULI) + " |", "| --- |" + " ---: |" * len(MODULI)]
    for each in closed_forms.RIGID:
        found = [each.hit(f"ice.elastic_modulus={modulus:g}") for modulus in MODULI]
        lines.append(f"| {each.name} | " + " | ".join(percent(hit.peak, each.rigid(hit.mass).force) for hit in found) + " |")
    return lines


def in_series() -> list[str]:
    lines = [
        "| | hit | model | force, N | depth, m | restitution | force, % off | depth, % off | restitution, % off | residual |",
        "| --- | --- | --- |" + " ---: |" * 7,
    ]
    for model in MODELS:
        for each in closed_forms.in_series(model):
            hit, due = each.hit, each.expected
            off = [percent(hit.peak, due.force), percent(hit.depth, due.depth), percent(hit.restitution, due.restitution)]
            lines.append(
                f"| {each.name} | {each.what} | `{model}` | {due.force:.0f} | {due.depth:.6f} | {due.restitution:.4f} | "
                f"{' | '.join(off)} | {hit.residual:.1e} |"
            )
    return lines


def history(case: str, model: str, pressure: float | None) -> hits.Hit:
    crushing = 1e6 * pressure if pressure else 1e15
    return hits.hit(case, OWN, f"contact.model={model}", f"ice.crushing_pressure={crushing:g}")


@styled
def draw_histories(found: dict) -> Figure:
    """Force and crushed depth over time, a column a hit and model."""
    drawn = new_figure(9.6, 4.6)
    panels = drawn.subplots(2, len(DRAWN) * len(MODELS), sharex="col")
    for column, (name, case, model) in enumerate((*of, model) for of in DRAWN for model in MODELS):
        top, below = panels[:, column]
        for pressure, colour in PRESSURES:
            hit = found[case, model, pressure]
            label = f"{pressure:g} MPa" if pressure else "elastic"
            top.plot(1e3 * hit.time, 1e-3 * hit.force, color=colour, label=label)
            below.plot(1e3 * hit.time, 1e3 * hit.crushed, color=colour)
        top.set_title(f"{name}\n{model}")
        below.set_xlabel("Time since the first touch (ms)")
        for axes in (top, below):
            axes.set_xlim(left=0.0)
            axes.set_ylim(bottom=0.0)
            axes.grid(True)
    panels[0, 0].set_ylabel("Force (kN)")
    panels[1, 0].set_ylabel("Crushed depth (mm)")
    drawn.legend(*panels[0, 0].get_legend_handles_labels(), loc="outside upper center", ncols=len(PRESSURES))
    return drawn


def histories() -> list[str]:
    found = {(case, model, p): history(case, model, p) for _, case in DRAWN for model in MODELS for p, _ in PRESSURES}
    save_png(draw_histories(found), HERE, "histories")
    lines = ["| hit | model | elastic, kN | 2 MPa, kN | 1 MPa, kN | crushed, mm, at 2 and 1 MPa | residual, the largest |",
             "| --- | --- |" + " ---: |" * 5]  # fmt: skip
    for name, case in DRAWN:
        for model in MODELS:
            of = [found[case, model, p] for p, _ in PRESSURES]
            peaks = " | ".join(f"{1e-3 * hit.peak:.1f}" for hit in of)
            depths = ", ".join(f"{1e3 * hit.depth:.2f}" for hit in of[1:])
            lines.append(f"| {name} | `{model}` | {peaks} | {depths} | {max(abs(hit.residual) for hit in of):.1e} |")
    return lines


def random_collisions() -> list[str]:
    lines = [
        "| model | collisions | crush, % | energy kept, median, % | kept, most, % | made by the law, most, % | "
        "kept less made, most, % | residual, median | largest |",
        "| --- |" + " ---: |" * 8,
    ]
    for model in MODELS:
        found = collisions.survey(model)
        size = np.abs(found.residual)
        cells = [
            f"{len(found.kept)}", f"{100.0 * (found.crushed > 0.0).mean():.1f}", number(100.0 * float(np.median(found.kept)), 3),
            f"{100.0 * found.kept.max():.4f}", number(100.0 * float(found.gained.max()), 3),
            f"{100.0 * (found.kept - found.gained).max():.4f}", f"{np.median(size):.1e}", f"{size.max():.1e}",
        ]  # fmt: skip
        lines.append(f"| `{model}` | {' | '.join(cells)} |")
    return lines


def jam() -> list[str]:
    path = JAM / "summary.json"
    if not path.exists() or json.loads(path.read_text())["status"] != "completed":
        run(load(HERE / "jam.toml"), JAM, resume=folder.holds_run(JAM), quiet=False)
    summary = json.loads(path.read_text())
    with open(JAM / "energy.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    energy = {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}
    lost = sum(energy[name][-1] for name in ("loss_damping", "loss_friction", "loss_crushing"))
    still = energy["time_s"] >= 0.5 * energy["time_s"][-1]
    return [
        "| quantity | result |",
        "| --- | ---: |",
        f"| floes | {summary['floes']} |",
        f"| dissipated, kJ | {1e-3 * lost:.2f} |",
        f"| ... by crushing, kJ | {1e-3 * energy['loss_crushing'][-1]:.2f} |",
        f"| deepest overlap of any step, mm | {1e3 * summary['contact']['largest_overlap_m']:.2f} |",
        f"| largest residual of the ledger, of what was dissipated | {np.abs(energy['residual']).max() / lost:.1e} |",
        f"| kinetic energy, the highest, J | {energy['kinetic'].max():.3g} |",
        f"| kinetic energy at the end, J | {energy['kinetic'][-1]:.2g} |",
        f"| largest rise of it in the second half, J | {max(np.diff(energy['kinetic'][still]).max(), 0.0):.2g} |",
        f"| crushed in the second half, J | {energy['loss_crushing'][-1] - energy['loss_crushing'][still][0]:.2g} |",
        f"| contacts at the end | {summary['contact']['open']} |",
    ]


PARTS: dict[str, Callable[[], list[str]]] = {
    "stiff": stiff, "convergence": convergence, "series": in_series, "histories": histories, "collisions": random_collisions,
    "jam": jam,
}  # fmt: skip


def main() -> None:
    parser = argparse.ArgumentParser(description="Crushing against what is known.")
    parser.add_argument("parts", nargs="*", metavar="PART", help=f"{', '.join(PARTS)}; all unless given")
    asked = parser.parse_args()
    unknown = [part for part in asked.parts if part not in PARTS]
    if unknown:
        parser.error(f"there is no part {unknown[0]!r}; the parts are {', '.join(PARTS)}")
    for part in asked.parts or PARTS:
        put_table(HERE / "README.md", part, PARTS[part]())
        print(f"{part}: done", flush=True)


if __name__ == "__main__":
    main()

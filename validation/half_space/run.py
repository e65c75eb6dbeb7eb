"""Contact of dilated polyhedra by the half-space, from point to line to face; writes reference.csv, figures, the README's tables.

    python -m validation.half_space.run

from the root of the repository; some eight minutes on two cores.
"""

import csv
import math
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

from validation.half_space import checks, figures
from validation.half_space.contact import Result, resolve
from validation.half_space.families import FAMILIES, Case

HERE = Path(__file__).parent
START, END = "<!-- tables: written by validation/half_space/run.py -->", "<!-- end of the tables -->"
WORKERS = 2

GEOMETRY = ("radius", "radius_other", "end_radius", "length", "width", "ends", "tilt", "angle", "overlap")
RESULTS = ("force", "energy", "moment", "energy_moment", "centre", "extent_x", "extent_y", "area", "peak")
ERRORS = ("force_error", "energy_error", "moment_error")
PIECES = ("point", "line", "face", "pieces", "pieces_over_force", "widened", "widened_energy", "widened_over_force")

#: moments below this part of force x extent are round-off of symmetric poses
ROUND_OFF = 1e-6

#: departure of the plain laws from the half-space that is called a miss
MISS = 0.3


def digits(value: float | str) -> str:
    if isinstance(value, str):
        return value
    return "" if math.isnan(value) else f"{value:.6g}"


def row(case: Case, result: Result) -> dict[str, str]:
    """One line of reference.csv."""
    contact = result.contact
    values: dict[str, float | str] = {"family": case.family, **case.geometry}
    values |= {name: getattr(contact, name) for name in ("force", "energy", "moment", "energy_moment", "centre", "area", "peak")}
    values |= dict(zip(("extent_x", "extent_y"), contact.extent, strict=True))
    for name in ("moment", "energy_moment"):
        if abs(values[name]) < ROUND_OFF * contact.force * contact.extent[0]:
            values[name] = 0.0
    if abs(contact.centre) < ROUND_OFF * contact.extent[0]:
        values["centre"] = 0.0
    values |= {name: float(f"{getattr(result, name):.1e}") for name in ERRORS}
    values |= {name: getattr(case, name) for name in ("point", "line", "face", "pieces")}
    values |= {"widened": case.widened[0], "widened_energy": case.widened[1]}
    values |= {"pieces_over_force": case.pieces / contact.force, "widened_over_force": case.widened[0] / contact.force}
    return {name: digits(values.get(name, math.nan)) for name in ("family", *GEOMETRY, *RESULTS, *ERRORS, *PIECES)}


def solved(family: str, index: int) -> Result:
    return resolve(FAMILIES[family][0]()[index].profile)


def compute() -> list[dict[str, str]]:
    """Every case of every family; reference.csv grows by whole families."""
    rows: list[dict[str, str]] = []
    with ProcessPoolExecutor(WORKERS) as pool:
        for family, (make, _) in FAMILIES.items():
            cases = make()
            results = pool.map(solved, [family] * len(cases), range(len(cases)))
            rows += [row(case, result) for case, result in zip(cases, results, strict=True)]
            with open(HERE / "reference.csv", "w", newline="", encoding="utf-8") as file:
                writer = csv.DictWriter(file, list(rows[0]), lineterminator="\n")
                writer.writeheader()
                writer.writerows(rows)
            print(f"{family}: {len(cases)} cases", flush=True)
    return rows


def short(text: str) -> str:
    """Four significant digits."""
    try:
        return "" if text == "" else f"{float(text):.4g}"
    except ValueError:
        return text


def family_table(family: str, rows: list[dict[str, str]]) -> list[str]:
    """The rows of a family in Markdown; columns that are the same in every row are named once, above."""
    fixed = [c for c in GEOMETRY if len({r[c] for r in rows}) == 1 and rows[0][c] != ""]
    shown = [c for c in GEOMETRY if c not in fixed and any(r[c] for r in rows)]
    shown += [
        c for c in ("force", "energy", "moment", "point", "line", "face", "widened") if any(r[c] not in ("", "0") for r in rows)
    ]
    ratios = [c for c in ("pieces_over_force", "widened_over_force") if any(r[c] for r in rows)]
    lines = [", ".join(f"{c} {short(rows[0][c])}" for c in fixed) + ".", ""] if fixed else []
    header = [*shown, *ratios, "force_error"]
    lines += ["| " + " | ".join(c.replace("_", " ") for c in header) + " |", "| " + " | ".join(["---:"] * len(header)) + " |"]
    for r in rows:
        cells = [short(r[c]) for c in shown] + [ratio(r[c]) for c in ratios] + [short(r["force_error"])]
        lines.append("| " + " | ".join(cells) + " |")
    name = family.replace(" ", "_")
    return [f"### {family.capitalize()}", "", f"![{family}: force]({name}.png)", "", *verdicts(rows), *lines, ""]


def ratio(text: str) -> str:
    """Two decimals; bold where it misses."""
    if text == "":
        return ""
    return f"**{float(text):.2f}**" if abs(float(text) - 1) > MISS else f"{float(text):.2f}"


def verdicts(rows: list[dict[str, str]]) -> list[str]:
    """How far the laws are off in a family."""
    lines = []
    for column, law in (("pieces_over_force", "The plain laws"), ("widened_over_force", "The widened patch")):
        found = [float(r[column]) for r in rows if r[column]]
        if found:
            misses = sum(abs(value - 1) > MISS for value in found)
            text = f"{law}: {min(found):.2f} to {max(found):.2f} of the force, more than {100 * MISS:.0f} % off"
            lines += [f"{text} in {misses} of {len(found)} cases.", ""]
    return lines


def check_tables() -> list[str]:
    lines = ["### Checks of the solver", "", "| quantity | known | computed | error |", "| --- | ---: | ---: | ---: |"]
    for check in [*checks.hertz(), *checks.flat_punches(), *checks.energy()]:
        lines.append(f"| {check.what} | {check.known:.6g} | {check.computed:.6g} | {check.error:+.1e} |")
    pairs = checks.betas()
    lines += ["", "Shape factor of rectangular flat punches, k = 2 E* beta sqrt(A/pi):", ""]
    lines += ["| aspect | " + " | ".join(f"{a:g}" for a, _ in pairs) + " |", "| --- |" + " ---: |" * len(pairs)]
    return [*lines, "| beta | " + " | ".join(f"{b:.4f}" for _, b in pairs) + " |", ""]


def main() -> None:
    rows = compute()
    lines = []
    for family, (_, parameter) in FAMILIES.items():
        own = [r for r in rows if r["family"] == family]
        figures.draw(own, family, parameter, HERE / f"{family.replace(' ', '_')}.png")
        lines += family_table(family, own)
    lines += check_tables()
    readme = HERE / "README.md"
    before, _, rest = readme.read_text(encoding="utf-8").partition(START)
    _, _, after = rest.partition(END)
    readme.write_text("\n".join([before.rstrip(), "", START, "", *lines, END]) + after, encoding="utf-8")


if __name__ == "__main__":
    main()

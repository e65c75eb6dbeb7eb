"""The contact laboratory: draw every figure of this folder and write the tables of the README beside it.

    python -m validation.contact_lab.run [--out DIR] [PART ...]

from the root of the repository. PART: overlaps, tilts, restitution, rises, loops, collisions, random; all of them unless given.
"""

import argparse
import shutil
import time
from collections.abc import Callable
from pathlib import Path

from validation.contact_lab import collisions, loops, overlaps, random_collisions, restitution, rises, tilt_figures
from validation.contact_lab.drawing import save_png
from validation.contact_lab.tilts import ROLLS

HERE = Path(__file__).parent
Table = list[str]


def draw_overlaps(out: Path) -> Table:
    drawn, lines = overlaps.figure()
    save_png(drawn, out, "force_by_overlap")
    return lines


def draw_tilts(out: Path) -> Table:
    for roll in ROLLS:
        save_png(tilt_figures.figure(roll), out, f"tilt_{roll.name}")
    return tilt_figures.jump_table()


def draw_restitution(out: Path) -> Table:
    found = restitution.survey()
    save_png(restitution.figure(found), out, "restitution")
    return restitution.table(found)


def draw_rises(out: Path) -> Table:
    found = rises.survey()
    save_png(rises.figure(found), out, "rises")
    return rises.table(found)


def draw_loops(out: Path) -> Table:
    found = loops.survey()
    save_png(loops.figure(found), out, "loops")
    return loops.table(found)


def draw_collisions(out: Path) -> Table:
    found = collisions.survey()
    save_png(collisions.figure(found), out, "collisions")
    return collisions.table(found)


def draw_random(out: Path) -> Table:
    found = random_collisions.survey()
    save_png(random_collisions.figure(found), out, "random_collisions")
    return random_collisions.table(found)


PARTS: dict[str, Callable[[Path], Table]] = {
    "overlaps": draw_overlaps,
    "tilts": draw_tilts,
    "restitution": draw_restitution,
    "rises": draw_rises,
    "loops": draw_loops,
    "collisions": draw_collisions,
    "random": draw_random,
}


def put_table(readme: Path, part: str, lines: Table) -> None:
    """Replace what stands between a part's two markers."""
    start, end = f"<!-- table {part}: written by run.py -->", f"<!-- end of table {part} -->"
    before, found, rest = readme.read_text(encoding="utf-8").partition(start)
    _, closed, after = rest.partition(end)
    if not (found and closed):
        raise SystemExit(f"{readme}: has no place for the table {part}; it goes between {start} and {end}")
    readme.write_text("\n".join([before + start, "", *lines, "", end]) + after, encoding="utf-8")


def main() -> None:
    parser = argparse.ArgumentParser(description="Figures and tables of the contact laboratory.")
    parser.add_argument("--out", type=Path, default=HERE, help="folder of the figures and of the README with the tables")
    parser.add_argument("parts", nargs="*", metavar="PART", help=f"{', '.join(PARTS)}; all unless given")
    asked = parser.parse_args()
    unknown = [part for part in asked.parts if part not in PARTS]
    if unknown:
        parser.error(f"there is no part {unknown[0]!r}; the parts are {', '.join(PARTS)}")
    asked.out.mkdir(parents=True, exist_ok=True)
    readme = asked.out / "README.md"
    if not readme.exists():
        shutil.copy(HERE / "README.md", readme)
    for part in asked.parts or PARTS:
        started = time.perf_counter()
        put_table(readme, part, PARTS[part](asked.out))
        print(f"{part}: {time.perf_counter() - started:.0f} s", flush=True)


if __name__ == "__main__":
    main()

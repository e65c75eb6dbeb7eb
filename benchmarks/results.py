"""Results on disk: results.csv, a row for every configuration, and results_others.csv, a row for every other figure."""

import csv
from pathlib import Path

RESULTS, OTHERS = "results.csv", "results_others.csv"
#: columns that hold words; the others hold numbers, empty where there is none
WORDS = {
    "scene", "model", "name", "unit", "note", "date", "program", "processor", "system", "python", "numba", "numpy", "coal", "layer",
}  # fmt: skip
#: columns that hold whole numbers
WHOLE = {"size", "floes", "threads", "steps", "span", "contacts", "listed_pairs", "near_pairs", "coal_contacts", "cores"}


def read(path: Path) -> list[dict]:
    """Rows of a file of results; none where there is no file."""
    if not path.exists():
        return []
    with path.open(newline="", encoding="utf-8") as file:
        return [{name: _value(name, text) for name, text in row.items()} for row in csv.DictReader(file)]


def _value(name: str, text: str):
    if name in WORDS:
        return text
    if text == "":
        return None
    return int(text) if name in WHOLE else float(text)


def grouped(value: int) -> str:
    """A whole number for a reader, in groups of three digits where it has more than four."""
    return f"{value:,}".replace(",", " ") if value >= 10_000 else str(value)


def _text(value) -> str:
    if value is None:
        return ""
    return f"{value:.5g}" if isinstance(value, float) else str(value)


def write(path: Path, rows: list[dict]) -> None:
    """Replace a file of results."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, list(rows[0]), lineterminator="\n")
        writer.writeheader()
        writer.writerows({name: _text(value) for name, value in row.items()} for row in rows)


def merged(old: list[dict], new: list[dict], keys: tuple[str, ...]) -> list[dict]:
    """New rows in the place of the old ones with the same keys, others after them.

    Old rows with other columns come from another state of these programs, and go.
    """
    if new:
        old = [row for row in old if set(row) == set(new[0])]
    fresh = {tuple(row[key] for key in keys): row for row in new}
    kept = [fresh.pop(tuple(row[key] for key in keys), row) for row in old]
    return kept + list(fresh.values())

"""Tables of time that a case file names: how driven structures move."""

import csv
from pathlib import Path

from dilatedem.errors import CaseError
from dilatedem.structures.support import MOST_ROWS, MOTION_COLUMNS

#: bytes of the largest such file
LARGEST = 2**22


def fill_tables(data: dict, folder: Path) -> None:
    """Put the rows of each file that a support names beside its name, in place; files lie relative to `folder`.

    What has its rows already is left as it is: the case of a run is repeated without the file. Raises CaseError for a file that
    cannot be read, or is no such table.
    """
    structures = data.get("structure")
    for number, structure in enumerate(structures if isinstance(structures, list) else []):
        support = structure.get("support") if isinstance(structure, dict) else None
        if isinstance(support, dict) and isinstance(support.get("file"), str) and support.get("table") is None:
            support["table"] = _rows(folder / support["file"], f"structure.{number}.support.file")


def _rows(path: Path, key: str) -> list[list[float]]:
    try:
        with path.open(encoding="utf-8-sig", newline="") as file:
            text = file.read(LARGEST + 1)
    except FileNotFoundError:
        raise CaseError(f"{key}: {path}: no such file; it is looked for beside the case file") from None
    except (OSError, ValueError) as error:
        raise CaseError(f"{key}: {path}: cannot be read: {getattr(error, 'strerror', None) or error}") from None
    lines = text.splitlines()
    names = [name.strip() for name in lines[0].split(",")] if lines else []
    if any(names.count(name) != 1 for name in MOTION_COLUMNS):
        raise CaseError(f"{key}: {path}: must begin with a line that names the columns {', '.join(MOTION_COLUMNS)}")
    if len(text) > LARGEST or len(lines) > MOST_ROWS + 1:
        raise CaseError(f"{key}: {path}: has more than {MOST_ROWS} rows; give fewer, motion is smooth between them")
    where = [names.index(name) for name in MOTION_COLUMNS]
    return [_numbers(row, where, f"{key}: {path}:{line}") for line, row in enumerate(csv.reader(lines[1:]), start=2) if any(row)]


def _numbers(row: list[str], where: list[int], place: str) -> list[float]:
    try:
        return [float(row[i]) for i in where]
    except (IndexError, ValueError):
        raise CaseError(f"{place}: must hold a number for each of {', '.join(MOTION_COLUMNS)}") from None

"""Tables of time that a case file names: how driven structures move, how current and wind change."""

import csv
from collections.abc import Iterator
from pathlib import Path

from dilatedem.errors import CaseError
from dilatedem.keys import MOST_ROWS
from dilatedem.structures.support import MOTION_COLUMNS

#: bytes of the largest such file
LARGEST = 2**22
#: columns of a file of current or wind
FLOW_COLUMNS = ("time_s", "u_m_s", "v_m_s")


def fill_tables(data: dict, folder: Path) -> None:
    """Put the rows of each file that a table of the case names beside its name, in place; files lie relative to `folder`.

    What has its rows already is left as it is: the case of a run is repeated without the file. Raises CaseError for a file that
    cannot be read, or is no such table.
    """
    for table, name, rows, columns, place in _named(data):
        if isinstance(table, dict) and isinstance(table.get(name), str) and table.get(rows) is None:
            table[rows] = _rows(folder / table[name], columns, f"{place}.{name}")


def _named(data: dict) -> Iterator[tuple]:
    """Where files may be named: the table, its keys for a file and for the rows, the columns, and the table's place in the case."""
    for flow in ("water", "wind"):
        yield data.get(flow), "velocity_file", "velocity_table", FLOW_COLUMNS, flow
    structures = data.get("structure")
    for number, structure in enumerate(structures if isinstance(structures, list) else []):
        support = structure.get("support") if isinstance(structure, dict) else None
        yield support, "file", "table", MOTION_COLUMNS, f"structure.{number}.support"


def _rows(path: Path, columns: tuple[str, ...], key: str) -> list[list[float]]:
    try:
        with path.open(encoding="utf-8-sig", newline="") as file:
            text = file.read(LARGEST + 1)
    except FileNotFoundError:
        raise CaseError(f"{key}: {path}: no such file; it is looked for beside the case file") from None
    except (OSError, ValueError) as error:
        raise CaseError(f"{key}: {path}: cannot be read: {getattr(error, 'strerror', None) or error}") from None
    lines = text.splitlines()
    names = [name.strip() for name in lines[0].split(",")] if lines else []
    if any(names.count(name) != 1 for name in columns):
        raise CaseError(f"{key}: {path}: must begin with a line that names the columns {', '.join(columns)}")
    if len(text) > LARGEST or len(lines) > MOST_ROWS + 1:
        raise CaseError(f"{key}: {path}: has more than {MOST_ROWS} rows; give fewer, it goes on from one to the next")
    where = [names.index(name) for name in columns]
    found = []
    for line, row in enumerate(csv.reader(lines[1:]), start=2):
        try:
            found += [[float(row[i]) for i in where]] if any(row) else []
        except (IndexError, ValueError):
            raise CaseError(f"{key}: {path}:{line}: must hold a number for each of {', '.join(columns)}") from None
        if len(found) > 1 and found[-1][0] <= found[-2][0]:
            raise CaseError(f"{key}: {path}:{line}: {columns[0]} = {found[-1][0]:g} must be more than in the row before")
    if not found:
        raise CaseError(f"{key}: {path}: has no rows below the names of its columns")
    return found

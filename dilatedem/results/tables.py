"""CSV tables of a run, without a last line that was cut short: as columns of NumPy, and as DataFrames."""

from __future__ import annotations

import contextlib
import csv
import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from dilatedem.errors import CaseError
from dilatedem.results.packages import imported

if TYPE_CHECKING:
    import pandas

Table = dict[str, np.ndarray]  # column name -> (rows,) float64, or object where a column holds text

#: columns that hold names: a structure may be called `1`
TEXT_COLUMNS = frozenset({"structure", "mode"})
#: columns that hold numbers of bodies, or how many; all other numbers are float64, whatever a run happened to write
WHOLE_COLUMNS = frozenset({"body", "bodies"})


def row_count(table: Table) -> int:
    return len(next(iter(table.values()))) if table else 0


def whole_lines(path: Path) -> str:
    """The text of a table up to its last line end: beyond it a number may lack its last digits."""
    text = path.read_text(encoding="utf-8", errors="replace")
    return text[: text.rfind("\n") + 1]


def read_table(path: Path) -> Table:
    """A CSV file by columns; no file gives no columns. Raises CaseError for a file that is no table at all."""
    if not path.is_file():
        return {}
    lines = whole_lines(path).splitlines()
    if not lines:
        return {}
    header, *rows = lines
    try:
        names = next(csv.reader([header]), [])
        if not names:
            raise CaseError(f"{path}: no table that can be read: its first line is empty")
        with contextlib.suppress(ValueError):  # text or empty cells among the numbers, rows of other lengths
            return numbers_and_names(names, rows)
        cells = [row for row in csv.reader(rows) if len(row) == len(names)]
    except csv.Error as error:
        raise CaseError(f"{path}: no table that can be read: {error}") from error
    columns = zip(*cells, strict=True) if cells else [()] * len(names)
    return {name: as_column(name, column) for name, column in zip(names, columns, strict=True)}


def numbers_and_names(names: list[str], rows: list[str]) -> Table:
    """The columns of a table that holds numbers but for TEXT_COLUMNS, five times as fast as cell by cell.

    Raises ValueError for any other.
    """
    if not any(rows):
        raise ValueError("no rows")
    text = [name for name in names if name in TEXT_COLUMNS]
    style = {"delimiter": ",", "quotechar": '"', "comments": None, "ndmin": 2}
    where = [i for i, name in enumerate(names) if name not in TEXT_COLUMNS]
    numbers = dict(zip([names[i] for i in where], np.loadtxt(rows, usecols=where, **style).T, strict=True))
    words = {name: np.loadtxt(rows, str, usecols=[names.index(name)], **style)[:, 0].astype(object) for name in text}
    return {name: words[name] if name in words else np.ascontiguousarray(numbers[name]) for name in names}


def as_column(name: str, column: tuple[str, ...]) -> np.ndarray:
    """Cells as numbers where all of them are, else as the text they are."""
    try:
        if name not in TEXT_COLUMNS:
            return np.array([float(text) if text else math.nan for text in column], dtype=np.float64)
    except ValueError:
        pass
    return np.array(column, dtype=object)


def read_frame(path: Path) -> pandas.DataFrame:
    """A CSV file as a DataFrame. Raises CaseError when the run has no such file, or one without a header yet."""
    if not path.is_file():
        raise CaseError(f"{path.parent}: this run has no {path.name}")
    pandas = imported("pandas")
    table = read_table(path)
    if not table:
        raise CaseError(f"{path}: nothing has been written to it yet")
    for name in WHOLE_COLUMNS & table.keys():
        if table[name].dtype == np.float64 and np.isfinite(table[name]).all():
            table[name] = table[name].astype(np.int64)
    return pandas.DataFrame(table)


def split_by_structure(table: Table, case: dict[str, Any]) -> dict[str, Table]:
    """Rows of a table by the structure they belong to, structures in the order of the case, each before its parts,
    then their total, then the others."""
    if not row_count(table) or "structure" not in table:
        return {}
    label = table["structure"]
    known = [name for structure in case.get("structure", []) for name in _names(structure)]
    known.append("total")  # all of them together
    names = [name for name in known if name in label] + sorted(set(label) - set(known))
    numeric = [name for name in table if name != "structure"]
    return {name: {column: table[column][label == name] for column in numeric} for name in names}


def _names(structure: dict[str, Any]) -> list[str]:
    """Of a structure of a case and of its parts."""
    return [str(structure.get("name")), *(f"{structure.get('name')}/{part.get('name')}" for part in structure.get("part", []))]

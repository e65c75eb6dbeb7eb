"""Whether files hold what a run writes into them: damage is told in a sentence, before anything is made of it.

What a killed run left out, or a last line that it cut short, is no damage: that is read as far as it goes.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

import numpy as np

from dilatedem.errors import CaseError, printable
from dilatedem.results.tables import TEXT_COLUMNS, Table, row_count

#: digits that the largest whole number of a file has (64 bits)
MOST_DIGITS = 19
#: tables and lists in each other, at most
MOST_DEPTH = 24

#: columns without which a table is none
REQUIRED = {
    "forces.csv": (
        "time_s", "structure", "fx_N", "fy_N", "fz_N", "mx_Nm", "my_Nm", "mz_Nm", "fx_min_N", "fx_max_N", "fy_min_N", "fy_max_N",
        "fh_max_N", "contacts",
    ),
    "energy.csv": ("time_s", "residual"),
    "bodies.csv": ("time_s", "body"),
    "hits.csv": (
        "structure", "start_s", "rise_s", "duration_s", "peak_N", "peak_time_s", "impulse_Ns", "body", "mode", "area_m2",
        "pressure_Pa", "crushed_m", "bodies",
    ),
    "structures.csv": ("time_s", "structure", "x_m", "y_m", "yaw_rad", "vx_m_s", "vy_m_s", "reaction_x_N", "reaction_y_N"),
}  # fmt: skip
#: what tells rows of one time apart
SERIES = {"forces.csv": "structure", "bodies.csv": "body", "hits.csv": "structure", "structures.csv": "structure"}
#: the column of times, which go on from row to row of a series
TIME = {"hits.csv": "start_s"}

Check = Callable[[Any], str]  # what is wrong with a value, empty where nothing is


def damaged(path: Path, what: str) -> CaseError:
    """The fault of a file that no run has written like that."""
    return CaseError(f"{printable(str(path))}: {printable(what)}: the file is damaged; restore it, or remove it to do without")


def _whole(value: Any) -> str:
    fine = isinstance(value, int) and not isinstance(value, bool) and abs(value) < 10**MOST_DIGITS
    return "" if fine else "must be a whole number"


def _number(value: Any) -> str:
    fine = isinstance(value, int | float) and not isinstance(value, bool) and abs(value) < 1e300
    return "" if fine else "must be a finite number"


def _length(value: Any) -> str:
    return _number(value) or ("" if value > 0 else "must be greater than 0")


def _text(value: Any) -> str:
    return "" if isinstance(value, str) else "must be text"


def _truth(value: Any) -> str:
    return "" if isinstance(value, bool) else "must be true or false"


def _maybe(check: Check) -> Check:
    return lambda value: "" if value is None else check(value)


def _vector(check: Check) -> Check:
    def each(value: Any) -> str:
        return "" if isinstance(value, list) and len(value) == 2 and not any(map(check, value)) else "must be a list of 2 numbers"

    return each


def _table(*, rest: Check = lambda value: "", **keys: Check) -> Check:
    """A table whose `keys`, those that are there, hold what they should; rest: what all others hold."""

    def look(value: Any) -> str:
        if not isinstance(value, dict):
            return "must be a table"
        for name, item in value.items():
            if fault := keys.get(name, rest)(item):
                return f"{name}: {fault}" if fault.startswith("must") else f"{name}.{fault}"
        return ""

    return look


def _list(check: Check) -> Check:
    def look(value: Any) -> str:
        if not isinstance(value, list):
            return "must be a list"
        for i, item in enumerate(value):
            if fault := check(item):
                return f"{i}: {fault}" if fault.startswith("must") else f"{i}.{fault}"
        return ""

    return look


#: what readers count on in case.toml
_CASE = _table(
    title=_text, domain=_table(size=_vector(_length), x_boundary=_text, y_boundary=_text), field=_table(seed=_whole), ice=_table(),
    water=_table(enabled=_truth, velocity=_vector(_number)), wind=_table(), gravity=_table(), contact=_table(model=_text),
    time=_table(duration=_length), output=_table(snapshot_interval=_number),
    structure=_list(_table(name=_text, kind=_text, support=_table(kind=_text))),
    body=_list(_table(fixed=_truth)),
)  # fmt: skip
_figure = _maybe(_number)
#: and in summary.json
_SUMMARY = _table(
    status=_text, message=_maybe(_text), title=_text, version=_text, versions=_table(rest=_text), origin=_table(rest=_text),
    seed=_maybe(_whole), floes=_whole, steps=_whole, dt_s=_maybe(_length), dt_critical_s=_maybe(_length), simulated_s=_figure,
    duration_s=_figure, wall_s=_figure, compile_s=_figure, threads=_whole,
    loads=_table(rest=_table(rest=_maybe(lambda value: _truth(value) and _number(value)))),
    energy=_table(rest=_figure), contact=_table(), motion=_table(rest=_table(rest=_number)),
    natural_frequencies=_table(rest=_table(rest=_list(_number))),
    hits=_table(
        threshold_N=_figure, gap_s=_figure, meaning=_text, structures=_table(rest=_table(rest=_figure)),
    ),
    flexure=_table(
        strength_Pa=_figure, floes=_whole, above_strength=_whole, first_above_s=_figure, largest_Pa=_figure, largest_time_s=_figure,
        largest_body=_maybe(_whole), meaning=_text,
    ),
    until=_table(met=_list(_text), message=_text),
    inflow=_table(
        entered=_whole, left=_whole, omitted=_whole, ice_m=_figure, waited_s=_figure, waited_first_s=_figure
    ),
    error_check=_table(
        message=_text, structure=_maybe(_text), start_s=_figure, end_s=_figure, change=_maybe(_table(rest=_figure)), wall_s=_figure
    ),
)  # fmt: skip


def require_case(case: dict[str, Any], path: Path) -> None:
    """Raises CaseError where case.toml holds what no case does, as far as readers count on it."""
    _require(case, _CASE, path)


def require_summary(summary: dict[str, Any], path: Path) -> None:
    """Raises CaseError where summary.json holds what no summary does, as far as readers count on it."""
    _require(summary, _SUMMARY, path)


def _require(content: dict[str, Any], check: Check, path: Path) -> None:
    if fault := _unshowable(content) or check(content):
        raise damaged(path, fault)


def _unshowable(content: dict[str, Any]) -> str:
    """Nesting that Python would not walk through, whole numbers that it would not write."""
    waiting: list[tuple[int, Any]] = [(0, content)]
    while waiting:
        depth, value = waiting.pop()
        if depth > MOST_DEPTH:
            return "is nested too deeply"
        if isinstance(value, dict | list):
            waiting += [(depth + 1, item) for item in (value.values() if isinstance(value, dict) else value)]
        elif isinstance(value, int) and abs(value) >= 10**MOST_DIGITS:
            return "holds a whole number of too many digits"
    return ""


def require_table(table: Table, path: Path) -> Table:
    """A table of a run, as it is. Raises CaseError for missing columns, cells that are no finite numbers, times that go back."""
    if not table:
        return table
    missing = [name for name in REQUIRED.get(path.name, ()) if name not in table]
    if missing:
        raise damaged(path, f"has no column {', '.join(missing)}")
    if not row_count(table):
        return table
    for name in table:
        if name in TEXT_COLUMNS:
            continue
        column = table[name]
        wrong = np.flatnonzero(~np.isfinite(column)) if column.dtype.kind in "iuf" else _not_numbers(column)
        if len(wrong):
            raise damaged(path, f"row {wrong[0] + 1}: {name} = {str(column[wrong[0]])[:40]} is no finite number")
    time = TIME.get(path.name, "time_s")
    series = table.get(SERIES.get(path.name, ""), np.zeros(row_count(table)))
    for which in dict.fromkeys(series.tolist()):
        rows = np.flatnonzero(series == which)
        back = np.flatnonzero(np.diff(table[time][rows]) <= 0.0)
        if len(back):
            raise damaged(path, f"row {rows[back[0] + 1] + 1}: {time} does not go on from the row before")
    if table[time].min() < 0.0:
        raise damaged(path, "a time is negative")
    return table


def _not_numbers(column: Iterable[Any]) -> np.ndarray:
    """Places of the cells that are no numbers, of a column that holds texts."""

    def is_number(cell: Any) -> bool:
        try:
            return math.isfinite(float(cell))
        except ValueError:
            return False

    return np.array([i for i, cell in enumerate(column) if not is_number(cell)], dtype=np.int64)


def require_array(values: np.ndarray, shape: tuple[int | None, ...], what: str) -> np.ndarray:
    """`values` as finite numbers of this shape (None: any length). Raises ValueError that says `what` they are."""
    values = np.asarray(values)
    if values.dtype.kind not in "iuf" or values.ndim != len(shape):
        raise ValueError(f"{what} holds no numbers of {len(shape)} dimensions")
    if any(wanted is not None and length != wanted for length, wanted in zip(values.shape, shape, strict=True)):
        raise ValueError(f"{what} has shape {values.shape}")
    if not np.isfinite(values).all():
        raise ValueError(f"{what} holds a value that is not finite")
    return values

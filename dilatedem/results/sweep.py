"""A sweep folder: its table, and its runs, each read when it is asked for."""

from __future__ import annotations

import csv
import math
import tomllib
from collections.abc import Iterator, Sequence
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from dilatedem.errors import CaseError
from dilatedem.results.files import is_run
from dilatedem.results.packages import imported
from dilatedem.results.run import Run
from dilatedem.results.tables import read_frame

if TYPE_CHECKING:
    import pandas

#: columns of sweep.csv that hold words, whatever they look like
WORDS = frozenset({"run", "status", "message"})


class Sweep:
    """What a sweep folder holds. Nothing is read before it is asked for."""

    def __init__(self, path: Path):
        self.path = path

    def __repr__(self) -> str:
        return f"<dilatedem sweep {str(self.path)!r}: {len(self.runs)} runs over {', '.join(self.keys) or 'seeds'}>"

    @cached_property
    def _rows(self) -> tuple[list[str], list[dict[str, str]]]:
        return read_rows(self.path)

    @property
    def keys(self) -> list[str]:
        """The keys of the case that vary, the seed apart unless it was varied as a key."""
        return varied_keys(self._rows[0])

    @cached_property
    def table(self) -> pandas.DataFrame:
        """sweep.csv, a row a run, numbers as numbers and what is empty as NaN.

        A key whose values are vectors keeps its column of text; its components, as numbers, follow in columns of their own:
        `water.velocity`, then `water.velocity.0`, `water.velocity.1`; so they do in the file, unless an earlier version wrote it.
        """
        pandas = imported("pandas")
        header, rows = self._rows
        columns: dict[str, Any] = {}
        for name in header:
            cells = [row[name] for row in rows]
            columns |= {name: cells} if name in WORDS else as_columns(name, cells, taken=header)
        return pandas.DataFrame(columns)

    @cached_property
    def statistics(self) -> pandas.DataFrame:
        """statistics.csv, as `dilatedem post` wrote it: a row per number, with its band. Raises CaseError where it is not there."""
        path = self.path / "statistics.csv"
        if not path.is_file():
            raise CaseError(f"{self.path}: this sweep has no {path.name}; dilatedem post {self.path} makes it")
        return read_frame(path)

    @cached_property
    def runs(self) -> Runs:
        """The runs in the order of the table: `runs[3]`, `runs["water.velocity.0=0.3__seed=2"]`, or one after the other."""
        _, rows = self._rows
        return Runs([locate(row["run"], self.path) for row in rows])


class Runs(Sequence[Run]):
    """Runs by number or by the name of their folder; each is loaded, once, when it is asked for.

    Raises CaseError for a run that has left no case.toml: it failed before its first file, or has yet to begin.
    """

    def __init__(self, folders: Sequence[Path]):
        self.folders = list(folders)
        self._loaded: dict[Path, Run] = {}

    def __len__(self) -> int:
        return len(self.folders)

    def __iter__(self) -> Iterator[Run]:
        return (self._run(folder) for folder in self.folders)

    def __getitem__(self, which: int | str | slice) -> Any:
        if isinstance(which, slice):
            return Runs(self.folders[which])
        if isinstance(which, str):
            found = [folder for folder in self.folders if folder.name == which]
            if not found:
                raise CaseError(f"{which}: no run of this sweep; there are {', '.join(folder.name for folder in self.folders)}")
            return self._run(found[0])
        return self._run(self.folders[which])

    def __repr__(self) -> str:
        return f"<{len(self)} runs: {', '.join(folder.name for folder in self.folders)}>"

    def _run(self, folder: Path) -> Run:
        if folder not in self._loaded:
            if not is_run(folder):
                raise CaseError(f"{folder}: no run to be found here (there is no case.toml in it)")
            self._loaded[folder] = Run(folder)
        return self._loaded[folder]


def varied_keys(header: Sequence[str]) -> list[str]:
    """The keys that vary, of the columns of sweep.csv: those left of `seed`, but for the components of vectors among them."""
    left = header[: header.index("seed")]
    return [name for name in left if not (name.rpartition(".")[2].isdecimal() and name.rpartition(".")[0] in left)]


def read_rows(folder: Path) -> tuple[list[str], list[dict[str, str]]]:
    """Header and rows of sweep.csv, cells as text; a row that was cut short is left out.

    The columns left of `seed` tell what varies (`varied_keys`). Raises CaseError when it is another kind of table.
    """
    path = folder / "sweep.csv"
    text = path.read_text(encoding="utf-8", errors="replace")
    try:
        lines = list(csv.reader(text.splitlines()))
    except csv.Error as error:
        raise CaseError(f"{path}: not the table of a sweep ({error})") from error
    if not lines or "seed" not in lines[0] or "run" not in lines[0]:
        raise CaseError(f"{path}: not the table of a sweep (it has no columns seed and run)")
    header, *rows = lines
    return header, [dict(zip(header, row, strict=True)) for row in rows if len(row) == len(header)]


def locate(name: str, sweep_folder: Path) -> Path:
    """A run's folder as sweep.csv names it, also when the sweep was moved since."""
    candidates = [sweep_folder / name, Path(name), sweep_folder / Path(name).name]
    return next((path for path in candidates if is_run(path)), candidates[0])


def parse_value(text: str) -> Any:
    """A cell as the TOML value it is; anything else is text."""
    if text == "":
        return None
    try:
        return tomllib.loads(f"value = {text}")["value"]
    except (ValueError, RecursionError):  # no TOML, or numbers and nesting beyond what Python reads
        return text


def as_columns(name: str, cells: list[str], *, taken: Sequence[str]) -> dict[str, list[Any]]:
    """A column of sweep.csv as the columns it makes: numbers; truth values; text; text and the components of its vectors.

    taken: names that components must leave alone, as the grid varies them, too
    """
    values = [parse_value(cell) for cell in cells]
    if all(value is None or is_number(value) for value in values):
        whole = all(isinstance(value, int) for value in values)
        return {name: values if whole else [math.nan if value is None else float(value) for value in values]}
    if all(isinstance(value, bool) for value in values):
        return {name: values}
    columns: dict[str, list[Any]] = {name: cells}
    if all(value is None or (isinstance(value, list) and all(map(is_number, value))) for value in values):
        vectors = [value or [] for value in values]
        for i in range(max(map(len, vectors))):
            if f"{name}.{i}" not in taken:
                columns[f"{name}.{i}"] = [float(vector[i]) if i < len(vector) else math.nan for vector in vectors]
    return columns


def is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)

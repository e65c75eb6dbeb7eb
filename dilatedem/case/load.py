"""Reading a case: TOML text, overrides on top, the schema's verdict, every fault in one message."""

import difflib
import re
import sys
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path as FilePath
from typing import Any

from pydantic import ValidationError

from dilatedem.case import faults
from dilatedem.case.histories import fill_tables
from dilatedem.case.limits import MOST_FAULTS, impossible
from dilatedem.case.lines import Path, line_numbers, line_of
from dilatedem.case.overrides import Override, apply, parse
from dilatedem.case.schema import Case
from dilatedem.errors import CaseError

STANDARD_INPUT = "-"
#: bytes of the largest case file; 100 000 bodies take a third of it
LARGEST_FILE = 2**26
#: Python reads whole numbers of so many digits, and TOML needs 19
_LONG_INTEGER = re.compile(r"(?<![\w.])[-+]?[0-9_]{4300,}(?![\w.])")


@dataclass(frozen=True)
class Source:
    """The text of a case file and the name under which messages speak of it."""

    name: str
    text: str


def load(path: str | FilePath, overrides: Sequence[str] = ()) -> Case:
    """The case at `path`, or on standard input for `-`, with overrides KEY=VALUE laid over it.

    Fails with CaseError, whose text has one line per fault.
    """
    return build(read(path), [parse(text) for text in overrides])


def read(path: str | FilePath) -> Source:
    """The text of the case file at `path`, or of standard input for `-`."""
    if str(path) == STANDARD_INPUT:
        stream = getattr(sys.stdin, "buffer", None)  # a stand-in for it may hold text alone
        return _decoded("<stdin>", stream.read(LARGEST_FILE + 1) if stream else sys.stdin.read().encode())
    name = str(path)
    try:
        with FilePath(path).open("rb") as file:
            return _decoded(name, file.read(LARGEST_FILE + 1))
    except FileNotFoundError:
        raise CaseError(f"{name}: no such case file{_neighbour(FilePath(path))}") from None
    except IsADirectoryError:
        raise CaseError(f"{name}: is a folder; name a file, such as {name.rstrip('/')}/case.toml") from None
    except OSError as error:
        raise CaseError(f"{name}: cannot be read: {error.strerror}") from None


def _decoded(name: str, content: bytes) -> Source:
    """The text of a case file, without the mark that some editors put in front. Raises CaseError for what is no text."""
    if len(content) > LARGEST_FILE:
        raise CaseError(f"{name}: is larger than {LARGEST_FILE // 2**20} MB, so it is no case file")
    try:
        return Source(name, content.decode("utf-8-sig"))
    except UnicodeDecodeError as error:
        raise CaseError(f"{name}: is not UTF-8 text (byte {error.start}), so it is no case file") from None


def case_from(source: str | FilePath | dict | Case, overrides: Mapping[str, Any]) -> Case:
    """A case from a file, from a dictionary that is laid out like one, or from another case, with overrides laid over it.

    overrides: values by dotted key, or dictionaries of them by table. Fails as `load` does.
    """
    laid_over = [Override(key, value, f"override {key}") for key, value in _flat(overrides)]
    if isinstance(source, dict | Case):
        data = source.model_dump(exclude_none=True) if isinstance(source, Case) else source
        _accepted(Source("case", ""), data)  # before it is copied, level by level
        return _validated(Source("case", ""), _copied(data), laid_over)
    return build(read(source), laid_over)


def _copied(data: Any) -> Any:
    """`data` in new tables and lists, which overrides may change."""
    if isinstance(data, dict):
        return {name: _copied(item) for name, item in data.items()}
    return [_copied(item) for item in data] if isinstance(data, list) else data


def _flat(overrides: Mapping[str, Any], before: str = "") -> Iterator[tuple[str, Any]]:
    for key, value in overrides.items():
        if isinstance(value, Mapping):
            yield from _flat(value, f"{before}{key}.")
        else:
            yield f"{before}{key}", value.tolist() if hasattr(value, "tolist") else value


def build(source: Source, laid_over: Sequence[Override] = ()) -> Case:
    """The case of a text, with overrides laid over it in order. Fails as `load` does."""
    try:
        data = tomllib.loads(source.text)
    except RecursionError:
        raise CaseError(f"{source.name}: is nested too deeply to be a case") from None
    except ValueError as error:
        raise CaseError(_syntax(source, str(error))) from None
    return _validated(source, data, laid_over)


def _validated(source: Source, data: dict, laid_over: Sequence[Override]) -> Case:
    """The case of `data`, which the overrides change. Fails as `load` does."""
    written = [(apply(data, override), override) for override in laid_over]
    _accepted(source, data, written)
    fill_tables(data, FilePath(source.name).parent)
    try:
        return Case.model_validate(data, context={"folder": FilePath(source.name).parent})
    except ValidationError as error:
        lines = line_numbers(source.text)
        by_line = sorted(faults.items(error), key=lambda item: line_of(faults.path_of(item), lines) or 0)
        found, count = faults.sentences(by_line[:MOST_FAULTS], data), len(by_line)
    found.sort(key=lambda fault: line_of(fault[0], lines) or 0)
    raise CaseError(_told(found, count, source, lines, written)) from None


def _accepted(source: Source, data: dict, written: Sequence[tuple[Path, Override]] = ()) -> None:
    """Raises CaseError for values that no schema can look at."""
    try:
        found = impossible(data)
    except CaseError as error:
        raise CaseError(f"{source.name}: {error}") from None
    if found:
        found = [(path, faults.key_and_value(path, text, data)) for path, text in found]
        raise CaseError(_told(found[:MOST_FAULTS], len(found), source, line_numbers(source.text), written))


def _told(
    found: Sequence[tuple[Path, str]], count: int, source: Source, lines: dict[Path, int], written: Sequence[tuple[Path, Override]]
) -> str:
    """A line a fault, with the place it comes from; `count`: of all, told or not."""
    told = [_place_and_text(_origin(path, source, lines, written), path, text) for path, text in found]
    more = [f"{source.name}: and more; {count} in all"] if count > MOST_FAULTS else []
    return "\n".join([*told, *more])


def _place_and_text(origin: str, path: Path, text: str) -> str:
    """A fault behind the place it comes from, its key said once where the place names it."""
    key = f"{'.'.join(map(str, path))}: "
    return f"{origin}: {text.removeprefix(key) if origin.endswith(f' {key[:-2]}') else text}"


def _origin(path: Path, source: Source, lines: dict[Path, int], written: Sequence[tuple[Path, Override]]) -> str:
    """The override that wrote the value at `path`, else its line in the file."""
    for place, override in reversed(written):
        # A table begun by an override is named by it too, but not one that the file has as well.
        begun = place[: len(path)] == path and path not in lines
        if path and (path[: len(place)] == place or begun):
            return override.origin
    line = line_of(path, lines)
    return source.name if line is None else f"{source.name}:{line}"


def _syntax(source: Source, message: str) -> str:
    """tomllib's message, with its line number moved to the front where editors look for it."""
    if long := _LONG_INTEGER.search(source.text):
        line = source.text.count("\n", 0, long.start()) + 1
        return f"{source.name}:{line}: holds a whole number of {len(long[0])} digits; at most 18 can be read"
    text, _, place = message.partition(" (at ")
    if place.startswith("line "):
        line, _, column = place.removeprefix("line ").rstrip(")").partition(", column ")
        return f"{source.name}:{line}: not valid TOML at column {column}: {text}"
    return f"{source.name}: not valid TOML: {message}"


def _neighbour(path: FilePath) -> str:
    try:
        names = [entry.stem for entry in path.parent.iterdir() if entry.suffix == ".toml"]
    except OSError:
        return f"; there is no folder {path.parent}"
    close = difflib.get_close_matches(path.stem, names, n=1)
    return f"; did you mean {path.parent / close[0]}.toml?" if close else ""

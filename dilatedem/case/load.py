"""Reading a case: TOML text, overrides on top, the schema's verdict, every fault in one message."""

import copy
import difflib
import sys
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path as FilePath
from typing import Any

from pydantic import ValidationError

from dilatedem.case import faults
from dilatedem.case.lines import Path, line_numbers, line_of
from dilatedem.case.overrides import Override, apply, parse
from dilatedem.case.schema import Case
from dilatedem.errors import CaseError

STANDARD_INPUT = "-"


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
        return Source("<stdin>", sys.stdin.read())
    name = str(path)
    try:
        return Source(name, FilePath(path).read_bytes().decode("utf-8-sig"))
    except FileNotFoundError:
        raise CaseError(f"{name}: no such case file{_neighbour(FilePath(path))}") from None
    except IsADirectoryError:
        raise CaseError(f"{name}: is a folder; name a file, such as {name.rstrip('/')}/case.toml") from None
    except UnicodeDecodeError as error:
        raise CaseError(f"{name}: is not UTF-8 text (byte {error.start}), so it is no case file") from None
    except OSError as error:
        raise CaseError(f"{name}: cannot be read: {error.strerror}") from None


def case_from(source: str | FilePath | dict | Case, overrides: Mapping[str, Any]) -> Case:
    """A case from a file, from a dictionary that is laid out like one, or from another case, with overrides laid over it.

    overrides: values by dotted key, or dictionaries of them by table. Fails as `load` does.
    """
    laid_over = [Override(key, value, f"override {key}") for key, value in _flat(overrides)]
    if isinstance(source, dict | Case):
        data = source.model_dump(exclude_none=True) if isinstance(source, Case) else copy.deepcopy(source)
        return _validated(Source("case", ""), data, laid_over)
    return build(read(source), laid_over)


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
    try:
        return Case.model_validate(data)
    except ValidationError as error:
        lines = line_numbers(source.text)
        found = faults.sentences(error, data)
    found.sort(key=lambda fault: line_of(fault[0], lines) or 0)
    raise CaseError("\n".join(f"{_origin(path, source, lines, written)}: {text}" for path, text in found))


def _origin(path: Path, source: Source, lines: dict[Path, int], written: list[tuple[Path, Override]]) -> str:
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

"""Line numbers of the keys of a TOML text, which Python's own TOML reader does not give."""

import re
import tomllib

Path = tuple[str | int, ...]

_KEY_PART = re.compile(r'[ \t]*(?:"((?:[^"\\\n]|\\.)*)"|\'([^\'\n]*)\'|([A-Za-z0-9_-]+))[ \t]*')

# What a value is made of, as far as finding its end goes. Long strings come before short ones; up to two
# quotes may stand before the closing three.
_TOKEN = re.compile(
    r'"""(?:[^\\]|\\.)*?"{3,5}'
    r"|'''.*?'{3,5}"
    r'|"(?:[^"\\\n]|\\.)*"'
    r"|'[^'\n]*'"
    r"|\#[^\n]*"
    r"|[\[\]{}\n]"
    r"|[^\"'\#\[\]{}\n]+",
    re.DOTALL,
)


def line_numbers(text: str) -> dict[Path, int]:
    """The line (from 1) of every table header and key of `text`, which must be valid TOML.

    Paths hold the number of the item where they pass through an array of tables: ("structure", 0, "radius").
    What stands inside an inline table or an array has no entry; `line_of` takes that of the nearest parent.
    """
    lines: dict[Path, int] = {}
    items: dict[Path, int] = {}  # arrays of tables: number of the last item begun
    table: Path = ()
    position, line, counted = 0, 1, 0
    while position < len(text):
        if text[position] in " \t\r\n":
            position += 1
        elif text[position] == "#":
            position = _end_of_line(text, position)
        else:
            line, counted = line + text.count("\n", counted, position), position
            if text[position] == "[":
                is_array = text.startswith("[[", position)
                parts, position = _dotted_key(text, position + 1 + is_array)
                table = _resolved(parts, items)
                if is_array:
                    items[table] = items.get(table, -1) + 1
                    lines.setdefault(table, line)
                    table = (*table, items[table])
                elif table in items:
                    table = (*table, items[table])
                position = _end_of_line(text, position)
                path = table
            else:
                parts, position = _dotted_key(text, position)
                path = (*table, *parts)
                position = _end_of_value(text, position + 1)
            for depth in range(1, len(path) + 1):
                lines.setdefault(path[:depth], line)
    return lines


def line_of(path: Path, lines: dict[Path, int]) -> int | None:
    """The line of the key at `path`, else that of the innermost table or key around it, else None."""
    for depth in range(len(path), 0, -1):
        if path[:depth] in lines:
            return lines[path[:depth]]
    return None


def _dotted_key(text: str, position: int) -> tuple[tuple[str, ...], int]:
    parts = []
    while match := _KEY_PART.match(text, position):
        quoted, literal, bare = match.groups()
        if quoted is not None:
            parts.append(tomllib.loads(f'key = "{quoted}"')["key"])
        else:
            parts.append(bare or literal)
        position = match.end()
        if not text.startswith(".", position):
            break
        position += 1
    return tuple(parts), position


def _resolved(parts: tuple[str, ...], items: dict[Path, int]) -> Path:
    """The path of a header: below an array of tables it belongs to the last item begun there."""
    path: Path = ()
    for part in parts[:-1]:
        path = (*path, part)
        if path in items:
            path = (*path, items[path])
    return (*path, parts[-1])


def _end_of_line(text: str, position: int) -> int:
    end = text.find("\n", position)
    return len(text) if end < 0 else end


def _end_of_value(text: str, position: int) -> int:
    depth = 0
    while match := _TOKEN.match(text, position):
        token = match.group()
        if token == "\n" and depth == 0:
            return position
        if token in ("[", "{"):
            depth += 1
        elif token in ("]", "}"):
            depth -= 1
        position = match.end()
    return len(text)

"""Values from the command line, `water.velocity=[0.5,0]`, laid over the case file before it is checked."""

import difflib
import re
import tomllib
from dataclasses import dataclass
from typing import Any

from dilatedem.case import schema
from dilatedem.case.lines import Path
from dilatedem.errors import CaseError

#: digits of the number of an item, at most
_MOST_DIGITS = 9

# Numbers that people type and TOML refuses: a bare point before or after the digits, leading zeros.
_LOOSE_NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?")

# What is meant for a list: numbers with commas between them.
_NUMBERS_OF_A_LIST = re.compile(rf"{_LOOSE_NUMBER.pattern}(\s*,\s*{_LOOSE_NUMBER.pattern})+,?")

# What may tell how water or air flow.
_TOLD = {"velocity", "velocity_file", "velocity_table"}
# Keys of which a case has one: to give the one is to take back the other.
_ALTERNATIVES: dict[Path, tuple[str, ...]] = {
    ("field", "floe_size"): ("floe_count",),
    ("field", "floe_count"): ("floe_size",),
    **{(flow, name): tuple(_TOLD - {name}) for flow in ("water", "wind") for name in _TOLD},
}
#: the same of a distribution of floe sizes, by its kind
_IMPLIED = {"power_law": ("floe_size", "floe_count")}


@dataclass(frozen=True)
class Override:
    """One value for one key.

    key : dotted, list items by number or, for structures, by name: `structure.pile.radius`.
    origin : how messages name it, `--set structure.pile.radius`.
    """

    key: str
    value: Any
    origin: str


def parse(text: str, option: str = "--set") -> Override:
    """An override from KEY=VALUE."""
    key, equals, value = text.partition("=")
    key = key.strip()
    if not equals or not all(key.split(".")):
        raise CaseError(f"{option} {text}: must be KEY=VALUE, as in {option} water.velocity=[0.5,0]")
    origin = f"{option} {key}"
    return Override(key, parse_value(value.strip(), origin), origin)


def parse_value(text: str, origin: str) -> Any:
    """A TOML value; a bare word is a string, so that `output.track=all` needs no quotes inside quotes."""
    try:
        table = tomllib.loads(f"value = {text}")
        if len(table) == 1:
            return table["value"]
    except (ValueError, RecursionError):
        if _LOOSE_NUMBER.fullmatch(text):
            return float(text)
        if _NUMBERS_OF_A_LIST.fullmatch(text):
            option, key = origin.split()
            raise CaseError(f"{origin}: {text} is no TOML value; did you mean a list, {option} '{key}=[{text}]'?") from None
        if text and text[0] not in "[{\"'":
            return text
    if not text:
        raise CaseError(f"{origin}: no value is given")
    raise CaseError(f"{origin}: {text} is no TOML value; quote it for the shell, as in '[0.5, 0]'")


def apply(data: dict, override: Override) -> Path:
    """Writes the override into `data`, the case as read, in place.

    Returns the path written. Tables that are missing are begun; an item of a list that is missing, as in
    `water.velocity.0`, changes that item of the key's default. Unknown keys are left to the schema.
    """
    parts = override.key.split(".")
    node: Any = data
    path: Path = ()
    for i, part in enumerate(parts):
        last = i == len(parts) - 1
        if isinstance(node, list):
            step: str | int = _item(node, part, path, override)
        elif isinstance(node, dict):
            step = part
            if not last and step not in node:
                node[step] = _missing((*path, step), data)
        else:
            raise CaseError(_no_parts(path, part, node, override))
        path = (*path, step)
        if last:
            node[step] = override.value
            for other in _alternatives(path, override.value):
                node.pop(other, None)
        else:
            node[step] = list(node[step]) if isinstance(node[step], tuple) else node[step]
            node = node[step]
    return path


def _alternatives(path: Path, value: Any) -> tuple[str, ...]:
    """Keys beside the one at `path` that a value for it takes back."""
    if path == ("field", "size_distribution") and isinstance(value, dict):
        return _IMPLIED.get(str(value.get("kind")), ())
    return _ALTERNATIVES.get(path, ())


def _item(items: list, part: str, path: Path, override: Override) -> int:
    name = _dotted(path)
    if part.isdecimal():
        if len(part) <= _MOST_DIGITS and int(part) < len(items):
            return int(part)
        known = f"its items are 0 to {len(items) - 1}" if items else "it is empty"
        raise CaseError(f"{override.origin}: {name} has no item {part}; {known}")
    names = [item.get("name", item.get("kind")) if isinstance(item, dict) else None for item in items]
    if part in names:
        return names.index(part)
    known = [known for known in names if isinstance(known, str)]
    close = difflib.get_close_matches(part, known, n=1)
    hint = f'did you mean "{close[0]}"?' if close else "give its number, from 0" if items else "there is none"
    raise CaseError(f'{override.origin}: {name} has no item "{part}"; {hint}')


def _missing(path: Path, data: dict) -> Any:
    """What stands at `path` when the case file says nothing: the default, or an empty table."""
    if path in (("structure",), *((name,) for name in schema.LISTED)):
        return []
    owner = schema.table_of(path, data)
    if owner is not None and owner[1] in owner[0].model_fields:
        default = owner[0].model_fields[owner[1]].default
        if not isinstance(default, schema.Table):
            return list(default) if isinstance(default, tuple | list) else default
    return {}


def _no_parts(path: Path, part: str, node: Any, override: Override) -> str:
    what = "has no default" if node is None or node is ... else "is no list or table"
    return f'{override.origin}: {_dotted(path)} {what} that "{part}" could belong to; give the whole value'


def _dotted(path: Path) -> str:
    return ".".join(map(str, path))

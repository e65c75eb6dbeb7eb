"""What is wrong with a case, as sentences: which key, its value, what is allowed, the likely cure."""

import difflib
import re
from typing import Any

from pydantic import ValidationError

from dilatedem.case import schema
from dilatedem.case.lines import Path
from dilatedem.errors import printable
from dilatedem.structures.kinds import SINGLE

# A value longer than this is cut in messages: a hull's vertices would bury the sentence.
LONGEST_VALUE = 60

_TYPES = {
    "bool_type": "must be true or false",
    "dict_type": "must be a table",
    "finite_number": "must be finite",
    "float_type": "must be a number",
    "int_type": "must be a whole number",
    "list_type": "must be a list",
    "model_attributes_type": "must be a table",
    "model_type": "must be a table",
    "string_type": "must be text in quotes",
    "union_tag_not_found": "is missing",
    "missing": "is missing",
}
_NAME_RULE = "must start with a letter and hold nothing but letters, digits, _ and -"


def items(error: ValidationError) -> list[dict]:
    """What pydantic says of each fault."""
    return error.errors(include_url=False, include_input=False)


def path_of(item: dict) -> Path:
    """The key that an item speaks of."""
    return _without_kind(item["loc"])


def sentences(items: list[dict], data: dict) -> list[tuple[Path, str]]:
    """Every fault once: the path of its key, and the sentence that names key, value and what is allowed.

    items : as pydantic gives them; data : the case as checked, from which the offending values are quoted.
    """
    found = [fault for item in items for fault in _faults(item, data)]
    return [(path, key_and_value(path, text, data)) for path, text in dict.fromkeys(found)]


def _faults(item: dict, data: dict) -> list[tuple[Path, str]]:
    """A fault of pydantic's as path and text; those that compare keys come several at once."""
    path = _without_kind(item["loc"])
    context = item.get("ctx", {})
    if item["type"] == "faults":
        return [((*path, *where), text) for where, text in context["faults"]]
    if item["type"] == "extra_forbidden":
        return [(path, _unknown(path, data))]
    if item["type"] in ("union_tag_invalid", "union_tag_not_found"):
        kinds = _kinds(path)
        path = (*path, "kind")
        if item["type"] == "union_tag_invalid":
            return [(path, _choice(kinds, str(context["tag"])))]
        return [(path, f"is missing; it {_choice(kinds, '')}")]
    header = ".".join(step for step in path if isinstance(step, str))
    if header in ("structure", "structure.part", *schema.LISTED) and item["type"] == "list_type":
        return [(path, f"must be a list of tables, each under a header [[{header}]]")]
    whole, allowed = _mixed_key(path, data)
    if allowed is not None:
        return [(whole, allowed)]
    return [(path, _allowed(item["type"], context, item["msg"], _value(path, data)))]


def _kinds(path: Path) -> list[str]:
    """What may stand under `kind` in the table at `path`."""
    if path[-1] == "support":
        return list(schema.SUPPORTS)
    if path[-1] == "size_distribution":
        return list(schema.DISTRIBUTIONS)
    return [name for name, kind in schema.STRUCTURES.items() if "part" not in path or kind in SINGLE]


def _without_kind(path: Path) -> Path:
    # pydantic names the kind of a structure, of its part, of a support and of a distribution after them; the case file does not.
    if len(path) > 2 and path[:2] == ("field", "size_distribution") and path[2] in schema.DISTRIBUTIONS:
        path = (*path[:2], *path[3:])
    for where, table in ((2, "structure"), (4, "part")):
        if len(path) > where and path[where - 2] == table and path[where] in schema.STRUCTURES:
            path = (*path[:where], *path[where + 1 :])
    for where in (3, 5):
        if len(path) > where and path[where - 1] == "support" and path[where] in schema.SUPPORTS:
            path = (*path[:where], *path[where + 1 :])
    return path


def _mixed_key(path: Path, data: dict) -> tuple[Path, str | None]:
    """Of a key that takes several types, the path of the key itself and its own words for what is allowed."""
    for depth in range(1, len(path) + 1):
        owner = schema.table_of(path[:depth], data)
        if owner is None or owner[1] not in owner[0].model_fields:
            continue
        extra = owner[0].model_fields[owner[1]].json_schema_extra or {}
        if "allowed" in extra:
            return path[:depth], extra["allowed"]
    return path, None


def _allowed(kind: str, context: dict, message: str, value: Any) -> str:
    """What is allowed, in the words of the user; pydantic's own where none of ours fit."""
    if kind in _TYPES:
        return _TYPES[kind]
    if kind == "greater_than":
        return f"must be greater than {context['gt']:g}"
    if kind == "greater_than_equal":
        return f"must be at least {context['ge']:g}"
    if kind == "less_than":
        return f"must be less than {context['lt']:g}"
    if kind == "less_than_equal":
        most = context["le"]
        return f"must be at most {most:g}" if isinstance(most, float) else f"must be at most {most}"
    if kind == "literal_error":
        return _choice(re.findall(r"'([^']*)'", context["expected"]), value)
    if kind == "too_short":
        return f"must have at least {context['min_length']} item{'s' * (context['min_length'] != 1)}"
    if kind == "too_long":
        return f"must have at most {context['max_length']} items"
    if kind == "string_pattern_mismatch":
        return _NAME_RULE
    return message[:1].lower() + message[1:]


def _choice(words: list[str], value: Any) -> str:
    quoted = [f'"{word}"' for word in words]
    text = "must be " + " or ".join([", ".join(quoted[:-1]), quoted[-1]] if len(quoted) > 1 else quoted)
    close = difflib.get_close_matches(value, words, n=1) if isinstance(value, str) else []
    return f'{text}; did you mean "{close[0]}"?' if close else text


def _unknown(path: Path, data: dict) -> str:
    """An unknown key, with the one of that name in another table, else the likeliest one of its own."""
    owner = schema.table_of(path, data)
    known = list(owner[0].model_fields) if owner is not None else []
    for name, table in schema.TABLES.items():
        if path[-1] in table.model_fields:
            return f'unknown key; did you mean "{name}.{path[-1]}"?'
    close = difflib.get_close_matches(str(path[-1]), known, n=1)
    if close:
        return f'unknown key; did you mean "{close[0]}"?'
    return f"unknown key; known here: {', '.join(known)}"


def key_and_value(path: Path, text: str, data: dict) -> str:
    """A fault's sentence with the key and the value it speaks of."""
    dotted = ".".join(_short(str(step)) for step in path)
    value = _value(path, data)
    absent = value is None or isinstance(value, dict) or text.startswith("unknown key")
    head = dotted if absent else f"{dotted} = {_toml(value)}"
    return printable(f"{head}: {text}" if head else text)


def _short(name: str) -> str:
    return name if len(name) <= LONGEST_VALUE else f"{name[: LONGEST_VALUE - 3]}..."


def _value(path: Path, data: Any) -> Any:
    for step in path:
        try:
            data = data[step]
        except (KeyError, IndexError, TypeError):
            return None
    return data


def _toml(value: Any) -> str:
    """A value as it would stand in TOML, cut where it is long."""
    if isinstance(value, bool):
        text = str(value).lower()
    elif isinstance(value, str):
        text = '"' + value.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n") + '"'
    elif isinstance(value, list | tuple):
        text = f"[{', '.join(map(_toml, value[:LONGEST_VALUE]))}]"
    elif isinstance(value, dict):
        text = f"{{{', '.join(f'{name} = {_toml(item)}' for name, item in value.items())}}}"
    elif isinstance(value, int) and abs(value) > 10**LONGEST_VALUE:
        text = hex(value)  # Python writes no decimals of thousands of digits
    else:
        text = str(value)
    return text if len(text) <= LONGEST_VALUE else f"{text[: LONGEST_VALUE - 3]}..."

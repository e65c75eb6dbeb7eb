"""The case as a reader takes it: every key with its value, unit and meaning, and whether it is the default."""

from __future__ import annotations

import functools
import json
from copy import deepcopy
from pathlib import Path
from typing import Any

from dilatedem.post.labels import describe_key, flatten, show

BODIES_LISTED = 5  # more explicit bodies than this are counted, not listed
#: written by dilatedem.case.meanings
MEANINGS = Path(__file__).with_name("meanings.json")


@functools.cache
def meanings() -> dict[str, dict[str, Any]]:
    """Unit, meaning and default of every key, by the names of dilatedem.case.meanings."""
    return json.loads(MEANINGS.read_text(encoding="utf-8"))


def input_groups(case: dict[str, Any]) -> list[dict[str, Any]]:
    """The tables of a case in their order: `name`, and `rows` of key, value, unit, meaning, and whether it is `own`.

    Own is what has no default, or another value than that.
    """
    groups: dict[str, list[dict[str, Any]]] = {}
    for key, value in flatten(shortened(case)).items():
        known = meanings().get(schema_key(key, case), {})
        group, short = split_key(key, case)
        unit = "" if isinstance(value, str) else describe_key(key)[1] or known.get("unit", "")
        meaning, own = known.get("meaning", ""), value != known.get("default")
        groups.setdefault(group, []).append({"key": short, "value": show(value), "unit": unit, "meaning": meaning, "own": own})
    return [{"name": name, "rows": rows} for name, rows in groups.items()]


def shortened(case: dict[str, Any]) -> dict[str, Any]:
    """The case without long lists: many bodies are counted, tables of motion told by their length."""
    shown = {key: value for key, value in deepcopy(case).items() if value != []}
    if len(bodies := case.get("body", [])) > BODIES_LISTED:
        shown["body"] = f"{len(bodies)} explicit bodies, see case.toml"
    supports = [structure.get("support", {}) for structure in shown.get("structure", [])]
    for table in (*supports, shown.get("water", {}), shown.get("wind", {})):
        for name in ("table", "velocity_table"):
            if table.get(name):
                table[name] = f"{len(table[name])} rows, see case.toml"
    return shown


def split_key(key: str, case: dict[str, Any]) -> tuple[str, str]:
    """The table that a dotted key belongs to, as a heading, and what remains of the key."""
    parts = key.split(".")
    if len(parts) == 1:
        return "case", key
    if len(parts) > 2 and parts[1].isdigit():
        entry = case[parts[0]][int(parts[1])]
        return f"{parts[0]} {entry.get('name') or parts[1]}", ".".join(parts[2:])
    return parts[0], ".".join(parts[1:])


def schema_key(key: str, case: dict[str, Any]) -> str:
    """The name under which `meanings` has a dotted key of a case: without numbers, with the words of kinds."""
    parts, table, name = key.split("."), case, []
    for part in parts:
        if part.isdigit() and isinstance(table, list):
            table = table[int(part)]
            if name[-1:] == ["part"]:
                name = ["structure"]  # a part of a structure has the keys of one
            if name == ["structure"]:
                name.append(str(table.get("kind", "")))
            continue
        table = table.get(part) if isinstance(table, dict) else None
        if part == "support" and name[:1] == ["structure"]:
            name = ["structure"]
        name.append(part)
        if part in ("support", "size_distribution") and isinstance(table, dict):
            name.append(str(table.get("kind", "")))
    return ".".join(name)

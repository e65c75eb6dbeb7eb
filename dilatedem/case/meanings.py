"""What every key of a case file means, made from the schema, for readers of run folders: they know no cases, only files."""

import json
from pathlib import Path
from typing import Any

from dilatedem.case.schema import DISTRIBUTIONS, LISTED, STRUCTURES, SUPPORTS, TABLES, Case
from dilatedem.keys import Table

FILE = Path("dilatedem", "post", "report", "meanings.json")


def meanings() -> dict[str, dict[str, Any]]:
    """By dotted key: unit, meaning in words, and default, None of a key that has none.

    Items of lists go without their numbers. Keys of structures, supports and distributions, which depend on the kind, have its
    word in front of their own: `structure.pile.radius`, `structure.support.sprung.mass`.
    """
    found = _keys("", Case, ["title"])
    for name in Case.model_fields:
        if name in TABLES:
            found |= _table(f"{name}.", TABLES[name])
        elif name in LISTED and name != "structure":
            found |= _table(f"{name}.", LISTED[name])
    for before, kinds in (("structure", STRUCTURES), ("structure.support", SUPPORTS), ("field.size_distribution", DISTRIBUTIONS)):
        for kind, table in kinds.items():
            found |= _table(f"{before}.{kind}.", table)
    return found


def _table(before: str, table: type[Table]) -> dict[str, dict[str, Any]]:
    """Keys of a table, and of the tables in it that are always there."""
    found = _keys(before, table, list(table.model_fields))
    for name, field in table.model_fields.items():
        if isinstance(field.default, Table):
            del found[f"{before}{name}"]
            found |= _table(f"{before}{name}.", type(field.default))
    return found


def _keys(before: str, table: type[Table], names: list[str]) -> dict[str, dict[str, Any]]:
    fields = {name: table.model_fields[name] for name in names}
    return {
        f"{before}{name}": {
            "unit": field.json_schema_extra["unit"], "meaning": " ".join(field.description.split()),
            "default": None if field.is_required() or isinstance(field.default, Table) else field.default,
        }
        for name, field in fields.items()
    }  # fmt: skip


def text() -> str:
    """The file, a line a key."""
    lines = [f"{json.dumps(key)}: {json.dumps(entry, ensure_ascii=False)}" for key, entry in meanings().items()]
    return "{\n" + ",\n".join(lines) + "\n}\n"

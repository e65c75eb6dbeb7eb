"""Writing a case as TOML, every default explicit, so that it can be run again as it stands."""

import hashlib
import re

import tomli_w

from dilatedem.case.schema import Case, Table

# tomli-w puts every item of an array on a line of its own; an array of numbers reads better on one. A line
# that ends in "[" can only begin an array: strings are written with their line ends escaped.
_NUMBERS = re.compile(r"\[\n((?:\s+[-+.\w]+,\n)+)\s*\]")


def dump(case: Case) -> str:
    """The case as TOML text with units as comments; reading it gives the same case again.

    Keys without a value (such as the floe count beside a floe size) are left out: TOML has no word for them.
    """
    blocks = [_line("title", case.title)]
    for name in type(case).model_fields:
        value = getattr(case, name)
        if isinstance(value, Table):
            blocks.append(_table(f"[{name}]", value))
        elif isinstance(value, list):
            blocks += _tables(name, value)
    return "\n".join(blocks)


def _tables(name: str, tables: list[Table]) -> list[str]:
    """Items of an array of tables, each before the arrays of tables that it holds."""
    blocks = []
    for table in tables:
        blocks.append(_table(f"[[{name}]]", table))
        for inner, items in _arrays(table).items():
            blocks += _tables(f"{name}.{inner}", items)
    return blocks


def _arrays(table: Table) -> dict[str, list[Table]]:
    """What a table holds that is no key: arrays of tables, by name."""
    values = {name: getattr(table, name) for name in type(table).model_fields}
    return {name: value for name, value in values.items() if isinstance(value, list) and value and isinstance(value[0], Table)}


def digest(case: Case) -> str:
    """SHA-256 of that text: the same for equal cases, and for no others."""
    return hashlib.sha256(dump(case).encode()).hexdigest()


def _table(header: str, table: Table) -> str:
    lines, inner, arrays = [f"{header}\n"], [], _arrays(table)
    for name, field in type(table).model_fields.items():
        value = getattr(table, name)
        if isinstance(value, Table):
            inner.append(_table(f"[{header.strip('[]')}.{name}]", value))
        elif value is not None and name not in arrays:
            lines.append(_line(name, value, field.json_schema_extra["unit"]))
    return "".join([*lines, *inner])


def _line(name: str, value: object, unit: str = "") -> str:
    text = tomli_w.dumps({name: value}).rstrip("\n")
    text = _NUMBERS.sub(lambda match: f"[{', '.join(match[1].replace(',', ' ').split())}]", text)
    return f"{text}  # {unit}\n" if unit and isinstance(value, int | float | tuple) else f"{text}\n"

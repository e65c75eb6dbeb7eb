"""The page that says what every key of the case file means, made from the schema.

`python -m dilatedem.case.reference` rewrites docs/case-file.md of the source tree, and the meanings that reports give.
"""

from pathlib import Path
from typing import Any

from pydantic.fields import FieldInfo

from dilatedem.case import meanings
from dilatedem.case.schema import DISTRIBUTIONS, LISTED, STRUCTURES, SUPPORTS, TABLES, Case, json_schema
from dilatedem.keys import OTHER_RANGE, RANGES, Table

PAGE = Path("docs", "case-file.md")

_HEAD = """\
# The case file

<!-- Made from dilatedem/case/schema.py by `python -m dilatedem.case.reference`; do not edit. -->

A case is a [TOML](https://toml.io) file. Tables and keys that are left out have the defaults below; there are
no structures and no explicit bodies unless given. Unknown keys are errors. All quantities are in SI units; z
points up from the still water level. `dilatedem check CASE` says what is wrong with a case, or what follows
from it; `dilatedem schema` prints this page for programs, as JSON Schema.

On the command line `--set KEY=VALUE` overrides any key, `--set water.velocity=[0.5,0]`, or an item of a list
by its number or name: `--set water.velocity.0=0.5`, `--set structure.pile.radius=3`. Setting
`field.floe_size` replaces a `field.floe_count`, and the other way round; so do the velocity of water or wind and its table.

Beside what stands under *allowed*, numbers have a range by their unit, wider than anything in use.
In size they are at most {most}; {other} without a unit.
Those that cannot be negative are 0, if that is allowed, or at least {least}. Whole numbers have 64 bits.
"""

_LIMITS = (
    ("exclusiveMinimum", "> {}"),
    ("minimum", "≥ {}"),
    ("exclusiveMaximum", "< {}"),
    ("maximum", "≤ {}"),
)


def page() -> str:
    """The whole page, Markdown."""
    definitions = json_schema()["$defs"]
    parts = [_HEAD.format(**_ranges()), "## At the top\n", _keys(Case, ["title"], json_schema())]
    for name in Case.model_fields:
        if name in TABLES:
            parts += _section(f"[{name}]", TABLES[name], definitions)
            for kind, distribution in DISTRIBUTIONS.items() if name == "field" else ():
                parts += _section(f'[field] size_distribution = {{kind = "{kind}"}}', distribution, definitions)
            for inner, field in TABLES[name].model_fields.items():
                if isinstance(field.default, Table):
                    parts += _section(f"[{name}.{inner}]", type(field.default), definitions)
        elif name == "structure":
            for kind, structure in STRUCTURES.items():
                parts += _section(f'[[structure]] kind = "{kind}"', structure, definitions)
            for kind, support in SUPPORTS.items():
                parts += _section(f'[[structure]] support = {{kind = "{kind}"}}', support, definitions)
        elif name in LISTED:
            parts += _section(f"[[{name}]]", LISTED[name], definitions)
    return "\n".join(parts)


def _ranges() -> dict[str, str]:
    """What the ranges of numbers are, in words."""
    return {
        "most": ", ".join(f"{limit.most:g} {unit}" for unit, limit in RANGES.items()),
        "least": ", ".join(f"{limit.least:g} {unit}" for unit, limit in RANGES.items() if limit.least),
        "other": f"{OTHER_RANGE.most:g}",
    }


def _section(title: str, table: type[Table], definitions: dict) -> list[str]:
    return [
        f"## `{title}`\n",
        f"{_plain(table.__doc__)}\n",
        _keys(table, list(table.model_fields), definitions[table.__name__]),
    ]


def _keys(table: type[Table], names: list[str], schema: dict) -> str:
    rows = ["| key | default | unit | allowed | meaning |", "| --- | --- | --- | --- | --- |"]
    for name in names:
        field = table.model_fields[name]
        unit = field.json_schema_extra["unit"]
        allowed = _allowed(schema["properties"][name])
        rows.append(f"| `{name}` | {_default(field)} | {unit} | {allowed} | {_plain(field.description)} |")
    return "\n".join(rows) + "\n"


def _allowed(node: dict) -> str:
    """The values a key takes, from its JSON Schema: what the program checks is what the page says."""
    if "oneOf" in node or "$ref" in node or "allOf" in node:
        return "table"
    if "anyOf" in node:
        return " or ".join(dict.fromkeys(_allowed(choice) for choice in node["anyOf"]))
    if "oneOf" in node:
        return "table"
    if "const" in node:
        return f'`"{node["const"]}"`'
    if "enum" in node:
        return ", ".join(f'`"{word}"`' for word in node["enum"])
    if node["type"] == "array":
        if "prefixItems" in node:
            return f"{len(node['prefixItems'])} × {_allowed(node['prefixItems'][0])}"
        bounds = [f"{word} {node[key]}" for word, key in (("at least", "minItems"), ("at most", "maxItems")) if key in node]
        count = f", {', '.join(bounds)}" if bounds else ""
        return f"list of ({_allowed(node['items'])}){count}"
    if node["type"] == "boolean":
        return "`true`, `false`"
    words = {"number": "number", "integer": "whole number", "string": "text"}[node["type"]]
    # The largest integer of TOML itself is no news to anyone.
    limits = [text.format(f"{node[key]:g}") for key, text in _LIMITS if key in node and node[key] < 2**62]
    return " ".join([words, ", ".join(limits)]).strip()


def _default(field: FieldInfo) -> str:
    if field.is_required():
        return "required"
    return "" if field.default is None else f"`{_value(field.default)}`"


def _value(value: Any) -> str:
    if isinstance(value, Table):
        return f"{{{', '.join(f'{name} = {_value(item)}' for name, item in value if item is not None)}}}"
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return f'"{value}"'
    if isinstance(value, tuple | list):
        return f"[{', '.join(map(_value, value))}]"
    if isinstance(value, float) and value >= 1e6:
        digits, exponent = f"{value:.6e}".split("e")
        return f"{float(digits)}e{int(exponent)}"
    return repr(value)


def _plain(text: str) -> str:
    return " ".join(text.split()).replace("|", "\\|")


def main() -> None:
    """Rewrites the page, and the meanings, of the source tree that this module belongs to."""
    for place, text in ((PAGE, page()), (meanings.FILE, meanings.text())):
        path = Path(__file__).resolve().parents[2] / place
        path.parent.mkdir(exist_ok=True)
        path.write_text(text, encoding="utf-8")
        print(path)


if __name__ == "__main__":
    main()

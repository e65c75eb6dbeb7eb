"""What the tables of a case file are made of: typed keys with a unit and a description, and their base.

Values are taken as they are typed in TOML: no text for a number, no number for a switch, nothing infinite.
"""

import hashlib
import os
from collections.abc import Iterator
from functools import cache
from typing import Annotated, Any, Literal, NamedTuple, get_args

from annotated_types import Ge, Gt
from pydantic import AfterValidator, BaseModel, BeforeValidator, ConfigDict, Field, ValidationInfo, model_validator
from pydantic.json_schema import GenerateJsonSchema
from pydantic_core import PydanticCustomError

# TOML integers end here; a larger seed could not be written back to case.toml.
LARGEST_INTEGER = 2**63 - 1
#: rows of a table of time or of depth, at most
MOST_ROWS = 10_000


class Range(NamedTuple):
    """What a number of some unit may be in size: at most `most`; where it cannot be negative 0, if it may, or at least `least`."""

    least: float
    most: float


#: by unit; wider than anything in use, and narrow enough that no product of such numbers leaves the range of floating point, and
#: that a position (double precision) is good to 2e-9 m
RANGES = {
    "m": Range(1e-9, 1e7),
    "m/s": Range(0.0, 1e5),
    "m/s2": Range(0.0, 1e5),
    "rad/s": Range(0.0, 1e7),
    "s": Range(1e-12, 1e10),
    "Pa": Range(1e-3, 1e21),
    "kg/m3": Range(1e-6, 1e9),
    "kg": Range(1e-9, 1e15),
    "kg m2": Range(1e-9, 1e21),
    "N/m": Range(1e-9, 1e18),
    "N m/rad": Range(1e-9, 1e24),
    "N s/m": Range(1e-9, 1e18),
    "N m s": Range(1e-9, 1e24),
    "kg/m": Range(1e-9, 1e12),
    "N m2": Range(1e-9, 1e24),
}
#: all other numbers
OTHER_RANGE = Range(0.0, 1e6)

# A fault found by comparing keys: where it sits, relative to the table that found it, and what is allowed.
Fault = tuple[tuple[str | int, ...], str]


def key(default: Any, unit: str, description: str, *, allowed: str | None = None, **bounds: Any) -> Any:
    """A documented key; `default` ... makes it required.

    `allowed` replaces the type's own messages where several types are accepted, such as "auto" or a number.
    """
    extra = {"unit": unit}
    if allowed is not None:
        extra["allowed"] = allowed
    return Field(default, description=description, json_schema_extra=extra, **bounds)


def _as_tuple(count: int) -> BeforeValidator:
    def convert(value: Any) -> tuple:
        if not isinstance(value, list | tuple) or len(value) != count:
            hint = f", as in {[value] + [0] * (count - 1)}" if type(value) in (int, float) else ""
            raise PydanticCustomError("allowed", f"must be a list of {count} numbers{hint}")
        return tuple(value)

    return BeforeValidator(convert)


def _beside_case(path: str, about: ValidationInfo) -> str:
    """The full path of a file that is there, from the folder of the case file, which the context of validation names."""
    full = os.path.abspath(os.path.join((about.context or {}).get("folder", ""), path))
    if not os.path.isfile(full):
        raise PydanticCustomError("allowed", "there is no such file: {full}", {"full": full})
    return full


Positive = Annotated[float, Field(gt=0)]
NonNegative = Annotated[float, Field(ge=0)]
PoissonRatio = Annotated[float, Field(ge=0, lt=0.5)]
Friction = Annotated[float, Field(ge=0, le=1000)]
Vector2 = Annotated[tuple[float, float], _as_tuple(2)]
Vector3 = Annotated[tuple[float, float, float], _as_tuple(3)]
Size2 = Annotated[tuple[Positive, Positive], _as_tuple(2)]
# Path of a file; once the case is read, in full.
File = Annotated[str, AfterValidator(_beside_case)]
# Of what is in a file: SHA-256.
Digest = Annotated[str, Field(pattern=r"^[0-9a-f]{64}$")]
Stiffness2 = Annotated[tuple[NonNegative, NonNegative], _as_tuple(2)]
Boundary = Literal["open", "periodic", "wall", "outflow", "inflow"]
# A name serves as an HDF5 group, a CSV field and a step of a dotted key: no / or comma or dot, and no number.
# \w is a letter or digit of any alphabet, [^\W\d] the same without the digits.
Name = Annotated[str, Field(pattern=r"^[^\W\d][\w-]*$")]


class Table(BaseModel):
    """A table of the case file: unknown keys, loose types and non-finite numbers are errors."""

    # built when it is first asked: most tables never are, but as parts of a case
    model_config = ConfigDict(extra="forbid", strict=True, frozen=True, allow_inf_nan=False, defer_build=True)

    def faults(self) -> list[Fault]:
        """What is wrong between the keys of this table, each of them being fine alone."""
        return []

    @model_validator(mode="after")
    def _compare_keys(self):
        faults = self._out_of_range() or self.faults()
        if faults:
            sentences = "; ".join(f"{'.'.join(map(str, where))}: {text}" for where, text in faults)
            raise PydanticCustomError("faults", "{sentences}", {"faults": faults, "sentences": sentences})
        return self


    def _out_of_range(self) -> list[Fault]:
        """Numbers that are too large or too small for their unit."""
        found: list[Fault] = []
        for name, field in type(self).model_fields.items():
            unit = (field.json_schema_extra or {}).get("unit", "")
            least, most = RANGES.get(unit, OTHER_RANGE)
            least = least if is_signless(type(self), name) else 0.0
            for where, value in _floats((name,), getattr(self, name)):
                if abs(value) > most:
                    found.append((where, f"must be at most {f'{most:g} {unit}'.strip()} in size"))
                elif 0.0 < value < least:
                    found.append((where, f"must be at least {least:g} {unit}"))
        return found


@cache
def is_signless(table: type[Table], name: str) -> bool:
    """Whether a key takes no negative numbers."""
    field = table.model_fields[name]
    return any(isinstance(bound, Gt | Ge) for bound in field.metadata) or _has_bound(field.annotation)


def _has_bound(annotation: Any) -> bool:
    bounds = [bound for about in getattr(annotation, "__metadata__", ()) for bound in getattr(about, "metadata", ())]
    return any(isinstance(bound, Gt | Ge) for bound in bounds) or any(map(_has_bound, get_args(annotation)))


def _floats(where: tuple[str | int, ...], value: Any) -> Iterator[tuple[tuple[str | int, ...], float]]:
    """The numbers of a value and where they sit in it."""
    if isinstance(value, float):
        yield where, value
    elif isinstance(value, list | tuple):
        for i, item in enumerate(value):
            yield from _floats((*where, i), item)


def complete(table: Table, name: str, value: Any) -> None:
    """Sets a key of a table that is being built; from then on the table is frozen."""
    table.__dict__[name] = value


def digest_key() -> Any:
    """The key `sha256` beside a key `file`."""
    text = "SHA-256 of the file. A run writes it to its case.toml, so that it is not repeated with another file unnoticed."
    return key(None, "", text)


def content_of(file: str) -> str:
    """SHA-256 of a file."""
    with open(file, "rb") as opened:
        return hashlib.file_digest(opened, "sha256").hexdigest()


def content_faults(file: str, sha256: str | None) -> list[Fault]:
    """What is wrong with the file of a table that names it, and perhaps what has to be in it."""
    try:
        found = content_of(file)
    except OSError as error:
        return [(("file",), f"cannot be read: {error.strerror}")]
    if sha256 not in (None, found):
        return [(("file",), "is another than it was: its SHA-256 is not that of the key sha256; leave that key out to take it")]
    return []


class TomlJsonSchema(GenerateJsonSchema):
    """TOML has no null: a key that may be left out is simply not required."""

    def nullable_schema(self, schema):
        return self.generate_inner(schema["schema"])

    def default_schema(self, schema):
        if schema.get("default", 0) is None:
            return self.generate_inner(schema["schema"])
        return super().default_schema(schema)

    def encode_default(self, dft):
        return _without_null(super().encode_default(dft))


def _without_null(value: Any) -> Any:
    """A table without the keys that have no value, and so are the tables in it."""
    if not isinstance(value, dict):
        return value
    return {name: _without_null(item) for name, item in value.items() if item is not None}

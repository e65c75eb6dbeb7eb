"""What the tables of a case file are made of: typed keys with a unit and a description, and their base.

Values are taken as they are typed in TOML: no text for a number, no number for a switch, nothing infinite.
"""

from typing import Annotated, Any, Literal

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, model_validator
from pydantic.json_schema import GenerateJsonSchema
from pydantic_core import PydanticCustomError

# TOML integers end here; a larger seed could not be written back to case.toml.
LARGEST_INTEGER = 2**63 - 1

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
            raise PydanticCustomError("allowed", f"must be a list of {count} numbers")
        return tuple(value)

    return BeforeValidator(convert)


Positive = Annotated[float, Field(gt=0)]
NonNegative = Annotated[float, Field(ge=0)]
PoissonRatio = Annotated[float, Field(ge=0, lt=0.5)]
Vector2 = Annotated[tuple[float, float], _as_tuple(2)]
Vector3 = Annotated[tuple[float, float, float], _as_tuple(3)]
Size2 = Annotated[tuple[Positive, Positive], _as_tuple(2)]
Boundary = Literal["open", "periodic", "wall", "outflow"]
# A name serves as an HDF5 group, a CSV field and a step of a dotted key: no / or comma or dot, and no number.
# \w is a letter or digit of any alphabet, [^\W\d] the same without the digits.
Name = Annotated[str, Field(pattern=r"^[^\W\d][\w-]*$")]


class Table(BaseModel):
    """A table of the case file: unknown keys, loose types and non-finite numbers are errors."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True, allow_inf_nan=False)

    def faults(self) -> list[Fault]:
        """What is wrong between the keys of this table, each of them being fine alone."""
        return []

    @model_validator(mode="after")
    def _compare_keys(self):
        faults = self.faults()
        if faults:
            sentences = "; ".join(f"{'.'.join(map(str, where))}: {text}" for where, text in faults)
            raise PydanticCustomError("faults", "{sentences}", {"faults": faults, "sentences": sentences})
        return self


def complete(table: Table, name: str, value: Any) -> None:
    """Sets a key of a table that is being built; from then on the table is frozen."""
    table.__dict__[name] = value


class TomlJsonSchema(GenerateJsonSchema):
    """TOML has no null: a key that may be left out is simply not required."""

    def nullable_schema(self, schema):
        return self.generate_inner(schema["schema"])

    def default_schema(self, schema):
        if schema.get("default", 0) is None:
            return self.generate_inner(schema["schema"])
        return super().default_schema(schema)

    def encode_default(self, dft):
        encoded = super().encode_default(dft)
        if isinstance(encoded, dict):
            return {name: value for name, value in encoded.items() if value is not None}
        return encoded

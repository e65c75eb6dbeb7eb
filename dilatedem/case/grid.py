"""The grid of a sweep: `--vary KEY=VALUES` and seeds, as lists of overrides, one list a case."""

import itertools
import re
from dataclasses import dataclass, field
from decimal import Decimal, InvalidOperation
from typing import Any

from dilatedem.case.overrides import Override, parse_value
from dilatedem.errors import CaseError

SEED_KEY = "field.seed"

# More cases than this in one sweep are taken for a slip of the step, as in 0:100:0.001.
LARGEST_GRID = 100_000

# Powers of ten between which the numbers of a range lie: beyond, no float could hold them.
SMALLEST_POWER, LARGEST_POWER = -300, 300
# Bytes of a folder's name; file systems take 255, and files beside it are called after it.
LONGEST_NAME = 240

_OPENING, _CLOSING = "[{", "]}"


@dataclass(frozen=True)
class Axis:
    """One key and the values it takes in turn; remarks: of what was asked for, what is not among them, in sentences."""

    key: str
    values: tuple[Any, ...]
    origin: str
    remarks: tuple[str, ...] = field(default=(), compare=False)


def axis(text: str) -> Axis:
    """An axis from `KEY=V1,V2,..`, `KEY=START:STOP:STEP`, or a mixture; STOP is taken when a step meets it.

    Fails with CaseError naming the option.
    """
    key, equals, values = text.partition("=")
    key = key.strip()
    if not equals or not all(key.split(".")):
        raise CaseError(f"--vary {text}: must be KEY=V1,V2,.. or KEY=START:STOP:STEP")
    origin = f"--vary {key}"
    found: list[Any] = []
    remarks: list[str] = []
    for part in _parts(values):
        if not _is_range(part):
            found.append(parse_value(part, origin))
            continue
        found += _range(part, origin)
        stop = part.split(":")[1].strip()
        if Decimal(str(found[-1])) != Decimal(stop):
            remarks.append(f"{origin}: {part}: no step meets {stop}; the last value is {found[-1]}")
    seen: set[str] = set()
    for value in found:
        words = repr(_comparable(value))
        if words in seen:
            raise CaseError(f"{origin}: {value} is given twice")
        seen.add(words)
    return Axis(key, tuple(found), origin, tuple(remarks))


def _comparable(value: Any) -> Any:
    """A value in a form in which equal ones have equal words: 1 and 1.0 are the same number, but no switch."""
    if isinstance(value, list):
        return [_comparable(item) for item in value]
    return float(value) if isinstance(value, int) and not isinstance(value, bool) and abs(value) < 2**53 else value


def cases(axes: list[Axis]) -> list[list[Override]]:
    """All combinations, the last axis changing fastest; one list of overrides a case.

    Fails with CaseError on a key that is varied twice and on a grid too large to be meant.
    """
    count = 1
    for i, axis_ in enumerate(axes):
        if axis_.key in [other.key for other in axes[:i]]:
            raise CaseError(f"{axis_.origin}: is varied twice; join the values in one list")
        count *= len(axis_.values)
    if count > LARGEST_GRID:
        raise CaseError(f"the sweep has {count} cases; at most {LARGEST_GRID} are run at once")
    columns = [[Override(axis_.key, value, axis_.origin) for value in axis_.values] for axis_ in axes]
    return [list(point) for point in itertools.product(*columns)]


def seed_axis(first: int, count: int) -> Axis:
    """The axis of `--seeds COUNT`: `count` seeds from that of the case on. Fails with CaseError for more than a sweep runs."""
    if count > LARGEST_GRID:
        raise CaseError(f"--seeds {count}: must be at most {LARGEST_GRID}, what a sweep runs at once")
    return Axis(SEED_KEY, tuple(range(first, first + count)), "--seeds")


def folder_name(point: list[Override]) -> str:
    """A readable folder name for a point of the grid, of characters that no shell or file system minds.

    `water.velocity=0.3__seed=2`; the values of a list are joined by commas. Fails with CaseError for a name that is too long.
    """
    parts = []
    for override in point:
        key = "seed" if override.origin == "--seeds" else override.key
        parts.append(f"{key}={_plain(override.value)}")
    name = re.sub(r"[^\w.,=+-]", "_", "__".join(parts))
    if (size := len(name.encode())) > LONGEST_NAME:
        raise CaseError(
            f"--vary {point[0].key}: the folder of a case would be called {name[:40]}..., which is {size} bytes long; at most "
            f"{LONGEST_NAME} will do: vary fewer keys or shorter values"
        )
    return name


def _plain(value: Any) -> str:
    if isinstance(value, list | tuple):
        return ",".join(map(_plain, value))
    return str(value).lower() if isinstance(value, bool) else str(value)


def _parts(text: str) -> list[str]:
    """The parts between commas, but for commas inside brackets and quotes."""
    parts, depth, quote = [""], 0, ""
    for character in text:
        if quote:
            quote = "" if character == quote else quote
        elif character in "\"'":
            quote = character
        elif character in _OPENING:
            depth += 1
        elif character in _CLOSING:
            depth -= 1
        if character == "," and depth == 0 and not quote:
            parts.append("")
        else:
            parts[-1] += character
    return [part.strip() for part in parts]


def _is_range(text: str) -> bool:
    pieces = text.split(":")
    return len(pieces) > 1 and _decimal(pieces[0]) is not None


def _range(text: str, origin: str) -> list[int] | list[float]:
    """START:STOP:STEP in decimal arithmetic, so that 0.1:1.0:0.1 holds 0.3 and not 0.30000000000000004."""
    numbers = [_decimal(piece) for piece in text.split(":")]
    if len(numbers) != 3 or None in numbers:
        raise CaseError(f"{origin}: {text}: a range is START:STOP:STEP, as in 0.1:1.0:0.1")
    start, stop, step = numbers
    for number in numbers:
        if number and not SMALLEST_POWER <= number.adjusted() <= LARGEST_POWER:
            raise CaseError(f"{origin}: {text}: {number} is no number that a key can hold")
    if step == 0 or (stop - start) * step < 0:
        raise CaseError(f"{origin}: {text}: no step of {step} leads from {start} to {stop}")
    steps = (stop - start) / step
    if steps >= LARGEST_GRID:
        count = f"{int(steps) + 1}" if steps < 1e15 else f"{steps:.0e}"
        raise CaseError(f"{origin}: {text}: has {count} values; at most {LARGEST_GRID} are run at once")
    count = int(steps) + 1
    values = [start + i * step for i in range(count)]
    if all(number == number.to_integral_value() and "." not in str(number) for number in numbers):
        return [int(value) for value in values]
    return [float(value) for value in values]


def _decimal(text: str) -> Decimal | None:
    try:
        number = Decimal(text.strip())
    except InvalidOperation:
        return None
    return number if number.is_finite() else None

"""What no case can hold, whatever its keys mean: found before the schema looks, so that nothing later need fear it."""

from typing import Any

from dilatedem.case.lines import Path
from dilatedem.errors import CaseError, printable
from dilatedem.keys import LARGEST_INTEGER

#: tables and lists in each other, at most; a case needs five, and Python recurses per level
MOST_DEPTH = 24
#: keys of one table; the largest has some twenty
MOST_KEYS = 1000
#: faults that are told of one case: whoever has more has another kind of file
MOST_FAULTS = 20


def impossible(data: dict) -> list[tuple[Path, str]]:
    """Values that no key takes, in a case as it was read: their paths, and what is allowed.

    Raises CaseError for tables that are nested too deeply or are too large to look at.
    """
    found: list[tuple[Path, str]] = []
    waiting: list[tuple[Path, Any]] = [((), data)]
    while waiting and len(found) <= MOST_FAULTS:
        path, value = waiting.pop()
        if len(path) > MOST_DEPTH:
            raise CaseError(f"{_start(path)}: is nested too deeply: at most {MOST_DEPTH} tables and lists can lie in each other")
        if isinstance(value, dict) and len(value) > MOST_KEYS:
            where = f"{_start(path)}: " if path else ""
            raise CaseError(f"{where}holds {len(value)} keys in one table, so it is no case; a table has some twenty at most")
        if isinstance(value, dict):
            waiting += [((*path, name), item) for name, item in reversed(value.items())]
            texts = [name for name in value if isinstance(name, str) and not is_unicode(name)]
            found += [((*path, name), "is a key that is not UTF-8 text; write it in UTF-8") for name in texts]
        elif isinstance(value, list | tuple):
            waiting += [((*path, i), item) for i, item in reversed(list(enumerate(value)))]
        elif isinstance(value, int) and not -LARGEST_INTEGER - 1 <= value <= LARGEST_INTEGER:
            found.append((path, "is too large: a whole number has at most 18 digits (64 bits); write a float, as in 1e20"))
        elif isinstance(value, str) and not is_unicode(value):
            found.append((path, "is not UTF-8 text; write it in UTF-8"))
    return found


def is_unicode(text: str) -> bool:
    """Whether text can be written to a file; bytes of a command line that are no UTF-8 come as halves of surrogate pairs."""
    return text.isascii() or not any("\ud800" <= character <= "\udfff" for character in text)


def _start(path: Path) -> str:
    return printable(".".join(map(str, path[:2])))

"""dilatedem: broken sea ice against offshore structures, by the discrete element method of dilated polyhedra.

In Python: `dilatedem.load(folder)` reads what a run or a sweep left behind.
"""

import importlib
from typing import Any

__version__ = "0.1.0"

#: names of the package and the modules they come from, imported when a name is asked for: `dilatedem --help` needs none of them
_SOURCES = {
    "load": "dilatedem.results.load",
}

__all__ = ["__version__", *_SOURCES]


def __getattr__(name: str) -> Any:
    if name not in _SOURCES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = globals()[name] = getattr(importlib.import_module(_SOURCES[name]), name)
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})

"""dilatedem: broken sea ice against offshore structures, by the discrete element method of dilated polyhedra.

In Python: `dilatedem.Simulation.from_case("pile.toml")` is a case to be stepped through, `dilatedem.run("pile.toml", "runs/pile")`
runs it into a folder, `dilatedem.load(folder)` reads what a run or a sweep left behind.
"""

import importlib
from typing import Any

__version__ = "0.2.0"

#: names of the package and the modules they come from, imported when a name is asked for: `dilatedem --help` needs none of them
_SOURCES = {
    "load": "dilatedem.results.load",
    "Simulation": "dilatedem.run.simulation",
}
#: rooms that can be called by their own name: `dilatedem.run(case, out)`
_ROOMS = ("run",)

__all__ = ["__version__", *_SOURCES, *_ROOMS]


def __getattr__(name: str) -> Any:
    if name in _ROOMS:
        return importlib.import_module(f"{__name__}.{name}")
    if name not in _SOURCES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = globals()[name] = getattr(importlib.import_module(_SOURCES[name]), name)
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})

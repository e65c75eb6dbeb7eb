"""The packages that only reading needs: imported when a table or a map is asked for."""

from __future__ import annotations

import importlib
from types import ModuleType

EXTRA = "pip install 'dilatedem[analysis]'"


def imported(name: str) -> ModuleType:
    """The package `name`. Raises ImportError with the command that brings it."""
    try:
        return importlib.import_module(name)
    except ModuleNotFoundError as error:
        if error.name != name:
            raise  # it is there, but lacks something of its own
        raise ImportError(f"{name} is not installed, which tables and load maps are given in: {EXTRA}", name=name) from None

"""What lies deeper in Numba than its documents go, changes from release to release, and has no other way: asked for by name."""

from importlib import import_module
from types import ModuleType


def inside(name: str) -> ModuleType | None:
    """A module of Numba; None where this release has none of that name."""
    try:
        return import_module(f"numba.{name}")
    except ImportError:
        return None

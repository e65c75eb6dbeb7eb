"""Qhull, as SciPy has it, without all that SciPy loads beside it.

scipy.spatial and scipy.linalg import half of SciPy and of NumPy: a fifth of the time that a run takes to its first step. What is
needed of them is compiled code, which can be imported without them while two empty packages stand in their places. A SciPy that is
built otherwise gives its Qhull by the public way, and so does one that was loaded before.
"""

import importlib
import importlib.util
import sys
from types import ModuleType

#: packages whose own modules the compiled code does not need
STOOD_IN = ("scipy.linalg", "scipy.spatial")


def _alone() -> ModuleType:
    """The compiled module. Raises ImportError or AttributeError where this SciPy has none that can stand alone."""
    scipy = importlib.import_module("scipy")
    for name in STOOD_IN:
        package = ModuleType(name)
        package.__path__ = [f"{place}/{name.partition('.')[2]}" for place in scipy.__path__]
        sys.modules[name] = package
    try:
        module = importlib.import_module("scipy.spatial._qhull")
        return module if all(hasattr(module, name) for name in __all__) else importlib.import_module("scipy.spatial")
    finally:
        for name in STOOD_IN:
            del sys.modules[name]
            scipy.__dict__.pop(name.partition(".")[2], None)


def _qhull() -> ModuleType:
    if not any(name in sys.modules for name in STOOD_IN):
        try:
            return _alone()
        except (ImportError, AttributeError):
            pass
    return importlib.import_module("scipy.spatial")


__all__ = ["ConvexHull", "HalfspaceIntersection", "QhullError", "Voronoi"]

_found = _qhull()
ConvexHull, HalfspaceIntersection = _found.ConvexHull, _found.HalfspaceIntersection
QhullError, Voronoi = _found.QhullError, _found.Voronoi

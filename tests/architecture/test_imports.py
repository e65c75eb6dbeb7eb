"""The direction of the imports, as pyproject.toml states it ([tool.importlinter])."""

import ast
import os
from pathlib import Path

import grimp
from importlinter.cli import lint_imports

from dilatedem.jit.cache import KERNEL_SOURCES

ROOT = Path(__file__).parents[2]
PACKAGE = ROOT / "dilatedem"

#: what makes a function part of a kernel
DECORATORS = {"kernel", "item", "device", "shared_loop", "by_type"}

#: what Numba documents, and changes with notice
PUBLIC = {"numba", "numba.core.event", "numba.extending", "numba.types"}


def test_imports_run_one_way(monkeypatch):
    monkeypatch.chdir(ROOT)
    monkeypatch.syspath_prepend(os.fspath(ROOT))
    assert lint_imports(config_filename="pyproject.toml", no_cache=True) == 0, "see `lint-imports` for the imports at fault"


def test_only_jit_knows_numba():
    """A bare njit would have its cache in the wrong place, where stale machine code gives stale answers."""
    found = []
    for path in PACKAGE.rglob("*.py"):
        if path.parent == PACKAGE / "jit":
            continue
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
            if isinstance(node, ast.ImportFrom):
                names = [node.module or ""]
            if any(name.split(".")[0] in ("numba", "llvmlite") for name in names):
                found.append(f"{path.relative_to(ROOT)}:{node.lineno}")
    assert not found, "use the decorators of dilatedem.jit"


def test_jit_uses_what_numba_documents():
    """What lies deeper changes from release to release: the program would run with a single one."""
    used = set()
    for path in (PACKAGE / "jit").rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Import):
                used |= {alias.name for alias in node.names if alias.name.split(".")[0] == "numba"}
            elif isinstance(node, ast.ImportFrom) and node.module.split(".")[0] == "numba":
                deeper = node.module in ("numba", "numba.core")  # modules, where the others hold functions
                used |= {f"{node.module}.{alias.name}" for alias in node.names} if deeper else {node.module}
    assert used <= PUBLIC, used - PUBLIC


def test_machine_code_is_named_by_all_sources_that_it_is_made_of():
    """Stale machine code gives stale answers: whatever a module with kernels imports counts, however far away."""
    graph = grimp.build_graph("dilatedem", cache_dir=None)
    made_of = set()
    for module in graph.modules:
        path = PACKAGE.parent.joinpath(*module.split("."))
        path = path / "__init__.py" if path.is_dir() else path.with_suffix(".py")
        used = {name for name in imported_names(path) if name in DECORATORS}
        if used or module.startswith("dilatedem.jit."):
            made_of |= {module} | graph.find_upstream_modules(module)
    counted = {f"dilatedem.{name.removesuffix('.py').replace('/', '.')}" for name in KERNEL_SOURCES}
    missed = {module for module in made_of if not any(f"{module}.".startswith(f"{name}.") for name in counted)}
    assert not missed, "add them to KERNEL_SOURCES in dilatedem/jit/cache.py"
    assert len(made_of) > 80


def imported_names(path: Path) -> set[str]:
    """What a module imports from `dilatedem.jit`."""
    nodes = (node for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))) if isinstance(node, ast.ImportFrom))
    return {alias.name for node in nodes if (node.module or "").startswith("dilatedem.jit") for alias in node.names}

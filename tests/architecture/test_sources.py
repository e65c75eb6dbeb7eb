"""Habits of the sources that no linter knows: no paths of one machine, files of a size that can be read in one go."""

import ast
import re
from collections import Counter
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
FOLDERS = ("dilatedem", "cases", "tests", "benchmarks", "validation", "docs", ".ci")
TEXT = {".py", ".toml", ".md", ".csv", ".html", ".json", ".txt", ".cfg", ""}
MACHINE_PATH = re.compile(r"(?<![\w.])/(?:home|root|work|Users)/\w|\bfile:///|[A-Z]:\\\\\w")

#: lines of the longest module: what a reader holds in mind at once
LONGEST_MODULE = 350


def sources() -> list[Path]:
    inside = [path for folder in FOLDERS for path in (ROOT / folder).rglob("*")]
    files = [path for path in [*ROOT.glob("*"), *inside] if path.is_file() and path.suffix in TEXT]
    return [path for path in files if "__pycache__" not in path.parts]


def test_sources_name_no_place_on_one_machine():
    found = []
    for path in sources():
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), start=1):
            if MACHINE_PATH.search(line):
                found.append(f"{path.relative_to(ROOT)}:{number}: {line.strip()[:100]}")
    assert not found


@pytest.mark.parametrize("path", sorted((ROOT / "dilatedem").rglob("*.py")), ids=lambda path: str(path.relative_to(ROOT)))
def test_a_module_can_be_read_in_one_go(path):
    text = path.read_text(encoding="utf-8")
    assert len(text.splitlines()) <= LONGEST_MODULE
    assert not re.fullmatch(r"utils?|helpers?|managers?|misc|common", path.stem)


def test_no_two_test_modules_have_one_name():
    # pytest imports them by name alone: of two, it would collect only the first
    names = Counter(path.name for path in (ROOT / "tests").rglob("test_*.py"))
    assert not [name for name, times in names.items() if times > 1]


#: rooms whose numbers a run follows from: they must come out alike on every processor (see dilatedem/numerics/plain.py)
DETERMINED = (
    "contact",
    "events",
    "field",
    "geometry",
    "jit",
    "motion",
    "numerics",
    "output",
    "scene",
    "state",
    "step",
    "structures",
    "water",
)
#: modules there that only tell whether a case is refused
JUDGING = ("geometry/separation.py",)
#: what BLAS, LAPACK and NumPy's vector code do as the processor has it
ROUNDED = {
    "linalg", "matmul", "dot", "vdot", "vecdot", "matvec", "vecmat", "inner", "tensordot", "einsum", "sin", "cos", "tan", "sinc",
    "arcsin", "arccos", "arctan", "arctan2", "hypot", "exp", "exp2", "expm1", "log", "log2", "log10", "log1p", "power",
    "float_power", "cbrt", "sinh", "cosh", "tanh",
}  # fmt: skip


def rounded_by_processor(path: Path) -> list[str]:
    """Where a module calls what rounds as the processor has it: functions of `np`, and `@`."""
    found = []
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id == "np" and node.attr in ROUNDED:
            found.append(f"{path.name}:{node.lineno}: np.{node.attr}")
        if isinstance(node, ast.BinOp | ast.AugAssign) and isinstance(node.op, ast.MatMult):
            found.append(f"{path.name}:{node.lineno}: @")
    return found


@pytest.mark.parametrize("room", DETERMINED)
def test_what_a_run_follows_from_is_rounded_alike_on_every_processor(room):
    judging = {ROOT / "dilatedem" / module for module in JUDGING}
    modules = sorted(set((ROOT / "dilatedem" / room).rglob("*.py")) - judging)
    assert modules
    found = [line for path in modules for line in rounded_by_processor(path)]
    assert not found, "use dilatedem.numerics.plain"


def test_the_search_for_such_calls_finds_them(tmp_path):
    path = tmp_path / "module.py"
    path.write_text("import numpy as np\na = np.linalg.det(b) + np.sin(c)\nd = e @ f\n", encoding="utf-8")
    assert len(rounded_by_processor(path)) == 3

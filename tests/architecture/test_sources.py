"""Habits of the sources that no linter knows: no paths of one machine, files of a size that can be read in one go."""

import re
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

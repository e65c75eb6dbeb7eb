"""The program understands the commands of the pages, and reads the cases that they name with what they lay over them."""

import re
import shlex
import shutil
from pathlib import Path

import click
import pytest
import typer
from typer.testing import CliRunner

from dilatedem.case.load import load
from dilatedem.cli import app

ROOT = Path(__file__).parents[2]
PAGES = ["README.md", *sorted(page.relative_to(ROOT).as_posix() for page in (ROOT / "docs").rglob("*.md"))]
FENCED = re.compile(r"^```sh\n(.*?)^```$", re.MULTILINE | re.DOTALL)
#: what stands in a command for words of the reader's own
VARIABLES = {"$u": "0.3", "$SLURM_ARRAY_TASK_ID": "7"}
#: commands that take no simulation and are quick; those of figures are tried in tests/unit
QUICK = ("init", "info", "export", "paraview", "schema")


def commands_of(page: str) -> list[list[str]]:
    """The words behind `dilatedem` of each command in the shell blocks of a page."""
    found = []
    for block in FENCED.findall((ROOT / page).read_text(encoding="utf-8")):
        for line in block.replace("\\\n", " ").splitlines():
            for name, value in VARIABLES.items():
                line = line.replace(name, value)
            words = shlex.split(line, comments=True)
            while any(word.endswith("dilatedem") for word in words):
                start = next(i for i, word in enumerate(words) if word.endswith("dilatedem"))
                words = words[start + 1 :]
                end = words.index("&&") if "&&" in words else len(words)
                found.append(words[:end])
                words = words[end:]
    return found


COMMANDS = [pytest.param(words, id=f"{page}: {' '.join(words)}") for page in PAGES for words in commands_of(page)]


def understood(words: list[str]) -> click.Context:
    """The command as the program reads it. Raises click.UsageError for one that it refuses."""
    group = typer.main.get_command(app)
    with click.Context(group) as context:
        name, command, rest = group.resolve_command(context, list(words))
        return command.make_context(name, list(rest), parent=context)


def test_pages_have_commands():
    assert len(COMMANDS) > 60


@pytest.mark.parametrize("words", COMMANDS)
def test_command_is_understood(words, monkeypatch):
    monkeypatch.chdir(ROOT)
    assert understood(words).command.callback


@pytest.mark.parametrize("words", [each for each in COMMANDS if "cases/" in " ".join(each.values[0])])
def test_case_of_a_command_can_be_read(words, monkeypatch):
    monkeypatch.chdir(ROOT)
    given = understood(words).params
    case = next(value for value in given.values() if str(value).startswith("cases/"))
    assert load(case, given.get("overrides") or []).time.duration > 0.0


def is_quick(words: list[str]) -> bool:
    return words[0] in QUICK and all(word == "runs/pile" for word in words if "runs/" in word)


@pytest.mark.parametrize("words", [each for each in COMMANDS if is_quick(each.values[0])])
def test_quick_command_runs(words, crowded, tmp_path, monkeypatch):
    shutil.copytree(crowded, tmp_path / "runs/pile")
    monkeypatch.chdir(tmp_path)
    result = CliRunner().invoke(app, words)
    assert result.exit_code == 0, result.output

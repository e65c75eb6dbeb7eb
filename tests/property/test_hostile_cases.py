"""Mutated cases end `check` with a sentence, whatever was done to them; validation/reliability tries thousands, and runs."""

import random
from pathlib import Path

import pytest
from typer.testing import CliRunner

from dilatedem.cli import app
from validation.reliability.mutations import mutated_text, mutated_values

CASES = sorted((Path(__file__).parents[1] / "cases").glob("*.toml"))


@pytest.mark.parametrize("seed", range(60))
def test_check_never_fails_but_with_a_sentence(tmp_path, seed):
    rng = random.Random(1000 + seed)
    path = tmp_path / "case.toml"
    path.write_bytes((mutated_text if seed % 3 == 0 else mutated_values)(rng, rng.choice(CASES).read_text()))
    done = CliRunner().invoke(app, ["check", str(path)])
    assert isinstance(done.exception, SystemExit | None), done.exception
    assert done.exit_code in (0, 2)
    assert bool(done.stderr.strip()) or done.exit_code == 0
    assert not any(ord(character) < 32 and character != "\n" for character in done.output)

"""Where a run comes from: when, on which machine, by which command."""

from datetime import datetime

import pytest

from dilatedem.output.origin import command, machine, now, origin


def test_times_know_their_distance_from_utc():
    started = now()
    told = origin(started)
    assert told["started"] == started
    assert datetime.fromisoformat(told["written"]).tzinfo is not None
    assert datetime.fromisoformat(told["written"]) >= datetime.fromisoformat(started)


def test_machine_is_told_in_words():
    assert set(machine()) == {"machine", "system", "processor", "cores"}
    assert all(isinstance(value, str) for value in machine().values()) and machine()["processor"]


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["/opt/bin/dilatedem", "run", "cases/pile.toml"], "dilatedem run cases/pile.toml"),
        (["lib/dilatedem/__main__.py", "run", "my case.toml", "--set", "water.velocity=[0.5, 0]"],
         "dilatedem run 'my case.toml' --set 'water.velocity=[0.5, 0]'"),
        (["lib/dilatedem/worker.py"], ""),
        (["study.py", "--fast"], ""),
        (["pytest/__main__.py"], ""),
        ([""], ""),
        ([], ""),
    ],
)  # fmt: skip
def test_command_is_that_of_the_program(words, told):
    assert command(words) == told

"""What a sweep will take is that of its cases, of which some are looked at."""

import pytest

from dilatedem.sweeps import foretell as room
from dilatedem.sweeps.foretell import DISK, FLOES, JAMMED, MEMORY, SECONDS, STEPS, foretell, spread
from tests.regression.folders import CASES, in_process

CROWDED = CASES / "crowded.toml"


def facts(case) -> dict:
    seconds = 10.0 * case.field.seed  # of seeds 1 to 20: 10 s to 200 s
    return {FLOES: 20 + case.field.seed % 2, STEPS: 7, SECONDS: seconds, JAMMED: 4.0 * seconds, MEMORY: 100.0, DISK: 2.5}


@pytest.fixture
def looks(monkeypatch) -> list[int]:
    looked: list[int] = []
    monkeypatch.setattr(room, "_facts", lambda job: looked.append(job.case.field.seed) or facts(job.case))
    return looked


def test_some_of_the_cases_stand_for_all(looks, tmp_path):
    told = foretell(CROWDED, seeds=20, jobs=2, out=tmp_path / "out", overrides=["field.seed=1"])
    assert looks == [1, 4, 6, 9, 12, 15, 17, 20]
    assert told == {
        "cases": 20, "completed before": 0, "looked at": "8 of the 20 cases to be run; all with --check-all",
        "floes of a case": "20 to 21",
        "steps of a case": "7", "wall time of a case, about": "10 s to 3.3 min", "cases at a time": 2,
        "processor time in all, about": "35 min, in jams up to 2.3 h", "wall time in all, about": "18 min, in jams up to 70 min",
        "memory at a time, MB, about": "200", "disk, MB, about": "50",
    }  # fmt: skip
    assert not (tmp_path / "out").exists()


def test_no_sweep_is_over_before_its_longest_case(looks, tmp_path):
    told = foretell(CROWDED, vary=["field.seed=1,20"], jobs=8, out=tmp_path / "out")
    assert told["wall time in all, about"] == "3.3 min, in jams up to 13 min"


def test_a_cluster_has_workers_that_nobody_has_counted(looks, tmp_path):
    told = foretell(CROWDED, seeds=2, scheduler="tcp://host:8786", out=tmp_path / "out", overrides=["field.seed=1"])
    assert told["cases at a time"] == "as many as the cluster has workers" and "wall time in all, about" not in told


def test_few_cases_are_all_looked_at():
    assert spread(list("abc")) == list("abc") and len(spread(list(range(100)))) == 8


def test_the_command_runs_and_writes_nothing(tmp_path):
    done = in_process("sweep", CROWDED, "--vary", "contact.friction=0.1,0.2", "--dry-run", "--out", tmp_path / "out")
    assert done.exit_code == 0 and not (tmp_path / "out").exists()
    words = dict(line.split("  ", 1) for line in done.stdout.splitlines())
    assert words["cases"].strip() == "2" and words["floes of a case"].strip() == "26"
    assert float(words["disk, MB, about"]) > 0.0

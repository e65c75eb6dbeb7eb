"""Ice fields that cannot be made end a sweep before anything is written; how many were tried is told."""

from itertools import count

import numpy as np
import pytest

from dilatedem.errors import CaseError
from dilatedem.scene.place import compose
from dilatedem.sweeps import fields
from dilatedem.sweeps.fields import LOOK_S, require_fields, scene_at_hand
from dilatedem.sweeps.plan import plan
from tests.regression.folders import CASES, in_process

CROWDED = CASES / "crowded.toml"


@pytest.fixture
def tried(monkeypatch) -> list[tuple[float, int]]:
    found: list[tuple[float, int]] = []
    monkeypatch.setattr(
        fields, "_require_field", lambda job: found.append((job.case.contact.friction, job.case.ice.density, job.case.field.seed))
    )
    return found


def test_each_field_is_made_once_and_first_seeds_come_first(tried, tmp_path):
    todo = plan(CROWDED, vary=["ice.density=900,910", "contact.friction=0.1,0.2"], seeds=2, out=tmp_path)
    assert require_fields(todo) == ""
    first = todo[0].case.field.seed
    assert tried == [(0.1, density, seed) for seed in (first, first + 1) for density in (900.0, 910.0)]


def test_so_many_as_the_time_allows_unless_all_are_asked_for(tried, tmp_path):
    todo = plan(CROWDED, seeds=20, out=tmp_path)
    ticks = count(0.0, 1.0)  # a second passes with each look at the clock
    said = require_fields(todo, clock=lambda: next(ticks))
    assert said == f"fields of {LOOK_S:.0f} of 20 cases were tried, in 5 s; --check-all tries all before the first run"
    assert len(tried) == LOOK_S
    assert require_fields(todo, every=True, clock=lambda: next(ticks)) == "" and len(tried) == LOOK_S + 20


def test_cases_that_have_begun_are_not_tried(tried, tmp_path):
    todo = plan(CROWDED, seeds=3, out=tmp_path)
    todo[0].status = "completed"
    todo[1].folder.mkdir()
    (todo[1].folder / "restart.h5").touch()
    require_fields(todo)
    assert [seed for *_, seed in tried] == [todo[2].case.field.seed]


def test_a_field_that_cannot_be_made_is_told_before_anything_is_written(tmp_path):
    """A pile as wide as the domain leaves no floe."""
    vary = ["--vary", "structure.0.radius=0.5,500"]
    for more in ([], ["--dry-run"], ["--check-all"]):
        done = in_process("sweep", CROWDED, *vary, *more, "--out", tmp_path / "out")
        assert done.exit_code == 2 and done.stderr.startswith("structure.0.radius=500: "), done.stderr
        assert not (tmp_path / "out").exists()
    with pytest.raises(CaseError):
        require_fields(plan(CROWDED, vary=["structure.0.radius=0.5,500"], out=tmp_path))


def test_scenes_that_were_made_to_be_tried_are_those_of_the_runs(tmp_path, monkeypatch):
    monkeypatch.setattr(fields, "_KEPT", {})
    one, two = (job.case for job in plan(CROWDED, seeds=2, out=tmp_path))
    monkeypatch.setattr(fields, "MOST_KEPT", compose(one).count + 1)
    require_fields(plan(CROWDED, seeds=2, out=tmp_path))
    kept = scene_at_hand(one)
    np.testing.assert_array_equal(kept.position, compose(one).position)
    assert scene_at_hand(two) is None, "no room for a second one"
    assert scene_at_hand(one.model_copy(update={"title": "another"})) is None

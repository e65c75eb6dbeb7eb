"""The benchmark program's own parts: what its command line asks for, what it keeps, how it judges, what its page says."""

import pytest

from benchmarks import measure, report, results, yardstick
from benchmarks.__main__ import arguments, main, plan_of
from benchmarks.measure import Plan, Replay
from benchmarks.scenes import packed_field, scene_simulation, settled, sized
from benchmarks.targets import Target, targets
from dilatedem.step.stages import STAGES


def row(**known) -> dict:
    one = {
        "scene": "packed", "model": "liu2015", "size": 200, "floes": 195, "threads": 1, "steps": 500, "dt_s": 1e-4, "span": 10,
        "ms_per_step": 0.2, "ms_per_step_median": 0.25, "us_per_floe_step": 1.0, "particle_steps_per_s": 1e6, "contacts": 392,
        "listed_pairs": 1154, "awake_pairs": 392.5, "coal_ms": 0.5, "coal_called_ms": 0.9, "near_pairs": 515, "coal_contacts": 380,
        "date": "2026-11-22T12:00+00:00", "program": "0.1.0", "processor": "a processor", "cores": 2, "load": 0.5,
        "system": "Linux", "python": "3.11", "numba": "0.68", "numpy": "2.4", "coal": "3.0.3", "layer": "none",
    }  # fmt: skip
    return one | {f"{stage}_us": 1.5 for stage in STAGES} | known


def test_other_figures_are_measured_without_the_scenes_unless_asked_for():
    assert plan_of(arguments(["--start", "--files"])) is None
    assert plan_of(arguments([])) == Plan()
    assert plan_of(arguments(["--all"])) == Plan()
    assert plan_of(arguments(["--quick"])) == Plan(sizes=(200,), threads=(1,), rounds=1)
    chosen = plan_of(arguments(["--start", "--scenes", "jam", "--threads", "2"]))
    assert chosen == Plan(scenes=("jam",), threads=(2,))


def test_of_all_rounds_the_best_counts_and_the_median_of_every_repeat(monkeypatch):
    times = iter([[3.0, 5.0], [8.0, 9.0], [2.0, 7.0], [10.0, 11.0]])

    def measured(scene, model, size, threads, repeats, simulation):
        taken = next(times)
        return row(size=size, ms_per_step=min(taken), ms_per_step_median=0.0), taken

    monkeypatch.setattr(measure, "measured", measured)
    monkeypatch.setattr(measure.Scenes, "ready", lambda *configuration: None)
    plan = Plan(scenes=("packed",), models=("liu2015",), sizes=(200, 2000), threads=(1,), rounds=2)
    found = [(row["size"], row["ms_per_step"], row["ms_per_step_median"]) for row in measure.rows_of(plan)]
    assert found == [(200, 3.0, 4.0), (2000, 8.0, 8.5), (200, 2.0, 4.0), (2000, 8.0, 9.5)]


def test_a_generated_field_is_packed_face_on_face_and_rocking_has_one_size():
    simulation = packed_field(200, "liu2015")
    assert simulation.model.floating == 200
    assert simulation.contacts > 1.5 * 200
    assert {size for scene, _, size, _ in Plan(sizes=(200, 2000)).configurations() if scene == "rocking"} == {200}


def test_a_wrong_scene_ends_the_command_line(capsys):
    with pytest.raises(SystemExit) as ended:
        main(["--scenes", "storm"])
    assert ended.value.code == 2 and "storm" in capsys.readouterr().err


def test_results_come_back_as_they_were_kept(tmp_path):
    rows = [row(), row(threads=2, coal_ms=None)]
    results.write(tmp_path / "results.csv", rows)
    assert results.read(tmp_path / "results.csv") == rows


def test_new_results_replace_those_of_the_same_configuration():
    keys = ("scene", "size")
    old, new = [row(size=200), row(size=2000)], [row(size=2000, ms_per_step=1.0), row(size=10_000)]
    assert results.merged(old, new, keys) == [old[0], *new]
    assert results.merged([{"scene": "jam"}], new, keys) == new, "rows with columns of another version would spoil the file"


def test_a_target_is_met_missed_or_open():
    words = [Target("", value, 0.03, 0.01).verdict() for value in (None, 0.005, 0.02, 0.04)]
    assert words == ["not measured", "**aim met**", "met", "**missed**"]
    assert Target("", 1.8, 1.7, 1.9, at_least=True).verdict() == "met"
    found = {target.what: target.value for target in targets([row(), row(model="consistent", ms_per_step=0.3)], [])}
    assert found["packed, 200 floes, a step"] == 0.2
    assert found["packed, consistent against liu2015"] == pytest.approx(1.5)
    assert found["drift, 200 floes, a step"] is None


def test_the_page_has_every_result_and_works_without_the_yardstick():
    other = {"name": "paper_s", "value": 50.0, "unit": "s", "note": "the whole case", "date": "2026-11-22T12:00+00:00"}
    page = report.page([row()], [other])
    for words in ("a processor", "| packed, liu2015 |", "same minute | – | – | 0.5 |", "YADE", "| the whole case | 50 s |"):
        assert words in page
    assert "of the paper's case" not in page
    stages = [other | {"name": f"paper_{stage}_s", "value": 0.5} for stage in STAGES]
    assert "take 4.50 s" in report.page([row()], stages) and report.page([row()], stages).count("11.1%") == len(STAGES)
    assert "coal, the yardstick, was not installed" in report.page([row(coal_ms=None)], [])


def test_without_coal_the_yardstick_has_no_answer(monkeypatch):
    monkeypatch.setattr(yardstick, "load_coal", lambda: None)
    assert yardstick.coal_step(None) is None


def test_coal_is_asked_about_every_contact():
    pytest.importorskip("coal")
    simulation = scene_simulation("packed")
    simulation.evaluate()
    answer = yardstick.coal_step(simulation, repeats=1)
    assert 0 < answer["coal_contacts"] <= simulation.contacts and answer["near_pairs"] >= answer["coal_contacts"]


def test_a_stretch_can_be_replayed_to_the_last_bit():
    replay = Replay(sized(settled("jam", "liu2015"), 200), 50)
    ends = []
    for _ in range(2):
        replay.rewind()
        replay._run(50)
        ends.append([values.tobytes() for group in replay.simulation.state.groups().values() for values in group])
    assert ends[0] == ends[1]

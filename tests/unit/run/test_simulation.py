"""The composition root: the time step, room for pairs, faults put into words, figures that follow from a case."""

import json
import re
from pathlib import Path

import numpy as np
import pytest

from dilatedem.case.load import load
from dilatedem.case.schema import Case
from dilatedem.errors import CaseError, Interrupted, SimulationStopped
from dilatedem.run import loop
from dilatedem.run.ending import total_steps
from dilatedem.run.foretell import check
from dilatedem.run.pace import free_span, time_step
from dilatedem.run.simulation import Simulation
from dilatedem.state.clock import Status
from dilatedem.state.pairs import empty_pairs

CASES = Path(__file__).parents[2] / "cases"
CROWDED = CASES / "crowded.toml"


def case_of(**tables) -> Case:
    return Case.model_validate({"field": {"source": "bodies"}, "body": [{"vertices": [[0.0, 0.0, 0.0]]}], **tables})


def test_the_automatic_step_divides_the_force_window():
    case = case_of(output={"force_interval": 0.01})
    dt = time_step(case, 3.3e-4)
    assert dt <= 3.3e-5 and 0.01 / dt == pytest.approx(round(0.01 / dt), abs=1e-9)
    assert dt > 0.98 * 3.3e-5
    half = time_step(case_of(time={"step_fraction": 0.5}), 3.3e-4)
    assert half <= 1.65e-4 and round(0.01 / half) == 63  # 61, made a whole number of spans of idle bodies: three of 21


def test_everything_is_written_on_time_where_one_step_divides_all_intervals():
    output = {"force_interval": 0.05, "track": [0], "track_interval": 0.03, "snapshot_interval": 0.0}
    case = case_of(output=output)
    dt = time_step(case, 3.3e-4)
    assert 0.01 / dt == pytest.approx(round(0.01 / dt), abs=1e-9) and round(0.01 / dt) % free_span(case, dt) == 0


def test_idle_bodies_step_together_with_every_output():
    assert free_span(case_of(), 0.01 / 992) == 32
    assert free_span(case_of(), 0.01 / 990) == 30
    assert free_span(case_of(), 1e-4) == 25  # 4 ms would be 40
    assert free_span(case_of(), 0.01 / 33) == 11  # 4 ms would be 13
    assert free_span(case_of(), 0.01 / 97) == 1
    assert free_span(case_of(output={"snapshot_interval": 0.0987}), 1e-4) == 25  # up to 2.5 ms late
    assert free_span(case_of(output={"snapshot_interval": 0.0123}), 1e-4) == 5  # of 123 steps less than a sixteenth
    assert free_span(case_of(), 5e-3) == 1


def test_the_automatic_step_is_no_longer_than_a_window_or_the_run():
    assert time_step(case_of(output={"force_interval": 1e-5}), 1.0) == 1e-5
    assert time_step(case_of(time={"duration": 0.003}), 1.0) <= 0.003


def test_a_step_of_the_case_is_taken_as_it_is_up_to_the_critical_one():
    assert time_step(case_of(time={"step": 3.3e-4}), 3.3e-4) == 3.3e-4
    with pytest.raises(CaseError, match=r"time\.step = 0\.0004: must be at most .* 0\.00033 s"):
        time_step(case_of(time={"step": 4e-4}), 3.3e-4)


@pytest.mark.parametrize(
    ("duration", "dt", "steps"), [(1.0, 0.1, 10), (1.0, 0.3, 4), (0.3, 0.1, 3), (100.0, 0.01 / 298, 2_980_000)]
)
def test_steps_reach_the_end_and_not_one_more(duration, dt, steps):
    assert total_steps(case_of(time={"duration": duration}), dt) == steps


def test_evaluating_the_start_moves_nothing():
    run = Simulation.of_case(load(CROWDED))
    before = run.state.bodies.position.copy(), run.state.bodies.velocity.copy()
    assert run.evaluate() == Status.DONE
    assert run.time_s == 0.0
    np.testing.assert_array_equal(run.state.bodies.position, before[0])
    np.testing.assert_array_equal(run.state.bodies.velocity, before[1])
    assert np.any(run.state.bodies.force != 0.0)  # but weight and buoyancy are there


def test_the_list_of_pairs_grows_where_it_is_too_short():
    roomy, tight = (Simulation.of_case(load(CROWDED)) for _ in range(2))
    tight.state.pairs = empty_pairs(2)  # rows of a list of one lie in memory like no others: the step would be compiled for them
    tight.make_room()
    for run in (roomy, tight):
        assert run.evaluate() == Status.DONE
        assert run.advance(6000) == Status.DONE
    assert len(tight.state.pairs.a) < len(roomy.state.pairs.a)
    for name, values in roomy.state.bodies._asdict().items():
        np.testing.assert_array_equal(getattr(tight.state.bodies, name), values, err_msg=name)


def test_loads_do_not_depend_on_how_steps_are_grouped():
    whole, parts = (Simulation.of_case(load(CROWDED)) for _ in range(2))
    whole.evaluate(), parts.evaluate()
    span = whole.span
    assert span > 1  # bodies that nothing can touch stand at the instant of all others only then
    whole.advance(100 * span)
    for spans in (1, 30, 69):
        parts.advance(spans * span)
    for name, values in whole.state.bodies._asdict().items():
        np.testing.assert_array_equal(getattr(parts.state.bodies, name), values, err_msg=name)


def test_a_body_inside_a_structure_starts_no_run_and_both_are_named(tmp_path):
    spike = [[-3.0, -3.0, -3.0], [3.0, -3.0, -3.0], [0.0, 3.0, -3.0], [0.0, 0.0, 3.0]]
    case = case_of(
        structure=[{"kind": "pile", "name": "leg", "center": [1.0, 0.0], "radius": 0.3}],
        body=[{"vertices": spike, "dilated_radius": 0.1, "position": [1.0, 0.0, 0.0]}],
    )
    with pytest.raises(CaseError, match=r'body 0 at \(1\.00, 0\.00\) and structure "leg", by \S+ m'):
        loop.run(case, tmp_path / "deep", quiet=True)
    assert not (tmp_path / "deep").exists()
    with pytest.raises(SimulationStopped, match=r'body 0 at \(1\.00, 0\.00\) and structure "leg" overlap by \S+ m'):
        Simulation.of_case(case).step()


def test_more_threads_than_the_machine_has_are_refused(tmp_path):
    with pytest.raises(CaseError, match=r"--threads = 9999: this machine offers \d+"):
        loop.run(load(CROWDED), tmp_path / "out", threads=9999, quiet=True)
    assert not (tmp_path / "out").exists()


def test_check_tells_what_the_run_then_does(crowded):
    facts = check(load(CROWDED))
    summary = json.loads((crowded / "summary.json").read_text())
    assert facts["floes"] == summary["floes"] == 26 and facts["floes left out at structures"] == 4
    assert (facts["step, s"], facts["steps"]) == (summary["dt_s"], summary["steps"])
    assert facts["critical step, s"] == summary["dt_critical_s"]
    size = sum(path.stat().st_size for path in crowded.rglob("*") if path.suffix in (".csv", ".vtu", ".h5"))
    assert 0.7 < facts["output, MB, about"] / (size / 1e6) < 1.4
    assert facts["concentration"] == pytest.approx(0.85)


def test_the_case_file_of_a_run_names_version_and_seed(crowded):
    from dilatedem import __version__

    text = (crowded / "case.toml").read_text()
    assert re.match(rf"# dilatedem {re.escape(__version__)}, seed 4\n\n", text)
    assert load(crowded / "case.toml") == load(CROWDED)


def test_an_interrupt_while_compiling_leaves_no_folder(tmp_path, monkeypatch):
    def interrupted(*asked, **more):
        raise KeyboardInterrupt

    monkeypatch.setattr(loop, "compile_kernels", interrupted)
    with pytest.raises(Interrupted, match="interrupted while compiling; no file was touched"):
        loop.run(load(CROWDED), tmp_path / "out", quiet=True)
    assert not (tmp_path / "out").exists()


def test_wall_time_adds_up_over_the_parts_of_a_run_and_contains_the_compiling(tmp_path):
    case, out = load(CROWDED, ["time.duration=0.1"]), tmp_path / "out"
    loop.run(case, out, quiet=True)
    first = json.loads((out / "summary.json").read_text())
    assert 0.0 < first["compile_s"] < first["wall_s"]
    assert first["steps_per_s"] == pytest.approx(first["steps"] / (first["wall_s"] - first["compile_s"]))
    (out / "summary.json").write_text(json.dumps(first | {"status": "running"}))  # as if killed before its last words
    loop.run(case, out, resume=True, quiet=True)
    second = json.loads((out / "summary.json").read_text())
    assert second["wall_s"] > first["wall_s"] and second["compile_s"] > first["compile_s"]
    assert second["steps"] == first["steps"]

"""The error of the time step: what is replayed, what is compared, and what is said where nothing can be."""

import csv
import json
import re
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from dilatedem.case.load import load
from dilatedem.case.schema import Case
from dilatedem.output import checkpoint
from dilatedem.output.windows import end_open_window
from dilatedem.post import info, post
from dilatedem.post.folders import run_statistics
from dilatedem.post.read import open_run
from dilatedem.post.report.page import write_run_report
from dilatedem.run import loop
from dilatedem.run.error_check import LEAD, TAIL, WINDOW, Watch, check
from dilatedem.run.simulation import Simulation
from dilatedem.state.bodies import bodies_at_rest
from dilatedem.state.clock import Status, clock_at_start
from dilatedem.state.loads import empty_loads, no_windows
from dilatedem.state.pairs import ALONE, empty_pairs, in_use, packed, unpacked
from dilatedem.state.supports import Excursions, excursions_at_start

CASES = Path(__file__).parents[2] / "cases"
PILE = {"kind": "pile", "center": [0.0, 0.0]}


def one_floe(*, structure=(PILE,), speed=0.3, **time) -> Case:
    """A floe of 2.8 m, 0.1 m ahead of a pile, in still water."""
    return Case.model_validate({
        "field": {"source": "bodies"},
        "water": {"velocity": [0.0, 0.0]},
        "structure": list(structure),
        "body": [{"outline": [[-4.9, -1.4], [-2.1, -1.4], [-2.1, 1.4], [-4.9, 1.4]], "velocity": [speed, 0.0, 0.0]}],
        "time": {"duration": 0.6, "error_check": True, **time},
    })  # fmt: skip


def ball(step: float) -> Case:
    """A ball of 0.3 m that is thrown at a pile; nothing else acts on it."""
    return Case.model_validate({
        "field": {"source": "bodies"},
        "water": {"enabled": False},
        "gravity": {"acceleration": 0.0},
        "structure": [PILE],
        "body": [{
            "vertices": [[0.0, 0.0, 0.0]], "dilated_radius": 0.3, "position": [-2.4, 0.0, 0.0], "velocity": [2.0, 0.3, 0.0],
        }],
        "time": {"duration": 0.2, "error_check": True, "step": step},
    })  # fmt: skip


def summary_of(case: Case, out: Path) -> dict:
    return json.loads((loop.run(case, out, overwrite=True, quiet=True) / "summary.json").read_text())


def test_a_coarse_step_has_a_larger_error_than_a_fine_one(tmp_path):
    coarse, fine = (summary_of(ball(step), tmp_path / "run")["error_check"] for step in (4e-4, 1e-5))
    for found, dt in ((coarse, 4e-4), (fine, 1e-5)):
        assert found["reproduced"] is True
        assert (found["at_dt"]["dt_s"], found["at_half_dt"]["dt_s"]) == (dt, 0.5 * dt)
        for name, key in (("fh_max", "fh_max_N"), ("impulse_h", "impulse_h_Ns")):
            assert found["change"][name] == pytest.approx(found["at_half_dt"][key] / found["at_dt"][key] - 1.0, abs=1e-12)
    assert abs(coarse["change"]["fh_max"]) > 1e-3 > 1e-4 > abs(fine["change"]["fh_max"])
    # and it is the error: what the fine run has of the peak, against the coarse one
    error = fine["at_half_dt"]["fh_max_N"] / coarse["at_dt"]["fh_max_N"] - 1.0
    assert coarse["change"]["fh_max"] == pytest.approx(error, rel=0.5)


@pytest.mark.parametrize("window", [0.01, 0.6])
def test_the_window_holds_the_peak_however_seldom_forces_are_written(window, tmp_path):
    case = one_floe()
    case = case.model_copy(update={"output": case.output.model_copy(update={"force_interval": window})})
    summary = summary_of(case, tmp_path / "run")
    found = summary["error_check"]
    assert found["reproduced"] is True
    assert found["at_dt"]["fh_max_N"] == summary["loads"]["pile"]["fh_max_N"] > 1e5


@pytest.mark.parametrize("name", ["crowded", "mixed"])
def test_a_run_of_many_bodies_is_reproduced_and_its_impulse_is_that_of_the_table(name, tmp_path):
    out = loop.run(load(CASES / f"{name}.toml", ["time.error_check=true", "time.duration=1.5"]), tmp_path / name, quiet=True)
    summary = json.loads((out / "summary.json").read_text())
    found, loads = summary["error_check"], summary["loads"]
    assert found["reproduced"] is True
    peak = max(load["fh_max_N"] for load in loads.values())
    assert found["at_dt"]["fh_max_N"] == loads[found["structure"]]["fh_max_N"] == peak > 1e3
    peak_s = loads[found["structure"]]["fh_max_time_s"]
    assert found["start_s"] < peak_s <= found["end_s"] <= min(peak_s + TAIL + 1e-9, 1.5)
    assert found["start_s"] == pytest.approx(WINDOW * round(found["start_s"] / WINDOW), abs=1e-3)
    interval = 0.05 if name == "crowded" else 0.02
    rows = [row for row in csv.DictReader((out / "forces.csv").open()) if row["structure"] == found["structure"]]
    held = [row for row in rows if found["start_s"] + 1e-6 < float(row["time_s"]) <= found["end_s"] + 1e-6]
    largest = interval * peak  # of the windows at the ends, where rows and window differ
    impulse = sum(float(row["fx_N"]) for row in held) * interval
    assert found["at_dt"]["impulse_x_Ns"] == pytest.approx(impulse, abs=0.2 * largest)
    assert found["at_dt"]["impulse_h_Ns"] >= abs(found["at_dt"]["impulse_x_Ns"])


@pytest.mark.parametrize(
    ("structure", "speed", "sentence"),
    [((), 0.3, "the case has no structure"), ((PILE,), 0.0, "no structure was touched")],
)
def test_without_a_load_there_is_nothing_to_check(structure, speed, sentence, tmp_path):
    summary = summary_of(one_floe(structure=structure, speed=speed, duration=0.02), tmp_path / "run")
    assert summary["status"] == "completed"
    assert summary["error_check"].keys() == {"message", "wall_s"}
    assert summary["error_check"]["message"] == f"time step not checked: {sentence}, so there is no load to compare"


def test_without_the_key_there_is_no_check_and_no_copy(tmp_path):
    out = tmp_path / "run"
    assert "error_check" not in summary_of(one_floe(error_check=False), out)
    groups, meta = checkpoint.load(out / "restart.h5")
    assert groups.keys() == {"ids", "bodies", "pairs", "hits", "ledger", "loads", "clock", "excursions"} and "watch" not in meta


def test_a_replay_that_stops_is_told_and_ends_no_run(monkeypatch, tmp_path):
    dt = Simulation.of_case(one_floe()).dt
    advance = Simulation.advance
    monkeypatch.setattr(
        Simulation, "advance", lambda self, steps, **more: advance(self, steps, **more) if self.dt == dt else Status.TOO_DEEP
    )
    summary = summary_of(one_floe(), tmp_path / "run")
    assert summary["status"] == "completed"
    found = summary["error_check"]
    assert re.fullmatch(r"time step not checked: the replay with half the step stopped at t = \S+ s \(TOO_DEEP\)", found["message"])
    assert found["reproduced"] is True and "at_dt" in found and "at_half_dt" not in found and "change" not in found


def played(case: Case) -> Simulation:
    """A run without files: every step of a `Watch` that looks every 0.01 s."""
    run = Simulation.of_case(case)
    assert run.evaluate() == Status.DONE
    watch, every = run.state.watch, round(0.01 / run.dt)
    watch.look(run.state, run.windows, 0)
    while run.time_s < case.time.duration - 1e-9:
        assert run.advance(every) == Status.DONE
        end_open_window(run.windows, run.state.loads, int(run.state.clock.step[0]))
        watch.look(run.state, run.windows, 0)
        run.windows.count[0] = 0
    return run


def test_a_replay_that_differs_in_the_last_bit_is_told():
    run = played(one_floe())
    assert check(run, ["pile"])["reproduced"] is True
    run.state.watch.peak = float(np.nextafter(run.state.watch.peak, np.inf))
    found = check(run, ["pile"])
    assert found["reproduced"] is False and "change" not in found
    assert "so this run cannot be resumed exactly" in found["message"]


def test_the_check_leaves_the_run_as_it_is():
    run = played(one_floe())
    before = {
        f"{name}.{part}": values.copy() for name, group in run.state.groups().items() for part, values in group._asdict().items()
    }
    assert check(run, ["pile"]) == check(run, ["pile"])
    for name, group in run.state.groups().items():
        for part, values in group._asdict().items():
            np.testing.assert_array_equal(values, before[f"{name}.{part}"], err_msg=f"{name}.{part}")


def test_a_copy_of_the_pairs_holds_all_of_them():
    pairs = played(one_floe()).state.pairs
    assert pairs.count[0] > 0
    copy = packed(pairs)
    again = unpacked(copy, len(pairs.a) + 7)
    for name in pairs._fields:
        rows = None if name in ALONE else int(pairs.count[0])
        assert getattr(again, name)[:rows].tobytes() == getattr(pairs, name)[:rows].tobytes(), name
    for name, values in in_use(pairs)._asdict().items():
        assert getattr(copy, name).tobytes() == values.tobytes(), name
    pairs.rounds[0] += 1
    pairs.a[0] += 1
    assert again.rounds[0] == pairs.rounds[0] - 1 and copy.a[0] == pairs.a[0] - 1


def watched(peaks: dict[float, float], *, end: float, dt: float = 1e-3) -> Watch:
    """A watch that looked every 0.01 s and found these loads (time [s] -> N) on the second of two structures."""
    watch, loads = Watch(dt), empty_loads(2, 2)
    windows = no_windows(2)
    state = SimpleNamespace(
        clock=clock_at_start(), loads=loads, bodies=bodies_at_rest(1, 1), pairs=empty_pairs(3),
        excursions=excursions_at_start(np.zeros((2, 3)), np.zeros((2, 3))),
    )  # fmt: skip
    for look in range(round(end / 0.01) + 1):
        state.clock.step[0] = round(look * 0.01 / dt)
        loads.steps[0] = min(look, 1)
        loads.window_extreme[1, 4] = peaks.get(round(look * 0.01, 2), 1.0)
        end_open_window(windows, loads, int(state.clock.step[0]))
        watch.look(state, windows, 0)
        windows.count[0] = 0
    return watch


@pytest.mark.parametrize(
    ("peak", "start"), [(0.05, 0.0), (0.3, 0.0), (0.4, 0.25), (0.5, 0.25), (0.51, 0.25), (0.6, 0.25), (0.62, 0.5), (0.98, 0.75)]
)
def test_a_replay_starts_well_before_its_peak(peak, start):
    watch = watched({peak: 5.0}, end=1.3)
    assert (watch.structure, watch.peak, watch.until) == (1, 5.0, round(peak / 1e-3))
    assert watch.worst.step == round(start / 1e-3)
    assert start == 0.0 or LEAD <= peak - 0.01 - start <= LEAD + WINDOW


def test_the_highest_peak_counts_and_of_equal_ones_the_first():
    assert watched({0.4: 3.0, 0.7: 5.0, 1.2: 5.0, 1.5: 4.0}, end=2.0).until == 700


def test_a_watch_comes_back_from_a_checkpoint(tmp_path):
    watch = watched({0.7: 5.0}, end=1.3)
    checkpoint.save(tmp_path / "saved.h5", watch.groups(), {"watch": watch.figures()})
    groups, meta = checkpoint.load(tmp_path / "saved.h5")
    again = Watch(watch.dt)
    again.restore(groups, meta["watch"], Excursions, where="saved.h5")
    assert again.figures() == watch.figures()
    assert [copy.step for copy in (again.before, again.latest, again.worst)] == [1000, 1250, 500]
    for name, group in watch.groups().items():
        for part, values in group._asdict().items():
            np.testing.assert_array_equal(getattr(again.groups()[name], part), values)


def test_info_and_report_tell_the_error(tmp_path):
    out = tmp_path / "run"
    found = summary_of(one_floe(), out)["error_check"]
    post([out])
    assert f"step error  {found['message']}" in info(out)
    page = (out / "report.html").read_text(encoding="utf-8")
    assert page.count("half the time step changes the") == 3
    for text in (found["message"], info(out), page):
        assert "one hit" in text and "no error bar" in text and "another history" in text
    assert json.loads((out / "summary.json").read_text())["error_check"] == found
    summary_of(one_floe(structure=(), duration=0.02), out)
    run = open_run(out)
    write_run_report(run, run_statistics(run), [])  # without the figures, which say nothing of it
    assert "Time step not checked: the case has no structure" in (out / "report.html").read_text(encoding="utf-8")

"""A sweep checks everything first, has processes run its cases, and tells what became of each.

The simulation is a stand-in that gets its case as a process does and writes a summary.
"""

import csv
import json
import math
import os
import signal
import subprocess
import sys
import time
import tomllib
from dataclasses import replace
from itertools import product
from pathlib import Path

import pytest

from dilatedem.case import write
from dilatedem.case.load import load
from dilatedem.errors import CaseError, SimulationStopped
from dilatedem.files.lock import Lock
from dilatedem.processes.children import Answer
from dilatedem.results.load import load as load_results
from dilatedem.statistics import mean, quantile
from dilatedem.sweeps import earlier
from dilatedem.sweeps.orders import Order, order_of
from dilatedem.sweeps.plan import plan
from dilatedem.sweeps.sweep import sweep
from tests.regression.folders import without_work

PILE = Path(__file__).parents[3] / "cases" / "pile.toml"
#: columns on all runs of a setting
TOGETHER = [
    f"pile_{load}_{what}{end}_N"
    for load, what, end in product(("fh_max", "along_mean"), ("mean", "p50", "p90"), ("", "_low", "_high"))
]


def simulate(order: Order, tell) -> Answer:
    """Friction tells it how to fare with a case."""
    case, folder = tomllib.loads(order.case), Path(order.out)
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "case.toml").write_text(order.case)
    (folder / "forces.csv").write_text("time_s,structure,fx_N,fy_N,fh_max_N\n0.01,pile,3000,4000,9000\n0.02,pile,0,0,0\n")

    def summarise(status: str) -> None:
        loads = {"pile": {"fx_max_N": case["water"]["velocity"][0] * 1e5, "fx_mean_N": 1e3, "fy_max_N": 2.0, "fy_min_N": -2.0}}
        summary = {"status": status, "steps": 7, "wall_s": 0.5, "loads": loads, "resumed": order.resume, "process": os.getpid()}
        (folder / "summary.json").write_text(json.dumps(summary | {"energy": {"residual_over_work": 1e-4}}))

    def interrupted(*_) -> None:
        (folder / "restart.h5").touch()
        summarise("interrupted")
        sys.exit(130)

    signal.signal(signal.SIGINT, interrupted)
    match case["contact"]["friction"]:
        case 0.3:
            summarise("stopped")
            return Answer(3, "bodies 3 and 7 overlap")
        case 0.4:
            return Answer(1, "Traceback\nZeroDivisionError: a bug")
        case 0.5:
            os.kill(os.getpid(), signal.SIGKILL)
        case 0.6:
            (folder / "started").touch()
            time.sleep(60)
    summarise("completed")
    return Answer(0)


@pytest.fixture
def quick(monkeypatch):
    without_work(monkeypatch, simulate)


def rows(out: Path) -> list[dict[str, str]]:
    with open(out / "sweep.csv", newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def test_grid_of_completed_cases(quick, tmp_path, capsys):
    out = tmp_path / "sweep"
    table = sweep(PILE, vary=["water.velocity.0=0.1:0.3:0.1"], seeds=2, jobs=2, out=out)
    assert table == out / "sweep.csv"
    found = rows(out)
    assert [row["run"] for row in found] == [
        f"water.velocity.0={speed}__seed={seed}" for speed in (0.1, 0.2, 0.3) for seed in (1, 2)
    ]
    assert list(found[0]) == [
        "water.velocity.0", "seed", "run", "status", "steps", "simulated_s", "wall_s", "pile_fx_max_N", "pile_fx_mean_N",
        "pile_fy_max_N", "pile_fy_min_N", "pile_fh_max_N", "pile_along_max_N", "pile_along_mean_N", "pile_across_max_N",
        "pile_across_min_N", "pile_mh_max_Nm", "pile_mz_max_Nm", "pile_mz_min_Nm", "pile_fx_min_N", "pile_fy_mean_N",
        "pile_along_min_N", "pile_across_mean_N", "pile_fh_mean_N", "pile_fh_p5_N", "pile_fh_p50_N", "pile_fh_p90_N",
        "pile_fh_p95_N", "pile_fh_p99_N", "residual_over_work", "runs", *TOGETHER, "message",
    ]
    assert {row["status"] for row in found} == {"completed"}
    last = found[-1]
    assert (last["water.velocity.0"], last["seed"], last["pile_fx_max_N"]) == ("0.3", "2", "30000.0")
    case = load(out / last["run"] / "case.toml")
    assert case == load(PILE, ["water.velocity=[0.3,0]", "field.seed=2"])
    assert "[6/6]" in capsys.readouterr().err


def test_failures_are_rows_and_leave_the_others_alone(quick, tmp_path):
    out = tmp_path / "sweep"
    with pytest.raises(SimulationStopped) as caught:
        sweep(PILE, vary=["contact.friction=0.1,0.3,0.4,0.5"], jobs=2, out=out)
    assert str(caught.value).splitlines() == [
        f"{out}: 3 of 4 cases did not finish:",
        "  contact.friction=0.3: stopped: bodies 3 and 7 overlap",
        "  contact.friction=0.4: failed: ZeroDivisionError: a bug",
        "  contact.friction=0.5: failed: killed by signal 9",
    ]
    assert [(row["status"], row["message"]) for row in rows(out)] == [
        ("completed", ""),
        ("stopped", "bodies 3 and 7 overlap"),
        ("failed", "ZeroDivisionError: a bug"),
        ("failed", "killed by signal 9"),
    ]
    assert "Traceback" in (out / "contact.friction=0.4.log").read_text()


def test_vectors_and_words_vary_too(quick, tmp_path):
    sweep(PILE, vary=["water.velocity=[0.1,0],[0.2,0]", "domain.x_boundary=open,wall"], out=tmp_path / "s")
    found = rows(tmp_path / "s")
    assert [(row["water.velocity"], row["domain.x_boundary"]) for row in found] == [
        ("[0.1, 0]", "open"), ("[0.1, 0]", "wall"), ("[0.2, 0]", "open"), ("[0.2, 0]", "wall")
    ]
    assert found[1]["run"] == "water.velocity=0.1,0__domain.x_boundary=wall"
    assert list(found[0])[:5] == ["water.velocity", "water.velocity.0", "water.velocity.1", "domain.x_boundary", "seed"]
    assert (found[2]["water.velocity.0"], found[2]["water.velocity.1"]) == ("0.2", "0")
    assert load_results(tmp_path / "s").keys == ["water.velocity", "domain.x_boundary"]


def test_everything_is_checked_before_anything_is_written(quick, tmp_path):
    out = tmp_path / "sweep"
    for options, expected in [
        ({}, "nothing varies: give --vary KEY=V1,V2,.. or --seeds N"),
        ({"vary": ["contact.friction=0.1,-0.2"]}, "--vary contact.friction: contact.friction = -0.2: must"),
        ({"vary": ["contact.fricton=1"]}, '--vary contact.fricton: unknown key; did you mean "friction"?'),
        ({"seeds": 2, "overrides": ["ice.density=0"]}, "--set ice.density: ice.density = 0: must be greater"),
        ({"seeds": 2, "scheduler": "tcp://a", "jobs": 2}, "give either --jobs or --scheduler"),
        ({"seeds": 2, "vary": ["field.seed=1,2"]}, "give either --vary field.seed or --seeds, not both"),
        ({"vary": ["title=a/b,a*b"]}, "two cases would share the folder title=a_b"),
    ]:
        with pytest.raises(CaseError) as caught:
            sweep(PILE, out=out, **options)
        assert str(caught.value).startswith(expected)
    with pytest.raises(CaseError) as caught:
        sweep(PILE, vary=["contact.friction=-30:-1:1"], out=out)
    assert str(caught.value).splitlines()[-1] == "... and 10 more"
    assert not out.exists()


def test_the_same_command_again_goes_on_or_has_nothing_to_do(quick, tmp_path, capsys):
    sweep(PILE, vary=["water.velocity.0=0.1,0.2"], out=tmp_path)
    table = (tmp_path / "sweep.csv").read_text()
    second, before = rows(tmp_path)[1], [path.stat().st_mtime_ns for path in sorted(tmp_path.rglob("*/*"))]
    sweep(PILE, vary=["water.velocity.0=0.1,0.2"], out=tmp_path)
    assert "2 cases in" in (said := capsys.readouterr().err) and said.endswith("all of them were completed before: nothing to do\n")
    assert [path.stat().st_mtime_ns for path in sorted(tmp_path.rglob("*/*"))] == before
    (tmp_path / second["run"] / "summary.json").write_text('{"status": "running"}')
    (tmp_path / second["run"] / "restart.h5").touch()
    sweep(PILE, vary=["water.velocity.0=0.1,0.2"], seeds=None, out=tmp_path)
    assert "[1/1] water.velocity.0=0.2: completed" in capsys.readouterr().err
    assert (tmp_path / "sweep.csv").read_text() == table
    with pytest.raises(CaseError, match="is not the case of this sweep: it has another ice.density; choose another --out"):
        sweep(PILE, vary=["water.velocity.0=0.1,0.2"], overrides=["ice.density=900"], out=tmp_path)


def test_more_seeds_go_on_with_fewer(quick, tmp_path):
    sweep(PILE, seeds=1, out=tmp_path)
    sweep(PILE, seeds=3, out=tmp_path)
    assert [row["status"] for row in rows(tmp_path)] == ["completed"] * 3
    with pytest.raises(CaseError, match="holds a sweep already; go on with --resume"):
        sweep(PILE, seeds=2, out=tmp_path)


def test_columns_that_hold_for_any_direction_of_the_current(quick, tmp_path):
    sweep(PILE, seeds=1, out=tmp_path)
    [row] = rows(tmp_path)
    found = {name.removeprefix("pile_"): float(cell) for name, cell in row.items() if name.startswith("pile_fh_") and cell}
    percentiles = {f"fh_p{share}_N": 90.0 * share for share in (5, 50, 90, 95, 99)}  # between 0 and 9000 N
    assert found == pytest.approx({"fh_mean_N": 2500.0, **percentiles})


def test_columns_on_all_runs_of_a_setting(quick, tmp_path, monkeypatch):
    """A row a run; what the seeds say together stands in each row of their setting, and nowhere without other seeds."""

    def simulate_scattered(order: Order, tell) -> Answer:
        answer, case = simulate(order, tell), tomllib.loads(order.case)
        summary = json.loads((path := Path(order.out) / "summary.json").read_text())
        force = 1e3 * case["field"]["seed"] + 1e6 * case["contact"]["friction"]
        summary["loads"]["pile"] |= {"fh_max_N": force, "along_mean_N": 5.0}
        path.write_text(json.dumps(summary))
        return answer

    without_work(monkeypatch, simulate_scattered)
    sweep(PILE, vary=["contact.friction=0.1,0.2"], seeds=8, out=tmp_path)
    table = load_results(tmp_path).table
    for friction, group in table.groupby("contact.friction"):
        assert set(group.runs) == {8} and len(group) == 8
        force = group.pile_fh_max_N.to_numpy()
        for what, band in (("mean", mean(force)), ("p50", quantile(force, 0.5)), ("p90", quantile(force, 0.9))):
            found = [set(group[f"pile_fh_max_{what}{end}_N"].dropna()) for end in ("", "_low", "_high")]
            assert found == [{end} if math.isfinite(end) else set() for end in (band.value, band.low, band.high)], friction
        assert set(group.pile_along_mean_mean_high_N) == {5.0}
    again = (tmp_path / "sweep.csv").read_text()
    (tmp_path / table.run[15] / "summary.json").write_text('{"status": "running"}')
    (tmp_path / table.run[15] / "restart.h5").touch()
    sweep(PILE, vary=["contact.friction=0.1,0.2"], seeds=8, out=tmp_path)  # from the table of before, but for the last run
    assert (tmp_path / "sweep.csv").read_text() == again
    sweep(PILE, vary=["contact.friction=0.1,0.2"], out=tmp_path / "without")
    assert not {"runs", *TOGETHER} & set(rows(tmp_path / "without")[0])


def test_a_folder_with_runs_is_not_overwritten(quick, tmp_path):
    sweep(PILE, vary=["contact.friction=0.1"], out=tmp_path)
    with pytest.raises(CaseError, match="holds a sweep already; go on with --resume"):
        sweep(PILE, vary=["contact.friction=0.2"], out=tmp_path)
    with pytest.raises(CaseError, match="holds a single run"):
        sweep(PILE, seeds=1, out=tmp_path / "contact.friction=0.1")


def test_resume_skips_the_finished_and_goes_on_with_the_others(quick, tmp_path):
    sweep(PILE, vary=["water.velocity.0=0.1,0.2"], out=tmp_path)
    first, second = (tmp_path / row["run"] for row in rows(tmp_path))
    before = (first / "summary.json").stat().st_mtime_ns
    (second / "restart.h5").touch()
    (second / "summary.json").write_text('{"status": "interrupted"}')
    sweep(PILE, vary=["water.velocity.0=0.1,0.2,0.4"], out=tmp_path, resume=True)
    assert (first / "summary.json").stat().st_mtime_ns == before
    assert json.loads((second / "summary.json").read_text())["resumed"] is True
    assert [row["status"] for row in rows(tmp_path)] == ["completed"] * 3
    with pytest.raises(CaseError, match="case.toml: is not the case of this sweep"):
        sweep(PILE, vary=["water.velocity.0=0.1"], overrides=["ice.density=900"], out=tmp_path, resume=True)


def test_order_of_a_case(tmp_path):
    [job] = plan(PILE, vary=["ice.density=900"], out=tmp_path)
    order = Order(write.dump(job.case), str(job.folder), laws=job.case.laws)
    assert order_of(job) == order
    job.folder.mkdir()
    assert order_of(job) == replace(order, overwrite=True)
    (job.folder / "restart.h5").touch()
    assert order_of(job) == replace(order, resume=True)


def test_a_process_runs_one_case_after_another(quick, tmp_path):
    out = tmp_path / "sweep"
    sweep(PILE, seeds=6, jobs=2, out=out)
    assert len({json.loads((out / row["run"] / "summary.json").read_text())["process"] for row in rows(out)}) <= 2


@pytest.mark.parametrize("signal_number", [signal.SIGINT, signal.SIGTERM])
def test_an_interrupt_lets_the_running_cases_save_their_state(tmp_path, signal_number):
    out = tmp_path / "sweep"
    program = (
        "import sys\nsys.path[:0] = [sys.argv.pop(1), sys.argv.pop(1)]\n"
        "import test_sweep, pytest\nfrom dilatedem import cli\n"
        "test_sweep.without_work(pytest.MonkeyPatch(), test_sweep.simulate)\ncli.main()"
    )
    arguments = ["sweep", PILE, "--vary", "contact.friction=0.1,0.6", "--seeds", "2", "--jobs", "3"]
    arguments += ["--out", out]
    places = [str(Path(__file__).parents[depth]) for depth in (0, 3)]
    process = subprocess.Popen(
        [sys.executable, "-c", program, *places, *map(str, arguments)], stderr=subprocess.PIPE, text=True
    )
    sleeping = [out / f"contact.friction=0.6__seed={seed}" for seed in (1, 2)]
    for _ in range(1200):
        asleep = all((folder / "started").exists() for folder in sleeping)
        if asleep and [row["status"] for row in rows(out)].count("completed") == 2:
            break
        time.sleep(0.05)
    process.send_signal(signal_number)
    _, said = process.communicate(timeout=60)
    assert process.returncode == 130, said
    assert "interrupted with 2 of 4 cases completed; --resume goes on" in said
    assert [row["status"] for row in rows(out)] == ["completed"] * 2 + ["interrupted"] * 2
    assert all((folder / "restart.h5").exists() for folder in sleeping)


def test_what_no_sweep_wrote_is_left_alone(quick, tmp_path):
    name = "contact.friction=0.1"
    mine = {"sweep.csv": "mine", f"{name}.log": "mine", f"{name}/energy.csv": "mine"}
    for place, resume in (("sweep.csv", True), ("sweep.csv", False), (f"{name}.log", False), (f"{name}/energy.csv", True)):
        out = tmp_path / f"{place}-{resume}".replace("/", "_")
        (out / place).parent.mkdir(parents=True)
        (out / place).write_text(mine[place])
        with pytest.raises(CaseError, match="stands in the way|holds a sweep already"):
            sweep(PILE, vary=["contact.friction=0.1"], out=out, resume=resume)
        assert [file.relative_to(out) for file in out.rglob("*") if file.is_file()] == [Path(place)]
        assert (out / place).read_text() == "mine"


def test_a_sweep_follows_no_links(quick, tmp_path):
    out, elsewhere = tmp_path / "out", tmp_path / "elsewhere"
    for folder in (out, elsewhere):
        folder.mkdir()
    (out / "contact.friction=0.1").symlink_to(elsewhere)
    with pytest.raises(CaseError, match="is a link"):
        sweep(PILE, vary=["contact.friction=0.1"], out=out, resume=True)
    assert list(elsewhere.iterdir()) == []


def test_a_case_that_still_runs_is_not_started_again(quick, tmp_path, monkeypatch):
    monkeypatch.setattr(earlier, "PATIENCE_S", 0.3)
    sweep(PILE, vary=["contact.friction=0.1,0.2"], out=tmp_path)
    with Lock(tmp_path / "contact.friction=0.2") as held:
        held.keep()
        with pytest.raises(CaseError, match="friction=0.2: another process is at work in it; .* --resume"):
            sweep(PILE, vary=["contact.friction=0.1,0.2"], out=tmp_path, resume=True)
    sweep(PILE, vary=["contact.friction=0.1,0.2"], out=tmp_path, resume=True)

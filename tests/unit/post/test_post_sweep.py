"""sweep.csv and several run folders as one table, and the figures of it."""

import json

import numpy as np
import pytest

from dilatedem.errors import CaseError
from dilatedem.post import info
from dilatedem.post.ensembles.study import study
from dilatedem.post.ensembles.sweeps import axis_value, compare_runs, read_sweep
from dilatedem.post.figures.sweep import places, setting_words, sweep_figure
from dilatedem.post.folders import post_sweep
from dilatedem.post.labels import axis_label, flatten, number, show
from dilatedem.post.read import open_run

LOADS = ("fx_max", "fx_mean", "fy_max", "fy_min", "fh_max")


def write_sweep(folder, *, broken=()):
    """Speed by contact model by two seeds; the highest force along x is 1000 N x speed x model x seed."""
    folder.mkdir()
    loads = ",".join(f"pile_{load}_N" for load in LOADS)
    lines = [f"water.velocity,contact.model,seed,run,status,steps,wall_s,{loads},residual_over_work,message"]
    for speed in (0.5, 0.25, 1.0):
        for factor, model in enumerate(("liu2015", "consistent"), start=1):
            for seed in (1, 2):
                name = f"v{speed}_{model}_{seed}"
                force = 1000.0 * speed * factor * seed
                cells = [force, force / 10.0, force / 4.0, -force / 4.0, 1.1 * force, 1e-4]
                status, message = ("stopped", "bodies 3, 7") if name in broken else ("completed", "")
                velocity = json.dumps(json.dumps([speed, 0.0]))
                numbers = ",".join(map(str, cells))
                row = f'{velocity},{model},{seed},{name},{status},100,2.5,{numbers},"{message}"'
                lines.append(row)
    (folder / "sweep.csv").write_text("\n".join(lines) + "\n")
    return folder


def test_table_is_read_as_written(tmp_path):
    sweep = read_sweep(write_sweep(tmp_path / "sweep"))
    assert sweep.keys == ["water.velocity", "contact.model"]
    assert sweep.structures == ["pile"]
    assert len(sweep.runs) == 12
    first = sweep.runs[0]
    assert first.values == {"water.velocity": [0.5, 0.0], "contact.model": "liu2015"}
    assert (first.seed, first.status, first.completed) == (1, "completed", True)
    assert first.loads["pile"]["fh_max"] == pytest.approx(550.0)


def test_runs_that_differ_in_the_seed_alone_are_one_ensemble(tmp_path):
    found = study(read_sweep(write_sweep(tmp_path / "sweep", broken=("v1.0_consistent_2",))))
    assert list(places(found, "water.velocity").values()) == [0.5, 0.5, 0.25, 0.25, 1.0, 1.0]
    assert list(places(found, "contact.model").values()) == ["liu2015", "consistent"] * 3  # in the order of the table
    assert found.ensembles[2].sample("pile", "horizontal_highest_N") == pytest.approx([275.0, 550.0])
    assert found.ensembles[-1].sample("pile", "horizontal_highest_N") == pytest.approx([2200.0])


def test_figure_shows_mean_and_spread_over_the_seeds(tmp_path):
    drawing = sweep_figure(study(read_sweep(write_sweep(tmp_path / "sweep"))), "pile", "water.velocity")
    axes = drawing.figure.axes[0]
    line = next(line for line in axes.lines if line.get_label() == "contact model liu2015")
    assert line.get_xdata() == pytest.approx([0.25, 0.5, 1.0])
    assert line.get_ydata() == pytest.approx([1.1 * 0.375, 1.1 * 0.75, 1.1 * 1.5])  # horizontal, wherever the current goes
    assert drawing.figure.axes[0].get_ylabel() == "Highest horizontal force (kN)"
    assert drawing.figure.axes[1].get_xlabel() == "Current speed (m/s)"
    assert "for each contact model" in drawing.caption


def test_key_that_takes_one_value_has_no_figure(tmp_path):
    sweep = read_sweep(write_sweep(tmp_path / "sweep"))
    short = study(type(sweep)(sweep.title, sweep.folder, sweep.keys, sweep.runs[:2]))
    assert sweep_figure(short, "pile", "water.velocity") is None
    assert sweep_figure(short, "jetty", "contact.model") is None


def test_report_of_a_sweep(tmp_path):
    folder = write_sweep(tmp_path / "sweep", broken=("v1.0_consistent_2",))
    written = post_sweep(read_sweep(folder))
    page = (folder / "report.html").read_text()
    assert folder / "report.html" in written
    assert "12 runs, 11 of them completed" in page
    assert "bodies 3, 7" in page
    assert page.count("<svg") == 3  # against either key, and a map of both
    assert "12 (11 completed, 1 stopped)" in info(folder)


def test_empty_and_foreign_tables(tmp_path):
    folder = write_sweep(tmp_path / "sweep")
    header = (folder / "sweep.csv").read_text().splitlines()[0]
    (folder / "sweep.csv").write_text(header + "\n")
    assert read_sweep(folder).runs == []
    assert post_sweep(read_sweep(folder))[-1].is_file()
    (folder / "sweep.csv").write_text("a,b\n1,2\n")
    with pytest.raises(CaseError, match="not the table of a sweep"):
        read_sweep(folder)


def test_keys_in_which_cases_differ_are_found(make_run, tmp_path):
    folders = [
        make_run(tmp_path / f"run{index}", floe_size=size, seed=seed, duration=1.0, snapshots=False)
        for index, (size, seed) in enumerate([(2.0, 1), (2.5, 1), (2.5, 2)])
    ]
    sweep = compare_runs([open_run(folder) for folder in folders], tmp_path)
    assert sweep.keys == ["field.floe_size"]
    assert [run.seed for run in sweep.runs] == [1, 1, 2]
    assert all(np.isfinite(run.loads["pile"]["fx_max"]) for run in sweep.runs)


def test_values_on_an_axis():
    assert axis_value("water.velocity", [0.3, -0.4]) == pytest.approx(0.5)
    assert axis_value("field.floe_size", 2) == 2.0
    assert axis_value("water.enabled", False) == "no"
    assert axis_value("domain.size", [50.0, 40.0]) == "50.0, 40.0"
    assert axis_value("field.floe_count", None) is None


def test_words_and_numbers():
    assert axis_label("structure.0.radius") == "Radius (m)"
    assert axis_label("water.velocity.0") == "Current along x (m/s)"
    assert axis_label("some.new_key") == "Some.new_key"
    assert [number(value) for value in (0.0, 12.3456, -0.5, 2.1e11, 1e-5)] == [
        "0", "12.35", "−0.5", "2.1 × 10¹¹", "1 × 10⁻⁵",
    ]  # fmt: skip
    assert show([True, None, 1.5]) == "yes, –, 1.5"
    flat = flatten({"a": {"b": 1, "c": [1, 2]}, "structure": [{"name": "pile"}]})
    assert flat == {"a.b": 1, "a.c": [1, 2], "structure.0.name": "pile"}


def test_a_velocity_that_turns_has_both_components_in_a_title():
    values = {"water.velocity": [0.3, 0.0], "field.floe_size": 2.0}
    both = setting_words(values, list(values), turning=["water.velocity"])
    assert both == "current along x, along y 0.3, 0 m/s, mean floe size 2 m"
    assert setting_words(values, list(values)) == "current speed 0.3 m/s, mean floe size 2 m"

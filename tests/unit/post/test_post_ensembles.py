"""Runs of a sweep as ensembles: equal drift, hits above a fixed threshold, statistics with bands, directions of the current."""

import csv
import json

import numpy as np
import pytest

from dilatedem.errors import CaseError
from dilatedem.post import post
from dilatedem.post.ensembles.laws import extremes
from dilatedem.post.ensembles.part import Part
from dilatedem.post.ensembles.study import Choice, study
from dilatedem.post.ensembles.sweeps import read_sweep
from dilatedem.post.figures.grid import grid_figure
from dilatedem.post.figures.rose import rose_figure
from dilatedem.post.figures.sweep import places
from dilatedem.statistics import mean, quantile


@pytest.fixture(scope="module")
def seeds(make_run, tmp_path_factory):
    """A sweep over eight seeds alone; the load grows with the seed."""
    folder = tmp_path_factory.mktemp("ensembles") / "seeds"
    return write_sweep(folder, make_run, [({}, seed, {"scale": 0.5 + 0.1 * seed}) for seed in range(1, 9)])


def write_sweep(folder, make_run, points):
    """points: values of the keys as cells of sweep.csv, seed, and what the run is made with."""
    folder.mkdir(parents=True)
    keys = list(points[0][0])
    rows = []
    for number, (values, seed, made) in enumerate(points):
        make_run(folder / f"run{number}", seed=seed, snapshots=False, **({"duration": 4.0} | made))
        rows.append([*values.values(), seed, f"run{number}", "completed", 1000.0, ""])
    with open(folder / "sweep.csv", "w", newline="") as file:
        csv.writer(file).writerows([[*keys, "seed", "run", "status", "pile_fh_max_N", "message"], *rows])
    return folder


def read_statistics(folder):
    with open(folder / "statistics.csv", newline="") as file:
        return list(csv.DictReader(file))


def test_seeds_alone_are_one_ensemble_with_statistics_and_bands(seeds):
    post([seeds])
    found = study(read_sweep(seeds))
    assert len(found.ensembles) == 1 and found.part == Part()
    highest = found.ensembles[0].sample("pile", "horizontal_highest_N")
    assert len(highest) == 8
    rows = {(row["quantity"], row["statistic"]): row for row in read_statistics(seeds)}
    assert all(row["structure"] == "pile" for row in rows.values())
    told = rows["horizontal_highest_N", "mean"]
    band = mean(highest)
    assert [float(told[name]) for name in ("n", "value", "low", "high")] == pytest.approx([8, band.value, band.low, band.high])
    told = rows["horizontal_highest_N", "percentile_90"]
    assert float(told["low"]) == pytest.approx(quantile(highest, 0.9).low) and told["high"] == ""  # 8 runs know no upper end
    assert float(rows["horizontal_highest_N", "gumbel_level_10_runs"]["value"]) > band.value
    page = (seeds / "report.html").read_text()
    assert "8 runs that differ in the seed alone, 8 of them completed" in page
    assert "Highest horizontal force" in page and "generalized Pareto" in page
    assert page.count("<svg") == 1 and (seeds / "figures/extremes_pile.png").is_file()


def test_a_part_is_looked_at_alone(seeds):
    """The current is 0.3 m/s: 0.6 to 0.9 m are drifted from 2 to 3 s."""
    part = study(read_sweep(seeds), Choice(part=Part(0.6, 0.9, "m")))
    member = part.ensembles[0].members[0]
    rows = np.genfromtxt(member.run.folder / "forces.csv", delimiter=",", names=True, dtype=None, encoding="utf-8")
    inside = (rows["time_s"] > 2.005) & (rows["time_s"] < 3.005)
    assert inside.sum() == 100
    measures = member.loads["pile"].measures
    assert measures["horizontal_highest_N"] == rows["fh_max_N"][inside].max()
    assert measures["along_mean_N"] == pytest.approx(rows["fx_N"][inside].mean())


def test_runs_that_end_before_the_part_are_left_out(make_run, tmp_path):
    points = [({}, 1, {"duration": 4.0}), ({}, 2, {"duration": 2.0})]
    folder = write_sweep(tmp_path / "sweep", make_run, points)
    found = study(read_sweep(folder), Choice(part=Part(0.0, 1.0, "m")))
    assert found.left_out == ("run1",) and len(found.ensembles[0].members) == 1
    with pytest.raises(CaseError, match="none of its runs reaches"):
        study(read_sweep(folder), Choice(part=Part(0.0, 50.0, "m")))


def test_speeds_are_compared_at_equal_drift(make_run, tmp_path):
    """0.2 and 0.4 m/s for 4 s: over the 0.8 m that both drift, 4 s of one and 2 s of the other."""
    points = [({"water.velocity": json.dumps([speed, 0.0])}, 1, {"current": (speed, 0.0)}) for speed in (0.2, 0.4)]
    found = study(read_sweep(write_sweep(tmp_path / "sweep", make_run, points)))
    assert found.equalized and (found.part.start, found.part.end, found.part.unit) == (0.0, pytest.approx(0.8), "m")
    assert found.ensembles[1].members[0].loads["pile"].end.max() <= 2.0 + 1e-9
    assert list(places(found, "water.velocity").values()) == [0.2, 0.4]


def test_threshold_and_gap_are_those_asked_for(seeds):
    asked = study(read_sweep(seeds), Choice(threshold=2e4, gap=0.05))
    ensemble = asked.ensembles[0]
    peaks = np.concatenate(asked.peaks(ensemble, "pile"))
    assert peaks.min() >= 2e4
    assert ensemble.sample("pile", "hits").sum() == len(peaks)
    assert len(peaks) > len(np.concatenate(study(read_sweep(seeds), Choice(threshold=2e4, gap=2.0)).peaks(ensemble, "pile")))
    law = extremes(asked, ensemble, "pile")
    assert law.threshold == 2e4 and law.pareto.threshold == 2e4 and len(law.pareto.peaks) == len(peaks)


def test_loads_of_every_direction(make_run, tmp_path):
    """The made-up ice pushes along +x whatever the current: along a current of -x that is a force against it."""
    currents = {"[0.3, 0.0]": (0.3, 0.0), "[0.0, 0.3]": (0.0, 0.3), "[-0.3, 0.0]": (-0.3, 0.0)}
    points = [({"water.velocity": text}, seed, {"current": current}) for text, current in currents.items() for seed in (1, 2)]
    found = study(read_sweep(write_sweep(tmp_path / "sweep", make_run, points)))
    along = [ensemble.sample("pile", "along_mean_N").mean() for ensemble in found.ensembles]
    assert along[2] == pytest.approx(-along[0]) and along[0] > 0.0
    across = [ensemble.sample("pile", "across_mean_N").mean() for ensemble in found.ensembles]
    assert along[1] == pytest.approx(across[0]) and across[1] == pytest.approx(-along[0])  # a quarter turn
    highest = [ensemble.sample("pile", "horizontal_highest_N").mean() for ensemble in found.ensembles]
    assert highest == pytest.approx([highest[0]] * 3)
    assert list(places(found, "water.velocity").values()) == ["0.3, 0", "0, 0.3", "−0.3, 0"]
    marks = [line for line in rose_figure(found, "pile").figure.axes[0].lines if line.get_markersize() == 6.0]
    assert marks[0].get_xdata() == pytest.approx([0.0, np.pi / 2, np.pi])
    assert marks[0].get_ydata() == pytest.approx(np.array(highest) / 1e3)


def test_two_keys_make_a_map(make_run, tmp_path):
    points = [
        ({"field.floe_size": size, "contact.friction": friction}, 1, {"scale": size * friction, "duration": 2.0})
        for size in (3.0, 2.0)
        for friction in (0.1, 0.3)
    ]
    found = study(read_sweep(write_sweep(tmp_path / "sweep", make_run, points)))
    cells = np.asarray(grid_figure(found, "pile").figure.axes[0].images[0].get_array())
    assert cells.shape == (2, 2)
    assert cells / cells[0, 0] == pytest.approx(np.array([[1.0, 1.5], [3.0, 4.5]]))  # friction upwards, sizes ascend to the right


def test_a_single_run_takes_no_part(make_run, tmp_path):
    make_run(tmp_path / "run", duration=1.0, snapshots=False)
    with pytest.raises(CaseError, match="for sweeps"):
        post([tmp_path / "run"], end="0.2m")
    with pytest.raises(CaseError, match="--gap nan: must be"):
        post([tmp_path / "run"], gap=float("nan"))


def test_a_foreign_table_is_left_alone(make_run, tmp_path):
    folder = write_sweep(tmp_path / "sweep", make_run, [({}, 1, {"duration": 1.0})])
    (folder / "statistics.csv").write_text("mine\n1\n")
    with pytest.raises(CaseError, match="stands in the way"):
        post([folder])
    assert (folder / "statistics.csv").read_text() == "mine\n1\n" and not (folder / "report.html").exists()


def test_a_run_whose_structure_no_ice_touched_says_so(make_run, tmp_path):
    folder = write_sweep(tmp_path / "calm", make_run, [({}, seed, {"scale": scale}) for seed, scale in ((1, 1.0), (2, 0.0))])
    table = (folder / "sweep.csv").read_text().replace("run1,completed,1000.0", "run1,completed,0.0")
    (folder / "sweep.csv").write_text(table)
    post([folder])
    assert (folder / "report.html").read_text().count("no ice touched pile, which counts as no load") == 1


def test_a_percentile_that_few_runs_cannot_tell_is_not_their_largest(make_run, tmp_path):
    folder = write_sweep(tmp_path / "sweep", make_run, [({}, seed, {"scale": 0.1 * seed, "duration": 1.0}) for seed in range(1, 6)])
    post([folder])
    highest = study(read_sweep(folder)).ensembles[0].sample("pile", "horizontal_highest_N")
    rows = {row["statistic"]: row for row in read_statistics(folder) if row["quantity"] == "horizontal_highest_N"}
    assert rows["percentile_90"]["value"] == "" and rows["percentile_90"]["n"] == "5"
    assert float(rows["percentile_90"]["low"]) == pytest.approx(quantile(highest, 0.9).low, rel=1e-6)
    page = (folder / "report.html").read_text()
    assert f"over {quantile(highest, 0.9).low / 1e3:.3g}" in page and "told from 7 runs on" in page

"""Runs cut into blocks: which windows are in which, laws of blocks of a history that is known, and what a report says of them."""

import csv
import math

import numpy as np
import pytest
from scipy import stats

from dilatedem.errors import CaseError
from dilatedem.post import post
from dilatedem.post.ensembles.blocks import Blocks, at_windows, longest, read_block
from dilatedem.post.ensembles.laws import extremes
from dilatedem.post.ensembles.measures import HIGHEST, loads_of
from dilatedem.post.ensembles.part import Part
from dilatedem.post.ensembles.study import Choice, Ensemble, Member, study
from dilatedem.post.ensembles.sweeps import read_sweep, run_alone
from dilatedem.post.read import open_run
from dilatedem.statistics import fit_gumbel

#: windows of a made-up history: length [s], how many to a block, how many blocks
WINDOW, TO_A_BLOCK, COUNT = 0.1, 25, 20
#: Gumbel's law of the highest load of a block [N]
LOCATION, SCALE = 5e4, 1.2e4
ENSEMBLES = 400


def history(random, blocks=COUNT):
    """Windows whose highest loads are independent, of Gumbel's law ln(TO_A_BLOCK) scales lower than that of a block."""
    count = blocks * TO_A_BLOCK
    force = random.gumbel(LOCATION - SCALE * math.log(TO_A_BLOCK), SCALE, count)
    return {"time_s": WINDOW * np.arange(1, count + 1), "fh_max_N": force, "fx_N": force, "fy_N": np.zeros(count)}


def maxima(table, edges):
    places = at_windows(edges, table["time_s"])
    pieces = [loads_of(table, (1.0, 0.0), (a, b), 1e3, 1.0) for a, b in zip(places, places[1:], strict=False)]
    return np.array([piece.measures[HIGHEST] for piece in pieces])


@pytest.mark.parametrize("level", [10, 100])
def test_bands_of_levels_hold_in_95_percent_of_histories(level):
    random, true = np.random.default_rng(7), float(stats.gumbel_r(LOCATION, SCALE).ppf(1.0 - 1.0 / level))
    edges = Blocks(TO_A_BLOCK * WINDOW, "s").edges({}, (0.0, COUNT * TO_A_BLOCK * WINDOW), COUNT * TO_A_BLOCK * WINDOW)
    bands = [fit_gumbel(maxima(history(random), edges)).level(level) for _ in range(ENSEMBLES)]
    held = np.mean([band.low <= true <= band.high for band in bands])
    assert held == pytest.approx(0.95, abs=3.0 * math.sqrt(0.95 * 0.05 / ENSEMBLES))


def test_no_window_is_lost_or_counted_twice():
    """Blocks of 0.73 s and windows of 0.1 s: a window belongs to the block that it ends in, and what is left at the end to none."""
    table = history(np.random.default_rng(1))
    edges = Blocks(0.73, "s").edges({}, (0.2, 50.0), 50.0)
    assert edges == pytest.approx(0.2 + 0.73 * np.arange(69))
    time, force = table["time_s"], table["fh_max_N"]
    expected = [force[(time > a + 1e-6) & (time <= b + 1e-6)].max() for a, b in zip(edges, edges[1:], strict=False)]
    assert maxima(table, edges) == pytest.approx(expected)


def test_blocks_of_drift_follow_the_current():
    """0.2 m/s that grows to 0.6 m/s over 100 s: 40 m; the drift is 0.2 t + 0.002 t^2."""
    case = {"water": {"velocity_table": [[0.0, 0.2, 0.0], [100.0, 0.6, 0.0]]}}
    edges = Blocks(4.0, "m").edges(case, (0.0, 100.0), 100.0)
    assert 0.2 * edges + 0.002 * edges**2 == pytest.approx(4.0 * np.arange(11), abs=1e-3)
    later = Blocks(4.0, "m").edges(case, (50.0, 100.0), 100.0)
    assert later[0] == 50.0 and len(later) == 7  # 25 of 40 m are left


def test_blocks_as_typed():
    assert read_block(None) is None and read_block("600s") == Blocks(600.0, "s") and read_block(" 180 m") == Blocks(180.0, "m")
    for text in ("600", "0s", "-5m", "10 km"):
        with pytest.raises(CaseError, match=f"--block {text}: must be a time in seconds or a drift in metres"):
            read_block(text)


def test_too_few_blocks_are_refused_with_the_longest_that_would_do(make_run, tmp_path):
    run = make_run(tmp_path / "run", duration=4.0, snapshots=False)
    assert longest([4.0]) == pytest.approx(0.4) and longest([4.0, 2.0]) == pytest.approx(0.571) and longest([0.0]) == 0.0
    for block, mend in (("0.5s", "has 8 of them (whole runs); it takes 10: choose blocks of 0.4 s or less"),
                        ("60s", "has 0 of them"), ("0.5m", "has 2 of them")):  # fmt: skip
        with pytest.raises(CaseError) as caught:
            post([run], block=block)
        assert str(caught.value).startswith(f"--block {block}: {run} ") and mend in str(caught.value)
    with pytest.raises(CaseError, match=r"has 5 of them \(time from 2 s on\); it takes 10: choose blocks of 0.2 s or less"):
        post([run], block="0.4s", start="2s")
    still = make_run(tmp_path / "still", duration=4.0, snapshots=False, current=(0.0, 0.0))
    with pytest.raises(CaseError, match="the ice does not drift; choose a time"):
        post([still], block="0.1m")
    assert not (run / "report.html").exists() and not (run / "statistics.csv").exists()


def test_a_long_run_alone_has_laws_of_its_blocks(make_run, tmp_path):
    run = make_run(tmp_path / "run", duration=10.0, snapshots=False, status="interrupted")
    written = [path.name for path in post([run], block="0.4s", start="1s")]
    assert {"statistics.csv", "extremes_pile.png", "force_pile.png", "report.html"} <= set(written)
    with open(run / "statistics.csv", newline="") as file:
        rows = {(row["quantity"], row["statistic"]): row for row in csv.DictReader(file)}
    force = np.genfromtxt(run / "forces.csv", delimiter=",", names=True, dtype=None, encoding="utf-8")
    highest = [force["fh_max_N"][100 + 40 * k : 140 + 40 * k].max() for k in range(22)]
    mean = rows[HIGHEST, "mean"]
    assert mean["n"] == "22" and float(mean["value"]) == pytest.approx(np.mean(highest))
    assert float(rows[HIGHEST, "gumbel_level_10_blocks"]["value"]) == pytest.approx(fit_gumbel(highest).level(10).value)
    assert "neighbour_correlation" in {statistic for _, statistic in rows}
    page = (run / "report.html").read_text()
    assert "time from 1 s on, in blocks of 0.4 s" in page and "one block of so many" in page and "22 blocks" in page
    assert page.count("Neighbouring blocks correlate by") == 2  # beside the table, and under the figure
    post([run])
    assert "Blocks of the run" not in (run / "report.html").read_text()


def test_runs_of_a_sweep_are_cut_one_after_another(make_run, tmp_path):
    for seed in (1, 2):
        make_run(tmp_path / f"run{seed}", seed=seed, duration=4.0, snapshots=False)
    (tmp_path / "sweep.csv").write_text("seed,run,status,pile_fh_max_N\n1,run1,completed,1\n2,run2,completed,1\n")
    found = study(read_sweep(tmp_path), Choice(blocks=Blocks(0.5, "s")))
    [ensemble] = found.ensembles
    assert [member.run.seed for member in ensemble.members] == [1] * 8 + [2] * 8 and found.noun == "block"
    first, second = ensemble.neighbours("pile", HIGHEST)
    assert len(first) == len(second) == 14 and first[1] == second[0] and first[7] != second[6]  # none across runs
    assert found.looked_at == "whole runs, in blocks of 0.5 s"
    post([tmp_path], block="0.5s")
    assert "Statistics over the blocks" in (tmp_path / "report.html").read_text()


def test_blocks_that_depend_on_each_other_are_told():
    """Neighbours of a slow wave are alike; those of independent loads are not."""
    def found(force):
        run = object()
        members = [Member(run, (1.0, 0.0), {"pile": loads}) for loads in map(loads_with, force)]
        return extremes(FewWindows(), Ensemble({}, members), "pile")

    random = np.random.default_rng(3)
    assert found(2.0 + np.sin(np.arange(40) / 4.0) + 0.1 * random.normal(size=40)).depend
    alone = found(random.gumbel(10.0, 2.0, 40))
    assert not alone.depend and abs(alone.neighbours[0]) < alone.neighbours[1] == pytest.approx(1.96 / math.sqrt(39))


def loads_with(force):
    table = {"time_s": np.array([1.0]), "fh_max_N": np.array([force]), "fx_N": np.array([force]), "fy_N": np.zeros(1)}
    return loads_of(table, (1.0, 0.0), (0.0, 1.0), 0.0, 1.0)


class FewWindows:
    """Stands for a study in which no threshold is asked for."""

    threshold, fixed = 0.0, False

    def peaks(self, ensemble, structure, threshold=None):
        return [loads.force for loads in ensemble.on(structure)]


def test_a_part_of_a_run_is_cut(make_run, tmp_path):
    run = open_run(make_run(tmp_path / "run", duration=4.0, snapshots=False))
    found = study(run_alone(run), Choice(part=Part(1.0, 3.0, "s"), blocks=Blocks(0.06, "m")))  # 0.2 s each
    assert len(found.ensembles[0].members) == 10
    assert found.looked_at == "time from 1 to 3 s, in blocks of 0.06 m of drift"


def test_blocks_without_a_load_are_told(make_run, tmp_path):
    """The made-up ice comes at a third of the time: blocks before that bear nothing, and have no GEV."""
    run = make_run(tmp_path / "run", duration=10.0, snapshots=False)
    force = np.genfromtxt(run / "forces.csv", delimiter=",", names=True, dtype=None, encoding="utf-8")["fh_max_N"]
    idle = sum(not force[25 * k : 25 * k + 25].any() for k in range(40))
    assert idle > 14
    post([run], block="0.25s")
    assert (run / "report.html").read_text().count(f"{idle} of the blocks bore no load") == 2
    assert "gev_" not in (run / "statistics.csv").read_text()

"""What the comparison with Liu, Long & Ji (2015) says of its runs: bands, Gumbel's law, tests, likeness of speeds, one state."""

from __future__ import annotations

import math
from types import SimpleNamespace

import numpy as np
import pytest
from scipy import stats

from validation.liu2015 import page, runner, statistics, trends
from validation.liu2015.measures import Ensemble
from validation.liu2015.plan import MODELS, SPEEDS, Run, plan
from validation.liu2015.similarity import likeness

#: (fields,) a load of each field
FIELDS = np.exp(0.3 * np.random.default_rng(5).standard_normal(10))


def results(measures_of, seeds=10, sources="a"):
    """A result a run of the plan, as far as tables need it. measures_of(run): its measures."""
    return [
        SimpleNamespace(run=run, sources=sources, measures=measures_of(run), folder=SimpleNamespace(summary={}))
        for run in plan(seeds=seeds)
    ]


def similar(law):
    """An ensemble whose highest forces are law(v) times a load of the field, and whose mean forces grow with v^2."""

    def measures(run):
        load = FIELDS[run.seed - 1] * (1.0 if run.model == "liu2015" else 2.0)
        return {
            "fh_max_equal_drift_N": load * law(run.speed),
            "fx_mean_equal_drift_N": load * run.speed**2,
            "fh_max_equal_drift_at_m": 3.0 + 0.1 * run.seed,
        }

    return Ensemble(results(measures))


@pytest.mark.parametrize("values", [[0.97] * 2 + [1.0] * 8, [0.0] * 9 + [0.0067], [0.02, 0.9, 0.01, 0.03, 0.02, 0.01]])
def test_bands_do_not_leave_the_range_of_shares_and_ratios(values):
    band = statistics.band(values)
    assert 0.0 <= min(values) <= band.low < band.value < band.high <= max(values) <= 1.0


def test_bands_hold_the_mean_as_often_as_they_say():
    samples = np.random.default_rng(3).standard_normal((300, 10))
    bands = [statistics.band(sample) for sample in samples]
    held = np.mean([band.low <= 0.0 <= band.high for band in bands])
    assert held == pytest.approx(statistics.CONFIDENCE, abs=0.03)


def test_gumbels_law_is_scipys():
    samples = stats.gumbel_r.rvs(100.0, 30.0, size=(5, 10), random_state=2)
    location, scale = statistics.fit_rows(samples)
    for row, values in enumerate(samples):
        assert (location[row], scale[row]) == pytest.approx(stats.gumbel_r.fit(values), rel=1e-4)
    law = statistics.gumbel(samples[0])
    assert law.quantile.value == pytest.approx(stats.gumbel_r.ppf(0.9, location[0], scale[0]))
    assert law.location.low < law.location.value < law.location.high
    assert 0.0 < law.scale.low < law.scale.high


def test_gumbels_law_of_many_fields_is_what_they_were_drawn_from():
    law = statistics.gumbel(stats.gumbel_r.rvs(100.0, 30.0, size=300, random_state=4))
    assert law.location.low < 100.0 < law.location.high
    assert law.scale.low < 30.0 < law.scale.high
    assert law.correlation > 0.99


@pytest.mark.parametrize("count", [5, 7])
def test_few_fields_get_no_band_of_their_scatter(count):
    """The scale of five equal values is 0, and one resample of 625 is such."""
    law = statistics.gumbel(FIELDS[:count])
    assert math.isfinite(law.scale.value) and math.isnan(law.scale.low)
    few = Ensemble([result for result in similar(lambda v: v**1.2).results if result.run.seed <= count])
    like = likeness(few, "liu2015")
    assert math.isnan(like.correlation.low) and like.exponent.low <= 1.2 + 1e-9 <= like.exponent.high + 2e-9


def test_holms_correction_by_hand():
    assert statistics.holm([0.01, 0.04, 0.03]) == pytest.approx([0.03, 0.06, 0.06])
    assert statistics.holm([0.9, 0.6]) == [1.0, 1.0]


def test_statements_that_must_all_hold_are_as_good_as_the_weakest():
    weak, strong = statistics.Test(10, 6, True, 0.4), statistics.Test(10, 10, True, 0.002)
    against = statistics.Test(10, 1, False, 0.01)
    assert statistics.together([strong, weak]) is weak
    assert statistics.together([strong, against]) == statistics.Test(10, 1, False, 0.02)


def test_signed_ranks_look_at_both_sides():
    up = statistics.signed_ranks(np.linspace(0.1, 1.0, 10), above=True)
    down = statistics.signed_ranks(np.linspace(0.1, 1.0, 10), above=False)
    assert (up.towards, up.count, up.p) == (True, 10, pytest.approx(2.0**-9))
    assert (down.towards, down.count, down.p) == (False, 0, pytest.approx(2.0**-9))


@pytest.mark.parametrize("model", MODELS)
def test_fields_that_are_copies_are_found_to_be(model):
    like = likeness(similar(lambda v: v**1.2), model)
    assert like.exponent.value == pytest.approx(1.2)
    assert like.mean_exponent.value == pytest.approx(2.0)
    assert like.correlation.value == pytest.approx(1.0)
    assert like.change.value == pytest.approx(0.0, abs=1e-12)
    assert (like.left, like.same, like.fields) == (pytest.approx(0.0, abs=1e-9), 10, 10)


def test_a_break_would_show_as_a_change_of_the_exponent():
    like = likeness(similar(lambda v: v if v < 0.7 else v**2 / 0.7), "liu2015")
    assert like.change.value == pytest.approx(1.0)


def test_what_follows_from_the_set_up_is_no_test():
    judged = trends.verdicts(full(10))
    setup = [verdict for verdict in judged if verdict.word == trends.SETUP]
    assert {verdict.finding.trend[:10] for verdict in setup} == {"The highes", "It grows f"}
    assert all(math.isnan(verdict.p) for verdict in setup)


def full(seeds):
    """An ensemble in which the small floes are softer and steadier and load the flanks, and the jam is steadier than before."""

    def measures(run):
        load = FIELDS[run.seed - 1] * (1.0 if run.size == "2.8" else 0.1)
        return {
            "fh_max_equal_drift_N": load * run.speed**1.2,
            "fx_mean_equal_drift_N": load * run.speed**2,
            "fh_max_equal_drift_at_m": 3.0,
            "fh_max_first_hits_N": load,
            "fluctuation_first_hits_N": load,
            "fluctuation_jam_over_before": 0.5 * load,
            "peak_over_mean": 100.0 * load,
            "upstream_45_deg_share": 0.8 if run.size == "2.8" else 0.3 * math.exp(-load),
        }

    return Ensemble(results(measures, seeds))


def words(ensemble, part):
    return {verdict.word for verdict in trends.verdicts(ensemble) if part in verdict.finding.trend}


def test_verdicts_need_enough_fields_and_the_right_side():
    assert words(full(10), "more steadily") == {trends.AGREES}
    assert words(full(10), "fluctuate more") == {trends.DISAGREES}
    assert words(full(10), "upstream arc") == {trends.DISAGREES}  # one size of two is enough to contradict
    assert words(full(3), "more steadily") == {trends.OPEN}


def test_what_is_not_tested_costs_the_others_nothing():
    both = full(10)
    alone = Ensemble([result for result in both.results if result.run.model == "liu2015" or result.run.seed < 3])
    of_both, of_one = ([v.p for v in trends.verdicts(e) if "steadily" in v.finding.trend] for e in (both, alone))
    assert of_one[0] == pytest.approx(0.5 * of_both[0], rel=1e-6) and math.isnan(of_one[1])


def test_runs_of_different_sources_are_not_compared(tmp_path):
    (tmp_path / "README.md").write_text("as it was", encoding="utf-8")
    mixed = results(lambda run: {}, 1, "a") + results(lambda run: {}, 1, "b")
    with pytest.raises(ValueError, match="14 with a, 14 with b"):
        page.write(Ensemble(mixed), tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["README.md"]
    assert (tmp_path / "README.md").read_text(encoding="utf-8") == "as it was"


def test_new_runs_are_not_put_beside_those_of_other_sources(tmp_path, monkeypatch):
    monkeypatch.setattr(runner, "source_digest", lambda: "new")
    monkeypatch.setattr(runner.Runner, "_refuse_foreign", lambda self, runs: None)
    runs = plan(seeds=1)
    folder = runs[0].folder(tmp_path)
    folder.mkdir(parents=True)
    (folder / "summary.json").write_text('{"status": "completed"}', encoding="utf-8")
    (folder / runner.SOURCES).write_text("old\n", encoding="utf-8")
    with pytest.raises(ValueError, match="1 runs were made with other sources .old. than these .new."):
        runner.Runner(tmp_path, jobs=1, limit=0.0, renew=False).work(runs)
    (folder / runner.SOURCES).write_text("new\n", encoding="utf-8")
    runner.Runner(tmp_path, jobs=1, limit=0.0, renew=False)._refuse_mixture(runs, "new")


def test_a_plan_cut_short_holds_whole_seeds():
    runs = plan()
    points = len(MODELS) * (len(SPEEDS) + 1)
    assert len(runs) == 10 * points == len(set(runs))
    for seed in range(1, 11):
        assert {run.seed for run in runs[(seed - 1) * points : seed * points]} == {seed}
    assert runs[0] == Run("liu2015", "2.8", 0.3, 1)

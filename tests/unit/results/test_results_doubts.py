"""What is said of a run whose energies make its loads doubtful: by `run`, `info`, `post` and the report."""

import itertools
import json
import math

import pytest
from typer.testing import CliRunner

from dilatedem.case.schema import Case
from dilatedem.cli import app
from dilatedem.post import info
from dilatedem.results.doubts import doubts
from dilatedem.results.load import load
from dilatedem.run import loop

WORDS = "the contact laws themselves made"


def summary_of(gain=0.0, damping=0.0, friction=0.0, residual=0.0, turned_over=1000.0, model="liu2015"):
    energy = {"gain_law_J": gain, "loss_damping_J": damping, "loss_friction_J": friction, "residual_J": residual}
    energy |= {"turned_over_J": turned_over, "residual_over_turned_over": residual / turned_over}
    return {"energy": energy, "contact": {"model": model}}


@pytest.fixture(scope="module")
def dropped(tmp_path_factory):
    """A cube that falls on a plane and rocks there, which the paper's laws feed."""
    corners = [list(corner) for corner in itertools.product((-0.3, 0.3), repeat=3)]
    case = Case.model_validate({
        "field": {"source": "bodies"}, "water": {"enabled": False}, "contact": {"friction": 0.5},
        "structure": [{"kind": "plane", "point": [0.0, 0.0, 0.0], "normal": [0.0, 0.0, 1.0]}],
        "body": [{"vertices": corners, "dilated_radius": 0.02, "position": [0.0, 0.0, 0.5], "rotation": [0.1, 0.2, 0.0]}],
        "time": {"duration": 1.0}, "output": {"snapshot_interval": 0},
    })  # fmt: skip
    return loop.run(case, tmp_path_factory.mktemp("doubts") / "run", quiet=True)


@pytest.mark.parametrize(("gain", "word"), [(10.1, "made"), (-10.1, "took")])
def test_laws_that_make_or_take_more_than_a_tenth_of_the_losses_are_told(gain, word):
    [sentence] = doubts(summary_of(gain, damping=60.0, friction=40.0))
    assert f"{word} 10.1 J (gain_law), 10 % of the 100 J lost" in sentence
    assert 'contact.model = "consistent"' in sentence and "time.step_fraction" in sentence
    assert doubts(summary_of(0.98 * gain, damping=60.0, friction=40.0)) == []


def test_laws_that_make_next_to_nothing_are_not_told_where_nothing_is_lost():
    assert doubts(summary_of(gain=0.5)) == []
    [sentence] = doubts(summary_of(gain=1.5))
    assert "lost" not in sentence


@pytest.mark.parametrize("model", ["liu2015", "consistent"])
def test_a_residual_beyond_a_thousandth_of_the_energy_turned_over_is_told(model):
    [sentence] = doubts(summary_of(residual=1.1, model=model))
    assert "1.1 J unexplained, 0.11 % of the 1 kJ turned over" in sentence and "time.step_fraction" in sentence
    assert ("consistent" in sentence) == (model == "liu2015")
    assert doubts(summary_of(residual=0.9, model=model)) == []


def test_the_error_of_the_steps_of_a_body_that_spins_freely_is_not_told():
    summary = summary_of(residual=23.0, turned_over=11.5)
    assert len(doubts(summary)) == 1
    summary["energy"]["kinetic_J"] = 1e8
    assert doubts(summary) == []


@pytest.mark.parametrize("summary", [{}, {"energy": None}, {"energy": {"residual_over_turned_over": None, "gain_law_J": None}}])
def test_what_a_summary_does_not_hold_is_not_doubted(summary):
    assert doubts(summary) == []


def test_a_cube_that_the_laws_feed_is_told_wherever_its_run_is_looked_at(dropped):
    summary = json.loads((dropped / "summary.json").read_text())
    energy = summary["energy"]
    assert energy["gain_law_J"] > 0.1 * (energy["loss_damping_J"] + energy["loss_friction_J"]) > 0.0
    [sentence] = doubts(summary)
    assert sentence.startswith(WORDS)
    assert f"caution     {sentence}" in info(dropped)
    made = CliRunner().invoke(app, ["post", str(dropped)])
    assert made.exit_code == 0 and made.stdout.splitlines()[1:] == [f"caution: {sentence}"]
    page = (dropped / "report.html").read_text(encoding="utf-8")
    assert WORDS in page[: page.index('id="loads"')]  # before the loads that it makes doubtful
    assert json.loads((dropped / "summary.json").read_text())["post"]["doubts"] == [sentence]
    assert load(dropped).doubts == [sentence]


def test_the_last_line_of_a_run_tells_it(dropped, tmp_path):
    coarse = ["--set", "time.step_fraction=0.4", "--out", str(tmp_path / "run")]
    made = CliRunner().invoke(app, ["run", str(dropped / "case.toml"), *coarse])
    assert made.exit_code == 0
    laws, residual = made.stdout.splitlines()[-2:]
    assert laws.startswith(f"caution: {WORDS}") and residual.startswith("caution: the energy ledger leaves")


def test_info_tells_the_residual_where_loads_did_no_work(dropped):
    share = json.loads((dropped / "summary.json").read_text())["energy"]["residual_over_turned_over"]
    assert 0.0 < share < 1e-3 and math.isfinite(share)
    assert "of the energy turned over" in info(dropped)

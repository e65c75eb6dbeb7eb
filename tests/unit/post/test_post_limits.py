"""What a report says a run cannot tell, with the figures of that run."""

from dataclasses import replace

import numpy as np
import pytest

from dilatedem.post.read import open_run
from dilatedem.post.report.checks import FINE, LOOK, UNKNOWN, checks, verdict_words
from dilatedem.post.report.limits import drag_words, length_of, limits, neighbour_words, pressure_words, waiting_words


@pytest.fixture(scope="module")
def run(make_run, tmp_path_factory):
    return open_run(make_run(tmp_path_factory.mktemp("limits") / "run", duration=2.0, snapshots=False))


def events(*pressures):
    """Load events with these mean nominal pressures [Pa]."""
    return {"pile": {"pressure_Pa": np.array(pressures), "crushed_m": np.array([0.0, 0.004, 0.0][: len(pressures)])}}


def crushing(run):
    return replace(run, case=run.case | {"ice": run.case["ice"] | {"crushing_pressure": 2e6}})


def about(run, what):
    return next(limit.text for limit in limits(run) if limit.about == what)


def test_long_floes_are_counted(run):
    """1.5 sqrt(sigma h/(rho g)) is 7.9 m for 0.5 m of ice; none of these floes is as long as that."""
    assert "none is longer than 7.92 m" in about(run, "Ice that breaks")
    long = np.array([[0.0, 0.0], [9.0, 0.0], [9.0, 2.0], [0.0, 2.0]])
    floes = replace(run.floes, outlines=[*run.floes.outlines, long])
    assert "1 is longer than 7.92 m" in about(replace(run, floes=floes), "Ice that breaks")
    assert length_of(long) == pytest.approx(np.hypot(9.0, 2.0))


def test_pressures_are_told_with_and_without_crushing(run):
    told = pressure_words(replace(run, hits=events(0.5e6, 1.5e6, 6e6)))
    assert "2 above 1 MPa, 1 above 2 MPa, 1 above 5 MPa, the highest 6 MPa" in told and "no design loads" in told
    told = pressure_words(replace(crushing(run), hits=events(0.5e6, 2e6)))
    assert "at 2 MPa on the nominal area" in told and "4 mm" in told and "no design" not in told


def test_drag_is_compared_with_skin_and_form_on_these_floes(run):
    """One floe of 2 m by 2 m: C (A + P d) over C_s A + C_f d P/pi."""
    square = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]])
    floes = replace(run.floes, outlines=[square], plan_area=np.array([4.0]))
    draft = 0.5 * 915.0 / 1025.0
    ratio = 0.6 * (4.0 + 8.0 * draft) / (0.004 * 4.0 + 0.8 * draft * 8.0 / np.pi)
    assert f"{ratio:.1f} times" in drag_words(replace(run, floes=floes))
    other = run.case | {"water": run.case["water"] | {"drag": "skin_form"}}
    assert drag_words(replace(run, case=other)) == ""


def test_neighbours_across_periodic_sides_are_told(run):
    """A pile 3 m wide in 16 m that repeat themselves, whichever way the current goes; two in line block once."""
    assert "every 16 m" in neighbour_words(run) and "block 19 %" in neighbour_words(run)
    back = run.case | {"water": run.case["water"] | {"velocity": [-0.3, 0.0]}}
    assert neighbour_words(replace(run, case=back)) == neighbour_words(run)
    behind = run.outlines | {"other": replace(run.outlines["pile"], outline=run.outlines["pile"].outline + [5.0, 0.0])}
    assert neighbour_words(replace(run, outlines=behind)) == neighbour_words(run)
    sideways = run.case | {"water": run.case["water"] | {"velocity": [0.0, 0.3]}}
    assert neighbour_words(replace(run, case=sideways)) == ""  # x is open


def test_time_before_the_first_load_is_told(run):
    first = run.forces["pile"]["time_s"][np.argmax(run.forces["pile"]["fh_max_N"] > 0.0)]
    assert f"at {first:.3g} s" in waiting_words(run)
    quiet = {"pile": run.forces["pile"] | {"fh_max_N": np.zeros_like(run.forces["pile"]["time_s"])}}
    assert waiting_words(replace(run, forces=quiet)) == ""


def test_unfinished_comes_first(run):
    assert limits(run)[0].about != "Unfinished"
    assert limits(replace(run, summary=run.summary | {"status": "interrupted"}))[0].about == "Unfinished"


def verdict(run, start):
    return next(check.verdict for check in checks(run) if check.what.startswith(start))


def test_checks_hold_or_ask_for_a_look(run):
    assert verdict(run, "the run came") == FINE
    assert verdict(replace(run, summary=run.summary | {"status": "running"}), "the run came") == LOOK
    assert verdict(run, "change of the highest hit") == UNKNOWN
    for change, wanted in ((-0.002, FINE), (0.02, LOOK), (-0.02, LOOK)):
        told = {"error_check": {"structure": "pile", "change": {"fh_max": change}}}
        assert verdict(replace(run, summary=run.summary | told), "change of the highest hit") == wanted
    for overlap, wanted in ((0.01, FINE), (0.041, LOOK)):
        told = {"contact": {"largest_overlap_m": overlap, "model": "liu2015"}}
        assert verdict(replace(run, summary=run.summary | told), "deepest overlap") == wanted
    for share, wanted in ((1e-4, FINE), (1e-2, LOOK)):
        told = {"energy": {"residual_over_turned_over": share, "residual_J": 10.0, "turned_over_J": 1e3, "kinetic_J": 1.0}}
        assert verdict(replace(run, summary=run.summary | told), "the energy ledger") == wanted
    assert verdict(replace(run, hits=events(0.9e6)), "mean nominal") == FINE
    assert verdict(replace(run, hits=events(0.9e6, 1.9e6)), "mean nominal") == LOOK
    assert verdict(replace(crushing(run), hits=events(0.9e6, 1.9e6)), "mean nominal") == FINE


def test_front_page_names_what_is_to_be_looked_at(run):
    found = checks(replace(run, summary=run.summary | {"status": "running"}))
    held = sum(check.verdict == FINE for check in found)
    asked = "To be looked at, see Checks and Limits: the run came to its end. Not known: change of the highest hit with half"
    assert verdict_words(found).startswith(f"{held} of {len(found)} checks hold. {asked}")

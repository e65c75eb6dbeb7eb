"""What `info` and the report say of floes that bend."""

import pytest

from dilatedem.errors import CaseError
from dilatedem.post.overview import bending_words
from dilatedem.post.report.tables import bending_rows
from dilatedem.results.soundness import require_summary

FOUND = {
    "strength_Pa": 5e5, "floes": 31, "above_strength": 2, "first_above_s": 1.5, "largest_Pa": 6.28e5, "largest_time_s": 4.25,
    "largest_body": 22, "meaning": "...",
}  # fmt: skip
UNBROKEN = FOUND | {"above_strength": 0, "first_above_s": None}


def test_the_most_that_pulled_and_how_many_would_have_broken():
    most = "floe 22 was pulled most, by 0.628 MPa at 4.25 s"
    told = bending_words({"flexure": FOUND})
    assert told == f"{most}; 2 of 31 floes passed the flexural strength of 0.5 MPa, the first at 1.5 s"
    assert bending_words({"flexure": UNBROKEN}) == f"{most}; 0 of 31 floes passed the flexural strength of 0.5 MPa"
    (tension, value, when), (above, count, first) = bending_rows(FOUND)
    assert (value, when) == ("0.628", "MPa, of floe 22 at 4.25 s") and "tension" in tension
    assert (count, first) == ("2 of 31", "the first at 1.5 s") and "0.5 MPa" in above
    assert bending_rows(UNBROKEN)[1][1:] == ["0 of 31", ""]


def test_a_summary_with_it_is_sound(tmp_path):
    require_summary({"flexure": FOUND}, tmp_path / "summary.json")
    with pytest.raises(CaseError, match="largest_Pa"):
        require_summary({"flexure": FOUND | {"largest_Pa": "much"}}, tmp_path / "summary.json")


def test_nothing_where_no_floe_bends():
    for nothing in ({}, {"flexure": {}}, {"flexure": FOUND | {"floes": 0}}, {"flexure": FOUND | {"largest_Pa": None}}):
        assert bending_words(nothing) == "" and bending_rows(nothing.get("flexure") or {}) == []

"""Front page, inputs and field of a report."""

import hashlib
from dataclasses import replace

import pytest

from dilatedem.post import post
from dilatedem.post.folders import run_statistics
from dilatedem.post.read import open_run
from dilatedem.post.report.front import direction, identity_rows, moment
from dilatedem.post.report.ice import field_rows
from dilatedem.post.report.inputs import input_groups, meanings, schema_key
from dilatedem.post.report.page import css_text, in_code, typeset, write_run_report


@pytest.fixture(scope="module")
def run(make_run, tmp_path_factory):
    return open_run(make_run(tmp_path_factory.mktemp("front") / "run", duration=2.0, snapshots=False))


def test_identity_is_that_of_the_summary_and_of_the_bytes_of_the_case(run):
    origin = {
        "started": "2026-05-04T09:08:07+02:00", "written": "2026-05-04T10:00:00+02:00", "machine": "node7", "processor": "P",
        "cores": "8", "system": "S", "command": "dilatedem run pile.toml",
    }  # fmt: skip
    told = dict(identity_rows(replace(run, summary=run.summary | {"origin": origin})))
    assert told["begun"] == "4 May 2026, 09:08:07 UTC+0200" and told["machine"] == "node7, P, 8 cores, S"
    assert told["command"] == "dilatedem run pile.toml"
    assert told["case.toml, SHA-256"] == hashlib.sha256((run.path / "case.toml").read_bytes()).hexdigest()
    assert not {"begun", "machine", "command"} & set(dict(identity_rows(run)))  # an older run does not tell


def test_times_are_told_with_their_distance_from_utc():
    assert moment("2026-11-30T13:51:22+00:00") == "30 November 2026, 13:51:22 UTC"
    assert moment("yesterday") == "yesterday" and moment(None) == ""


@pytest.mark.parametrize(
    ("flow", "words"), [((0.3, 0.0), "+x"), ((-0.3, 0.0), "−x"), ((0.0, -1.0), "−y"), ((1.0, 1.0), "45° from +x")]
)
def test_flows_have_a_direction(flow, words):
    assert direction(flow) == words


def test_signatures_are_written_in_or_left_blank(make_run, tmp_path):
    folder = make_run(tmp_path / "run", duration=1.0, snapshots=False)
    post([folder], prepared_by="A. <Maker>", project="Harbour & light")
    page = (folder / "report.html").read_text(encoding="utf-8")
    assert 'aria-label="prepared by">A. &lt;Maker&gt;</td>' in page and "Harbour &amp; light" in page
    assert 'aria-label="checked by"></td>' in page


def test_inputs_have_meaning_and_unit_and_tell_what_the_case_sets(run):
    groups = {group["name"]: {row["key"]: row for row in group["rows"]} for group in input_groups(run.case)}
    size, thickness = groups["field"]["floe_size"], groups["ice"]["thickness"]
    assert size["own"] and size["value"] == "2" and size["unit"] == "m" and size["meaning"].startswith("Square root")
    assert not thickness["own"] and thickness["unit"] == "m"
    assert groups["structure pile"]["radius"]["own"] and groups["structure pile"]["radius"]["meaning"] == "Radius of the pile."
    assert all(row["meaning"] for group in groups.values() for row in group.values())


def test_keys_of_kinds_have_the_meaning_of_their_kind():
    case = {
        "structure": [
            {"kind": "box", "size": [1.0, 2.0], "support": {"kind": "sprung", "mass": 1.0}},
            {"kind": "parts", "part": [{"kind": "brace", "radius": 0.5}]},
        ],
        "wave": [{"period": 5.0}],
        "field": {"size_distribution": {"kind": "power_law", "exponent": 1.9}},
    }  # fmt: skip
    keys = (
        "structure.0.size", "structure.0.support.mass", "structure.1.part.0.radius", "wave.0.period",
        "field.size_distribution.exponent",
    )  # fmt: skip
    named = [schema_key(key, case) for key in keys]
    assert named == [
        "structure.box.size", "structure.support.sprung.mass", "structure.brace.radius", "wave.period",
        "field.size_distribution.power_law.exponent",
    ]  # fmt: skip
    assert set(named) <= set(meanings())


def test_field_is_told_in_figures(run):
    rows = {row[0]: row[1] for row in field_rows(run)}
    assert rows["floes"] == str(len(run.floes.outlines))
    cover = 100.0 * run.floes.plan_area.sum() / (20.0 * 16.0)
    assert float(rows["share of the domain that they cover"]) == pytest.approx(cover, rel=1e-2)
    assert field_rows(replace(run, floes=None)) == []


def test_texts_are_safe_in_style_sheets_and_code():
    assert css_text('a "b" </style>') == '"a \\22 b\\22  \\3c \\2f style\\3e "'
    assert in_code("`open` <or> `wall`") == "<code>open</code> &lt;or&gt; <code>wall</code>"


def test_units_stay_whole_and_an_index_is_one(run):
    """No line ends within kN m, and C_R of ISO 19906 has its index; what else a text holds is escaped."""
    assert str(typeset("moment (kN m)")) == "moment (kN\N{NO-BREAK SPACE}m)"
    assert str(typeset("12 kN s, at 5 s; 3 kJ, C_R <b>")) == "12 kN\N{NO-BREAK SPACE}s, at 5 s; 3 kJ, C<sub>R</sub> &lt;b&gt;"
    page = write_run_report(run, run_statistics(run), []).read_text()
    assert "moment (kN\N{NO-BREAK SPACE}m)" in page and "level ice, C<sub>R</sub> 1.8 MPa (kN)" in page
    assert "C_R" not in page and "kN m" not in page

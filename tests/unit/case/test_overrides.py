"""Overrides take TOML values for any key; what cannot be meant is refused in one sentence."""

from pathlib import Path

import pytest

from dilatedem.case.load import Source, build, load
from dilatedem.case.overrides import Override, apply, parse, parse_value
from dilatedem.case.schema import TABLES, Case
from dilatedem.case.write import dump
from dilatedem.errors import CaseError

PILE = Path(__file__).parents[3] / "cases" / "pile.toml"


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("3", 3),
        ("-1e-3", -1e-3),
        (".5", 0.5),
        ("1.", 1.0),
        ("[0.5, 0]", [0.5, 0]),
        ("true", True),
        ("auto", "auto"),
        ('"auto"', "auto"),
        ("two words", "two words"),
        ("{a = 1}", {"a": 1}),
    ],
)
def test_values(text, value):
    assert parse_value(text, "--set x") == value
    assert type(parse_value(text, "--set x")) is type(value)


def test_a_power_law_of_sizes_takes_back_the_number_of_floes_and_a_lognormal_one_does_not():
    power = load(PILE, ['field.size_distribution={kind = "power_law", min = 1.0, max = 8.0}', "field.size_distribution.max=9"])
    assert (power.field.floe_count, power.field.floe_size, power.field.size_distribution.max) == (None, None, 9)
    assert power.field.asked_size == pytest.approx(power.field.size_distribution.floe_size)
    assert build(Source("again", dump(power))) == power
    assert load(PILE, ['field.size_distribution={kind = "lognormal"}']).field.floe_count == 200


def test_overrides_reach_every_kind_of_key():
    case = load(
        PILE,
        [
            "water.velocity=[0.5,0]",
            "structure.pile.radius=3",
            "structure.0.center.1=1.5",
            "output.track=all",
            "title=a = b",
            "time.step=1e-4",
            "gravity.acceleration=0",
            "ice.thickness=1",
            "ice.thickness=0.6",
        ],
    )
    assert case.water.velocity == (0.5, 0.0)
    assert (case.structure[0].radius, case.structure[0].center) == (3.0, (10.0, 1.5))
    assert (case.output.track, case.title, case.time.step) == ("all", "a = b", 1e-4)
    assert (case.gravity.acceleration, case.ice.thickness) == (0.0, 0.6)


def test_item_of_a_list_that_the_file_leaves_at_its_default():
    data: dict = {}
    assert apply(data, parse("water.velocity.0=0.7")) == ("water", "velocity", 0)
    assert data == {"water": {"velocity": [0.7, 0.0]}}
    assert Case().water.velocity == (0.3, 0.0)


def test_whole_lists_of_tables():
    assert load(PILE, ["structure=[]"]).structure == []
    body = load(PILE, ["body=[{vertices = [[0, 0, 0]]}]", "body.0.density=800"]).body
    assert body[0].density == 800.0


def test_floe_size_and_count_replace_each_other():
    field = load(PILE, ["field.floe_count=500"]).field
    assert (field.floe_count, field.floe_size) == (500, None)


@pytest.mark.parametrize("table", list(TABLES))
def test_every_key_can_be_overridden_by_its_default(table):
    case = load(PILE)
    for line in dump(case).split(f"[{table}]\n")[1].split("\n\n")[0].split("\n[")[0].splitlines():
        name, value = line.split("  #")[0].split(" = ", 1)
        assert load(PILE, [f"{table}.{name}={value}"]) == case


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("foo", "must be KEY=VALUE, as in --set water.velocity=[0.5,0]"),
        ("=3", "must be KEY=VALUE"),
        ("a..b=3", "must be KEY=VALUE"),
        ("ice.density=", "no value is given"),
        ("water.velocity=[0.5,0", "[0.5,0 is no TOML value; quote it for the shell, as in '[0.5, 0]'"),
        ("water.velocity=0.5,0", "0.5,0 is no TOML value; did you mean a list, --set 'water.velocity=[0.5,0]'?"),
        ("water.velocity=.5, -1e-3", ".5, -1e-3 is no TOML value; did you mean a list, --set 'water.velocity=[.5, -1e-3]'?"),
        ("structure.pyle.radius=3", 'structure has no item "pyle"; did you mean "pile"?'),
        ("structure.1.radius=3", "structure has no item 1; its items are 0 to 0"),
        ("body.0.density=3", "body has no item 0; it is empty"),
        ("water.velocity.2=1", "water.velocity has no item 2; its items are 0 to 1"),
        ("water.velocity.x=1", 'water.velocity has no item "x"; give its number, from 0'),
        ("ice.density.x=1", 'ice.density is no list or table that "x" could belong to'),
        ("ice.initial_velocity.0=1", 'ice.initial_velocity is no list or table that "0" could belong to'),
        ("structure.pile.radus=3", 'structure.0.radus: unknown key; did you mean "radius"?'),
        ("contact.frction=0.2", 'unknown key; did you mean "friction"?'),
    ],
)
def test_faults(text, expected):
    with pytest.raises(CaseError) as caught:
        load(PILE, [text])
    message = str(caught.value)
    key = text.split("=")[0]
    assert message.startswith((f"--set {key}: {expected}", f"--set {text}: {expected}"))
    assert "\n" not in message


def test_words_with_commas_are_words():
    assert load(PILE, ["title=1, 2, many"]).title == "1, 2, many"
    assert load(PILE, ['title="1,2"']).title == "1,2"


def test_origin_names_the_option():
    assert parse("a.b=1", "--vary") == Override("a.b", 1, "--vary a.b")

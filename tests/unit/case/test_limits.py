"""What no case can hold: numbers, texts and shapes of tables that later code would choke on; each told in a sentence, at once."""

import time

import pytest

from dilatedem.case.load import case_from, load
from dilatedem.errors import CaseError

#: s of the processor, which other programs share, that a hostile file may cost at most
SOON = 10.0


def refused(tmp_path, text: str, *overrides: str) -> str:
    path = tmp_path / "pile.toml"
    path.write_text(text)
    began = time.process_time()
    with pytest.raises(CaseError) as caught:
        load(path, overrides)
    assert time.process_time() - began < SOON
    return str(caught.value).replace(f"{tmp_path}/", "")


@pytest.mark.parametrize("number", ["0x" + "f" * 5000, "9" * 30, "-" + "9" * 30, "9" * 400])
@pytest.mark.parametrize(
    "place", ["[field]\nfloe_count = {}", "[ice]\ndensity = {}", "[output]\ntrack = [0, {}]", "[ice]\nno_key = {}"]
)
def test_integers_of_more_than_64_bits(tmp_path, number, place):
    message = refused(tmp_path, place.format(number))
    assert message.startswith("pile.toml:2: ")
    assert message.endswith(": is too large: a whole number has at most 18 digits (64 bits); write a float, as in 1e20")
    assert len(message) < 250


def test_integers_of_64_bits_are_fine(tmp_path):
    assert case_from({"field": {"seed": 2**63 - 1}}, {}).field.seed == 2**63 - 1


@pytest.mark.parametrize("header", ["", "[ice]\n", "[[body]]\n"])
def test_hundreds_of_thousands_of_keys(tmp_path, header):
    message = refused(tmp_path, header + "\n".join(f"k{i} = 1" for i in range(450_000)))
    assert "holds 450000 keys in one table, so it is no case" in message
    assert "\n" not in message


def test_of_many_faults_the_first_are_told(tmp_path):
    lines = refused(tmp_path, "\n".join(f"k{i:03d} = 1" for i in range(900))).splitlines()
    assert [line[:18] for line in lines[:2]] == ["pile.toml:1: k000:", "pile.toml:2: k001:"]
    assert lines[-1] == "pile.toml: and more; 900 in all"
    assert len(lines) == 21


def test_line_numbers_of_a_long_file_take_no_time(tmp_path):
    message = refused(tmp_path, "\n".join("[[body]]\nvertices = [[0, 0, 0]]\nfixd = true" for _ in range(20_000)))
    assert message.startswith('pile.toml:3: body.0.fixd: unknown key; did you mean "fixed"?\n')


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("[contact]\ndamping = 1e10", "contact.damping = 10000000000.0: must be at most 100"),
        ("[contact]\nfriction = 1e300", "contact.friction = 1e+300: must be at most 1000"),
        ('[[structure]]\nkind = "pile"\nradius = 1e-300', "structure.0.radius = 1e-300: must be at least 1e-09 m"),
        ('[[structure]]\nkind = "pile"\ncenter = [1e300, 0]', "structure.0.center.0 = 1e+300: must be at most 1e+07 m in size"),
        ('[[structure]]\nkind = "box"\nsize = [1e-300, 1]', "structure.0.size.0 = 1e-300: must be at least 1e-09 m"),
        ("[domain]\nsize = [50, 1e308]", "domain.size.1 = 1e+308: must be at most 1e+07 m in size"),
        ("[output]\ntrack_interval = 1e300", "output.track_interval = 1e+300: must be at most 1e+10 s in size"),
        ("[output]\nsnapshot_interval = 1e-300", "output.snapshot_interval = 1e-300: must be at least 1e-12 s"),
        ("[time]\nduration = 1e300", "time.duration = 1e+300: must be at most 1e+10 s in size"),
        ("[time]\nstep = 1e-300", "time.step = 1e-300: must be at least 1e-12 s"),
        ("[water]\nvelocity = [0, -1e200]", "water.velocity.1 = -1e+200: must be at most 100000 m/s in size"),
        ("[water]\ndrag_force_coefficient = 1e300", "water.drag_force_coefficient = 1e+300: must be at most 1e+06 in size"),
        ("[ice]\nelastic_modulus = 1e300", "ice.elastic_modulus = 1e+300: must be at most 1e+21 Pa in size"),
        ("[ice]\ndensity = 1e-300", "ice.density = 1e-300: must be at least 1e-06 kg/m3"),
        ("[ice]\ninitial_velocity = [0, 0, 1e300]", "ice.initial_velocity.2 = 1e+300: must be at most 100000 m/s in size"),
        ("[[body]]\nvertices = [[0, 0, 0], [0, 1e300, 0]]", "body.0.vertices.1.1 = 1e+300: must be at most 1e+07 m in size"),
        ('[[structure]]\nkind = "plane"\npoint = [0, 0, 0]\nnormal = [1e-200, 0, 0]', "must not be zero, nor shorter than 1e-09: "),
    ],
)
def test_numbers_beyond_their_unit(tmp_path, text, expected):
    message = refused(tmp_path, text)
    assert expected in message
    assert "\n" not in message


def test_zero_where_it_switches_off(tmp_path):
    case = case_from({"output": {"snapshot_interval": 0.0}, "gravity": {"acceleration": 0.0}}, {})
    assert (case.output.snapshot_interval, case.gravity.acceleration) == (0.0, 0.0)


@pytest.mark.parametrize("key", ["title", "ice.density", "no_key"])
def test_texts_that_are_no_unicode(tmp_path, key):
    assert "is not UTF-8 text; write it in UTF-8" in refused(tmp_path, "", f"{key}=\udcff")


@pytest.mark.parametrize("value", ["\\u001b[31m", "\\u0007", "\\u202e", "\\u2028", "\\u009b"])
def test_control_characters_are_shown_as_escapes(tmp_path, value):
    for text in ('[ice]\ndensity = "{}"', '"{}" = 1', '[domain]\nx_boundary = "{}"', '[[structure]]\nkind = "{}"'):
        text = text.format(value)
        message = refused(tmp_path, text)
        assert message.isascii() and message.isprintable()


@pytest.mark.parametrize("place", ["water.velocity." + "9" * 5000, "water.velocity.99999999999", "body." + "9" * 5000 + ".fixed"])
def test_numbers_of_items_beyond_all_lists(tmp_path, place):
    assert "has no item" in refused(tmp_path, "", f"{place}=1")


def test_dictionaries_are_looked_at_like_files():
    deep: dict = {}
    for _ in range(5000):
        deep = {"x": deep}
    large, bad = {"ice": {"density": 10**5000}}, {"title": "\udcff"}
    for case, expected in ((deep, "nested too deeply"), (large, "is too large"), (bad, "UTF-8")):
        with pytest.raises(CaseError, match=expected):
            case_from(case, {})

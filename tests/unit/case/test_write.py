"""A case that was written is the same case when it is read."""

import math
import tomllib

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dilatedem.case.lines import line_numbers
from dilatedem.case.load import STANDARD_INPUT, Source, build, load
from dilatedem.case.schema import Body, Case
from dilatedem.case.write import dump

numbers = st.floats(-1e5, 1e5)
positive = st.floats(1e-6, 1e5)
non_negative = st.floats(0, 1e3)
ratios = st.floats(0, 0.5, exclude_max=True)
names = st.from_regex(r"[A-Za-z_][A-Za-z0-9_-]{0,8}", fullmatch=True).filter(lambda name: "wall_" not in name)


def vectors(size: int, items=numbers):
    return st.lists(items, min_size=size, max_size=size)


def tables(required=None, **optional):
    return st.fixed_dictionaries(required or {}, optional=optional)


piles = tables({"kind": st.just("pile")}, center=vectors(2), radius=positive, poisson_ratio=ratios)
planes = tables({"kind": st.just("plane"), "point": vectors(3), "normal": st.just([0.6, 0.0, -0.8])})
motion = {"velocity": vectors(3), "angular_velocity": vectors(3), "rotation": vectors(3), "density": positive}
hulls = tables(
    {"vertices": st.lists(vectors(3), min_size=1, max_size=4)},
    position=vectors(3),
    dilated_radius=positive,
    **motion,
)
floes = tables(
    {"outline": st.lists(vectors(2), min_size=3, max_size=5)},
    position=vectors(2) | vectors(3),
    thickness=st.floats(1.0, 10.0),
    **motion,
)
cases = tables(
    title=st.text(),
    domain=tables(size=vectors(2, positive), x_boundary=st.sampled_from(["open", "periodic", "wall"])),
    field=tables(seed=st.integers(0, 2**63 - 1), concentration=st.floats(0.01, 0.99))
    | tables({"floe_count": st.integers(1, 10**6)}),
    ice=tables(thickness=st.floats(0.1, 1e3), initial_velocity=st.just("current") | vectors(3)),
    water=tables(enabled=st.booleans(), velocity=vectors(2), density=positive),
    gravity=tables(acceleration=non_negative),
    contact=tables(model=st.sampled_from(["liu2015", "consistent"]), friction=non_negative),
    time=tables(duration=st.floats(1.0, 1e6), step=st.just("auto") | st.floats(1e-9, 1.0)),
    output=tables(track=st.just("all") | st.lists(st.integers(0, 10**6), unique=True)),
    body=st.lists(hulls | floes, max_size=3),
    structure=st.dictionaries(names, piles | planes, max_size=3).map(
        lambda named: [{"name": name, **structure} for name, structure in named.items()]
    ),
)


@settings(deadline=None, max_examples=150, derandomize=True)
@given(cases)
def test_round_trip(data):
    case = Case.model_validate(data)
    text = dump(case)
    again = build(Source(STANDARD_INPUT, text))
    assert again == case
    assert dump(again) == text
    # The scanner of line numbers finds every key of a text it has not seen before.
    lines = line_numbers(text)
    written = text.split("\n")
    for path, line in lines.items():
        if path[-1] == "title":
            assert written[line - 1].startswith("title = ")
        elif len(path) > 1 and isinstance(path[-1], str):
            assert written[line - 1].startswith((f"{path[-1]} = ", f"[{path[0]}.{path[-1]}]"))


def test_every_default_is_explicit_and_units_stand_beside():
    listed = {"structure": [{"kind": "pile"}], "body": [{"vertices": [[0, 0, 0]]}], "wave": [{"amplitude": 0.1, "period": 3.0}]}
    text = dump(Case.model_validate(listed))
    data = tomllib.loads(text)
    assert set(data) == set(Case.model_fields)
    assert set(data["structure"][0]) == {
        "kind", "name", "center", "radius", "elastic_modulus", "poisson_ratio", "support"
    }
    assert set(data["body"][0]) == set(Body.model_fields) - {"outline", "outline_tolerance", "thickness", "modes"}
    assert "velocity = [0.3, 0.0]  # m/s\n" in text
    assert 'step = "auto"\n' in text


def test_numbers_keep_every_digit(tmp_path):
    title = 'a\n"b"\\[1.0,\n]'
    case = Case.model_validate({"title": title, "ice": {"density": math.nextafter(915.0, 916.0)}})
    path = tmp_path / "case.toml"
    path.write_text("# dilatedem 0.1.0, seed 1\n" + dump(case), encoding="utf-8")
    assert load(path) == case


@pytest.mark.parametrize("value", [0.1, 1e-300, 12345.678901234567])
def test_floats(value):
    case = Case.model_validate({"gravity": {"acceleration": value}})
    assert build(Source("x", dump(case))).gravity.acceleration == value

"""Axes of a sweep: lists, ranges without drift, combinations in order, readable folders."""

import time

import pytest

from dilatedem.case.grid import Axis, axis, cases, folder_name, seed_axis
from dilatedem.errors import CaseError


@pytest.mark.parametrize(
    ("text", "values"),
    [
        ("k=0.1:1.0:0.1", (0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0)),
        ("k=1:3:1", (1, 2, 3)),
        ("k=0:1:0.4", (0.0, 0.4, 0.8)),
        ("k=3:1:-1", (3, 2, 1)),
        ("k=-0.2:0.2:0.2", (-0.2, 0.0, 0.2)),
        ("k=1e-4:3e-4:1e-4", (1e-4, 2e-4, 3e-4)),
        ("k=2:2:1", (2,)),
        ("k=1,2.5,4:6:1", (1, 2.5, 4, 5, 6)),
        ("k=[0.1,0],[0.2,0]", ([0.1, 0], [0.2, 0])),
        ("k=open, wall", ("open", "wall")),
        ('k="a,b",c', ("a,b", "c")),
        ("k=true,false", (True, False)),
        ('k="1:2"', ("1:2",)),
    ],
)
def test_values(text, values):
    found = axis(text)
    assert found == Axis("k", values, "--vary k")
    assert [type(value) for value in found.values] == [type(value) for value in values]


@pytest.mark.parametrize(
    ("text", "remarks"),
    [
        ("k=0.1:1.0:0.1", ()),
        ("k=1e-4:3e-4:1e-4", ()),
        ("k=3:1:-1", ()),
        ("k=0:1:0.4", ("--vary k: 0:1:0.4: no step meets 1; the last value is 0.8",)),
        ("k=9,5:1:-3", ("--vary k: 5:1:-3: no step meets 1; the last value is 2",)),
    ],
)
def test_a_stop_that_no_step_meets_is_said(text, remarks):
    assert axis(text).remarks == remarks


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("k", "--vary k: must be KEY=V1,V2,.. or KEY=START:STOP:STEP"),
        ("k=", "--vary k: no value is given"),
        ("k=1,,2", "--vary k: no value is given"),
        ("k=1:2", "--vary k: 1:2: a range is START:STOP:STEP"),
        ("k=1:2:x", "--vary k: 1:2:x: a range is START:STOP:STEP"),
        ("k=1:2:0", "--vary k: 1:2:0: no step of 0 leads from 1 to 2"),
        ("k=1:2:-1", "--vary k: 1:2:-1: no step of -1 leads from 1 to 2"),
        ("k=0:1:1e-9", "--vary k: 0:1:1e-9: has 1000000001 values"),
        ("k=1,2,1", "--vary k: 1 is given twice"),
        ("k=1,2,1.0", "--vary k: 1.0 is given twice"),
        ("k=0:1e999999:1e-999999", "--vary k: 0:1e999999:1e-999999: 1E+999999 is no number that a key can hold"),
        ("k=0:1:1e-999999", "--vary k: 0:1:1e-999999: 1E-999999 is no number that a key can hold"),
        ("k=0:1e200:1e-200", "--vary k: 0:1e200:1e-200: has 1e+400 values; at most 100000"),
    ],
)
def test_faults(text, expected):
    with pytest.raises(CaseError) as caught:
        axis(text)
    assert str(caught.value).startswith(expected)


def test_combinations_change_the_last_axis_fastest():
    points = cases([axis("a=1,2"), seed_axis(5, 2)])
    assert [[override.value for override in point] for point in points] == [[1, 5], [1, 6], [2, 5], [2, 6]]
    names = [folder_name(point) for point in points]
    assert names == ["a=1__seed=5", "a=1__seed=6", "a=2__seed=5", "a=2__seed=6"]


def test_a_switch_is_no_number():
    assert axis("k=1,true").values == (1, True)


def test_a_hundred_thousand_values_take_no_time():
    began = time.process_time()
    assert len(axis("k=1:100000:1").values) == 100_000
    assert time.process_time() - began < 5.0


def test_seeds_that_cannot_be_meant():
    with pytest.raises(CaseError, match="^--seeds 1000000000: must be at most 100000"):
        seed_axis(1, 10**9)


def test_a_folder_name_fits_every_file_system():
    for long in ("x" * 300, "ä" * 130):
        points = cases([axis(f"title={long},b")])
        with pytest.raises(CaseError, match=r"^--vary title: the folder of a case would be called title=.*bytes long; at most 240"):
            folder_name(points[0])
    assert len(folder_name(cases([axis("title=" + "x" * 234)])[0])) == 240


def test_grids_that_cannot_be_meant():
    with pytest.raises(CaseError, match="--vary a: is varied twice"):
        cases([axis("a=1,2"), axis("a=3")])
    with pytest.raises(CaseError, match="the sweep has 1000000 cases"):
        cases([Axis(key, tuple(range(1000)), key) for key in "ab"])


def test_folder_names_suit_any_file_system():
    texts = ("water.velocity=[0.3, 0]", "title=a/b c*", "water.enabled=true", "x=1e20")
    axes = [axis(text) for text in texts]
    assert folder_name(cases(axes)[0]) == "water.velocity=0.3,0__title=a_b_c___water.enabled=true__x=1e+20"

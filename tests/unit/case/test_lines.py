"""Line numbers of keys, on TOML written in every way it allows."""

from dilatedem.case.lines import line_numbers, line_of

TEXT = '''\
# a comment = 1
title = """one
two = 2
three"""  # [not.a.table]

[domain]
size = [  # = [
  50.0, # ]
  50.0,
]
x_boundary = 'a # "b'

[ "quoted.key" . inner ]
value = {a = 1, b = [2, 3]}
dotted . "x y".z = "\\"]"

[[structure]]
kind = "pile"
[structure.extra]
deep = 1

[[structure]]
kind = """a\\""""
name = "b"
empty = ""
last = \'\'\'x\'\'\'\'
end = 1'''


def test_lines_of_keys():
    import tomllib

    tomllib.loads(TEXT)
    lines = line_numbers(TEXT)
    assert lines[("title",)] == 2
    assert lines[("domain",)] == 6
    assert lines[("domain", "size")] == 7
    assert lines[("domain", "x_boundary")] == 11
    assert lines[("quoted.key", "inner", "value")] == 14
    assert lines[("quoted.key", "inner", "dotted", "x y", "z")] == 15
    assert lines[("structure",)] == 17
    assert lines[("structure", 0, "kind")] == 18
    assert lines[("structure", 0, "extra", "deep")] == 20
    assert lines[("structure", 1)] == 22
    assert lines[("structure", 1, "name")] == 24
    assert lines[("structure", 1, "last")] == 26
    assert lines[("structure", 1, "end")] == 27
    assert not any("two" in path or "not" in path for path in lines)


def test_what_has_no_line_takes_that_around_it():
    lines = line_numbers(TEXT)
    assert line_of(("quoted.key", "inner", "value", "b", 1), lines) == 14
    assert line_of(("domain", "missing"), lines) == 6
    assert line_of(("ice", "density"), lines) is None
    assert line_of((), lines) is None

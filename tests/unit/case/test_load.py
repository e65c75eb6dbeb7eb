"""Every fault of a case file is one line that says where, which key, its value and what is allowed."""

import io
from pathlib import Path

import pytest

from dilatedem.case.load import load
from dilatedem.errors import CaseError
from dilatedem.structures.kinds import BY_NAME

#: all kinds of structures, as a message lists them
KINDS = " or ".join(", ".join(f'"{kind}"' for kind in BY_NAME).rsplit(", ", 1))


def fault_lines(tmp_path: Path, text: str, *overrides: str) -> list[str]:
    """What loading `text` as pile.toml says, the folder cut off."""
    path = tmp_path / "pile.toml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(CaseError) as caught:
        load(path, overrides)
    return str(caught.value).replace(f"{tmp_path}/", "").splitlines()


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("[watr]\ndensity = 1.0", 'pile.toml:1: watr: unknown key; did you mean "water"?'),
        ("friction = 0.2", 'pile.toml:1: friction: unknown key; did you mean "contact.friction"?'),
        ("[ice]\nthicknes = 1.0", 'pile.toml:2: ice.thicknes: unknown key; did you mean "thickness"?'),
        (
            "[domain]\nfoo = 1",
            "pile.toml:2: domain.foo: unknown key; known here: size, x_boundary, y_boundary, wall_friction",
        ),
        ("[ice]\n\nthickness = -0.5", "pile.toml:3: ice.thickness = -0.5: must be greater than 0"),
        (
            "[ice]\nthickness = 0.5\ndilated_radius = 0.3",
            "pile.toml:3: ice.dilated_radius = 0.3: must be at most half the thickness, 0.25 m",
        ),
        ("contact = {friction = -0.1}", "pile.toml:1: contact.friction = -0.1: must be at least 0"),
        ("[ice]\npoisson_ratio = 0.5", "pile.toml:2: ice.poisson_ratio = 0.5: must be less than 0.5"),
        ("[field]\nconcentration = 1", "pile.toml:2: field.concentration = 1: must be less than 1"),
        ("[field]\nseed = 1.0", "pile.toml:2: field.seed = 1.0: must be a whole number"),
        ('[ice]\ndensity = "915"', 'pile.toml:2: ice.density = "915": must be a number'),
        ("[ice]\ndensity = nan", "pile.toml:2: ice.density = nan: must be finite"),
        ("[ice]\ndensity = true", "pile.toml:2: ice.density = true: must be a number"),
        ("[water]\nenabled = 1", "pile.toml:2: water.enabled = 1: must be true or false"),
        ("[water]\nvelocity = [0.3]", "pile.toml:2: water.velocity = [0.3]: must be a list of 2 numbers"),
        ("[domain]\nsize = [\n50.0,\n-1.0]", "pile.toml:2: domain.size.1 = -1.0: must be greater than 0"),
        (
            '[domain]\nx_boundary = "periodc"',
            'pile.toml:2: domain.x_boundary = "periodc": must be "open", "periodic", "wall", "outflow" or "inflow"; '
            'did you mean "periodic"?',
        ),
        ("[time]\nstep = -1", 'pile.toml:2: time.step = -1: must be "auto" or a number greater than 0'),
        ("[time]\nstep = 200.0", "pile.toml:2: time.step = 200.0: must be at most time.duration, 100 s"),
        (
            '[ice]\ninitial_velocity = "curent"',
            'pile.toml:2: ice.initial_velocity = "curent": must be "current" or a list of 3 numbers',
        ),
        (
            "[output]\ntrack = [1, -2]",
            'pile.toml:2: output.track = [1, -2]: must be "all" or a list of body numbers, from 0',
        ),
        ("[output]\ntrack = [1, 1]", "pile.toml:2: output.track = [1, 1]: names a body twice"),
        (
            "[field]\nfloe_size = 2.8\nfloe_count = 200",
            "pile.toml:3: field.floe_count = 200: give either floe_size or floe_count, not both",
        ),
        (
            '[field]\nsource = "bodies"',
            'pile.toml:2: field.source = "bodies": needs at least one [[body]]',
        ),
        ("ice = 3", "pile.toml:1: ice = 3: must be a table"),
        (
            "structure = {}",
            "pile.toml:1: structure: must be a list of tables, each under a header [[structure]]",
        ),
    ],
)
def test_fault_of_a_table(tmp_path, text, expected):
    assert fault_lines(tmp_path, text) == [expected]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (
            '[[structure]]\nkind = "pile"\n[[structure]]\nkind = "pile"\nname = "pile"',
            'pile.toml:5: structure.1.name = "pile": is the name of structure.0 too; '
            "give each structure one of its own",
        ),
        (
            '[[structure]]\nkind = "pile"\nname = "wall_x_min"',
            'pile.toml:3: structure.0.name = "wall_x_min": is kept for a wall of the domain; choose another',
        ),
        (
            '[[structure]]\nkind = "pile"\nname = "a/b"',
            'pile.toml:3: structure.0.name = "a/b": must start with a letter and hold nothing but letters, '
            "digits, _ and -",
        ),
        (
            '[[structure]]\nkind = "pyle"',
            f'pile.toml:2: structure.0.kind = "pyle": must be {KINDS}; did you mean "pile"?',
        ),
        (
            "[[structure]]\nradius = 2.0",
            f"pile.toml:1: structure.0.kind: is missing; it must be {KINDS}",
        ),
        (
            '[[structure]]\nkind = "pile"\nradus = 2.0',
            'pile.toml:3: structure.0.radus: unknown key; did you mean "radius"?',
        ),
        (
            '[[structure]]\nkind = "plane"\npoint = [0, 0, 0]',
            "pile.toml:1: structure.0.normal: is missing",
        ),
        (
            '[[structure]]\nkind = "plane"\npoint = [0, 0, 0]\nnormal = [0, 0, 0]',
            "pile.toml:4: structure.0.normal = [0, 0, 0]: must not be zero: "
            "it points from the plane towards the ice",
        ),
        ("[[body]]\nfixed = true", "pile.toml:1: body.0: needs either vertices or outline"),
        ("[[body]]\nvertices = []", "pile.toml:2: body.0.vertices = []: must have at least 1 item"),
        (
            "[[body]]\nvertices = [[0, 0, 0]]\nfixed = true\nvelocity = [1, 0, 0]",
            "pile.toml:4: body.0.velocity = [1, 0, 0]: must be zero for a fixed body; or set fixed = false",
        ),
        (
            "[[body]]\nvertices = [[0, 0, 0]]\nthickness = 0.5",
            "pile.toml:3: body.0.thickness = 0.5: belongs to an outline; "
            "vertices give the shape by themselves",
        ),
        (
            "[[body]]\nvertices = [[0, 0, 0]]\nposition = [1, 2]",
            "pile.toml:3: body.0.position = [1, 2]: must be a list of 3 numbers; "
            "only an outline finds its height",
        ),
        (
            "[[body]]\noutline = [[0, 0], [1, 0], [0, 1]]\nvertices = [[0, 0, 0]]",
            "pile.toml:2: body.0.outline = [[0, 0], [1, 0], [0, 1]]: "
            "give either vertices or outline, not both",
        ),
        (
            "[[body]]\noutline = [[0, 0], [1, 0], [0, 1]]\ndilated_radius = 0.3",
            "pile.toml:3: body.0.dilated_radius = 0.3: must be at most half the thickness, 0.25 m",
        ),
        (
            "[[body]]\noutline = [[0, 0], [1, 0], [0, 1]]\nthickness = 0.05",
            "pile.toml:3: body.0.thickness = 0.05: must be at least twice ice.dilated_radius, 0.08 m",
        ),
        (
            '[field]\nsource = "bodies"\n[output]\ntrack = [2]\n[[body]]\nvertices = [[0, 0, 0]]',
            "pile.toml:4: output.track = [2]: there is no body 2; they are numbered from 0 to 0",
        ),
    ],
)
def test_fault_of_a_solid(tmp_path, text, expected):
    assert fault_lines(tmp_path, text) == [expected]


def test_every_fault_is_listed_in_the_order_of_the_file(tmp_path):
    text = "title = 3\n[time]\nstep = 0\nstpe = 1\n[ice]\ndensity = 0\n"
    text += '[[structure]]\nkind = "pile"\nradius = 0'
    lines = fault_lines(tmp_path, text)
    assert [line.split(": ")[0] for line in lines] == [f"pile.toml:{n}" for n in (1, 3, 4, 6, 9)]


def test_override_is_named_as_the_place_of_its_fault(tmp_path):
    text = "[contact]\nfriction = 0.2\n"
    assert fault_lines(tmp_path, text, "contact.friction=-0.1") == [
        "--set contact.friction: contact.friction = -0.1: must be at least 0"
    ]
    assert fault_lines(tmp_path, text, "watr.velocity=[1,0]") == [
        '--set watr.velocity: watr: unknown key; did you mean "water"?'
    ]
    # The value at fault is that of the file, although the override brought it to light.
    assert fault_lines(tmp_path, "[ice]\ndilated_radius = 0.2", "ice.thickness=0.3") == [
        "pile.toml:2: ice.dilated_radius = 0.2: must be at most half the thickness, 0.15 m"
    ]


@pytest.mark.parametrize(
    ("content", "expected"),
    [
        (b"[ice\n", "pile.toml:1: not valid TOML at column 5: "),
        (b"[ice]\ndensity = 1\ndensity = 2\n", "pile.toml:3: not valid TOML at column 12: "),
        (b"title = 'x", "pile.toml: not valid TOML: "),
        (b"\xff\xfe", "pile.toml: is not UTF-8 text (byte 0)"),
        (b"x = " + b"[" * 5000, "pile.toml: is nested too deeply"),
        (b"[ice]\nx = " + b"9" * 5000, "pile.toml:2: holds a whole number of 5000 digits; at most 18 can be read"),
        (b"x = " + b"[" * 100 + b"]" * 100, "pile.toml: x.0: is nested too deeply: at most 24 tables and lists"),
        (b"x." * 3000 + b"x = 1", "pile.toml: x.x: is nested too deeply: at most 24 tables and lists"),
        (b" " * (2**26 + 1), "pile.toml: is larger than 64 MB"),
    ],
)
def test_unreadable_text(tmp_path, content, expected):
    path = tmp_path / "pile.toml"
    path.write_bytes(content)
    with pytest.raises(CaseError) as caught:
        load(path)
    message = str(caught.value).replace(f"{tmp_path}/", "")
    assert message.startswith(expected)
    assert "\n" not in message


def test_missing_file_names_its_neighbour(tmp_path):
    (tmp_path / "pile.toml").touch()
    with pytest.raises(CaseError, match=r"pyle.toml: no such case file; did you mean .*/pile.toml\?"):
        load(tmp_path / "pyle.toml")
    with pytest.raises(CaseError, match="there is no folder"):
        load(tmp_path / "no" / "pile.toml")
    with pytest.raises(CaseError, match="is a folder; name a file, such as"):
        load(tmp_path)


def test_byte_order_mark_and_crlf_are_fine(tmp_path):
    path = tmp_path / "pile.toml"
    path.write_bytes(b"\xef\xbb\xbf[ice]\r\ndensity = 900\r\n")
    assert load(path).ice.density == 900.0


def test_standard_input(monkeypatch):
    monkeypatch.setattr("sys.stdin", io.StringIO("[ice]\ndensity = 900\n"))
    assert load("-").ice.density == 900.0
    monkeypatch.setattr("sys.stdin", io.StringIO("\n[ice]\ndensity = 0\n"))
    with pytest.raises(CaseError, match="^<stdin>:3: ice.density = 0: must be greater than 0$"):
        load("-")


def test_standard_input_in_bytes(monkeypatch):
    def given(content: bytes):
        monkeypatch.setattr("sys.stdin", io.TextIOWrapper(io.BytesIO(content), encoding="utf-8"))
        return load("-")

    assert given(b"\xef\xbb\xbf[ice]\ndensity = 900\n").ice.density == 900
    with pytest.raises(CaseError, match=r"^<stdin>: is not UTF-8 text \(byte 8\), so it is no case file$"):
        given(b"title = \xff")

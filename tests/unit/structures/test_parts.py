"""A structure of parts has one record, the sum of theirs, and one more for each of them."""

import json
from pathlib import Path

import h5py
import numpy as np
import pytest

from dilatedem.case.load import Source, build, load
from dilatedem.case.overrides import Override
from dilatedem.errors import CaseError
from dilatedem.results.load import load as results
from dilatedem.run import loop

CROWDED = Path(__file__).parents[2] / "cases" / "crowded.toml"
SUMMED = ["fx_N", "fy_N", "fz_N", "mx_Nm", "my_Nm", "mz_Nm", "contacts"]
JACKET = """
[[structure]]
kind = "parts"
name = "jacket"
friction = 0.2
elastic_modulus = 1e11
[[structure.part]]
kind = "brace"
name = "leg_a"
from = [0.5, 2.5, -20.0]
to = [2.5, 2.0, 5.0]
radius = 0.6
[[structure.part]]
kind = "brace"
name = "leg_b"
from = [0.5, -2.5, -20.0]
to = [2.5, -2.0, 5.0]
radius = 0.6
friction = 0.3
[[structure.part]]
kind = "box"
name = "fender"
center = [2.0, 0.0]
size = [1.0, 1.5]
"""


def jacket(extra: str = "", *overrides: tuple[str, object]):
    """Its case in the ice of `crowded.toml`, for six seconds."""
    text = CROWDED.read_text(encoding="utf-8")
    before, rest = text.split("[[structure]]")
    case = before + rest[rest.index("[time]") :] + JACKET + extra
    settings = [("time.duration", 6.0), ("output.track", []), *overrides]
    return build(Source("jacket.toml", case), [Override(key, value, f"--set {key}") for key, value in settings])


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """Run folder of the jacket."""
    return loop.run(jacket(), tmp_path_factory.mktemp("parts") / "run", quiet=True)


def test_the_whole_bears_the_sum_of_its_parts_in_every_window(run):
    forces = results(run).forces
    whole = forces[forces.structure == "jacket"]
    parts = [forces[forces.structure == f"jacket/{name}"] for name in ("leg_a", "leg_b", "fender")]
    assert len(whole) == 120 and sum((part.fh_max_N.max() > 1e3) for part in parts) >= 2
    for column in SUMMED:
        total = sum(part[column].to_numpy() for part in parts)
        largest = max(np.abs(part[column]).max() for part in parts)
        np.testing.assert_allclose(whole[column].to_numpy(), total, rtol=0.0, atol=1e-6 * largest, err_msg=column)
    assert list(forces.structure[:4]) == ["jacket", "jacket/leg_a", "jacket/leg_b", "jacket/fender"]


def test_the_highest_load_of_the_whole_is_of_one_step_and_no_sum_of_highest_loads(run):
    forces = results(run).forces
    whole, parts = forces[forces.structure == "jacket"], forces[forces.structure != "jacket"]
    sums = parts.groupby("time_s").fh_max_N.sum().to_numpy()
    highest = parts.groupby("time_s").fh_max_N.max().to_numpy()
    assert (whole.fh_max_N.to_numpy() <= sums * (1.0 + 1e-6)).all() and (whole.fh_max_N.to_numpy() < 0.99 * sums).any()
    assert whole.fh_max_N.max() >= 0.3 * highest.max()


def test_its_files_are_complete(run):
    told = results(run)
    assert list(told.summary["loads"]) == ["jacket", "jacket/leg_a", "jacket/leg_b", "jacket/fender"]
    assert set(told.load_map_names) == {"jacket/leg_a", "jacket/leg_b", "jacket/fender"}
    assert float(told.load_map("jacket/leg_a").impulse_Ns.sum()) > 0.0
    with h5py.File(run / "run.h5") as file:
        assert file["structures/jacket/outline_m"].shape == (0, 2)
        assert len(file["structures/jacket/leg_a/outline_m"]) > 30
    from dilatedem.post import post

    post([run])
    drawn = {path.name for path in (run / "figures").iterdir()}
    assert {"force_jacket.png", "force_jacket_leg_a.png", "load_around_jacket_leg_b.png", "load_map_jacket_leg_a.png"} <= drawn
    page = (run / "report.html").read_text(encoding="utf-8")
    assert page.index("jacket/leg_a") < page.index("jacket/leg_b") < page.index("jacket/fender")


def test_the_case_as_run_repeats_it(run, tmp_path):
    case = load(run / "case.toml")
    assert case == jacket()
    again = loop.run(case, tmp_path / "again", quiet=True)
    assert (again / "forces.csv").read_bytes() == (run / "forces.csv").read_bytes()


def test_parts_have_what_their_structure_has_unless_they_have_their_own():
    (whole,) = jacket().structure
    assert [part.friction for part in whole.part] == [0.2, 0.3, 0.2]
    assert {part.elastic_modulus for part in whole.part} == {1e11}
    np.testing.assert_allclose(whole.place, [0.5 * (2.0 + 2.1), 0.0, 0.0], atol=1e-9)


def test_keys_of_parts_can_be_set_by_name():
    (whole,) = jacket("", ("structure.jacket.part.leg_b.radius", 0.9)).structure
    assert [part.radius for part in whole.part[:2]] == [0.6, 0.9]


@pytest.mark.parametrize(
    ("more", "sentence"),
    [
        ('[[structure.part]]\nkind = "brace"\nname = "x"\nfrom = [0, 0, 0]\nto = [1, 0, 0]\nradius = -1.0\n',
         "structure.0.part.3.radius = -1.0: must be greater than 0"),
        ('[[structure.part]]\nkind = "brace"\nname = "x"\nform = [0, 0, 0]\nto = [1, 0, 0]\n',
         'structure.0.part.3.form: unknown key; did you mean "from"?'),
        ('[[structure.part]]\nkind = "pile"\nname = "leg_a"\n',
         'structure.0.part.3.name = "leg_a": is the name of part.0 too; give each part one of its own'),
        ('[[structure.part]]\nkind = "parts"\n', 'structure.0.part.3.kind = "parts": must be "pile"'),
        ('[[structure.part]]\nname = "x"\n', 'structure.0.part.3.kind: is missing; it must be "pile"'),
    ],
    ids=["value", "key", "name", "nested", "kind"],
)  # fmt: skip
def test_faults_name_the_part_and_the_line(more, sentence):
    with pytest.raises(CaseError) as error:
        jacket(more)
    assert sentence in str(error.value) and str(error.value).startswith("jacket.toml:"), str(error.value)


def test_a_structure_without_parts_is_refused():
    with pytest.raises(CaseError, match=r"structure.0.part: is missing"):
        build(Source("x.toml", '[[structure]]\nkind = "parts"\n'))
    with pytest.raises(CaseError, match=r"structure.0.part: must be a list of tables, each under a header \[\[structure.part\]\]"):
        build(Source("x.toml", '[[structure]]\nkind = "parts"\n[structure.part]\nkind = "pile"\n'))


def test_the_summary_of_a_part_is_that_of_its_rows(run):
    loads = json.loads((run / "summary.json").read_text())["loads"]
    forces = results(run).forces
    for name, said in loads.items():
        assert said["fh_max_N"] == pytest.approx(forces[forces.structure == name].fh_max_N.max(), rel=1e-6)

"""What carries a structure: keys and messages, tables of time, the step that it needs, and the files of a run with structures that
move."""

import csv
import json
from xml.etree import ElementTree

import meshio
import numpy as np
import pytest

from dilatedem.case import write
from dilatedem.case.load import case_from, load
from dilatedem.errors import CaseError
from dilatedem.post import post
from dilatedem.post.read import open_run
from dilatedem.results.load import load as results
from dilatedem.run import loop
from dilatedem.run.advice import advice
from dilatedem.run.foretell import as_json, check
from dilatedem.run.simulation import Simulation
from dilatedem.structures.support import Driven, Sprung
from tests.unit.structures.test_box import toml

BEAM = {"kind": "modal", "length": 20.0, "mass_per_length": 1e3, "bending_stiffness": [1e10, 1e10]}
TABLE = [[0.0, 7.0, 2.0, 0.0], [1.0, 7.0, 2.0, 0.0], [2.0, 5.5, 2.0, 0.3], [4.0, 5.0, 1.0, 0.3]]


def case_with(support: dict, kind: str = "pile", part: list[dict] | None = None, **more):
    own = {"point": [8.0, 0.0, 0.0], "normal": [-1.0, 0.0, 0.0]} if kind == "plane" else {"part": part} if part else {}
    return case_from({"structure": [{"kind": kind, "support": support, **own}], **more}, {})


@pytest.mark.parametrize(("support", "said"), [
    ({"kind": "spring"}, 'support.kind = "spring": must be "held", "driven", "sprung" or "modal"; did you mean "sprung"?'),
    ({}, 'structure.0.support.kind: is missing; it must be "held", "driven", "sprung" or "modal"'),
    ({"kind": "sprung", "stiffness": [1.0, 1.0]}, "structure.0.support.mass: is missing"),
    ({"kind": "sprung", "mass": 1.0, "stiffnes": [1.0, 1.0]}, 'support.stiffnes: unknown key; did you mean "stiffness"?'),
    ({"kind": "sprung", "mass": 1.0, "stiffness": [1.0, -1.0]}, "structure.0.support.stiffness.1 = -1.0: must be at least 0"),
    ({"kind": "sprung", "mass": 1.0, "stiffness": [1.0, 1.0], "damping": [0.0, 0.0], "damping_ratio": 0.1},
     "structure.0.support.damping = [0.0, 0.0]: give either damping_ratio or damping, not both"),
    ({"kind": "sprung", "mass": 1.0, "stiffness": [1.0, 1.0], "stiffness_yaw": 1.0},
     "structure.0.support.stiffness_yaw = 1.0: needs inertia beside it"),
    ({"kind": "driven", "velocity": [1.0, 0.0], "table": TABLE},
     "structure.0.support.velocity = [1.0, 0.0]: give either velocity and turning or a table of time, not both"),
    ({"kind": "driven", "table": TABLE[::-1]}, "times must grow from row to row"),
    ({"kind": "driven", "file": "nowhere.csv"}, "structure.0.support.file: nowhere.csv: no such file"),
    ({"kind": "modal", "length": 20.0, "mass_per_length": 1e3}, "structure.0.support.bending_stiffness: is missing"),
    (BEAM | {"modes": 21}, "structure.0.support.modes = 21: must be at most 20"),
    (BEAM | {"push_height": 0.5}, "structure.0.support.push_height = 0.5: must be above -20 m, the foot, and up to 0 m, the top"),
    (BEAM | {"soil_stiffness": 0.1}, "structure.0.support.soil_stiffness = 0.1: the soil hardly holds it"),
])  # fmt: skip
def test_what_is_wrong_is_said(support, said):
    with pytest.raises(CaseError) as fault:
        case_with(support)
    assert said in str(fault.value)


def test_a_beam_says_how_fast_it_swings():
    """1.8751^2/(2 pi L^2) sqrt(EI/m) and 4.6941^2 likewise, and the share of the static displacement that two modes have."""
    few = {"floe_count": 4, "concentration": 0.3}
    simulation = Simulation.of_case(case_with(BEAM | {"modes": 2}, time={"step": 1e-4}, field=few))
    told = simulation.scene.structures[0].support.remarks(simulation.dt)
    assert list(told) == ["along x", "along y"]
    assert told["along x"].startswith("4.424, 27.72 Hz; 361 time steps in a period of the fastest; 99.54 % of the displacement")
    facts = check(simulation.case)
    assert facts['modes of "pile" along y'] == told["along y"] and as_json(facts)["modes_of_pile_along_y"] == told["along y"]


def test_nothing_can_carry_a_plane():
    driven = {"kind": "driven", "velocity": [1.0, 0.0]}
    with pytest.raises(CaseError, match=r'structure.0.support.kind = "driven": must be "held": a plane has no end'):
        case_with(driven, "plane")
    parts = [{"kind": "pile"}, {"kind": "plane", "point": [8.0, 0.0, 0.0], "normal": [-1.0, 0.0, 0.0]}]
    with pytest.raises(CaseError, match=r'structure.0.part.1.kind = "plane": must not be "plane" in a structure that moves'):
        case_with(driven, "parts", part=parts)


def test_parts_move_with_their_structure_alone():
    said = r'structure.0.part.0.support.kind = "driven": must be "held": parts move with their structure; give the support to that'
    with pytest.raises(CaseError, match=said):
        case_with({"kind": "held"}, "parts", part=[{"kind": "pile", "support": {"kind": "driven", "velocity": [1.0, 0.0]}}])
    said = r'structure.0.part.0.support.kind = "sprong": must be "held", "driven", "sprung" or "modal"'
    with pytest.raises(CaseError, match=said):
        case_with({"kind": "held"}, "parts", part=[{"kind": "pile", "support": {"kind": "sprong"}}])


def test_a_case_is_written_with_its_supports_and_read_again():
    for support in (
        {"kind": "held"}, {"kind": "driven", "turning": 0.1}, {"kind": "sprung", "mass": 5e5, "stiffness": [1e8, 0.0]},
        {"kind": "driven", "table": TABLE},
    ):  # fmt: skip
        case = case_with(support)
        text = write.dump(case)
        assert "[structure.support]\n" in text
        assert load_text(text) == case
    assert "damping_ratio = 0.02\n" in write.dump(case_with({"kind": "sprung", "mass": 5e5, "stiffness": [1e8, 0.0]}))
    changed = load("cases/pile.toml", ["structure.pile.support={kind='sprung', mass=1e5, stiffness=[1e6, 1e6]}",
                                       "structure.pile.support.mass=2e5"])  # fmt: skip
    assert changed.structure[0].support.mass == 2e5


def load_text(text: str):
    from dilatedem.case.load import Source, build

    return build(Source("case", text))


def test_a_table_lies_beside_its_case_and_goes_into_it(tmp_path):
    rows = [["yaw_rad", "time_s", "x_m", "y_m"], *([yaw, time, x, y] for time, x, y, yaw in TABLE)]
    with (tmp_path / "way.csv").open("w", newline="") as file:
        csv.writer(file).writerows(rows)
    (tmp_path / "case.toml").write_text('[[structure]]\nkind = "pile"\nsupport = {kind = "driven", file = "way.csv"}\n')
    case = load(tmp_path / "case.toml")
    assert case.structure[0].support.table == TABLE
    (tmp_path / "way.csv").unlink()
    assert load_text(write.dump(case)) == case, "the run is repeated without the file"
    (tmp_path / "way.csv").write_text("time_s,x_m\n0,1\n")
    with pytest.raises(CaseError, match=r"must begin with a line that names the columns time_s, x_m, y_m, yaw_rad"):
        load(tmp_path / "case.toml")
    (tmp_path / "way.csv").write_text("time_s,x_m,y_m,yaw_rad\n0,1,2,3\n1,1,two,3\n")
    with pytest.raises(CaseError, match=r"way.csv:3: must hold a number for each of"):
        load(tmp_path / "case.toml")


def test_motion_is_smooth_starts_at_the_place_and_never_overshoots():
    way = Driven(kind="driven", table=TABLE).carriage()
    times = np.linspace(-1.0, 6.0, 7001)
    place, rate = way.at(times)
    assert way.at(np.zeros(1))[0][0].tolist() == [0.0, 0.0, 0.0]
    rows = np.array(TABLE)
    assert way.at(rows[:, 0])[0] == pytest.approx(rows[:, 1:] - rows[0, 1:], abs=1e-12)
    assert np.abs(np.diff(rate, axis=0)).max() < 0.02, "no jump of the velocity"
    steepest = np.abs(np.diff(rate, axis=0)).max()  # what a difference may be off by at a row, where the acceleration jumps
    assert np.gradient(place[:, 0], times)[1:-1] == pytest.approx(rate[1:-1, 0], abs=steepest)
    assert np.abs(place[(times >= 0.0) & (times <= 1.0)]).max() == 0.0, "it stands still where the table does"
    inside = (times >= 0.0) & (times <= 4.0)
    assert place[inside].min(axis=0) == pytest.approx([-2.0, -1.0, 0.0])
    assert place[inside].max(axis=0) == pytest.approx([0.0, 0.0, 0.3])


def test_damping_is_a_share_of_the_critical_one():
    carriage = Sprung(kind="sprung", mass=4.0, stiffness=(9.0, 0.0), damping_ratio=0.5, inertia=2.0, stiffness_yaw=8.0).carriage()
    assert carriage.damping.tolist() == [6.0, 0.0, 4.0]
    assert carriage.inverse_mass.tolist() == [0.25, 0.25, 0.5]


def test_the_critical_step_knows_supports():
    body = [{"vertices": [[0.0, 0.0, 0.0]], "dilated_radius": 0.5, "position": [0.0, 0.0, 0.0]}]
    still = {"field": {"source": "bodies"}, "body": body, "gravity": {"acceleration": 0.0}}
    stiff = {"kind": "sprung", "mass": 1e3, "stiffness": [1e13, 0.0], "damping_ratio": 0.0}
    held, sprung = (Simulation.of_case(case_with(support, **still)) for support in ({"kind": "held"}, stiff))
    assert sprung.critical == pytest.approx(2.0 / np.sqrt(1e10), rel=1e-12) and held.critical > 5 * sprung.critical
    light = Simulation.of_case(case_with({"kind": "sprung", "mass": 1.0, "stiffness": [0.0, 0.0]}, **still))
    assert light.critical < 0.2 * held.critical, "a light structure gives way faster than the body"
    fast = Simulation.of_case(case_with({"kind": "driven", "velocity": [3e3, 0.0]}, **still))
    assert fast.critical < held.critical


def test_advice_on_ways_that_are_hardly_meant():
    def said(support: dict, **more) -> str:
        simulation = Simulation.of_case(case_with(support, time={"duration": 50.0}, **more))
        return " ".join(advice(simulation.case, simulation.scene, simulation.model, simulation.state.bodies, share=0.1))

    field = {"field": {"floe_count": 4, "concentration": 0.3}, "water": {"velocity": [0.0, 0.0]}}
    assert 'structure "pile" is driven out of the domain across x = -25 m at t = 37' in said(
        {"kind": "driven", "velocity": [-1.0, 0.0]}, **field)  # fmt: skip
    around = said({"kind": "driven", "velocity": [0.0, 1.0]}, domain={"y_boundary": "periodic"}, **field)
    assert "is driven 50 m along y, where the domain repeats after 50 m" in around
    assert "driven" not in said({"kind": "driven", "velocity": [0.1, 0.0]}, **field)
    assert "driven" not in said({"kind": "sprung", "mass": 1e5, "stiffness": [1e6, 1e6]}, **field)


STRUCTURES = [
    {"kind": "pile", "name": "soft", "center": [2.0, -2.0], "radius": 0.6,
     "support": {"kind": "sprung", "mass": 2e3, "stiffness": [1e6, 1e6]}},
    {"kind": "parts", "name": "bow", "support": {"kind": "driven", "table": TABLE},
     "part": [{"kind": "box", "name": "stem", "center": [3.5, 2.0], "size": [1.6, 1.0]}]},
    {"kind": "pile", "name": "fast", "center": [-1.0, 4.5], "radius": 0.4},
]  # fmt: skip


@pytest.fixture(scope="module")
def moved(tmp_path_factory):
    """Run folder of the crowded case with three structures: on springs, driven, of a part, and held."""
    settings = ["time.duration=2.0", "time.error_check=true", "field.floe_count=70", "output.snapshot_interval=0.5"]
    settings.append(f"structure=[{', '.join(map(inline, STRUCTURES))}]")
    return loop.run(load("tests/cases/crowded.toml", settings), tmp_path_factory.mktemp("moved") / "run", quiet=True)


def inline(structure: dict) -> str:
    support = structure.get("support", {"kind": "held"})
    plain = {name: value for name, value in structure.items() if name != "support"}
    part = f", part = [{', '.join(map(toml, plain.pop('part')))}]" if "part" in plain else ""
    return f"{toml(plain)[:-1]}{part}, support = {toml(support)}}}"


def test_files_of_a_run_with_structures_that_move(moved):
    table = results(moved).structures
    columns = ["time_s", "structure", "x_m", "y_m", "yaw_rad", "vx_m_s", "vy_m_s", "reaction_x_N", "reaction_y_N"]
    assert list(table.columns) == columns
    assert list(dict.fromkeys(table.structure)) == ["soft", "bow"]
    soft, bow = (table[table.structure == name] for name in ("soft", "bow"))
    place, rate = Driven(kind="driven", table=TABLE).carriage().at(bow.time_s.to_numpy())
    assert bow[["x_m", "y_m", "yaw_rad"]].to_numpy() == pytest.approx(place, abs=1e-8)
    assert bow[["vx_m_s", "vy_m_s"]].to_numpy() == pytest.approx(rate[:, :2], abs=1e-8)
    damping = 2.0 * 0.02 * np.sqrt(1e6 * 2e3)
    assert soft.reaction_x_N.to_numpy() == pytest.approx((1e6 * soft.x_m + damping * soft.vx_m_s).to_numpy(), rel=1e-6, abs=1e-3)
    summary = json.loads((moved / "summary.json").read_text())
    assert summary["error_check"]["reproduced"], "a copy of the state holds how structures move"
    assert set(summary["motion"]) == {"soft", "bow"} and summary["energy"]["work_structure_J"] != 0.0
    assert summary["motion"]["soft"]["displacement_max_m"] == pytest.approx(np.hypot(soft.x_m, soft.y_m).max(), rel=1e-6)
    energy = results(moved).energy
    assert {"structure_kinetic", "structure_elastic", "loss_support"} <= set(energy)
    assert energy.residual.abs().max() < 1e-3 * summary["energy"]["turned_over_J"]


def test_structures_move_in_paraview_and_in_plan(moved):
    files = [entry.get("file") for entry in ElementTree.parse(moved / "structures.pvd").iter("DataSet")]
    assert files == [f"snapshots/structures_{number:06d}.vtu" for number in range(5)]
    first, last = meshio.read(moved / files[0]), meshio.read(moved / files[-1])
    assert sorted(np.concatenate(last.cell_data["structure"]).tolist()) == [0, 2]
    assert np.concatenate(last.cell_data["displacement"])[:, 0].min() == pytest.approx(-1.5, abs=1e-6)
    # the bow has 8 corners, and stands before the pile's 128
    middles = [mesh.points[:8].mean(axis=0) for mesh in (first, last)]
    assert middles[1] - middles[0] == pytest.approx([-1.5, 0.0, 0.0], abs=1e-6)
    assert len(meshio.read(moved / "structures.vtu").cells) == 1, "what is held stands still there, once"
    post([moved])
    assert {"motion_soft.png", "motion_bow.png", "plan.png"} <= {path.name for path in (moved / "figures").iterdir()}
    assert "largest displacement" in (moved / "report.html").read_text()
    outlines = open_run(moved).outlines_at(2.0)
    x, y = outlines["bow/stem"].outline.mean(axis=0)
    assert (x, y) == pytest.approx((3.5 - 1.5, 2.0), abs=1e-6)
    side = outlines["bow/stem"].outline[1] - outlines["bow/stem"].outline[2]
    assert np.arctan2(-side[0], side[1]) == pytest.approx(0.3, abs=1e-6), "turned by the table's yaw"

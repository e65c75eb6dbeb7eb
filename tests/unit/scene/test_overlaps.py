"""Bodies that start in each other: found without kernels, as deep as the kernels find them, named before anything is written."""

import numpy as np
import pytest
from typer.testing import CliRunner

from dilatedem.cli import app
from dilatedem.errors import CaseError
from dilatedem.run.simulation import Simulation
from dilatedem.scene.overlaps import MOST_FOUND, TOUCHING, overlaps

SQUARE = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
PILE = {"kind": "pile", "center": [0.0, 0.0], "radius": 2.0}
BALL = {"vertices": [[0.0, 0.0, 0.0]], "dilated_radius": 0.5}


def floe(x: float, y: float, **more) -> dict:
    """A square floe of 2 m around a place."""
    return {"outline": [[x + a, y + b] for a, b in SQUARE], **more}


def case(*bodies: dict, **tables) -> dict:
    tables = {"domain": {"size": [30.0, 30.0]}, "field": {"source": "bodies"}, **tables}
    return {**tables, "body": list(bodies)}


def found(data: dict) -> list[tuple[int, int, float, bool]]:
    simulation = Simulation.from_case(data)
    seen = overlaps(simulation.scene, simulation.model, simulation.state.bodies)
    return sorted((overlap.a, overlap.b, round(overlap.depth, 6), overlap.seam) for overlap in seen)


def refused(data: dict) -> list[str]:
    with pytest.raises(CaseError) as caught:
        Simulation.from_case(data).require_apart()
    return str(caught.value).splitlines()


@pytest.mark.parametrize("offset", [1.9, 1.5, 0.5, 0.0])
def test_two_floes(offset):
    # at no offset at all the shortest way apart is up: 0.5 m
    assert found(case(floe(0, 0), floe(offset, 0))) == [(0, 1, round(min(2.0 - offset, 0.5), 6), False)]


def test_floes_that_touch():
    radius = 0.04
    for gap, seen in ((1e-3, 0), (0.0, 0), (-0.9 * TOUCHING * radius, 0), (-1.1 * TOUCHING * radius, 1)):
        assert len(found(case(floe(0, 0), floe(2.0 + gap, 0)))) == seen


def test_floes_one_above_the_other():
    upper = floe(0.5, 0.5, position=[0.5, 0.5, 0.6])
    lower = floe(0.0, 0.0, position=[0.0, 0.0, 0.0])
    assert found(case(lower, upper)) == []
    assert found(case(lower, upper | {"position": [0.5, 0.5, 0.45]})) == [(0, 1, 0.05, False)]


def test_across_a_seam_and_over_its_corner():
    domain = {"size": [30.0, 30.0], "x_boundary": "periodic", "y_boundary": "periodic"}
    assert found(case(floe(14.5, 3), floe(-14.5, 3), domain=domain)) == [(0, 1, 0.5, True)]  # 1 m of width, 0.5 m of thickness
    assert found(case(floe(14.5, 14.5), floe(-14.2, -14.2), domain=domain)) == [(0, 1, 0.5, True)]
    assert found(case(floe(13.5, 3), floe(-13.9, 3), domain=domain)) == []
    # a body may be drawn periods away from the domain
    assert found(case(floe(3.0, 3.0), floe(64.8, -57.0), domain=domain)) == [(0, 1, 0.2, False)]


def test_in_structures_walls_and_fixed_bodies():
    domain = {"size": [30.0, 30.0], "x_boundary": "wall"}
    held = [floe(-8, 8, fixed=True), floe(-8, 9.9), floe(5, 8, fixed=True)]
    bodies = [floe(-2.5, 0), floe(17, 4), floe(14.2, -4), *held, floe(2, -8)]
    box = {"kind": "box", "name": "box", "center": [3.5, -8.0], "size": [4.0, 4.0]}
    lines = refused(case(*bodies, domain=domain, structure=[PILE, box]))
    told = "5 pairs of bodies overlap at t = 0 and would be thrown apart; move them apart, or leave one of each pair out:"
    assert lines[0] == told
    assert lines[1:] == [
        '  body 0 at (-2.50, 0.00) and structure "pile", by 0.5 m',
        '  body 1 at (17.00, 4.00) and structure "wall_x_max", by 3 m',
        '  body 2 at (14.20, -4.00) and structure "wall_x_max", by 0.2 m',
        "  body 3 at (-8.00, 8.00) and body 4 at (-8.00, 9.90), by 0.1 m",
        '  body 6 at (2.00, -8.00) and structure "box", by 1.5 m',
    ]


def test_a_pile_across_a_seam():
    domain = {"size": [30.0, 30.0], "y_boundary": "periodic"}
    pile = PILE | {"center": [0.0, 14.0]}
    assert found(case(floe(0.0, -14.5), domain=domain, structure=[pile])) == [(0, 1, 1.5, True)]


def test_what_is_held_may_stand_in_what_is_held():
    assert found(case(floe(0, 0, fixed=True), floe(0.5, 0, fixed=True), floe(9, 9), structure=[PILE])) == []


def test_floes_born_in_a_level_plane():
    bed = {"kind": "plane", "point": [0.0, 0.0, -0.2], "normal": [0.0, 0.0, 1.0]}
    data = {"domain": {"size": [30.0, 30.0]}, "field": {"floe_count": 20}, "structure": [bed]}
    lines = refused(data)
    assert lines[0].startswith("20 pairs of bodies overlap at t = 0")
    assert len(lines) == 12 and lines[-1] == "  ..."


def test_generated_floes_keep_clear_of_bodies_and_structures():
    field = {"floe_count": 400, "concentration": 0.9}
    data = case(floe(-6, 0), BALL | {"position": [6.0, 6.0, 0.0]}, structure=[PILE], field=field)
    simulation = Simulation.from_case(data)
    assert simulation.scene.field.left_out > 10
    assert found(data) == []


def test_a_case_that_is_wrong_as_a_whole_is_told_soon():
    lines = refused(case(*[BALL] * 60))
    assert lines[0].startswith(f"more than {MOST_FOUND} pairs of bodies overlap")
    assert lines[1] == "  body 0 at (0.00, 0.00) and body 1 at (0.00, 0.00), by 1 m"


def test_one_pair_is_one():
    assert refused(case(floe(0, 0), floe(1.8, 0)))[0].startswith("1 pair of bodies overlaps at t = 0 and would be thrown apart")


def test_as_deep_as_the_first_step_finds_them():
    rng = np.random.default_rng(5)
    shapes = [
        {"vertices": rng.normal(size=(8, 3)).tolist(), "dilated_radius": 0.3},
        {"vertices": [[-0.6, 0.0, 0.0], [0.6, 0.0, 0.0]], "dilated_radius": 0.4},
        BALL,
        {"vertices": [[-0.8, -0.8, 0.0], [0.8, -0.8, 0.0], [0.0, 0.9, 0.0]], "dilated_radius": 0.2},
    ]
    poses = [(rng.uniform(-7, 7, 3) * [1.0, 1.0, 0.5], rng.uniform(-2, 2, 3)) for _ in range(60)]
    bodies = [{**shapes[i % 4], "position": at.tolist(), "rotation": turn.tolist()} for i, (at, turn) in enumerate(poses)]
    domain = {"size": [14.0, 14.0], "x_boundary": "periodic", "y_boundary": "periodic"}
    plane = {"kind": "plane", "point": [0.0, 0.0, -4.0], "normal": [0.1, 0.2, 1.0]}
    structures = [plane, PILE | {"radius": 1.0}]
    simulation = Simulation.from_case(case(*bodies, domain=domain, structure=structures, water={"enabled": False}))
    found = overlaps(simulation.scene, simulation.model, simulation.state.bodies)
    seen = {(overlap.a, overlap.b): overlap.depth for overlap in found}
    simulation.evaluate()
    pairs, radius = simulation.state.pairs, simulation.model.shapes.radius
    expected = {}
    for k in range(pairs.count[0]):
        a, b = int(pairs.a[k]), int(pairs.b[k])
        smaller = min(radius[a], radius[b]) if radius[b] > 0.0 else radius[a]
        if pairs.overlap[k] > TOUCHING * smaller:
            expected[a, b] = pairs.overlap[k]
    assert len(expected) > 15
    assert seen == pytest.approx(expected, rel=1e-6)
    assert any(overlap.seam for overlap in found)


@pytest.mark.parametrize("command", ["check", "run"])
def test_commands_end_before_anything_is_written(tmp_path, monkeypatch, command):
    monkeypatch.chdir(tmp_path)
    text = '[field]\nsource = "bodies"\n' + "".join(f"[[body]]\noutline = {floe(x, 0)['outline']}\n" for x in (0, 1.9))
    (tmp_path / "case.toml").write_text(text)
    result = CliRunner().invoke(app, [command, "case.toml"])
    assert (result.exit_code, result.stdout) == (2, "")
    assert result.stderr.splitlines()[1:] == ["  body 0 at (0.00, 0.00) and body 1 at (1.90, 0.00), by 0.1 m"]
    assert [path.name for path in tmp_path.iterdir()] == ["case.toml"]


@pytest.mark.parametrize("axis", [0, 1])
def test_a_body_longer_than_the_period(axis):
    outline = [[-12.0, -1.4], [12.0, -1.4], [12.0, 1.4], [-12.0, 1.4]]
    outline = [[x, y] if axis == 0 else [-y, x] for x, y in outline]
    name = "xy"[axis]
    for size, fits in ((20.0, False), (24.1, False), (24.5, True)):
        data = case({"outline": outline}, domain={"size": [size, size], f"{name}_boundary": "periodic"})
        if fits:
            Simulation.from_case(data).require_apart()
            continue
        with pytest.raises(CaseError, match=rf"^domain.size.{axis} = {size:g}: .*body 0, 24.2 m across, could meet its own image$"):
            Simulation.from_case(data)

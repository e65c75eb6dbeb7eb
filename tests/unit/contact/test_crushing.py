"""Ice that crushes: what it bears is never exceeded, what has crushed stays so, and the ledger knows what it cost."""

from functools import partial

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from dilatedem.contact.crushing.depth import CLOSE, GONE
from dilatedem.run.simulation import Simulation
from dilatedem.state.clock import Status
from dilatedem.state.pairs import packed, unpacked
from dilatedem.state.storage import MOST_CORNERS
from tests.kernels import area_of_pair, distance_of_pair
from validation.contact_lab import tilts
from validation.contact_lab.probe import Poses, Probe
from validation.contact_lab.scenes import FLOE, HALF_FLOE, PILE, PILE_RADIUS, scene

PRESSURE, SPEED = 2e6, 0.3
#: contact model, damping law, damping
KINDS = [("liu2015", "viscous", 0.0), ("liu2015", "viscous", 0.36), ("consistent", "viscous", 0.0), ("consistent", "viscous", 0.36),
         ("consistent", "touch", 0.36)]  # fmt: skip
#: attitude of the floe, and how far beside the pile's axis it hits [m]
HITS = {
    "side": (Rotation.identity(), 0.0),
    "corner": (Rotation.from_euler("z", 45.0, degrees=True), 0.0),
    "oblique": (Rotation.from_euler("z", 12.0, degrees=True), 0.8),
    "vertex": (Rotation.from_euler("zy", [50.0, 25.0], degrees=True), 0.1),
}
#: m, from the pile at the start, of the outermost corner's sphere
START = 0.002


def floe(turn: Rotation, aside: float) -> dict:
    """Just off the pile, on its -x side."""
    core = turn.apply([[x, y, z] for x in (-1.36, 1.36) for y in (-1.36, 1.36) for z in (-0.21, 0.21)])
    core[:, 1] += aside
    ends = tilts.seat_on_column(core[None, :, :2], PILE_RADIUS + 0.04 + START)
    return FLOE | {"position": [float(ends[0]), aside, 0.0], "rotation": turn.as_rotvec().tolist()}


def begin(kind: tuple, hit: str, speed: float = SPEED) -> Simulation:
    model, law, damping = kind
    case = scene(model, floe(*HITS[hit]), PILE, damping=damping, damping_law=law, speeds=(speed, 0.0), crushing=PRESSURE)
    simulation = Simulation.of_case(case)
    assert simulation.evaluate() == Status.DONE
    return simulation


def bearable(simulation: Simulation) -> float:
    """What the ice bears at the pose and the crushed depth of the one pair [N], by another evaluation."""
    shapes, bodies = simulation.model.shapes, simulation.state.bodies
    pairs = unpacked(packed(simulation.state.pairs), len(simulation.state.pairs.a))
    vertex, face_normal, scratch = shapes.vertex.copy(), shapes.face_normal.copy(), np.zeros((8, MOST_CORNERS, 3))
    _, normal, pa, pb, offset = distance_of_pair(
        shapes, simulation.model.surroundings, bodies, pairs, vertex, face_normal, 0
    )  # fmt: skip
    area, *_ = area_of_pair(shapes, pairs, vertex, face_normal, 0, offset, normal, pa, pb, float(pairs.crushed[0]), scratch)
    return PRESSURE * area


def until_off(simulation: Simulation, look=lambda simulation: None) -> list:
    """Advance until the floe has touched and come off; what `look` says of each step of the contact."""
    seen = []
    for _ in range(20_000):
        assert simulation.advance(1) == Status.DONE
        if simulation.contacts > 0:
            seen.append(look(simulation))
        elif seen:
            return seen
    raise AssertionError("the hit does not end")


def residual(simulation: Simulation, before: float) -> float:
    """What the ledger does not account for, over the kinetic energy before."""
    terms = simulation.energies()
    known = sum(terms[name] for name in ("kinetic", "elastic", "loss_damping", "loss_friction", "loss_crushing"))
    return (known - terms["gain_law"]) / before - 1.0


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: "-".join(map(str, kind)))
@pytest.mark.parametrize("hit", HITS)
def test_a_hit_bears_no_more_than_the_ice(kind, hit):
    simulation = begin(kind, hit)
    before = simulation.energies()["kinetic"]
    pairs = simulation.state.pairs
    found = until_off(simulation, lambda s: (float(pairs.normal_force[0]), bearable(s), float(pairs.crushed[0])))
    force, limit, crushed = np.array(found).T
    assert (force <= (1.0 + 1.5 * CLOSE) * limit).all()
    assert (np.diff(crushed) >= 0.0).all() and crushed[-1] > 1e-4
    # where it crushes it bears all of it, with whatever dashpot; in the last step the bodies may already part
    grows = np.flatnonzero(np.diff(crushed) > 0.0)[:-1] + 1
    assert force[grows] == pytest.approx(limit[grows], rel=1.5 * CLOSE)
    assert abs(residual(simulation, before)) < 1e-4


KIND = ("consistent", "viscous", 0.0)


def move(simulation: Simulation, position=None, turn: Rotation | None = None, velocity=(0.0, 0.0, 0.0)) -> None:
    """Put the floe elsewhere; its pair is looked at there."""
    bodies, pairs = simulation.state.bodies, simulation.state.pairs
    if position is not None:
        bodies.position[0] = position
    if turn is not None:
        bodies.orientation[0] = turn.as_quat(scalar_first=True)
    bodies.velocity[0], bodies.angular_velocity[0] = velocity, 0.0
    pairs.wake[0] = 0.0
    assert simulation.evaluate() == Status.DONE


def test_a_second_hit_at_the_same_place_finds_what_has_crushed():
    simulation = begin(KIND, "side")
    until_off(simulation)
    crushed, lost = float(simulation.state.pairs.crushed[0]), simulation.energies()["loss_crushing"]
    assert crushed > 1e-3
    move(simulation, velocity=(0.1, 0.0, 0.0))
    peak = max(until_off(simulation, lambda s: float(s.state.pairs.normal_force[0])))
    assert simulation.state.pairs.crushed[0] == crushed and simulation.energies()["loss_crushing"] == lost
    assert simulation.state.bodies.velocity[0, 0] == pytest.approx(-0.1, rel=1e-4)
    # as hard as one of a floe that bears everything
    assert 4e4 < peak < bearable(simulation)
    move(simulation, velocity=(SPEED, 0.0, 0.0))
    until_off(simulation)
    assert simulation.state.pairs.crushed[0] > 1.1 * crushed


def test_a_contact_forgets_where_it_has_gone():
    away = -(PILE_RADIUS + HALF_FLOE)
    for gap, left in ((0.01, 1.0), (0.9 * GONE, 1.0), (1.1 * GONE, 0.0)):
        simulation = begin(KIND, "side")
        until_off(simulation)
        crushed = float(simulation.state.pairs.crushed[0])
        move(simulation, [away - gap, 0.0, 0.0])
        assert simulation.state.pairs.crushed[0] == left * crushed


def test_another_side_of_the_floe_is_whole():
    fresh, simulation = begin(KIND, "side"), begin(KIND, "side")
    until_off(fresh)
    until_off(simulation)
    away = -(PILE_RADIUS + HALF_FLOE + START)
    move(simulation, [away, 0.0, 0.0], Rotation.from_euler("z", 90.0, degrees=True), (SPEED, 0.0, 0.0))
    assert simulation.state.pairs.crushed[0] == 0.0
    until_off(simulation)
    assert simulation.state.pairs.crushed[0] == pytest.approx(fresh.state.pairs.crushed[0], rel=1e-3)


def test_a_new_contact_is_looked_at_however_much_the_last_one_bore():
    simulation = begin(KIND, "side")
    until_off(simulation)
    assert simulation.state.pairs.bears[0] > 1e4
    turn, _ = HITS["corner"]
    move(simulation, floe(turn, 0.0)["position"], turn, (SPEED, 0.0, 0.0))
    pairs = simulation.state.pairs
    found = until_off(simulation, lambda s: (float(pairs.normal_force[0]), bearable(s)))
    assert all(force <= (1.0 + 1.5 * CLOSE) * limit for force, limit in found)


#: largest change left for a turn of tilts.FINEST: the crushed depth is found to CLOSE
CONTINUOUS = 4.0 * CLOSE


@pytest.mark.parametrize("fixed_height", [False, True])
@pytest.mark.parametrize("roll", tilts.ROLLS, ids=lambda roll: roll.name)
def test_force_and_moment_change_without_a_jump(roll, fixed_height):
    probe = Probe(scene("consistent", FLOE, roll.partner, crushing=PRESSURE))
    end = tilts.FIXED_HEIGHT_END if fixed_height else 0.5 * np.pi
    jumps = tilts.largest_jumps(
        probe, partial(roll.poses, probe, fixed_height=fixed_height), end, roll.roller, scan=1e-4 if fixed_height else 1e-3
    )
    assert max(jump.narrowed for jump in jumps) < CONTINUOUS


def test_ice_that_hardly_crushes_is_elastic():
    poses = []
    for turn in (0.0, 0.2, 5.0, 45.0):
        rotation = Rotation.from_euler("zy", [turn, 0.5 * turn], degrees=True)
        core = rotation.apply([[x, y, z] for x in (-1.36, 1.36) for y in (-1.36, 1.36) for z in (-0.21, 0.21)])
        poses.append((float(tilts.seat_on_column(core[None, :, :2], PILE_RADIUS + 0.04 - 5e-4)[0]), rotation))
    found = []
    for pressure in (None, 1e18):
        probe = Probe(scene("consistent", FLOE, PILE, crushing=pressure))
        turns = Rotation.concatenate([rotation for _, rotation in poses])
        answers = probe.at(
            Poses.at_rest(probe, len(poses)).moved(0, position=[[x, 0.0, 0.0] for x, _ in poses], rotation=turns)
        )
        found.append(answers)
    assert (found[0].strength > 1e3).all()
    assert found[1].force == pytest.approx(found[0].force, rel=1e-9, abs=1e-9 * found[0].strength.max())

"""The normal part of a contact: where the force acts, what damping adds to it, and what friction leans on."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from dilatedem.case.schema import Case
from dilatedem.contact.consistent.press import DEEPEST_SHARE
from dilatedem.geometry.polyhedron import convex_hull
from dilatedem.run.simulation import Simulation
from dilatedem.state.clock import Status
from tests.pair_in_place import PairInPlace

RADIUS, RATIO = 0.04, 0.7
CUBE = [[x, y, z] for x in (-0.5, 0.5) for y in (-0.3, 0.3) for z in (-0.2, 0.2)]
PLANE = {"kind": "plane", "point": [0.0, 0.0, 0.0], "normal": [0.0, 0.0, 1.0]}


def scene(*bodies: dict, plane=False, damping=0.0, damping_law="viscous", friction=0.0) -> Simulation:
    case = {
        "field": {"source": "bodies"},
        "water": {"enabled": False},
        "gravity": {"acceleration": 0.0},
        "contact": {
            "model": "consistent", "damping": damping, "damping_law": damping_law, "friction": friction, "stiffness_ratio": RATIO,
        },
        "structure": [PLANE] if plane else [],
        "body": list(bodies),
    }
    return Simulation.of_case(Case.model_validate(case))


def pressed(*bodies: dict, **contact):
    """The one contact of a scene at its start, as a dictionary, and the simulation."""
    simulation = scene(*bodies, **contact)
    assert simulation.evaluate() == Status.DONE
    pairs = simulation.state.pairs
    return {name: np.array(getattr(pairs, name)[0]) for name in pairs._fields if name != "frame"}, simulation


def modulus(simulation) -> float:
    return 1.0 / simulation.model.solids.compliance[:2].sum()


def ball(height: float, speed=0.0) -> dict:
    return {
        "vertices": [[0.0, 0.0, 0.0]], "dilated_radius": 0.2, "position": [0.0, 0.0, height], "velocity": [0.0, 0.0, -speed]
    }  # fmt: skip


@pytest.mark.parametrize("overlap", [1e-5, 1e-3])
@pytest.mark.parametrize("speed", [0.0, 0.2, -0.001])
@pytest.mark.parametrize("damping", [0.0, 0.36])
def test_force_of_a_ball_on_a_plane(overlap, speed, damping):
    # F = K d^(3/2) + c sqrt(m K) d^(1/4) d', c = sqrt(5) xi; the body's own mass against a plane that does not move
    found, simulation = pressed(ball(0.2 - overlap, speed), plane=True, damping=damping)
    K, mass = 4.0 / 3.0 * modulus(simulation) * np.sqrt(0.2), simulation.model.solids.mass[0]
    elastic = K * overlap**1.5
    viscous = np.sqrt(5.0) * damping * np.sqrt(mass * K) * overlap**0.25 * speed
    assert found["normal_force"] == pytest.approx(max(elastic + viscous, 0.0), rel=1e-6)
    assert found["stored"] == pytest.approx(0.4 * elastic * overlap, rel=1e-6)
    assert found["tangent"] == pytest.approx(1.5 * elastic / overlap, rel=1e-6)
    # against the mean of Hertz's stiffness, F/d times 5/4
    assert found["shear_stiffness"] == pytest.approx(RATIO * 1.25 * elastic / overlap, rel=1e-6)
    assert found["elastic_power"] == pytest.approx(elastic * speed, rel=1e-6, abs=1e-12)
    assert found["damping_power"] == pytest.approx((max(elastic + viscous, 0.0) - elastic) * speed, rel=1e-6, abs=1e-12)
    assert found["grip"] == 0.0


@pytest.mark.parametrize("overlap", [1e-9, 1e-5, 1e-3])
@pytest.mark.parametrize("speed", [0.0, 0.2, -0.001])
def test_force_of_a_dashpot_that_vanishes_at_touch(overlap, speed):
    # F = K d^(3/2) max(0, 1 + a v/sqrt(v^2 + 2 W/m)), a = 1.2579 for the damping 0.36
    found, simulation = pressed(ball(0.2 - overlap, speed), plane=True, damping=0.36, damping_law="touch")
    K, mass = 4.0 / 3.0 * modulus(simulation) * np.sqrt(0.2), simulation.model.solids.mass[0]
    elastic = K * overlap**1.5
    share = max(0.0, 1.0 + 1.2579 * speed / np.sqrt(speed**2 + 0.8 * elastic * overlap / mass))
    assert found["normal_force"] == pytest.approx(share * elastic, rel=1e-4)
    assert found["damping_power"] == pytest.approx((share - 1.0) * elastic * speed, rel=1e-3, abs=1e-12)
    assert found["damping_power"] >= 0.0


def test_a_force_never_pulls():
    found, _ = pressed(ball(0.2 - 1e-5, -5.0), plane=True, damping=0.36)
    assert found["normal_force"] == 0.0 and not found["force"].any()
    assert found["damping_power"] > 0.0  # the elastic energy that it does not give back


def block(overlap: float, tilt=(0.0, 0.0, 0.0), **more) -> dict:
    low = (Rotation.from_rotvec(tilt).apply(CUBE))[:, 2].min()
    return {
        "vertices": CUBE, "dilated_radius": RADIUS, "position": [0.0, 0.0, RADIUS - low - overlap], "rotation": list(tilt), **more
    }  # fmt: skip


def test_grip_of_a_flat_patch():
    found, _ = pressed(block(1e-4), plane=True)
    assert found["grip"] == pytest.approx(np.sqrt((1.0**2 + 0.6**2) / 12.0), rel=1e-6)
    assert found["size"] == pytest.approx(0.6, rel=1e-9)


def test_grip_of_a_line():
    # the lower edge of a block that stands on it
    found, _ = pressed(block(1e-4, (0.7, 0.0, 0.0)), plane=True)
    assert found["grip"] == pytest.approx(1.0 / np.sqrt(12.0), rel=0.05)


@pytest.mark.parametrize("tilt", [(0.0, 0.0, 0.0), (1e-4, -2e-4, 0.3), (5e-3, 2e-3, 0.0), (0.2, 0.1, 1.0), (0.6, -0.7, 0.0)])
def test_force_at_a_point_and_couple_are_the_wrench_of_the_energy(tilt):
    # a block over a larger one; what acts on the bodies is what the pose's energy says
    table = {"vertices": [[x, y, z] for x in (-2.0, 2.0) for y in (-2.0, 2.0) for z in (-0.3, 0.3)], "dilated_radius": RADIUS,
             "position": [0.0, 0.0, -0.3 - RADIUS]}  # fmt: skip
    found, simulation = pressed(table, block(2e-4, tilt))
    shapes = [np.array(simulation.model.shapes.vertex[s:e]) for s, e in ((0, 8), (8, 16))]
    pair = PairInPlace(*(convex_hull(vertices) for vertices in shapes))
    for body in range(2):
        w, x, y, z = simulation.state.bodies.orientation[body]
        pair.place(body, simulation.state.bodies.position[body], Rotation.from_quat([x, y, z, w]))
    expected = pair.press(modulus(simulation))
    size = np.linalg.norm(expected.force)
    assert found["force"] == pytest.approx(expected.force, abs=1e-6 * size)
    assert np.cross(found["point"], found["force"]) + found["couple"] == pytest.approx(expected.moment, abs=1e-6 * size)
    # the couple that no place of the force could give lies along it
    assert np.cross(found["couple"], found["force"]) == pytest.approx(np.zeros(3), abs=1e-6 * size**2)
    # between the bodies: half-way through the overlap
    assert abs(found["point"][2] - 0.3 - RADIUS) < 1e-3
    bodies = simulation.state.bodies
    assert bodies.contact_force[0] == pytest.approx(-bodies.contact_force[1], rel=1e-14)


@pytest.mark.parametrize("damping", [0.0, 0.36])
def test_rocking_meets_a_dashpot_that_cannot_lift_the_patch(damping):
    for spin in ((0.05, 0.0, 0.0), (0.0, 0.05, 0.0), (0.03, -0.05, 0.0), (3.0, 2.0, 0.0)):
        found, simulation = pressed(block(1e-4, angular_velocity=list(spin)), plane=True, damping=damping)
        # on the plane, the second body of the pair
        couple = found["couple"]
        if damping == 0.0:
            assert couple == pytest.approx(np.zeros(3), abs=1e-9 * found["normal_force"])
            continue
        assert couple @ spin > 0.0  # drags the plane along, and the block back
        assert abs(couple[2]) < 1e-12 * np.linalg.norm(couple)
        assert np.linalg.norm(couple) <= found["normal_force"] * found["grip"] * (1.0 + 1e-9)
        assert found["damping_power"] == pytest.approx(couple @ spin, rel=1e-6)
        if max(np.abs(spin)) > 1.0:
            assert np.linalg.norm(couple) == pytest.approx(found["normal_force"] * found["grip"], rel=1e-9)
    # turning about the normal is none of its business
    found, _ = pressed(block(1e-4, angular_velocity=[0.0, 0.0, 3.0]), plane=True, damping=damping)
    assert found["couple"] == pytest.approx(np.zeros(3), abs=1e-9 * found["normal_force"])


def test_a_plane_is_a_large_face():
    # of the same solid: the same force, once b's border is far away
    ice = {"elastic_modulus": 1e9, "poisson_ratio": 0.3}
    for tilt in ((0.0, 0.0, 0.0), (2e-4, 1e-4, 0.4), (0.3, 0.2, 0.0), (0.7, 0.0, 0.0)):
        case = {
            "field": {"source": "bodies"}, "water": {"enabled": False}, "gravity": {"acceleration": 0.0},
            "contact": {"model": "consistent"}, "structure": [PLANE | ice], "body": [block(1e-4, tilt)],
        }  # fmt: skip
        simulation = Simulation.of_case(Case.model_validate(case))
        assert simulation.evaluate() == Status.DONE
        table = {"vertices": [[x, y, z] for x in (-9.0, 9.0) for y in (-9.0, 9.0) for z in (-0.3, 0.3)],
                 "dilated_radius": RADIUS, "position": [0.0, 0.0, -0.3 - RADIUS]}  # fmt: skip
        found, _ = pressed(block(1e-4, tilt), table)
        on_plane = simulation.state.pairs.force[0]
        # where the rim is no wider than the dilation of b adds to the curve: it does not, over a face
        assert found["force"] == pytest.approx(on_plane, rel=2e-3, abs=2e-3 * np.linalg.norm(on_plane))


@pytest.mark.parametrize(("share", "status"), [(0.9, Status.DONE), (0.97, Status.TOO_DEEP), (1.3, Status.TOO_DEEP)])
def test_an_overlap_past_meaning_stops_the_run(share, status):
    # the force ends where the cores are about to touch: the run must not go on without it
    reach = 2.0 * RADIUS
    floor = {"vertices": [[x, y, z] for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-0.3, 0.3)], "dilated_radius": RADIUS,
             "position": [0.0, 0.0, -0.3 - RADIUS]}  # fmt: skip
    simulation = scene(floor, block(share * reach))
    assert simulation.evaluate() == status
    assert (share > DEEPEST_SHARE) == (status == Status.TOO_DEEP)
    if status == Status.DONE:
        assert simulation.state.pairs.normal_force[0] > 0.0

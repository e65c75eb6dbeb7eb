"""Loads of the water: buoyancy is the gradient of its energy, drag follows Liu 2015, Eqs. (26) and (27)."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from dilatedem.case.schema import Case
from dilatedem.run.simulation import Simulation
from tests.reference.cores import polygon
from tests.reference.submerged_hull import submerged

OUTLINE = polygon(7, 2.6, 2)
HULL = (np.random.default_rng(7).normal(size=(14, 3)) * [1.0, 0.8, 0.5]).tolist()


def afloat(body: dict, *, current=(0.0, 0.0), drag: float = 0.0) -> Simulation:
    case = {
        "field": {"source": "bodies"},
        "water": {"velocity": list(current), "drag_force_coefficient": drag, "drag_moment_coefficient": drag / 6},
        "body": [body],
    }
    return Simulation.of_case(Case.model_validate(case))


def put(simulation: Simulation, position, turn: Rotation) -> None:
    simulation.state.bodies.position[0] = position
    x, y, z, w = turn.as_quat()
    simulation.state.bodies.orientation[0] = w, x, y, z
    simulation.evaluate()


@pytest.mark.parametrize("body", [{"outline": OUTLINE.tolist()}, {"vertices": HULL, "dilated_radius": 0.05}], ids=["floe", "hull"])
@pytest.mark.parametrize("tilt", [0.0, 0.02, 0.3, 1.2, 2.8])
def test_buoyancy_is_the_gradient_of_its_energy(body, tilt):
    simulation = afloat(body)
    position = np.array([0.3, -0.2, -0.13])
    turn = Rotation.from_rotvec(tilt * np.array([0.6, 0.8, 0.0])) * Rotation.from_rotvec([0, 0, 0.4])

    def energy(shift, twist):
        put(simulation, position + shift, Rotation.from_rotvec(twist) * turn)
        found = simulation.energies()
        return found["gravity"] + found["buoyancy"]

    put(simulation, position, turn)
    force, torque = simulation.state.bodies.force[0].copy(), simulation.state.bodies.torque[0].copy()
    step, zero = 1e-5, np.zeros(3)
    gradient = np.array([[energy(sign * step * axis, zero) for sign in (1, -1)] for axis in np.eye(3)])
    twisting = np.array([[energy(zero, sign * step * axis) for sign in (1, -1)] for axis in np.eye(3)])
    weight = simulation.model.solids.mass[0] * 9.81
    assert force == pytest.approx(-(gradient[:, 0] - gradient[:, 1]) / (2 * step), abs=1e-6 * weight)
    assert torque == pytest.approx(-(twisting[:, 0] - twisting[:, 1]) / (2 * step), abs=1e-6 * weight)


@pytest.mark.parametrize("tilt", [0.0, 0.05, 0.8])
def test_drag(tilt):
    simulation = afloat({"outline": OUTLINE.tolist()}, current=(0.4, -0.1), drag=0.6)
    turn, position = Rotation.from_rotvec([tilt, 0.0, 0.0]), np.array([0.0, 0.0, -0.15])
    velocity, spin = np.array([0.1, 0.3, -0.2]), np.array([0.2, -0.1, 0.4])
    put(simulation, position, turn)
    still = simulation.state.bodies.force[0].copy(), simulation.state.bodies.torque[0].copy()
    simulation.state.bodies.velocity[0], simulation.state.bodies.angular_velocity[0] = velocity, spin
    # the two halves of `evaluate` predict the motion from the momentum: so much of it as the spin says
    inertia = simulation.model.solids.inertia[0]
    simulation.state.bodies.angular_momentum[0] = turn.as_matrix() @ inertia @ turn.as_matrix().T @ spin
    simulation.evaluate()
    outer = simulation.scene.shapes[0].outer
    _, _, wetted = submerged(outer, turn.as_matrix(), position[2])
    past = velocity - [0.4, -0.1, 0.0]
    at_rest = np.array([0.4, -0.1, 0.0])
    expected = -0.5 * 0.6 * 1025.0 * wetted * (np.linalg.norm(past) * past + np.linalg.norm(at_rest) * at_rest)
    assert simulation.state.bodies.force[0] - still[0] == pytest.approx(expected, rel=1e-9, abs=1e-9)
    size = np.linalg.norm(outer.vertices, axis=1).mean()
    brake = -0.5 * 0.1 * 1025.0 * wetted * size**3 * np.linalg.norm(spin) * spin
    assert simulation.state.bodies.torque[0] - still[1] == pytest.approx(brake, rel=1e-9, abs=1e-9)


def test_no_loads_above_the_water():
    simulation = afloat({"outline": OUTLINE.tolist()}, current=(0.4, 0.0), drag=0.6)
    put(simulation, [0.0, 0.0, 3.0], Rotation.from_rotvec([0.4, 0.0, 0.0]))
    weight = simulation.model.solids.mass[0] * 9.81
    assert simulation.state.bodies.force[0] == pytest.approx([0.0, 0.0, -weight])
    assert (simulation.state.bodies.torque[0] == 0.0).all()

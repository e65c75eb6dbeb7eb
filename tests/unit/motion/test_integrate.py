"""Motion of single bodies: second order, |L| kept, gravity exact, fixed bodies stay."""

import numpy as np
import pytest

from dilatedem.case.schema import Case
from dilatedem.numerics.frames import matrix_from_quaternion
from dilatedem.run.simulation import Simulation
from dilatedem.state.clock import Status

BOX = [[x, y, z] for x in (-1.4, 1.4) for y in (-0.7, 0.7) for z in (-0.25, 0.25)]


def simulation(step: float, body: dict, **tables) -> Simulation:
    case = {
        "field": {"source": "bodies"},
        "water": {"enabled": False},
        "gravity": {"acceleration": 0.0},
        "time": {"duration": 10.0, "step": step},
        "body": [{"vertices": BOX, "dilated_radius": 0.05, **body}],
    }
    made = Simulation.of_case(Case.model_validate(case | tables))
    made.span = 1  # the plain scheme: idle bodies take the step of the case, too
    assert made.evaluate() == Status.DONE
    return made


def turned_by(first: np.ndarray, second: np.ndarray) -> float:
    """Angle [rad] between two orientations."""
    # by the chord: the cosine cannot tell small angles apart
    return float(4 * np.arcsin(0.5 * min(np.linalg.norm(first - second), np.linalg.norm(first + second))))


def after(duration: float, step: float, **body) -> Simulation:
    made = simulation(step, body)
    assert made.advance(round(duration / step)) == Status.DONE
    return made


def test_rotation_is_second_order():
    spin = {"angular_velocity": [0.3, 1.0, 0.5]}
    exact = after(2.0, 1e-5, **spin).state.bodies.orientation[0]
    errors = [turned_by(after(2.0, step, **spin).state.bodies.orientation[0], exact) for step in (4e-4, 2e-4, 1e-4)]
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.1)
    assert errors[1] / errors[2] == pytest.approx(4.0, rel=0.15)
    assert errors[0] < 1e-6


def test_angular_momentum_and_energy_without_torque():
    made = simulation(2e-4, {"angular_velocity": [0.3, 1.0, 0.5]})
    bodies, before = made.state.bodies, made.energies()["kinetic"]
    momentum = bodies.angular_momentum[0].copy()
    drift = []
    for _ in range(20):
        made.advance(1000)
        drift.append(made.energies()["kinetic"] / before - 1.0)
        assert (bodies.angular_momentum[0] == momentum).all()
        assert np.linalg.norm(bodies.orientation[0]) == pytest.approx(1.0, abs=1e-14)
        turn = matrix_from_quaternion(bodies.orientation[0])
        spin = turn @ made.model.solids.inverse_inertia[0] @ turn.T @ momentum
        assert bodies.angular_velocity[0] == pytest.approx(spin, rel=1e-12)
    # no creep: the error is bounded, and of second order
    assert np.abs(drift).max() < 1e-7


def test_free_fall_is_exact():
    made = simulation(5e-4, {"position": [0.0, 0.0, 3.0], "velocity": [0.2, 0.0, 1.0]}, gravity={"acceleration": 9.81})
    made.advance(2000)
    bodies = made.state.bodies
    assert bodies.position[0] == pytest.approx([0.2, 0.0, 3.0 + 1.0 - 0.5 * 9.81], abs=1e-10)
    assert bodies.velocity[0] == pytest.approx([0.2, 0.0, 1.0 - 9.81], abs=1e-10)


def test_motion_is_time_reversible():
    body = {"position": [0.0, 0.0, -0.1], "rotation": [0.1, 0.05, 0.2], "velocity": [0.3, 0.0, 0.4]}
    still = {"drag_force_coefficient": 0.0, "drag_moment_coefficient": 0.0}
    made = simulation(4e-4, body, water=still, gravity={"acceleration": 9.81})
    bodies = made.state.bodies
    start = bodies.position[0].copy(), bodies.orientation[0].copy()
    made.advance(2000)
    gone = np.linalg.norm(bodies.position[0] - start[0])
    for motion in (bodies.velocity, bodies.angular_velocity, bodies.angular_momentum):
        motion[0] *= -1.0
    made.advance(2000)
    assert gone > 0.1
    assert bodies.position[0] == pytest.approx(start[0], abs=1e-9)
    # rotation by an explicit half-way spin is reversible to its order only
    assert turned_by(bodies.orientation[0], start[1]) < 1e-5


def test_fixed_body_stays():
    made = simulation(4e-4, {"fixed": True, "rotation": [0.1, 0.0, 0.0]}, gravity={"acceleration": 9.81})
    before = made.state.bodies.position[0].copy(), made.state.bodies.orientation[0].copy()
    made.advance(100)
    assert (made.state.bodies.position[0] == before[0]).all()
    assert (made.state.bodies.orientation[0] == before[1]).all()

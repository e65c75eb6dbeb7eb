"""Bodies that bend, on their way: free flight, closed loops of pose and modes, bars that meet end on end.

In free flight momenta are constant, 1/2 m v^2 + 1/2 L.I(xi)^-1.L + 1/2 sum (xi_i'^2 + w_i^2 xi_i^2) is so to the
square of the step. What a contact does around a closed loop of poses and modes, without damping and friction, is nothing.
Two equal bars that meet end on end at v exchange their momenta through waves: the force is rho c A v/2 for 2 L/c, c = sqrt(E/rho).
"""

import numpy as np
import pytest

from dilatedem.numerics.frames import matrix_from_quaternion, quaternion_from_rotation_vector
from dilatedem.run.simulation import Simulation
from dilatedem.state.clock import Status

BLOCK = [[-1.4, -0.7], [1.4, -0.7], [1.4, 0.7], [-1.4, 0.7]]
OTHER = [[-1.0, -0.8], [1.0, -0.8], [1.0, 0.8], [-1.0, 0.8]]
MODES = 6


def simulation(model: str, *bodies: dict, step: float = 1e-4, **more) -> Simulation:
    """Bodies that bend by six modes, without water, weight, damping and friction."""
    return Simulation.from_case({
        "field": {"source": "bodies"}, "water": {"enabled": False}, "gravity": {"acceleration": 0.0},
        "contact": {"model": model, "damping": 0.0, "friction": 0.0}, "time": {"step": step}, "body": list(bodies),
        "deformation": {"modes": MODES, "damping": 0.0, "mesh_size": 0.5} | more,
    })  # fmt: skip


@pytest.fixture(autouse=True)
def _elements():
    pytest.importorskip("skfem")


def stored(flight: Simulation) -> float:
    return sum(flight.energy[name] for name in ("kinetic", "elastic", "modal", "loss_modal"))


def flown(step: float, damping: float = 0.0) -> tuple[Simulation, float]:
    """A block that spins and vibrates for 0.1 s, and the largest change of its energy on the way [J]."""
    flight = simulation("liu2015", {"outline": BLOCK, "velocity": [0.3, 0.1, -0.2], "angular_velocity": [0.2, 1.0, 0.7]},
                        step=step, damping=damping)  # fmt: skip
    bodies = flight.state.bodies
    bodies.rate[0] = [3.0, -2.0, 1.5, 1.0, -1.0, 0.5]
    flight.evaluate()
    before, velocity, momentum, worst = stored(flight), bodies.velocity[0].copy(), bodies.angular_momentum[0].copy(), 0.0
    for _ in range(20):
        assert flight.advance(round(0.005 / step)) == Status.DONE
        worst = max(worst, abs(stored(flight) - before))
    np.testing.assert_allclose(bodies.velocity[0], velocity, rtol=1e-9)
    np.testing.assert_allclose(bodies.angular_momentum[0], momentum, rtol=1e-9)
    return flight, worst


def test_free_flight_keeps_its_momenta_and_its_energy_to_the_square_of_the_step():
    (_, coarse), (flight, fine) = flown(1e-4), flown(5e-5)
    assert flight.energy["modal"] > 5.0 and fine < 0.3 * coarse and fine < 5e-3 * flight.energy["modal"]
    modes = flight.state.bodies.coordinate[0]
    assert np.abs(modes).max() > 1e-4


def test_what_damping_takes_from_the_modes_is_booked():
    flight, off = flown(5e-5, damping=0.05)
    assert flight.energy["loss_modal"] > 5.0 and off < 5e-3 * flight.energy["loss_modal"]


#: rotation of the second body [rad], and its place along x at which it overlaps the first by some 2 mm [m]
CORNER, FACE = ([0.05, 0.02, 0.3], 2.5847), ([0.0, 0.0, 0.0], 2.3983)


@pytest.mark.parametrize(("model", "pose"), [("consistent", CORNER), ("consistent", FACE), ("liu2015", CORNER)])
def test_a_loop_of_poses_and_modes_costs_nothing(model, pose):
    """Within 1 % of the most that is stored on the way; each of force, moment and modal forces does several percent of it."""
    turn, place = pose
    pair = simulation(model, {"outline": BLOCK, "position": [0.0, 0.0, 0.0]},
                      {"outline": OTHER, "position": [place, 0.1, 0.05], "rotation": turn})  # fmt: skip
    work, peak = loop(pair, np.array(turn), steps=240)
    assert peak > 1.0 and abs(work) < 1e-2 * peak


def loop(pair: Simulation, turn: np.ndarray, steps: int) -> tuple[float, float]:
    """Work [J] of the contact around a loop of the second body's pose and both bodies' modes, and the peak of its energy."""
    bodies, out = pair.state.bodies, np.random.default_rng(2).normal(size=(4, MODES)) * 2e-3
    start, work, peak, last = bodies.position[1].copy(), 0.0, 0.0, None
    for k in range(steps + 11):  # the first ten for the point of contact to come along
        c, s = np.cos(2.0 * np.pi * k / steps), np.sin(2.0 * np.pi * k / steps)
        bodies.position[1] = start + [2e-4 * s, 0.02 * s, 0.02 * (1.0 - c)]
        bodies.orientation[1] = quaternion_from_rotation_vector(turn + 1e-4 * np.array([c, s, c - s]))
        bodies.coordinate[0], bodies.coordinate[1] = out[0] * c + out[1] * s, out[2] * c + out[3] * s
        for _ in range(1 if k else 3):
            assert pair.evaluate() == Status.DONE
        peak = max(peak, float(pair.state.pairs.stored[0]))
        R = matrix_from_quaternion(bodies.orientation[1])
        now = bodies.position[1].copy(), R, bodies.coordinate.copy()
        loads = bodies.contact_force[1].copy(), bodies.contact_torque[1].copy(), bodies.mode_load.copy()
        if k > 10:
            turned = R @ last[0][1].T
            twist = 0.5 * np.array([turned[2, 1] - turned[1, 2], turned[0, 2] - turned[2, 0], turned[1, 0] - turned[0, 1]])
            moves = now[0] - last[0][0], twist, now[2] - last[0][2]
            work += sum(float((0.5 * (load + old) * move).sum()) for load, old, move in zip(loads, last[1], moves, strict=True))
        last = now, loads
    return work, peak


@pytest.mark.parametrize("model", ["consistent", "liu2015"])
def test_bars_that_meet_end_on_end_lose_nothing_and_part_at_the_wave_s_pace(model):
    length, step = 4.0, 2e-5
    bar = [[-length / 2, -0.25], [length / 2, -0.25], [length / 2, 0.25], [-length / 2, 0.25]]
    bars = [
        {"outline": bar, "position": [side * (length / 2 + 1e-5), 0.0, 0.0], "velocity": [-side * 0.15, 0.0, 0.0]}
        for side in (-1.0, 1.0)
    ]
    pair = simulation(model, *bars, step=step, modes=12, mesh_size=0.25)
    pair.evaluate()
    before, last = stored(pair), 0.0
    while pair.time < 0.01:
        assert pair.advance(5) == Status.DONE
        if pair.state.bodies.contact_force[1, 0] > 0.0:
            last = pair.time
    np.testing.assert_allclose(pair.state.bodies.velocity.sum(axis=0), 0.0, atol=1e-12)
    assert abs(stored(pair) - before) < 1e-3 * before
    assert 0.75 < last / (2.0 * length * np.sqrt(915.0 / 1e9)) < 1.05  # one mode of twelve is along the bars
    assert pair.energy["modal"] > 0.05 * before

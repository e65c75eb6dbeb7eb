"""Structures on beams that vibrate, against SciPy's answer of a linear system and against elements in time.

    q'' + 2 zeta w q' + w^2 q = phi F,   u = sum phi q,   foot: F - sum g q'',  its moment F x - sum h q''

with the load F of the ice that the run itself recorded at every step, and, for the whole beam, M x'' + C x' + K x = r F of
elements, C damping each of their modes alike.
"""

import numpy as np
import pytest
from scipy.linalg import eigh
from scipy.signal import lsim

from dilatedem.motion import vibrate
from dilatedem.structures.beam import Beam, beam_modes
from tests.reference.beam_elements import matrices, place_row
from tests.verification.test_supports import BALL_MASS, SPEED, scene, total

LENGTH, MASS, BENDS, RATIO = 12.0, 400.0, 2e8, 0.05
BEAM = {
    "kind": "modal", "length": LENGTH, "mass_per_length": MASS, "bending_stiffness": [BENDS, 2.0 * BENDS], "damping_ratio": RATIO,
}  # fmt: skip
STEP = 1e-4


def history(support: dict, steps: int, step: float = STEP, **more) -> dict[str, np.ndarray]:
    """Time, load of the ice, displacement, force and moment of the foot along x at every step, and the energies' sum."""
    simulation = scene(support, time={"step": step}, **more)
    simulation.evaluate()
    state, rows = simulation.state, [(0.0, 0.0, 0.0, 0.0, 0.0, total(simulation))]
    for _ in range(steps):
        simulation.step(1)
        foot, pile = state.excursions.foot[0], simulation.structures["pile"]
        rows.append((simulation.time, pile.load[0], pile.displacement[0], foot[0], foot[3], total(simulation)))
    return dict(zip(("time", "ice", "place", "force", "moment", "energy"), np.array(rows).T, strict=True))


@pytest.fixture(scope="module")
def hit() -> dict[str, np.ndarray]:
    """A ball hits a beam of three modes, which swings on for two periods of the slowest."""
    return history(BEAM | {"modes": 3}, 12_000)


def answer(modes, ratio: float, time: np.ndarray, force: np.ndarray, place: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Displacement, force and moment of the foot of these modes under a history of force, by scipy.signal.lsim."""
    place_sum, shear, moment = np.zeros(len(time)), force.copy(), place * force
    for frequency, shape, g, h in zip(modes.frequency, modes.shape, modes.shear, modes.moment, strict=True):
        a = np.array([[0.0, 1.0], [-frequency**2, -2.0 * ratio * frequency]])
        _, _, q = lsim((a, np.array([[0.0], [shape]]), np.eye(2), np.zeros((2, 1))), force, time)
        acceleration = shape * force + q @ a[1]
        place_sum += shape * q[:, 0]
        shear -= g * acceleration
        moment -= h * acceleration
    return place_sum, shear, moment


def test_the_answer_of_its_modes(hit):
    modes = beam_modes(Beam(LENGTH, MASS, BENDS), 3, LENGTH)
    place, force, moment = answer(modes, RATIO, hit["time"], hit["ice"], LENGTH)
    assert hit["ice"].max() > 1e3 and hit["ice"][-1] == 0.0, "it was hit, and swings freely"
    assert hit["place"] == pytest.approx(place, abs=1e-3 * np.abs(place).max())
    assert hit["force"] == pytest.approx(force, abs=1e-3 * np.abs(force).max())
    assert hit["moment"] == pytest.approx(moment, abs=1e-3 * np.abs(moment).max())


def test_the_answer_of_elements():
    """Ten modes against all those of 24 elements, by Newmark's steps of constant mean acceleration."""
    hit, beam = history(BEAM | {"modes": 10}, 6000), Beam(LENGTH, MASS, BENDS)
    mass, stiffness = matrices(beam, 24)
    square, shapes = eigh(stiffness, mass)
    damping = mass @ shapes @ np.diag(2.0 * RATIO * np.sqrt(square)) @ shapes.T @ mass
    push, h = place_row(beam, LENGTH, 24), STEP
    solve = np.linalg.inv(mass + 0.5 * h * damping + 0.25 * h * h * stiffness)
    x, v, a = (np.zeros(len(mass)) for _ in range(3))
    place = [0.0]
    for force in hit["ice"][1:]:
        x, v = x + h * v + 0.25 * h * h * a, v + 0.5 * h * a
        a = solve @ (push * force - damping @ v - stiffness @ x)
        x, v = x + 0.25 * h * h * a, v + 0.5 * h * a
        place.append(push @ x)
    assert hit["place"] == pytest.approx(np.array(place), abs=1e-3 * np.abs(place).max())


def test_the_ledger_closes():
    energy = history(BEAM | {"modes": 3}, 5000, 2e-5)["energy"]
    assert np.abs(energy - energy[0]).max() < 1e-5 * energy[0]


@pytest.mark.parametrize("count", [1, 2, 6])
def test_a_steady_load_comes_down_whole(count, monkeypatch):
    """However few the modes: 30 kN along x and -10 kN along y, until the beam is at rest."""
    monkeypatch.setattr(vibrate, "_note_most", vibrate._note_most.py_func)
    simulation = scene(BEAM | {"modes": count, "damping_ratio": 0.7, "soil_stiffness": 1e8, "soil_stiffness_turning": 1e9})
    supports, excursions, loads = simulation.model.supports, simulation.state.excursions, simulation.state.loads
    loads.step_load[0, :2] = load = np.array([3e4, -1e4])
    for _ in range(10_000):
        vibrate.vibrate.py_func(0, 2e-4, supports, excursions)
        vibrate.push_modes.py_func(0, 2e-4, loads, supports, excursions)
    assert excursions.foot[0, :2] == pytest.approx(load, rel=1e-8)
    assert excursions.foot[0, 2:] == pytest.approx([1e4 * LENGTH, 3e4 * LENGTH], rel=1e-8)
    beams = [Beam(LENGTH, MASS, bends, 0.0, 1e8, 1e9) for bends in (BENDS, 2.0 * BENDS)]
    expected = np.array([beam_modes(beam, count, LENGTH).flexibility() for beam in beams]) * load
    assert excursions.displacement[0, :2] == pytest.approx(expected, rel=1e-8)
    assert abs(expected[0]) < beams[0].flexibility(LENGTH) * load[0], "what is left out is said by check"


def test_one_mode_is_a_mass_on_springs():
    """phi^2 = 1/M and w^2/phi^2 = K: the same hit, and the same displacement, as on springs."""
    support = BEAM | {"modes": 1}
    mode = beam_modes(Beam(LENGTH, MASS, BENDS), 1, LENGTH)
    mass, stiffness = 1.0 / mode.shape[0] ** 2, (mode.frequency[0] / mode.shape[0]) ** 2
    assert mass == pytest.approx(0.25 * MASS * LENGTH, rel=1e-12)
    simulations = [scene(kind, time={"step": STEP}) for kind in (
        support, {"kind": "sprung", "mass": mass, "stiffness": [stiffness, 2.0 * stiffness], "damping_ratio": RATIO},
    )]  # fmt: skip
    loads, places = [], []
    for simulation in simulations:
        simulation.evaluate()
        rows = []
        for _ in range(3000):
            simulation.step(1)
            rows.append((simulation.structures["pile"].load[0], simulation.structures["pile"].displacement[0]))
        load, place = np.array(rows).T
        loads.append(load)
        places.append(place)
    assert loads[0] == pytest.approx(loads[1], abs=1e-9 * loads[1].max())
    assert places[0] == pytest.approx(places[1], abs=1e-9 * np.abs(places[1]).max())
    assert BALL_MASS * SPEED > loads[0].sum() * STEP * 0.5 > 0.0
    assert simulations[0].critical == pytest.approx(simulations[1].critical, rel=1e-9)


def test_no_mode_is_too_fast_for_the_step():
    """The critical step knows the fastest mode of a beam that hardly weighs."""
    support = BEAM | {"modes": 20, "mass_per_length": 1e-3, "damping_ratio": 0.0}
    fastest = beam_modes(Beam(LENGTH, 1e-3, 2.0 * BENDS), 20, LENGTH).frequency[-1]
    assert scene(support, time={"step": 1e-9}).critical <= 2.0 / fastest * (1.0 + 1e-12)

"""The critical step: assembled stiffness over the mass that a corner of a floe opposes to it."""

import numpy as np
import pytest

from dilatedem.case.schema import Case
from dilatedem.errors import CaseError, SimulationStopped
from dilatedem.motion.timestep import _worst_mobility, critical_step
from dilatedem.run.simulation import Simulation

SQUARE = [[-1.4, -1.4], [1.4, -1.4], [1.4, 1.4], [-1.4, 1.4]]


def floe(damping: float = 0.36, **tables) -> Simulation:
    case = {"field": {"source": "bodies"}, "contact": {"damping": damping}, "body": [{"outline": SQUARE}]}
    return Simulation.of_case(Case.model_validate(case | tables))


def test_mobility_of_a_floes_corner():
    # m_eff/m = 0.386 hit sideways, 0.147 from above (sharp 2.8 x 2.8 x 0.5 m floe; the worst of all is from above)
    sharp = floe(ice={"dilated_radius": 1e-4})
    share = 1.0 / (sharp.model.solids.mass[0] * _worst_mobility(sharp.model.shapes, sharp.model.solids)[0])
    assert share == pytest.approx(0.147, abs=1e-3)
    m, half, high = 1.0, 1.4, 0.25
    sideways = 1 / m + half**2 / (m * 2.8**2 / 6) + high**2 / (m * (2.8**2 + 0.5**2) / 12)
    assert 1 / sideways == pytest.approx(0.386, abs=1e-3)


def step_of(area: float, m_eff: float, damping: float = 0.36) -> float:
    """dt = (2/omega)(sqrt(1 + xi^2) - xi) for two equal ice bodies that oppose a mass m_eff [kg] each to k = 2 E* beta
    sqrt(A/pi).
    """
    stiffness = 2 * 1e9 / (2 * 0.91) * 1.02 * np.sqrt(area / np.pi)
    return 2 / np.sqrt(stiffness * 2 / m_eff) * (np.sqrt(1 + damping**2) - damping)


def test_critical_step_of_the_reference_floe():
    mass, inertia = 3579.213, 2407.511
    # the specification's numbers: faces of the core, corners of the outer shape
    assert step_of(2.72**2, 0.147 * mass) == pytest.approx(5.5e-4, rel=0.01)
    # (8.8e-4 s for the side face takes the same 0.147, not the 0.386 of a hit from the side, which would give 1.42e-3 s)
    assert step_of(2.72 * 0.42, 0.147 * mass) == pytest.approx(8.8e-4, rel=0.01)
    # what is computed: face and corner of the core both, hit from above, the worst case
    made = floe(water={"velocity": [0.0, 0.0]}, gravity={"acceleration": 0.0})
    assert made.critical == pytest.approx(step_of(2.72**2, 1 / (1 / mass + 2 * 1.36**2 / inertia)), rel=1e-6)


def test_damping_shortens_the_step():
    still = {"water": {"velocity": [0.0, 0.0]}, "gravity": {"acceleration": 0.0}}
    elastic, damped = floe(0.0, **still), floe(0.36, **still)
    assert damped.critical / elastic.critical == pytest.approx(np.sqrt(1 + 0.36**2) - 0.36, rel=1e-6)


def test_automatic_step_divides_the_force_window():
    made = floe()
    assert made.dt <= 0.1 * made.critical
    assert made.case.output.force_interval / made.dt == pytest.approx(round(made.case.output.force_interval / made.dt), abs=1e-9)


def test_step_above_the_critical_one_is_refused():
    with pytest.raises(CaseError, match="time.step"):
        floe(time={"step": 2e-3, "duration": 1.0})


def test_critical_step_without_free_bodies():
    made = floe()
    made.model.solids.inverse_mass[:] = 0.0
    assert critical_step(made.model, made.state.bodies) == np.inf


def lone(**motion) -> Simulation:
    """A floe alone in space, in motion."""
    given = {"water": {"enabled": False}, "gravity": {"acceleration": 0.0}, "domain": {"size": [1000.0, 1000.0]}}
    return floe(**given, body=[{"outline": SQUARE, "position": [0.0, 0.0, 0.0], **motion}])


@pytest.mark.parametrize("motion", [{"angular_velocity": [0.3, 300.0, 0.0]}, {"velocity": [800.0, 0.0, 0.0]}])
def test_the_automatic_step_knows_how_fast_bodies_are_at_the_start(motion):
    made = lone(**motion)
    assert made.dt < 0.5 * lone().dt
    made.evaluate()
    at_start = made.energy["kinetic"]
    made.step(2000)  # stops nowhere
    assert at_start > 1e6 and made.energy["kinetic"] == pytest.approx(at_start, rel=1e-6)


def test_a_body_that_gets_too_fast_says_what_to_set():
    made = lone()
    made.state.bodies.angular_momentum[0] = made.model.solids.inertia[0] @ [0.0, 400.0, 0.0]
    with pytest.raises(SimulationStopped, match=r"body 0 at .* moved .* in one step, .*, set time.step to at most") as stop:
        made.step(2)
    needed = float(str(stop.value).split("at most ")[1].split(" s")[0])
    assert 0.0 < needed < made.dt

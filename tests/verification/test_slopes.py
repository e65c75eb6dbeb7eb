"""A rigid floe that slides up a slope presses on it along the edge of the cone of friction: the load has H/V =
(sin a + mu cos a)/(cos a - mu sin a), a: angle of the slope from the horizontal. On a plane and on the generator of a cone.
"""

from math import cos, radians, sin
from pathlib import Path

import numpy as np
import pytest

from dilatedem.case.load import load
from dilatedem.numerics.frames import matrix_from_quaternion
from dilatedem.run.simulation import Simulation
from dilatedem.state.clock import Status
from tests.verification.comparison import MODELS, Comparison, by_model, check

CASES = Path(__file__).parents[2] / "validation" / "structures"
#: angle [deg], friction, and H/V as it is known
SLOPES = ((45.0, 0.0, 1.0), (45.0, 0.1, 1.222222), (60.0, 0.1, 2.215847), (30.0, 0.1, 0.718853))
KINDS = ("plane", "cone")
#: m: radius of the edge, gap at the start, radius of the cone at the water level
ROUNDED, GAP, CONE = 0.04, 1e-3, 3.0
#: m: axis of the floe's lower edge under the water level, and from its centroid
DEPTH, EDGE = 0.5 * 915.0 / 1025.0 - ROUNDED, np.array([0.96, 0.0, -0.21])
#: way up the slope [m] after which friction has stopped sticking
SLIDING = 1e-3


def ratio(slope: float, friction: float) -> float:
    """H/V of a floe that slides up."""
    a = radians(slope)
    return (sin(a) + friction * cos(a)) / (cos(a) - friction * sin(a))


def overrides(kind: str, slope: float, friction: float) -> list[str]:
    """Settings of the case file that put the structure `GAP` away from the floe's lower edge."""
    a, away = radians(slope), ROUNDED + GAP
    settings = [f"contact.friction={friction}"]
    if kind == "plane":
        settings.append(f"structure.0.normal=[{-sin(a)}, 0.0, {cos(a)}]")
        return [*settings, f"structure.0.point=[{away * sin(a)}, 0.0, {-DEPTH - away * cos(a)}]"]
    return [*settings, f"structure.0.slope={slope}", f"structure.0.center=[{CONE + (away + DEPTH * cos(a)) / sin(a)}, 0.0]"]


def pushed(kind: str, slope: float, friction: float, model: str) -> np.ndarray:
    """Loads (n, 3) [N] on the structure, of every fifth step at which the floe's edge slides up it."""
    case = load(CASES / f"slope_{kind}.toml", [f"contact.model={model}", *overrides(kind, slope, friction)])
    simulation = Simulation.of_case(case)
    assert simulation.evaluate() == Status.DONE
    up, bodies = np.array([cos(radians(slope)), 0.0, sin(radians(slope))]), simulation.state.bodies
    loads, touched = [], None
    while simulation.time_s < case.time.duration:
        assert simulation.advance(5) == Status.DONE
        arm = matrix_from_quaternion(bodies.orientation[0]) @ EDGE
        place, speed = (bodies.position[0] + arm) @ up, (bodies.velocity[0] + np.cross(bodies.angular_velocity[0], arm)) @ up
        load_now = simulation.state.loads.step_load[0, :3]
        if not load_now.any():
            touched = None
            continue
        touched = place if touched is None else touched
        if speed > 0.0 and place > touched + SLIDING:
            loads.append(load_now.copy())
    return np.array(loads)


def compare_kind(kind: str, model: str) -> list[Comparison]:
    found = []
    for slope, friction, known in SLOPES:
        assert ratio(slope, friction) == pytest.approx(known, abs=1e-6)
        loads = pushed(kind, slope, friction, model)
        assert len(loads) > 50, "the floe slides up"
        ratios = -loads[:, 0] / loads[:, 2]
        worst = ratios[np.abs(ratios - ratio(slope, friction)).argmax()]
        what = f"{slope:g} degrees, mu = {friction:g}: H/V, the worst of all steps"
        found.append(Comparison(f"slope_{kind}", what, ratio(slope, friction), float(worst)))
    return found


def compare() -> list[Comparison]:
    return by_model(lambda model: [row for kind in KINDS for row in compare_kind(kind, model)])


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("kind", KINDS)
def test_the_load_leans_as_slope_and_friction_say(kind, model):
    check(compare_kind(kind, model))

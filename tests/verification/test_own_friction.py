"""A rigid floe that slides up a slope presses on it with H/V = (sin a + mu cos a)/(cos a - mu sin a), a: slope from the horizontal.

H: horizontal force, V: vertical. From the balance of a contact that slips: normal force N along the normal, mu N down the slope on
the floe. mu is the structure's own coefficient; that of ice on ice is another here.
"""

from math import cos, radians, sin

import numpy as np
import pytest

from dilatedem.case.schema import Case
from dilatedem.run.simulation import Simulation
from dilatedem.state.clock import Status

#: half the thickness of the floe and the radius of its edges, m
FLAT, RADIUS = 0.01, 0.05


def sliding(model: str, slope: float, structure: dict) -> Simulation:
    """A floe that lies on the slope through (-2, 0, 0) and moves up it at 2 m/s, under its weight alone."""
    a = radians(slope)
    normal, upward = np.array([-sin(a), 0.0, cos(a)]), np.array([cos(a), 0.0, sin(a)])
    place = np.array([-2.0, 0.0, 0.0]) - 0.4 * upward + (FLAT + RADIUS) * normal
    return Simulation.of_case(Case.model_validate({
        "field": {"source": "bodies"}, "water": {"enabled": False}, "contact": {"model": model, "friction": 0.7},
        "time": {"step": 2e-5}, "structure": [structure],
        "body": [{
            "vertices": [[x, y, z] for x in (-0.3, 0.3) for y in (-0.4, 0.4) for z in (-FLAT, FLAT)], "dilated_radius": RADIUS,
            "position": place.tolist(), "rotation": [0.0, -a, 0.0], "velocity": (2.0 * upward).tolist(),
        }],
    }))  # fmt: skip


def pier(slope: float, friction: float) -> dict:
    outline = [[-2.0, -3.0], [4.0, -3.0], [4.0, 3.0], [-2.0, 3.0]]
    return {"kind": "pier", "outline": outline, "slope": slope, "bottom": -2.0, "top": 1.5, "friction": friction}


@pytest.mark.parametrize("model", ["liu2015", "consistent"])
@pytest.mark.parametrize(("slope", "friction", "ratio"), [
    (45.0, 0.0, 1.0), (45.0, 0.1, 1.222222), (60.0, 0.1, 2.215847), (30.0, 0.1, 0.718853),
])  # fmt: skip
def test_horizontal_over_vertical_force_on_a_pier(model, slope, friction, ratio):
    a = radians(slope)
    assert (sin(a) + friction * cos(a)) / (cos(a) - friction * sin(a)) == pytest.approx(ratio, abs=1e-6)
    simulation = sliding(model, slope, pier(slope, friction))
    impulse = np.zeros(3)
    assert simulation.advance(1000) == Status.DONE
    for _ in range(3000):
        assert simulation.advance(1) == Status.DONE
        impulse += simulation.state.loads.step_load[0, :3]
    assert impulse[0] > 0.0 > impulse[2]
    assert -impulse[0] / impulse[2] == pytest.approx(ratio, rel=1e-3)

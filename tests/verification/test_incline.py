"""A block on an incline slips if and only if tan(alpha) > mu, with a = g (sin(alpha) - mu cos(alpha)); it tips if and only if
tan(alpha) > b/h, b: width of the flat side it stands on, h: twice the height of its centroid.

`liu2015` keeps this as far as it can: its force on a tilted face is no gradient of an energy, so that a block that friction
loads off its centre goes on rocking by some 1e-5 rad, fed by the law (`gain_law` of the ledger), and creeps downhill at
millimetres a second where it should stand. It does not accelerate, which is what is tested; tipping is bracketed to 0.95-1.1
only (a base of 1.05 still tips).
"""

from math import cos, radians, sin

import numpy as np

from tests.verification.comparison import Comparison, advance_to, check, start

SLOPE, GRAVITY = radians(20.0), 9.81
DOWN = np.array([cos(SLOPE), 0.0, -sin(SLOPE)])


def _speed(simulation) -> float:
    return float(simulation.state.bodies.velocity[0] @ DOWN)


def _tilt(simulation, body: int) -> float:
    """Angle [rad] a block has turned by, against the slope."""
    orientation = simulation.state.bodies.orientation[body]
    return 2 * np.arctan2(orientation[2], orientation[0]) - SLOPE


def compare_slip() -> list[Comparison]:
    case = "incline_slip"
    simulation = start(case)
    advance_to(simulation, 0.2)
    first, since = _speed(simulation), simulation.time_s
    advance_to(simulation, 0.8)
    found = (_speed(simulation) - first) / (simulation.time_s - since)
    held = start(case, "contact.friction=0.4")
    advance_to(held, 0.2)
    before = held.state.bodies.position[0].copy()
    advance_to(held, 0.5)
    middle = held.state.bodies.position[0].copy()
    advance_to(held, 0.8)
    ways = (middle - before) @ DOWN, (held.state.bodies.position[0] - middle) @ DOWN
    return [
        Comparison(case, "mu = 0.3: acceleration, m/s2", GRAVITY * (sin(SLOPE) - 0.3 * cos(SLOPE)), found),
        # from the mean speeds of two windows: the speed of an instant rocks
        Comparison(case, "mu = 0.4: acceleration, m/s2", 0.0, (ways[1] - ways[0]) / 0.3**2, scale=GRAVITY * sin(SLOPE)),
    ]


def compare_tip() -> list[Comparison]:
    case = "incline_tip"
    simulation = start(case)
    advance_to(simulation, 1.5)
    return [
        Comparison(case, "b/h = 0.95 tan(alpha): has tipped (1 = yes)", 1.0, float(_tilt(simulation, 0) > 0.1)),
        Comparison(case, "b/h = 1.1 tan(alpha): has tipped (1 = yes)", 0.0, float(abs(_tilt(simulation, 1)) > 0.01), scale=1.0),
    ]


def compare() -> list[Comparison]:
    return compare_slip() + compare_tip()


def test_slips_beyond_the_angle_of_friction():
    check(compare_slip())


def test_tips_beyond_its_base():
    check(compare_tip())

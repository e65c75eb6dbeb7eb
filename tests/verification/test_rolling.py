"""A capsule rolls without slipping: down an incline with a = g sin(alpha)/(1 + I/(m R^2)), and along the level at constant speed.

It slips only where tan(alpha) > mu (1 + m R^2/I). I/m = R^2 (V_c/2 + 2 V_s/5)/(V_c + V_s) about the axis, V_c and V_s the volumes
of the cylinder and of both half spheres. Friction acts half an overlap above the plane, so that R w = v to 5e-4. The friction
spring has no damping of its own: acceleration and speed are taken from the whole run, not from an instant.
"""

from math import cos, pi, radians, sin

import numpy as np
import pytest

from tests.verification.comparison import MODELS, Comparison, by_model, check, follow, start

CASE, SLOPE, GRAVITY, RADIUS, LENGTH, SPEED = "rolling", radians(20.0), 9.81, 0.1, 0.5, 0.5
DOWN = np.array([cos(SLOPE), 0.0, -sin(SLOPE)])


def inertia_share() -> float:
    """I/(m R^2) of the capsule about its axis."""
    rod, ball = pi * RADIUS**2 * LENGTH, 4 / 3 * pi * RADIUS**3
    return (0.5 * rod + 0.4 * ball) / (rod + ball)


def compare_model(model: str) -> list[Comparison]:
    simulation = start(CASE, model=model)

    def read(s):
        b = s.state.bodies
        return b.velocity[0] @ DOWN, b.angular_velocity[0, 1], b.velocity[1, 0], b.angular_velocity[1, 1]

    share = inertia_share()
    times, seen = follow(simulation, 1.0, read, every=20)
    settled = times > 0.1
    gain, spin_up = (np.polyfit(times[settled], seen[settled, i], 1)[0] for i in (0, 1))
    fall = GRAVITY * sin(SLOPE) / (1 + share)
    late = times > 0.8
    bodies = simulation.state.bodies
    aside = np.abs(bodies.velocity[:2, 1]).max() + RADIUS * np.abs(bodies.angular_velocity[:2, ::2]).max()
    return [
        Comparison(CASE, "incline: acceleration, m/s2", fall, float(gain)),
        Comparison(CASE, "incline: R x angular acceleration, m/s2", fall, float(RADIUS * spin_up)),
        Comparison(CASE, "level: speed after 0.8 to 1 s, m/s", SPEED, float(seen[late, 2].mean())),
        Comparison(CASE, "level: R x spin after 0.8 to 1 s, m/s", SPEED, float(RADIUS * seen[late, 3].mean())),
        Comparison(CASE, "both: motion aside and out of the axis, m/s", 0.0, float(aside), 1e-9, SPEED),
    ]


def compare() -> list[Comparison]:
    return by_model(compare_model)


@pytest.mark.parametrize("model", MODELS)
def test_rolling_capsules(model):
    check(compare_model(model))

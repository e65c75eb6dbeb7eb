"""A floating box: draft h rho/rho_w; heave T = 2 pi sqrt(m/(rho_w g A)); roll T = 2 pi sqrt(I/(rho_w g V GM)).

b = 2.8 m, h = 0.5 m, A = b^2, I = m (b^2 + h^2)/12, metacentric height GM = b^2/(12 d) - (h - d)/2 with the draft d. Without
added mass.
"""

from math import pi, sqrt

import numpy as np

from tests.verification.comparison import Comparison, advance_to, check, follow, start, zero_crossings

CASE = "floating_box"
WIDTH, HEIGHT, ICE, WATER, GRAVITY = 2.8, 0.5, 915.0, 1025.0, 9.81


def compare() -> list[Comparison]:
    simulation = start(CASE)
    bodies, mass = simulation.state.bodies, ICE * WIDTH**2 * HEIGHT
    draft = HEIGHT * ICE / WATER
    metacentre = WIDTH**2 / (12 * draft) - 0.5 * (HEIGHT - draft)
    heave = 2 * pi * sqrt(mass / (WATER * GRAVITY * WIDTH**2))
    roll = 2 * pi * sqrt(mass * (WIDTH**2 + HEIGHT**2) / 12 / (mass * GRAVITY * metacentre))
    rest = np.abs(bodies.force[0]).max() + np.abs(bodies.torque[0]).max()
    level = float(bodies.position[0, 2])
    times, seen = follow(
        simulation, 10.0, lambda s: (s.state.bodies.position[1, 2] - level, s.state.bodies.orientation[2, 1]), every=100
    )
    periods = [2 * np.diff(zero_crossings(times, seen[:, i])).mean() for i in range(2)]
    return [
        Comparison(CASE, "draft, m", draft, 0.5 * HEIGHT - level, 1e-6),
        Comparison(CASE, "force and moment at equilibrium, N", 0.0, rest, 1e-6, scale=mass * GRAVITY),
        Comparison(CASE, "heave period, s", heave, periods[0]),
        Comparison(CASE, "roll period, s", roll, periods[1]),
    ]


def test_floating_box():
    check(compare())


def test_targets_of_the_specification():
    draft, heave, roll = (c.target for c in compare() if c.scale is None)
    assert (round(draft, 5), round(heave, 4), round(roll, 4)) == (0.44634, 1.3402, 1.3741)


def test_box_at_rest_stays():
    simulation = start(CASE)
    before = simulation.state.bodies.position[0].copy()
    advance_to(simulation, 5.0)
    assert np.abs(simulation.state.bodies.position[0] - before).max() < 1e-8
    assert np.abs(simulation.state.bodies.orientation[0, 1:]).max() < 1e-8

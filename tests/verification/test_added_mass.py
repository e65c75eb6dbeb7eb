"""Boxes that take water along: heave T = 2 pi sqrt((m + M)/(rho_w g A)), roll T = 2 pi sqrt((I + J)/(m g GM)).

Of a thin disc with the same plan area, a = sqrt(A/pi): M = 4/3 rho_w a^3, J = 8/45 rho_w a^5. I and GM as in test_floating_box.
"""

from math import pi, sqrt

import numpy as np

from tests.verification.comparison import Comparison, check, follow, start, zero_crossings

CASE = "added_mass"
BOXES = ((2.8, 0.5), (10.0, 1.0))
ICE, WATER, GRAVITY = 915.0, 1025.0, 9.81


def heave(width: float, height: float, added: float) -> float:
    mass, radius = ICE * width**2 * height, width / sqrt(pi)
    return 2 * pi * sqrt((mass + added * 4 / 3 * WATER * radius**3) / (WATER * GRAVITY * width**2))


def roll(width: float, height: float, added: float) -> float:
    mass, draft, radius = ICE * width**2 * height, height * ICE / WATER, width / sqrt(pi)
    metacentre = width**2 / (12 * draft) - 0.5 * (height - draft)
    inertia = mass * (width**2 + height**2) / 12 + added * 8 / 45 * WATER * radius**5
    return 2 * pi * sqrt(inertia / (mass * GRAVITY * metacentre))


def periods(*overrides: str) -> list[float]:
    simulation = start(CASE, *overrides)
    levels = simulation.state.bodies.position[:2, 2] - 0.01

    def read(simulation):
        bodies = simulation.state.bodies
        return *(bodies.position[:2, 2] - levels), bodies.orientation[2, 1]

    times, seen = follow(simulation, 15.0, read, every=100)
    return [float(2 * np.diff(zero_crossings(times, seen[:, i])).mean()) for i in range(3)]


def compare() -> list[Comparison]:
    found, without = periods(), periods("water.added_mass=false")
    rows = [
        Comparison(CASE, f"heave period of {width:g} m x {height:g} m, {how}, s", heave(width, height, added), periods_found[i])
        for i, (width, height) in enumerate(BOXES)
        for how, added, periods_found in (("alone", 0.0, without), ("with its water", 1.0, found))
    ]
    return [*rows, Comparison(CASE, "roll period of 2.8 m x 0.5 m, with its water, s", roll(*BOXES[0], 1.0), found[2])]


def test_added_mass():
    check(compare())


def test_targets_of_the_specification():
    targets = [heave(*box, added) for box in BOXES for added in (0.0, 1.0)]
    assert [round(target, 4) for target in targets] == [1.3402, 2.12, 1.8954, 3.6371]

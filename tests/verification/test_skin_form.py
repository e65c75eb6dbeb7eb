"""Drag by skin and form: drift from rest, spin decay, steady floes between wind and current and in a current that has a shear.

Drift from rest in a current c: v = c k c t/(1 + k c t), k = K_w/m, with K_w = rho_w (C_s A + C_f W d)/2: skin on the plan area A,
form on the mean width W = P/pi times the draught d. Spin decay: w = w0/(1 + k_r w0 t), with
k_r = rho_w (C_s 2 pi/5 a^5 + C_f d W^4/32)/(2 I_z): the bottom as a disc of radius a = sqrt(A/pi), the sides as a plate W wide.

Between a wind w and the current: K_w |v - c|(v - c) = K_a |w - v|(w - v), K_a = rho_a (C_s A + C_f W (h - d))/2, so that
v = (sqrt(K_w) c + sqrt(K_a) w)/(sqrt(K_w) + sqrt(K_a)). In a shear the skin's current is that at the depth d, the form's the mean
down to it, and the same holds with their parts of K_w in place of K_w and K_a.
"""

from math import pi, sqrt

import numpy as np

from dilatedem.run.simulation import Simulation
from tests.verification.comparison import Comparison, advance_to, check, start

WIDTH, HEIGHT, ICE, WATER, AIR = 2.8, 0.5, 915.0, 1025.0, 1.3
AREA, MEAN_WIDTH, DRAUGHT, MASS = WIDTH**2, 4 * WIDTH / pi, HEIGHT * ICE / WATER, ICE * WIDTH**2 * HEIGHT
SKIN, FORM = 0.5 * WATER * 0.004 * AREA, 0.5 * WATER * 0.8 * MEAN_WIDTH * DRAUGHT
#: s, from when on they are steady to 4e-4: the slower of them comes nearer by exp(-0.005 t)
SURELY = {"drift_wind": 400.0, "drift_shear": 1200.0}


def drift() -> list[Comparison]:
    current, simulation, rows = 0.3, start("drift_skin_form"), []
    for goal in (5.0, 30.0):
        advance_to(simulation, goal)
        reached = (SKIN + FORM) / MASS * current * simulation.time_s
        target = current * reached / (1 + reached)
        rows.append(Comparison("drift_skin_form", f"speed after {goal:g} s, m/s", target, speed(simulation)[0]))
    return rows


def spin_decay() -> list[Comparison]:
    spin, inertia = 0.5, MASS * WIDTH**2 / 6
    fifth = sqrt(AREA / pi) ** 5
    k = 0.5 * WATER * (0.004 * 0.4 * pi * fifth + 0.8 * DRAUGHT * MEAN_WIDTH**4 / 32) / inertia
    simulation = start("spin_decay_skin_form")
    advance_to(simulation, 30.0)
    target, found = spin / (1 + k * spin * simulation.time_s), float(simulation.state.bodies.angular_velocity[0, 2])
    return [Comparison("spin_decay_skin_form", "spin after 30 s, rad/s", target, found)]


def speed(simulation: Simulation) -> np.ndarray:
    return simulation.state.bodies.velocity[0, :2].copy()


def steady(case: str) -> np.ndarray:
    simulation = start(case)
    advance_to(simulation, SURELY[case])
    return speed(simulation)


def between_wind_and_current() -> list[Comparison]:
    air = 0.5 * AIR * (0.002 * AREA + 0.8 * MEAN_WIDTH * (HEIGHT - DRAUGHT))
    weights = np.sqrt([SKIN + FORM, air])
    target = weights @ [[0.2, 0.0], [0.0, 15.0]] / weights.sum()
    found = steady("drift_wind")
    return [Comparison("drift_wind", f"steady speed along {axis}, m/s", target[i], found[i]) for i, axis in enumerate("xy")]


def in_a_shear() -> list[Comparison]:
    depths, shares = [0.0, 0.2, 0.6], [1.0, 0.9, 0.3]
    low = np.interp(DRAUGHT, depths, shares)
    mean = (0.2 * 0.95 + (DRAUGHT - 0.2) * 0.5 * (0.9 + low)) / DRAUGHT
    weights = np.sqrt([SKIN, FORM])
    target = 0.5 * weights @ [low, mean] / weights.sum()
    return [Comparison("drift_shear", "steady speed, m/s", target, steady("drift_shear")[0])]


def compare() -> list[Comparison]:
    return drift() + spin_decay() + between_wind_and_current() + in_a_shear()


def test_skin_and_form():
    check(compare())

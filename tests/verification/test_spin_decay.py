"""Spin decay in still water: w = w0/(1 + k_r w0 t), k_r = C r_eff^3 rho_w A_sub/(2 I_z).

Solution of I_z dw/dt = -C r_eff^3 rho_w A_sub w^2/2 (Liu 2015, Eq. (27)); r_eff: mean distance of the vertices from the centroid.
"""

from math import sqrt

from tests.verification.comparison import Comparison, advance_to, check, start

CASE = "spin_decay"
WIDTH, HEIGHT, ICE, WATER, SPIN, DRAG = 2.8, 0.5, 915.0, 1025.0, 0.5, 0.1


def compare() -> list[Comparison]:
    wetted = WIDTH**2 + 4 * WIDTH * HEIGHT * ICE / WATER
    size = 0.5 * sqrt(2 * WIDTH**2 + HEIGHT**2)
    inertia = ICE * WIDTH**2 * HEIGHT * WIDTH**2 / 6
    k = DRAG * size**3 * WATER * wetted / (2 * inertia)
    simulation = start(CASE)
    rows = []
    for goal in (1.0, 5.0, 30.0):
        advance_to(simulation, goal)
        target = SPIN / (1 + k * SPIN * simulation.time_s)
        spin = float(simulation.state.bodies.angular_velocity[0, 2])
        rows.append(Comparison(CASE, f"spin after {goal:g} s, rad/s", target, spin))
    return rows


def test_spin_decay():
    check(compare())

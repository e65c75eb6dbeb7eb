"""Drift from rest in a current v_w: v = v_w k v_w t/(1 + k v_w t), k = C rho_w A_sub/(2 m).

Solution of m dv/dt = C rho_w A_sub (v_w - v)^2/2 (Liu 2015, Eq. (26)); A_sub: the wetted bottom and sides.
"""

from tests.verification.comparison import Comparison, advance_to, check, start

CASE = "drift"
WIDTH, HEIGHT, ICE, WATER, CURRENT, DRAG = 2.8, 0.5, 915.0, 1025.0, 0.3, 0.6


def compare() -> list[Comparison]:
    wetted = WIDTH**2 + 4 * WIDTH * HEIGHT * ICE / WATER
    k = DRAG * WATER * wetted / (2 * ICE * WIDTH**2 * HEIGHT)
    simulation = start(CASE)
    rows = []
    for goal in (1.0, 5.0, 30.0):
        advance_to(simulation, goal)
        reached = k * CURRENT * simulation.time_s
        target = CURRENT * reached / (1 + reached)
        rows.append(Comparison(CASE, f"speed after {goal:g} s, m/s", target, float(simulation.state.bodies.velocity[0, 0])))
    return rows


def test_drift():
    check(compare())

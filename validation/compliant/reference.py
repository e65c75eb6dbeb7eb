"""A floe that crushes on a pile that gives way: rigid ice, rigid-plastic, no water.

    m x'' = -F,   M u'' + K u = F,   F = p A(d),   A = 2 h sqrt(2 R d - d^2), to leading order 2 h sqrt(2 R d),

d the crushed depth, the largest x - u so far; F acts only while d grows. Without springs F is (M/(m + M))^(1/3) of that on a fixed
pile, to leading order F = (6 R m v^2 p^2 h^2)^(1/3).
"""

from typing import NamedTuple

import numpy as np
from scipy.integrate import solve_ivp

MASS, SPEED, PRESSURE = 1.83e5, 0.5, 1.5e6  # kg, m/s, Pa
RADIUS, THICKNESS = 2.0, 0.5  # m, of the pile and of the floe


class Peak(NamedTuple):
    """The highest force [N], how much is crushed then [m], and where the pile is then [m]."""

    force: float
    crushed: float
    shift: float


def force_at(crushed: float, leading: bool) -> float:
    """Pressure times nominal area [N]: of the whole chord, or its leading order."""
    d = max(crushed, 0.0)
    return PRESSURE * 2.0 * THICKNESS * float(np.sqrt(2.0 * RADIUS * d - (0.0 if leading else d * d)))


def fixed() -> float:
    """Highest force [N] on a pile that is held, to leading order."""
    return (6.0 * RADIUS * MASS * SPEED**2 * PRESSURE**2 * THICKNESS**2) ** (1.0 / 3.0)


def peak(mass: float, stiffness: float, *, leading: bool = False) -> Peak:
    """Of a pile of this mass [kg] on a spring [N/m]: at the first instant at which ice and pile move alike."""

    def rate(_, y):
        x, v, u, w = y
        force = force_at(x - u, leading)
        return [v, -force / MASS, w, (force - stiffness * u) / mass]

    def alike(_, y):
        return y[1] - y[3]

    alike.terminal, alike.direction = True, -1.0
    x, _, u, _ = solve_ivp(rate, (0.0, 2.0), [0.0, SPEED, 0.0, 0.0], events=alike, rtol=1e-11, atol=1e-14).y[:, -1]
    return Peak(force_at(x - u, leading), float(x - u), float(u))

"""Reference for a central impact: one body, one equation of motion, m d'' = -max(F(d) + viscous force, 0) with the overlap d.

The viscous force is, for F = K d^p and the damping coefficient xi of the case,
`liu2015`: xi sqrt(2 m K) d^(p-1) d' (Liu 2015, Eqs. (3), (4)), whose restitution depends on speed unless p = 1;
`consistent`: c sqrt(m K) d^((p-1)/2) d', c = sqrt(2 (p+1)) xi. With y = sqrt(2 W/m), W = K d^(p+1)/(p+1), as the coordinate the
equation is v dv/dy = -(y + 2 xi v) for every p, K, m and speed: a damped oscillator, left where y + 2 xi v = 0. Hence one
restitution, e = exp(-xi t), sqrt(1 - xi^2) t = pi - atan2(2 xi sqrt(1 - xi^2), 1 - 2 xi^2), and exp(-2) at xi = 1. The same holds
of any law F(d) if its viscous force is xi sqrt(2 m/W) F d'. As `liu2015` has that form for p = 1, with xi/sqrt(2) for xi, its
face contacts rebound alike at all speeds too.
"""

from collections.abc import Callable
from math import acosh, atan2, exp, log, pi, sqrt

from scipy.integrate import solve_ivp

from tests.verification.point_impact import Impact

#: of ice (1 GPa, 0.3) on steel (210 GPa, 0.3), Pa
ICE_STEEL = 1 / (0.91 / 1e9 + 0.91 / 210e9)


def restitution_of_oscillator(xi: float) -> float:
    """Speed after over speed before of a damped oscillator that is left where its force would pull."""
    if xi > 1.0:
        root = sqrt(xi**2 - 1.0)
        return exp(-2.0 * xi * acosh(xi) / root)
    if xi == 1.0:
        return exp(-2.0)
    if xi == 0.0:
        return 1.0
    root = sqrt(1.0 - xi**2)
    return exp(-xi / root * (pi - atan2(2 * xi * root, 1 - 2 * xi**2)))


def viscous_law(model: str, stiffness: float, exponent: float, mass: float, xi: float) -> Callable[[float, float], float]:
    """Viscous force [N] of overlap [m] and speed of approach [m/s], for F = K d^p."""
    if model == "liu2015":
        coefficient, power = xi * sqrt(2 * mass * stiffness), exponent - 1.0
    else:
        coefficient, power = xi * sqrt(2 * (exponent + 1) * mass * stiffness), 0.5 * (exponent - 1.0)
    return lambda depth, rate: coefficient * depth**power * rate


def power_law(stiffness: float, exponent: float) -> Callable[[float], float]:
    return lambda depth: stiffness * depth**exponent


def line_law(modulus: float, length: float, radius: float) -> Callable[[float], float]:
    """F = pi E* L d/Lam, Lam = 0.2 + ln(L^2/(R d)) + ln(Lam): a line of length L on a plane, by boundary elements."""

    def force(depth: float) -> float:
        if depth <= 0.0:
            return 0.0
        start = 0.2 + log(length**2 / (radius * depth))
        parameter = start
        for _ in range(6):
            parameter = start + log(parameter)
        return pi * modulus * length * depth / parameter

    return force


def impact_in_theory(
    force: Callable[[float], float], mass: float, speed: float, viscous: Callable[[float, float], float] | None = None
) -> tuple[Impact, float]:
    """Largest overlap and force and the duration of an impact, and speed after over speed before."""

    def total(depth, rate):
        depth = max(depth, 0.0)
        return max(force(depth) + (viscous(depth, rate) if viscous else 0.0), 0.0)

    def left(t, state):
        return state[0] if t > 0.0 else 1.0

    def motion(t, state):
        return state[1], -total(*state) / mass

    left.terminal, left.direction = True, -1.0
    # a time of the order of the impact: when the speed would have driven in as far as the energy allows
    depth = 1e-9
    while force(depth) * depth < mass * speed**2:
        depth *= 1.1
    result = solve_ivp(
        motion, (0.0, 100 * depth / speed), (0.0, speed), events=left, rtol=1e-9, atol=1e-12 * depth, max_step=0.02 * depth / speed
    )
    forces = [total(*state) for state in result.y.T]
    return Impact(float(result.y[0].max()), max(forces), float(result.t[-1])), float(-result.y[1, -1] / speed)

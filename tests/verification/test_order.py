"""The integrator is of second order: halving the step divides the error by four.

Error: the largest over the run, at the instants that all steps share. Observed order: log2 of the ratio of the errors of two
steps, for three halvings; 2.0 +- 0.1. References:
* a sphere that swings in its overlap, under gravity, elastic or damped, without opening: m d'' = m g - K d^(3/2) - viscous force
  (`normal_impact`), integrated to 1e-13
* a sphere that does so while it sticks and rolls: m v' = -k_s s, I w' = l k_s s, s' = v - l w, k_s = q K d^(1/2), l = R - d/2
  being the lever of the contact; in `consistent` a spring that grows stiffer keeps its force, s' = v - l w - s d'/(2 d) for d' > 0
* a box that tumbles: Euler's equation in the body frame and its quaternion, integrated to 1e-13; error: the angle between the two
* heave of the floating box and drift from rest in closed form (`test_floating_box`, `test_drift`): forces of water, the
  second depending on speed
"""

from math import pi, sqrt

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from tests.verification.comparison import MODELS, Comparison, by_model, check, follow, start
from tests.verification.normal_impact import ICE_STEEL, viscous_law

CASE, RADIUS, GRAVITY, DURATION, RATIO, SLIDING = "order", 0.1, 9.81, 0.05, 0.7, 2e-3
MASS, STIFFNESS = 915.0 * 4 / 3 * pi * RADIUS**3, 4 / 3 * ICE_STEEL * sqrt(RADIUS)
START = 9.402e-6
HALVINGS = 3
#: nothing touches in the cases of water: soft ice allows steps long enough for their errors to stand out from round-off
SOFT = "ice.elastic_modulus=1e4"


def _solve(motion, state, times) -> np.ndarray:
    return solve_ivp(motion, (0.0, times[-1]), state, method="DOP853", t_eval=times, rtol=1e-13, atol=1e-18).y


def orders(case: str, step: float, until: float, error, *overrides: str, model: str = "") -> list[float]:
    """Observed orders from four runs of a case, each with half the step.

    error: what to `read` of a simulation, and the error of what was seen at its instants.
    """
    errors = []
    for k in range(HALVINGS + 1):
        simulation = start(case, f"time.step={step / 2**k!r}", *overrides, model=model)
        simulation.span = 1  # the plain scheme: a body that nothing touches would take 1 ms at a time, whatever the step
        times, seen = follow(simulation, until, error.read, every=2**k)
        errors.append(error(simulation, times, seen))
    return [float(np.log2(errors[k] / errors[k + 1])) for k in range(HALVINGS)]


def _rows(case: str, what: str, found: list[float]) -> list[Comparison]:
    return [
        Comparison(case, f"{what}: order from step 1/{2**k} to 1/{2 ** (k + 1)}", 2.0, order, 0.1, 1.0)
        for k, order in enumerate(found)
    ]


class Bounce:
    """Height of the sphere on the plate."""

    def __init__(self, model: str, xi: float):
        self.viscous = viscous_law(model, STIFFNESS, 1.5, MASS, xi)

    @staticmethod
    def read(simulation) -> float:
        return RADIUS - simulation.state.bodies.position[0, 2]

    def __call__(self, simulation, times, seen) -> float:
        def motion(t, y):
            return y[1], GRAVITY - (STIFFNESS * y[0] ** 1.5 + self.viscous(y[0], y[1])) / MASS

        return np.abs(seen - _solve(motion, (START, 0.0), times)[0]).max()


class Roll:
    """Way of the sphere that sticks and rolls."""

    def __init__(self, model: str):
        # of k_s = q F_n/d; and whether a spring that grows stiffer keeps its force (`test_oblique_impact`)
        self.share, self.keeps_force = (RATIO, False) if model == "liu2015" else (1.25 * RATIO, True)

    @staticmethod
    def read(simulation) -> float:
        return simulation.state.bodies.position[2, 0] - 2.0

    def __call__(self, simulation, times, seen) -> float:
        def motion(t, y):
            d, rate, x, v, spin, s = y
            lever, shear = RADIUS - 0.5 * d, self.share * STIFFNESS * d**0.5 * s
            sliding = v - lever * spin - (0.5 * s * max(rate, 0.0) / d if self.keeps_force else 0.0)
            return rate, GRAVITY - STIFFNESS * d**1.5 / MASS, v, -shear / MASS, lever * shear / (0.4 * MASS * RADIUS**2), sliding

        return np.abs(seen - _solve(motion, (START, 0.0, 0.0, SLIDING, 0.0, 0.0), times)[2]).max()


class Tumble:
    """Orientation of the free box."""

    spin = (3.0, 4.0, 2.0)

    @staticmethod
    def read(simulation) -> np.ndarray:
        return simulation.state.bodies.orientation[1].copy()

    def __call__(self, simulation, times, seen) -> float:
        # the program's own inertia, verified elsewhere: the trace of rounding would hide the error of the step
        i1, i2, i3 = np.diag(simulation.model.solids.inertia[1])

        def motion(t, y):
            a, b, c, w, x, z, u = y
            euler = (i2 - i3) / i1 * b * c, (i3 - i1) / i2 * c * a, (i1 - i2) / i3 * a * b
            turn = -x * a - z * b - u * c, w * a + z * c - u * b, w * b + u * a - x * c, w * c + x * b - z * a
            return *euler, *(0.5 * rate for rate in turn)

        true = _solve(motion, (*self.spin, 1.0, 0.0, 0.0, 0.0), times)[3:].T
        # 1 - cos of a small angle would drown in round-off
        return 2 * min(np.linalg.norm(seen - true, axis=1).max(), np.linalg.norm(seen + true, axis=1).max())


class Heave:
    """Height of the lifted box; the box beside it floats at its equilibrium."""

    rate = sqrt(1025.0 * GRAVITY * 2.8**2 / (915.0 * 2.8**2 * 0.5))

    @staticmethod
    def read(simulation) -> float:
        return simulation.state.bodies.position[1, 2] - simulation.state.bodies.position[0, 2]

    def __call__(self, simulation, times, seen) -> float:
        return np.abs(seen - 0.01 * np.cos(self.rate * times)).max()


class Drift:
    """Speed of the box that the current takes along."""

    wetted = 2.8**2 + 4 * 2.8 * 0.5 * 915.0 / 1025.0
    rate = 0.3 * 0.6 * 1025.0 * wetted / (2 * 915.0 * 2.8**2 * 0.5)

    @staticmethod
    def read(simulation) -> float:
        return simulation.state.bodies.velocity[0, 0]

    def __call__(self, simulation, times, seen) -> float:
        return np.abs(seen - 0.3 * self.rate * times / (1 + self.rate * times)).max()


def compare_contact(model: str) -> list[Comparison]:
    rows = []
    for what, xi in (("elastic contact", 0.0), ("damped contact", 0.36)):
        rows += _rows(CASE, what, orders(CASE, 4e-5, DURATION, Bounce(model, xi), f"contact.damping={xi}", model=model))
    return rows + _rows(CASE, "sticking contact", orders(CASE, 4e-5, DURATION, Roll(model), model=model))


def compare_free() -> list[Comparison]:
    return [
        *_rows(CASE, "tumbling box", orders(CASE, 4e-5, DURATION, Tumble())),
        *_rows("floating_box", "heave", orders("floating_box", 0.02, 2.0, Heave(), SOFT)),
        *_rows("drift", "drift", orders("drift", 0.02, 2.0, Drift(), SOFT)),
    ]


def compare() -> list[Comparison]:
    return compare_free() + by_model(compare_contact)


def test_order_without_contact():
    check(compare_free())


@pytest.mark.parametrize("model", MODELS)
def test_order_in_contact(model):
    check(compare_contact(model))

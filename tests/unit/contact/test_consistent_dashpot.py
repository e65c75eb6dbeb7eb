"""Two dashpots with one restitution: the damping of `touch` against a direct solution of the motion, and against the table."""

from math import acosh, exp, sqrt

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from dilatedem.contact.consistent.dashpot import touch_damping, touch_loss, viscous_loss
from tests.verification.normal_impact import restitution_of_oscillator

#: damping of the case -> a = 2 z
FACTORS = {0.05: 0.2275, 0.1: 0.4369, 0.2: 0.7970, 0.3: 1.0871, 0.36: 1.2579, 0.5: 1.6792, 0.7: 2.3268, 1.0: 3.3787}


def rebound(factor: float, exponent: float, speed: float) -> float:
    """Speed after over speed before of m d'' = -K d^p max(0, 1 + a d'/sqrt(d'^2 + 2 W/m)), m = 3 kg, K = 2e4 N/m^p."""
    mass, stiffness = 3.0, 2e4

    def motion(_, state):
        depth, rate = max(state[0], 0.0), state[1]
        stored = stiffness * depth ** (exponent + 1.0) / (exponent + 1.0)
        share = 1.0 + factor * rate / sqrt(rate * rate + 2.0 * stored / mass)
        return rate, -stiffness * depth**exponent * max(share, 0.0) / mass

    def left(_, state):
        return state[0] + (1.0 if state[1] > 0.0 else 0.0)

    left.terminal = True
    deepest = ((exponent + 1.0) * mass * speed**2 / (2.0 * stiffness)) ** (1.0 / (exponent + 1.0))
    # from the slow way out: nothing acts there once the share is 0
    result = solve_ivp(
        motion, (0.0, 1e3 * deepest / speed), (0.0, speed), events=left, rtol=1e-10, atol=1e-13, max_step=0.02 * deepest / speed
    )
    return -result.y[1, -1] / speed


@pytest.mark.parametrize(("damping", "factor"), FACTORS.items())
def test_both_laws_have_one_restitution(damping, factor):
    a = 2.0 * touch_damping(damping)
    assert a == pytest.approx(factor, abs=6e-5)
    assert exp(-viscous_loss(damping)) == pytest.approx(restitution_of_oscillator(damping), rel=1e-6)
    assert exp(-touch_loss(0.5 * a)) == pytest.approx(restitution_of_oscillator(damping), rel=1e-6)


@pytest.mark.parametrize("damping", [0.1, 0.36, 1.0])
@pytest.mark.parametrize(("exponent", "speed"), [(1.0, 0.01), (1.5, 1.0), (1.5, 3.0), (2.0, 0.2)])
def test_restitution_is_that_of_every_power_law_and_speed(damping, exponent, speed):
    rebounds = rebound(2.0 * touch_damping(damping), exponent, speed)
    assert rebounds == pytest.approx(restitution_of_oscillator(damping), rel=1e-5)


def test_the_loss_of_an_overdamped_contact():
    for damping in (1.0001, 2.0, 30.0, 100.0):
        root = sqrt(damping**2 - 1.0)
        assert viscous_loss(damping) == pytest.approx(2.0 * damping * acosh(damping) / root, rel=1e-5)
        assert touch_loss(touch_damping(damping)) == pytest.approx(viscous_loss(damping), rel=1e-9)


def test_no_damping_is_none_and_a_weak_one_is_in_proportion():
    assert touch_damping(0.0) == 0.0
    weak = 1e-9
    assert touch_damping(weak) == pytest.approx(0.75 * np.pi * weak, rel=1e-6)

"""What `contact.laws` asks of the laws of Liu, Long & Ji (2015)."""

from math import inf, pi

import numpy as np

from dilatedem.contact.liu2015.press import BETA, force_change_liu2015, press_liu2015
from dilatedem.jit import device, item
from dilatedem.numerics.vector import dot, norm

MEMORY = ("stiffness", "exponent")
#: the force jumps with the mode: by 100 kN it makes 0.02 J in a single step of the paper's case, and the square of the stride more
LONG_STRIDE = 6

press = press_liu2015
force_change = force_change_liu2015


@device
def carry(contact, old, new):
    """What is left of the spring's elongation when its stiffness [N/m] changes, and what part of the step's displacement stretches
    it: all of both, as in Eqs. (5) and (6), whatever energy that makes."""
    return 1.0, 1.0


@item
def rubbed(contact, dt, opened, old, new, slid, turned, slipped):
    """Energy lost to friction in a step, and energy that the spring was given by changing its stiffness [J].

    opened: the contact is new; old, new: stiffness [N/m], elongation and turning [m] of the spring before the step and after it;
    slid, turned: how the bodies moved, m/s; slipped [m].
    """
    (old_stiffness, before, _), (stiffness, slip, _) = old, new
    made = 0.0
    if not opened:
        made = 0.5 * (stiffness - old_stiffness) * dot(before, slip)
    if slipped == 0.0:
        return 0.0, made
    held = stiffness * norm(slip)
    held_before = held if opened else old_stiffness * norm(before)
    return 0.5 * (held + held_before) * slipped, made


@device
def deepest(contact, reach):
    """Overlap [m] past which the law means nothing, reach: sum of the two radii; here it has a force at any depth."""
    return inf


def resting_stiffness(shapes, free, area, modulus, inverse_mass, speed):
    """(k,) stiffness [N/m] of each body's largest face, Eq. (24); 0 without faces.

    free (k,): bodies; area (k,) [m2] of their largest faces; modulus (k,) [Pa]; inverse_mass (k,) [1/kg] of both together; speed
    [m/s] of an impact.
    """
    return 2.0 * modulus * BETA * np.sqrt(area / pi)

"""What `contact.laws` asks of the law of one energy per pair."""

from math import pi, sqrt

import numpy as np

from dilatedem.contact.consistent.line import line_compliance
from dilatedem.contact.consistent.press import DEEPEST_SHARE, force_change_consistent, press_consistent
from dilatedem.contact.liu2015 import law as liu2015
from dilatedem.contact.spring import rescaled
from dilatedem.jit import device, item
from dilatedem.numerics.plain import norm
from dilatedem.numerics.vector import dot

MEMORY = ("wrung", "grip")
#: the force does not jump; it rises many times over where faces close as they tilt, in a stride of more than so many steps
LONG_STRIDE = 12

press = press_consistent
force_change = force_change_consistent


@device
def carry(contact, old, new):
    """As of `liu2015.law`: what `spring.rescaled` leaves, so that a spring has no energy that it was never given."""
    return rescaled(old, new)


@item
def rubbed(contact, dt, opened, old, new, slid, turned, slipped):
    """As of `liu2015.law`: what the spring took up on the way less what it has now is lost, and nothing is made."""
    (old_stiffness, before, before_turned), (stiffness, slip, wrung) = old, new
    taken = old_stiffness * (dot(before, slid) + before_turned * turned)
    taken += stiffness * (dot(slip, slid) + wrung * turned)
    kept = stiffness * (dot(slip, slip) + wrung * wrung)
    kept -= old_stiffness * (dot(before, before) + before_turned * before_turned)
    return 0.5 * (dt * taken - kept), 0.0


@device
def deepest(contact, reach):
    """Overlap [m] at which the cores are about to touch, and the energy ends."""
    return DEEPEST_SHARE * reach


def resting_stiffness(shapes, free, area, modulus, inverse_mass, speed):
    """As of `liu2015.law`: a square face presses as there; of a body without faces, a capsule that lies along a flat."""
    stiffness = liu2015.resting_stiffness(shapes, free, area, modulus, inverse_mass, speed)
    for k in np.flatnonzero(area == 0.0):
        stiffness[k] = _line_stiffness(shapes, free[k], modulus[k], inverse_mass[k], speed)
    return stiffness


def _line_stiffness(shapes, i: int, modulus: float, inverse_mass: float, speed: float) -> float:
    """Tangent stiffness [N/m] of a capsule that lies along a flat, pressed in by an impact at `speed`; 0 for a sphere."""
    ends = shapes.vertex[shapes.vertex_start[i] : shapes.vertex_start[i + 1]]
    length = float(norm(ends[-1] - ends[0]))
    if length == 0.0 or modulus == 0.0:
        return 0.0
    stiffness = modulus * length
    for _ in range(4):
        overlap = speed / sqrt(inverse_mass * stiffness)
        compliance, _ = line_compliance.py_func(length * length / (shapes.radius[i] * overlap))
        stiffness = pi * modulus * length / (compliance - 0.5)
    return stiffness

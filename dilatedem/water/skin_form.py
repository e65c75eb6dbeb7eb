"""Drag by skin and form: friction along a floe's bottom, pressure on its sides and, where it heaves or tilts, under its bottom.

As the wind acts on what is dry: the sides count as the draught times the mean width, perimeter/pi for any convex outline (Cauchy).
What turns is braked by the same coefficients: the bottom as a disc of the same area, of radius a, the sides as a plate of the mean
width that turns about its middle. A body that is no upright prism counts as a sphere of its effective radius, of which as much is
under water as it displaces.
"""

from math import pi, sqrt

from dilatedem.jit import device, item
from dilatedem.numerics.vector import add, cross, scale, sub
from dilatedem.water.current import current_at, share_above, share_at
from dilatedem.water.sea import SURFACE

#: integrals over a disc of radius 1: of r^3, braking what turns about its axis, and of |x|^3, about a diameter
ROUND, ACROSS = 0.4 * pi, 8.0 / 15.0


@device
def plan_area(i, hulls):
    """m2, of body i seen from above."""
    return hulls.plan[i, 0] if hulls.prism[i] else pi * hulls.effective_radius[i] ** 2


@device
def draught(i, hulls, wet):
    """Mean depth [m] of body i under the surface: the volume under water over the plan area."""
    return wet[i, SURFACE] / plan_area(i, hulls)


@item
def skin_form_drag(i, time, setting, hulls, wet, past, spin):
    """Force [N] and torque about the centroid [N m] on body i, of which some is under water.

    past: its velocity [m/s] against the water of the waves; spin: how it turns against it [rad/s]; the current is taken from both
    here, at the depth of the bottom and as the mean over the draught.
    """
    area, deep = plan_area(i, hulls), draught(i, hulls, wet)
    width, bottom = 0.75 * pi * hulls.effective_radius[i], -hulls.effective_radius[i]
    if hulls.prism[i]:
        width, bottom = hulls.plan[i, 4] / pi, hulls.height[i, 0]
    (current_x, current_y), rho = current_at(time, setting), setting.water_density
    low, mean = share_at(deep, setting), share_above(deep, setting)
    skin = _braked(0.5 * rho * setting.skin * area, sub(past, (low * current_x, low * current_y, past[2])))
    form = _braked(0.5 * rho * setting.form * width * deep, sub(past, (mean * current_x, mean * current_y, past[2])))
    press = _braked(0.5 * rho * setting.form * area, (0.0, 0.0, past[2]))
    torque = add(cross((0.0, 0.0, bottom), skin), cross((0.0, 0.0, bottom + 0.5 * deep), form))
    fifth = sqrt(area / pi) ** 5
    upright = _braked(
        0.5 * rho * (setting.skin * ROUND * fifth + setting.form * deep * width**4 / 32.0), (0.0, 0.0, spin[2])
    )
    tilting = _braked(0.5 * rho * setting.form * ACROSS * fifth, (spin[0], spin[1], 0.0))
    return add(add(skin, form), press), add(torque, add(upright, tilting))


@device
def _braked(strength, past):
    """-strength |past| past."""
    return scale(-strength * sqrt(past[0] * past[0] + past[1] * past[1] + past[2] * past[2]), past)

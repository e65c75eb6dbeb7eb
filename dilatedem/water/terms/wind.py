"""Drag of the wind on what stands out of the water: skin friction on the upper face, form drag on the sides.

Quadratic in the wind against the floe, like the drag of the water. The skin sees a floe's plan area, the form its freeboard times
its mean width, perimeter/pi for any convex outline (Cauchy).
"""

from math import pi

import numpy as np

from dilatedem.jit import item
from dilatedem.numerics.series import linear
from dilatedem.numerics.vector import add, cross, dot, load, norm, scale, sub
from dilatedem.water.sea import LEVEL
from dilatedem.water.term import LoadTerm

#: s over which it changes at least: a floe follows the wind within minutes
SHORTEST_TIME = 1.0


def of_case(case) -> dict:
    """wind_x, wind_y [m/s]; wind_density [kg/m3]; wind_skin, wind_form: coefficients.

    At sea wind (k, 2) [m/s] at wind_time (k,) [s].
    """
    wind, rows = case.wind, np.array(case.wind.history, float)
    return {
        "wind_x": float(rows[0, 1]), "wind_y": float(rows[0, 2]), "wind_density": wind.density, "wind_skin": wind.skin_coefficient,
        "wind_form": wind.form_coefficient, "wind_time": rows[:, 0].copy(), "wind": rows[:, 1:].copy(),
    }  # fmt: skip


@item
def wind(i, time, setting, hulls, solids, bodies, wet):
    """Of a steady wind, over still water."""
    return _blow(i, (setting.wind_x, setting.wind_y, 0.0), 0.0, setting, hulls, bodies)


@item
def wind_at_sea(i, time, setting, hulls, solids, bodies, wet):
    """Of a wind that a table tells, over the surface there is."""
    air = linear(setting.wind_time, setting.wind, 0, time), linear(setting.wind_time, setting.wind, 1, time), 0.0
    return _blow(i, air, wet[i, LEVEL] if setting.water else 0.0, setting, hulls, bodies)


@item
def _blow(i, air, surface, setting, hulls, bodies):
    """Horizontal; the skin's part acts at the height of the upper face, the form's half-way up the freeboard.

    air: velocity [m/s]; surface: height of the water [m]. A body that is no upright prism counts as a sphere of its effective
    radius.
    """
    none = (0.0, 0.0, 0.0)
    if air[0] == 0.0 and air[1] == 0.0:
        return none, none, 0.0
    if hulls.prism[i]:
        area, width = hulls.plan[i, 0], hulls.plan[i, 4] / pi
        bottom, top = hulls.height[i, 0], hulls.height[i, 1]
    else:
        top = hulls.effective_radius[i]
        area, width, bottom = pi * top * top, 0.5 * pi * top, -top
    level = max(surface - bodies.position[i, 2], bottom) if setting.water else bottom  # of the water, from the centroid
    if level >= top:
        return none, none, 0.0
    v, w = load(bodies.velocity, i), load(bodies.angular_velocity, i)
    u = sub(air, (v[0], v[1], 0.0))
    press = 0.5 * setting.wind_density * norm(u)
    skin, form = scale(press * setting.wind_skin * area, u), scale(press * setting.wind_form * width * (top - level), u)
    force = add(skin, form)
    torque = add(cross((0.0, 0.0, top), skin), cross((0.0, 0.0, 0.5 * (top + level)), form))
    return force, torque, dot(force, v) + dot(torque, w)


def is_on(setting) -> bool:
    """A wind of no speed is none, not still air."""
    return setting.wind_x != 0.0 or setting.wind_y != 0.0 or bool(np.any(getattr(setting, "wind", 0.0)))


def shortest_time(case) -> float:
    """A table may change faster than floes follow: from row to row."""
    return min([SHORTEST_TIME, *np.diff([row[0] for row in case.wind.history])])


PARAMETERS = ("wind_x", "wind_y", "wind_density", "wind_skin", "wind_form")
TERM = LoadTerm(
    PARAMETERS, of_case, wind, work="work_wind", is_on=is_on, shortest_time=shortest_time, at_sea=wind_at_sea,
    sea_parameters=("wind_time", "wind"),
)  # fmt: skip

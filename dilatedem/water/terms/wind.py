"""Drag of a steady wind on what stands out of the water: skin friction on the upper face, form drag on the sides.

Quadratic in the wind against the floe, like the drag of the water. The skin sees a floe's plan area, the form its freeboard times
its mean width, perimeter/pi for any convex outline (Cauchy).
"""

from math import pi

from dilatedem.jit import item
from dilatedem.numerics.vector import add, cross, dot, load, norm, scale, sub
from dilatedem.water.term import LoadTerm

#: s over which it changes at least: the wind is steady, and a floe follows it within minutes
SHORTEST_TIME = 1.0


def of_case(case) -> dict[str, float]:
    """wind_x, wind_y [m/s]; wind_density [kg/m3]; wind_skin, wind_form: coefficients."""
    wind = case.wind
    return {
        "wind_x": wind.velocity[0], "wind_y": wind.velocity[1], "wind_density": wind.density, "wind_skin": wind.skin_coefficient,
        "wind_form": wind.form_coefficient,
    }  # fmt: skip


@item
def wind(i, time, setting, hulls, solids, bodies, wet):
    """Horizontal; the skin's part acts at the height of the upper face, the form's half-way up the freeboard.

    A body that is no upright prism counts as a sphere of its effective radius.
    """
    none = (0.0, 0.0, 0.0)
    if setting.wind_x == 0.0 and setting.wind_y == 0.0:
        return none, none, 0.0
    if hulls.prism[i]:
        area, width = hulls.plan[i, 0], hulls.plan[i, 4] / pi
        bottom, top = hulls.height[i, 0], hulls.height[i, 1]
    else:
        top = hulls.effective_radius[i]
        area, width, bottom = pi * top * top, 0.5 * pi * top, -top
    level = max(-bodies.position[i, 2], bottom) if setting.water else bottom  # of the water, from the centroid
    if level >= top:
        return none, none, 0.0
    v, w = load(bodies.velocity, i), load(bodies.angular_velocity, i)
    u = sub((setting.wind_x, setting.wind_y, 0.0), (v[0], v[1], 0.0))
    press = 0.5 * setting.wind_density * norm(u)
    skin, form = scale(press * setting.wind_skin * area, u), scale(press * setting.wind_form * width * (top - level), u)
    force = add(skin, form)
    torque = add(cross((0.0, 0.0, top), skin), cross((0.0, 0.0, 0.5 * (top + level)), form))
    return force, torque, dot(force, v) + dot(torque, w)


def is_on(setting) -> bool:
    """A wind of no speed is none, not still air."""
    return setting.wind_x != 0.0 or setting.wind_y != 0.0


PARAMETERS = ("wind_x", "wind_y", "wind_density", "wind_skin", "wind_form")
TERM = LoadTerm(PARAMETERS, of_case, wind, work="work_wind", is_on=is_on, shortest_time=lambda case: SHORTEST_TIME)

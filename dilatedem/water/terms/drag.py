"""Drag of the current on the wetted surface (Liu 2015, Eqs. 26 and 27); at sea also of waves, or by skin and form."""

import numpy as np

from dilatedem.jit import item
from dilatedem.numerics.series import sums_from
from dilatedem.numerics.vector import dot, load, norm, scale, sub
from dilatedem.water.current import current_at, share_above
from dilatedem.water.sea import SPIN, SURFACE, WATER
from dilatedem.water.skin_form import draught, skin_form_drag
from dilatedem.water.term import LoadTerm

#: s over which it changes at least: a floe takes up the current's speed in many seconds
SHORTEST_TIME = 1.0


def of_case(case) -> dict:
    """current_x, current_y [m/s]; drag_force, drag_moment: C_d^F of Eq. (26), C_d^M of Eq. (27).

    At sea: current (k, 2) [m/s] at current_time (k,) [s], current_way (k, 2) [m] that it has come since t = 0; shear (m, 1), its
    share at shear_depth (m,) [m], and shear_sum, the integral of that; skin_form: whether by skin and form, and coefficients.
    """
    water = case.water
    rows = np.array(water.history if water.enabled else [[0.0, 0.0, 0.0]], float)
    shear = np.array(water.shear or [[0.0, 1.0]], float)
    times, current, depths, shares = rows[:, 0].copy(), rows[:, 1:].copy(), shear[:, 0].copy(), shear[:, 1:].copy()
    return {
        "current_x": float(current[0, 0]), "current_y": float(current[0, 1]), "drag_force": water.drag_force_coefficient,
        "drag_moment": water.drag_moment_coefficient, "current_time": times, "current": current,
        "current_way": sums_from(0.0, times, current), "shear_depth": depths, "shear": shares,
        "shear_sum": sums_from(0.0, depths, shares), "skin_form": water.drag == "skin_form", "skin": water.skin_coefficient,
        "form": water.form_coefficient,
    }  # fmt: skip


@item
def drag(i, time, setting, hulls, solids, bodies, wet):
    """Quadratic in the velocity against the water, and in the spin."""
    if not setting.water or wet[i, 0] == 0.0:
        return (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), 0.0
    density, wetted = setting.water_density, wet[i, 4]
    v = load(bodies.velocity, i)
    u = sub(v, (setting.current_x, setting.current_y, 0.0))
    force = scale(-0.5 * setting.drag_force * density * wetted * norm(u), u)  # Eq. (26)
    w = load(bodies.angular_velocity, i)
    size = hulls.effective_radius[i]
    brake = scale(-0.5 * setting.drag_moment * size**3 * density * wetted * norm(w), w)  # Eq. (27)
    return force, brake, dot(force, v) + dot(brake, w)


@item
def drag_at_sea(i, time, setting, hulls, solids, bodies, wet):
    """The same against the mean current over the draught and the water of the waves, or by skin and form."""
    if not setting.water or wet[i, SURFACE] == 0.0:
        return (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), 0.0
    v, w = load(bodies.velocity, i), load(bodies.angular_velocity, i)
    past = sub(v, (wet[i, WATER], wet[i, WATER + 1], wet[i, WATER + 2]))
    spin = sub(w, (wet[i, SPIN], wet[i, SPIN + 1], 0.0))
    if setting.skin_form:
        force, brake = skin_form_drag(i, time, setting, hulls, wet, past, spin)
    else:
        u, v_y = current_at(time, setting)
        share = share_above(draught(i, hulls, wet), setting)
        past = sub(past, (share * u, share * v_y, 0.0))
        strength, size = -0.5 * setting.water_density * wet[i, SURFACE + 4], hulls.effective_radius[i]
        force = scale(strength * setting.drag_force * norm(past), past)  # Eq. (26)
        brake = scale(strength * setting.drag_moment * size**3 * norm(spin), spin)  # Eq. (27)
    return force, brake, dot(force, v) + dot(brake, w)


def shortest_time(case) -> float:
    """A table may change faster than floes follow: from row to row."""
    return min([SHORTEST_TIME, *np.diff([row[0] for row in case.water.history])])


PARAMETERS = ("current_x", "current_y", "drag_force", "drag_moment")
AT_SEA = ("current_time", "current", "current_way", "shear_depth", "shear", "shear_sum", "skin_form", "skin", "form")
TERM = LoadTerm(
    PARAMETERS, of_case, drag, work="work_drag", shortest_time=shortest_time, at_sea=drag_at_sea, sea_parameters=AT_SEA
)

"""Drag of the current on the wetted surface (Liu 2015, Eqs. 26 and 27)."""

from dilatedem.jit import item
from dilatedem.numerics.vector import dot, load, norm, scale, sub
from dilatedem.water.term import LoadTerm

#: s over which it changes at least: a floe takes up the current's speed in many seconds
SHORTEST_TIME = 1.0


def of_case(case) -> dict[str, float]:
    """current_x, current_y [m/s]; drag_force, drag_moment: C_d^F of Eq. (26), C_d^M of Eq. (27)."""
    current_x, current_y = case.water.velocity if case.water.enabled else (0.0, 0.0)
    return {
        "current_x": current_x, "current_y": current_y, "drag_force": case.water.drag_force_coefficient,
        "drag_moment": case.water.drag_moment_coefficient,
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


PARAMETERS = ("current_x", "current_y", "drag_force", "drag_moment")
TERM = LoadTerm(PARAMETERS, of_case, drag, work="work_drag", shortest_time=lambda case: SHORTEST_TIME)

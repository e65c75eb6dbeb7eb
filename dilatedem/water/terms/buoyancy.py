"""Buoyancy of still water, with its righting moment (Liu 2015, Eq. 25)."""

from dilatedem.jit import item
from dilatedem.numerics.rotation import rotation_matrix, to_world
from dilatedem.numerics.vector import cross
from dilatedem.water.term import LoadTerm

#: s over which it changes at least: a floe heaves and rolls within seconds
SHORTEST_TIME = 1.0


def of_case(case) -> dict[str, float]:
    """water: whether there is any; water_density [kg/m3]."""
    return {"water": case.water.enabled, "water_density": case.water.density}


@item
def buoyancy(i, time, setting, hulls, solids, bodies, wet):
    """The weight of the water displaced, upwards at its centroid; its work is the energy `buoyancy`."""
    volume = wet[i, 0] if setting.water else 0.0
    if volume == 0.0:
        return (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), 0.0
    lift = setting.water_density * setting.gravity * volume
    q = bodies.orientation
    R = rotation_matrix(q[i, 0], q[i, 1], q[i, 2], q[i, 3])
    return (0.0, 0.0, lift), cross(to_world(R, (wet[i, 1], wet[i, 2], wet[i, 3])), (0.0, 0.0, lift)), 0.0


TERM = LoadTerm(("water", "water_density"), of_case, buoyancy, shortest_time=lambda case: SHORTEST_TIME)

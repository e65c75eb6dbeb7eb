"""What waves do to a floe beyond still water: the pressure under their surface, and the acceleration of water that it takes along.

The pressure of water that is accelerated as a whole is that of water at rest under a gravity that is tilted and lessened: its force
on the volume V under the surface is rho V (g + a), at the centre of V. Of it the force of still water, which has an energy of its
own, is taken away. Water that the floe takes along (`water.added_mass`) resists an acceleration against the water around alone, so
that the water's own acceleration pushes it. For floes that are short against the wave.
"""

from math import cos, pi, sin

import numpy as np

from dilatedem.jit import item
from dilatedem.numerics.rotation import rotation_matrix, to_world
from dilatedem.numerics.vector import add, cross, dot, load, scale
from dilatedem.water.sea import ACCELERATION, SURFACE, TURNING
from dilatedem.water.term import LoadTerm

#: share of the shortest period over which loads count as changing: free bodies then take 500 steps a period at least
CHANGING = 0.5


def of_case(case) -> dict:
    """wave (w, 7): of each component what `water.waves` reads; no rows: no waves."""
    return {"wave": np.array([_component(wave, case.gravity.acceleration) for wave in case.wave], float).reshape(-1, 7)}


def _component(wave, gravity: float) -> list[float]:
    direction, omega = wave.direction * pi / 180.0, 2.0 * pi / wave.period
    k = omega * omega / gravity  # deep water
    return [wave.amplitude, k * cos(direction), k * sin(direction), k, omega, wave.phase * pi / 180.0, wave.rise]


@item
def wave_load(i, time, setting, hulls, solids, bodies, wet):
    """Zero for a body that is above the surface, but for what still water would do there."""
    none = (0.0, 0.0, 0.0)
    if len(setting.wave) == 0:
        return none, none, 0.0
    q, weight = bodies.orientation, setting.water_density * setting.gravity
    R = rotation_matrix(q[i, 0], q[i, 1], q[i, 2], q[i, 3])
    still = (0.0, 0.0, weight * wet[i, 0])
    force, torque = scale(-1.0, still), scale(-1.0, cross(to_world(R, (wet[i, 1], wet[i, 2], wet[i, 3])), still))
    volume = wet[i, SURFACE]
    if volume > 0.0:
        a = wet[i, ACCELERATION], wet[i, ACCELERATION + 1], wet[i, ACCELERATION + 2]
        press = scale(setting.water_density * volume, (a[0], a[1], a[2] + setting.gravity))
        centre = to_world(R, (wet[i, SURFACE + 1], wet[i, SURFACE + 2], wet[i, SURFACE + 3]))
        along, heave, turning = solids.added_mass[i, 0], solids.added_mass[i, 1], solids.added_inertia[i]
        force = add(force, add(press, (along * a[0], along * a[1], heave * a[2])))
        torque = add(torque, add(cross(centre, press), (turning * wet[i, TURNING], turning * wet[i, TURNING + 1], 0.0)))
    return force, torque, dot(force, load(bodies.velocity, i)) + dot(torque, load(bodies.angular_velocity, i))


def is_on(setting) -> bool:
    return len(getattr(setting, "wave", ())) > 0


def shortest_time(case) -> float:
    return min((CHANGING * wave.period for wave in case.wave), default=float("inf"))


TERM = LoadTerm(
    (), of_case, None, work="work_wave", is_on=is_on, shortest_time=shortest_time, at_sea=wave_load, sea_parameters=("wave",)
)

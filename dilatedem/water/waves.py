"""Airy waves of deep water: the surface at a floe, and how the water under it moves.

A sum of components a cos(theta), theta = k.(x - X) - omega t + phi, omega^2 = g k; X is the way that the current has come, so that
the waves ride on it and a floe that drifts with the current sees them as in still water. `setting.wave` (w, 7) has a row a
component: a [m], k_x, k_y, k [1/m], omega [rad/s], phi [rad], and the time [s] over which it rises. Depths are counted from the
surface as it is at the instant, and motion falls with them as exp(-k depth).
"""

from math import cos, exp, sin

from dilatedem.jit import device
from dilatedem.water.current import way_of_current


@device
def _angle(w, x, y, time, wave):
    """theta [rad] of component w at (x, y) [m] of the water that moves along."""
    return wave[w, 1] * x + wave[w, 2] * y - wave[w, 4] * time + wave[w, 5]


@device
def _amplitude(w, time, wave):
    """a [m] of component w at `time` [s]; it begins and ends to rise gently."""
    if time >= wave[w, 6]:
        return wave[w, 0]
    x = time / wave[w, 6]
    return wave[w, 0] * x * x * (3.0 - 2.0 * x)


@device
def surface(x, y, time, setting):
    """Height [m] of the water's surface over (x, y) [m] at `time` [s], and its slopes along x and y."""
    wave, (way_x, way_y) = setting.wave, way_of_current(time, setting)
    height = slope_x = slope_y = 0.0
    for w in range(len(wave)):
        theta, amplitude = _angle(w, x - way_x, y - way_y, time, wave), _amplitude(w, time, wave)
        height += amplitude * cos(theta)
        slope_x -= wave[w, 1] * amplitude * sin(theta)
        slope_y -= wave[w, 2] * amplitude * sin(theta)
    return height, slope_x, slope_y


@device
def moving_water(x, y, depth, time, setting):
    """How the waves move the water at (x, y) [m] and a depth [m] under the surface, at `time` [s].

    Returns velocity [m/s], acceleration [m/s2], and about x and y how fast [rad/s] level planes of water turn, and the rate
    [rad/s2] of that. The acceleration is that of linear theory, without what the motion carries along (of second order).
    """
    wave, (way_x, way_y) = setting.wave, way_of_current(time, setting)
    u = v = w = a_x = a_y = a_z = spin_x = spin_y = turning_x = turning_y = 0.0
    for n in range(len(wave)):
        theta = _angle(n, x - way_x, y - way_y, time, wave)
        kx, ky, k, omega = wave[n, 1], wave[n, 2], wave[n, 3], wave[n, 4]
        speed = _amplitude(n, time, wave) * omega * exp(-k * depth)
        along, up = speed * cos(theta), speed * sin(theta)
        u += along * kx / k
        v += along * ky / k
        w += up
        a_x += omega * up * kx / k
        a_y += omega * up * ky / k
        a_z -= omega * along
        spin_x += ky * along
        spin_y -= kx * along
        turning_x += omega * ky * up
        turning_y -= omega * kx * up
    return (u, v, w), (a_x, a_y, a_z), (spin_x, spin_y), (turning_x, turning_y)

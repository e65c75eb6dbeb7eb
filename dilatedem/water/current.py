"""The current that floes are in: a table of time, and what share of it reaches a depth."""

from dilatedem.jit import device
from dilatedem.numerics.series import integral, linear


@device
def current_at(time, setting):
    """Velocity (u, v) [m/s] of the water at its surface at `time` [s]."""
    return linear(setting.current_time, setting.current, 0, time), linear(setting.current_time, setting.current, 1, time)


@device
def way_of_current(time, setting):
    """How far (x, y) [m] the water at the surface has come since t = 0."""
    return (
        integral(setting.current_time, setting.current, setting.current_way, 0, time),
        integral(setting.current_time, setting.current, setting.current_way, 1, time),
    )


@device
def share_at(depth, setting):
    """Velocity of the current at a depth [m] over that at the surface."""
    return linear(setting.shear_depth, setting.shear, 0, depth)


@device
def share_above(depth, setting):
    """The mean of `share_at` from the surface down to a depth [m]."""
    if depth <= 0.0:
        return share_at(0.0, setting)
    return integral(setting.shear_depth, setting.shear, setting.shear_sum, 0, depth) / depth

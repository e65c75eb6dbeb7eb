"""Root of a function of one variable, by Brent's method."""

from collections.abc import Callable

# Evaluations at most: bisection alone needs 60 for all digits, and the method at worst some times as many.
MOST_STEPS = 200


def bracketed_root(function: Callable[[float], float], low: float, high: float, *, absolute: float, relative: float) -> float:
    """Where `function` passes 0 between `low` and `high`, where its signs differ; to within `absolute` + `relative` of it.

    R. P. Brent, Algorithms for Minimization Without Derivatives (1973), chapter 4, step for step and digit for digit as
    scipy.optimize.brentq, whose import takes longer than building a small field. Raises ValueError if the signs are the same.
    """
    before, here = low, high  # `here` is the best so far, `across` the latest on the other side of the root
    value_before, value = function(before), function(here)
    if value_before == 0.0 or value == 0.0:
        return before if value_before == 0.0 else here
    if (value_before < 0.0) == (value < 0.0):
        raise ValueError(f"no change of sign between {low:g} and {high:g}")
    across = value_across = step = step_before = 0.0
    for _ in range(MOST_STEPS):
        if (value_before < 0.0) != (value < 0.0):
            across, value_across = before, value_before
            step = step_before = here - before
        if abs(value_across) < abs(value):
            before, here, across = here, across, here
            value_before, value, value_across = value, value_across, value
        near = (absolute + relative * abs(here)) / 2.0
        half = (across - here) / 2.0
        if value == 0.0 or abs(half) < near:
            return here
        tried = None
        if abs(step_before) > near and abs(value) < abs(value_before):
            tried = _interpolated(before, here, across, value_before, value, value_across)
        if tried is not None and 2.0 * abs(tried) < min(abs(step_before), 3.0 * abs(half) - near):
            step_before, step = step, tried
        else:
            step_before = step = half
        before, value_before = here, value
        here += step if abs(step) > near else (near if half > 0.0 else -near)
        value = function(here)
    return here


def _interpolated(
    before: float, here: float, across: float, value_before: float, value: float, value_across: float
) -> float | None:
    """Step from `here` to the root of the secant, or of the inverse parabola through three places; None if there is none."""
    if before == across:
        return -value * (here - before) / (value - value_before)
    slope_before = (value_before - value) / (before - here)
    slope_across = (value_across - value) / (across - here)
    change = value_across * slope_across - value_before * slope_before
    divisor = slope_across * slope_before * (value_across - value_before)
    return -value * change / divisor if divisor != 0.0 else None

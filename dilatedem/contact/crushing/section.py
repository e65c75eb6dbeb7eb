"""A convex polygon that half planes leave of the contact plane, with rounded corners: cut, and measured.

The half planes of both bodies, and how their edges are rounded in plan, are those of `nominal`.
"""

from math import atan2, pi, sqrt

from dilatedem.jit import device
from dilatedem.state.storage import MOST_CORNERS

#: rows of `scratch` with the half planes of a, by number: u and v of the outward direction, share of the edge that is rounded |
#: where the rounding begins, tangent of the slope behind it, how far the body reaches by itself | offset, its rate, radius of the
#: rounding in plan; those of b stand in the next rows. Rows 0 and 1 hold the polygon that is cut: u, v, and the half plane along
#: the side that begins there
DIRECTION, EDGE, OFFSET = 2, 4, 6
#: cosine of the angle of two half planes from which on their rounded corner lacks less, and nothing where they face each other
NEEDLE = -0.6
#: sine of the angle of two directions beyond which two bodies that recede along them leave each other alone
ASKEW = 0.2


@device
def _missing(sine, cosine, one_body):
    """What a rounded corner lacks of a sharp one between two half planes, by their angle, for roundings of 1 m: between the
    tangents and the arc, or (of two edges that cross) the ellipse."""
    if one_body:
        return (sine - 0.5 * (1.0 + cosine) * atan2(sine, cosine)) / (1.0 + max(cosine, NEEDLE))
    return (1.0 - 0.25 * pi) * sine * (1.0 + ASKEW * ASKEW) / (sine * sine + ASKEW * ASKEW)


@device
def cut(source, count, target, u, v, offset, number):
    """The part of a polygon where u x + v y <= offset, to `target`; returns its corner count. number: of the half plane."""
    kept = 0
    sj = u * source[0, 0] + v * source[0, 1] - offset
    for i in range(count):
        j = i + 1 if i + 1 < count else 0
        si, sj = sj, u * source[j, 0] + v * source[j, 1] - offset
        if si <= 0.0:
            target[kept, 0], target[kept, 1], target[kept, 2] = source[i, 0], source[i, 1], source[i, 2]
            kept += 1
        if (si < 0.0 and sj > 0.0) or (si > 0.0 and sj < 0.0):
            t = si / (si - sj)
            target[kept, 0] = source[i, 0] + t * (source[j, 0] - source[i, 0])
            target[kept, 1] = source[i, 1] + t * (source[j, 1] - source[i, 1])
            target[kept, 2] = number if si < 0.0 else source[i, 2]
            kept += 1
    return kept


@device
def _side(polygon, count, i):
    """Length [m] of the side of a polygon that begins at corner i."""
    j = i + 1 if i + 1 < count else 0
    x, y = polygon[j, 0] - polygon[i, 0], polygon[j, 1] - polygon[i, 1]
    return sqrt(x * x + y * y)


@device
def _rounded_off(polygon, count, first, scratch):
    """What the corners between a side of the polygon and those after it lack of sharp ones [m2].

    A side shorter than the rounding counts in part, and for the rest those beside it meet across it: where a half plane no longer
    cuts the polygon, nothing jumps.
    """
    number = int(polygon[first, 2])
    if number < 0:
        return 0.0
    which, k = number // MOST_CORNERS, number % MOST_CORNERS
    rounding = scratch[OFFSET + which, k, 2]
    if rounding == 0.0:
        return 0.0
    u, v = scratch[DIRECTION + which, k, 0], scratch[DIRECTION + which, k, 1]
    lacking, through = 0.0, min(_side(polygon, count, first) / rounding, 1.0)
    for step in range(1, count):
        i = first + step if first + step < count else first + step - count
        solid, number = min(_side(polygon, count, i) / rounding, 1.0), int(polygon[i, 2])
        if number >= 0:
            other, m = number // MOST_CORNERS, number % MOST_CORNERS
            p, q = scratch[DIRECTION + other, m, 0], scratch[DIRECTION + other, m, 1]
            sine, cosine = u * q - v * p, u * p + v * q
            if sine > 0.0:
                lacking += through * solid * _missing(sine, cosine, which == other) * rounding * scratch[OFFSET + other, m, 2]
        through *= 1.0 - solid
        if through <= 0.0:
            break
    return lacking


@device
def measure(polygon, count, scratch):
    """Area of the polygon less what its rounded corners lack [m2], how fast it grows as its half planes move [m], and how far its
    farthest corner is [m]."""
    sharp, lacking, rate, square = 0.0, 0.0, 0.0, 0.0
    for i in range(count):
        j, number = i + 1 if i + 1 < count else 0, int(polygon[i, 2])
        sharp += 0.5 * (polygon[i, 0] * polygon[j, 1] - polygon[j, 0] * polygon[i, 1])
        lacking += _rounded_off(polygon, count, i, scratch)
        square = max(square, polygon[i, 0] * polygon[i, 0] + polygon[i, 1] * polygon[i, 1])
        if number >= 0:
            rate += scratch[OFFSET + number // MOST_CORNERS, number % MOST_CORNERS, 1] * _side(polygon, count, i)
    if sharp <= lacking:
        return 0.0, 0.0, 0.0
    return sharp - lacking, rate * (1.0 - lacking / sharp), sqrt(square)

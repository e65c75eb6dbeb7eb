"""What an edge or a vertex can press at most, told for a fraction of the time that its energy takes."""

from math import log, pi, sqrt

from dilatedem.contact.consistent.cap import UNBOUNDED, corner_of, side_of
from dilatedem.contact.consistent.line import BASE, BEND, LEVEL, line_compliance, pressing
from dilatedem.jit import device, item
from dilatedem.numerics.vector import along, cross, dot, sub

HERTZ = 8.0 / 15.0
#: row of `scratch` (the next: of cap b) that holds the bounds of each edge of cap a: integral of the squared overlap along what
#: presses of it, the length of that and its deepest overlap
BOUNDS = 6
#: `line_compliance`, or a little less, at L^2/(R* overlap) = 1e2, 1e3, 1e4, 1e5
SLENDER_2, SLENDER_3, SLENDER_4, SLENDER_5 = (BASE + log(x) + BEND * log(x) / (log(x) + LEVEL) for x in (1e2, 1e3, 1e4, 1e5))


@device
def line_bound(modulus, second, length, overlap, curvature):
    """Upper bound of the energy of an edge with the integral `second` of its squared overlap, no more than `overlap` anywhere, no
    longer than `length`."""
    short = second / (overlap * overlap)  # the shorter the line, the stiffer
    return 0.5 * pi * modulus * second / line_compliance(min(short, length) ** 2 * curvature / overlap)[0]


@device
def surely_below(modulus, second, length, overlap, radius, least):
    """Whether `line_bound` is below `least`, told without its logarithm; False where that cannot tell."""
    short = min(second, length * overlap * overlap)  # the shorter length, times the squared overlap
    x, unit = short * short, overlap * overlap * overlap * overlap * overlap * radius
    compliance = SLENDER_2
    if x > 1e5 * unit:
        compliance = SLENDER_5
    elif x > 1e4 * unit:
        compliance = SLENDER_4
    elif x > 1e3 * unit:
        compliance = SLENDER_3
    elif x < 1e2 * unit:
        return False
    return 0.5 * pi * modulus * second < least * compliance


@device
def point_bound(modulus, overlap, radius):
    """Upper bound of the energy of a vertex that presses by at most `overlap`."""
    return HERTZ * modulus * overlap * overlap * sqrt(overlap * radius)


@device
def _within_reach(scratch, which, count, normal, p, e, height, fall, low, high, reach):
    """The part of low..high of an edge p + s e that is within `reach` of cap `which`, or a little more; empty: the second is not
    above the first.

    height - s fall: above the cap's plane. Past a side of the cap nothing is nearer than that side, taken as a line without ends.
    """
    for k in range(count):
        if high <= low:
            break
        out = cross(side_of(scratch, which, k), normal)
        past, rate = dot(sub(p, corner_of(scratch, which, k)), out), dot(e, out)
        if max(past + rate * low, past + rate * high) <= 0.0:
            continue
        a, b, c = rate * rate + fall * fall, past * rate - height * fall, past * past + height * height - reach * reach
        root, first, last = b * b - a * c, high, low
        if root > 0.0:
            root = sqrt(root)
            first, last = (-b - root) / a, (-b + root) / a
        elif a == 0.0 and c < 0.0:
            first, last = low, high
        if rate > 0.0:
            high = min(high, max(-past / rate, last))
        elif rate < 0.0:
            low = max(low, min(-past / rate, first))
        else:
            low, high = max(low, first), min(high, last)
    return low, high


@device
def _bound_on_flat(scratch, which, count, normal, p, e, length, reach, overlap):
    """Bounds of an edge, as of BOUNDS, on a cap that has a face: its overlap with the plane where it is within reach of the cap."""
    u, rate = reach - dot(sub(p, corner_of(scratch, which, 0)), normal), -dot(e, normal)
    low, high = 0.0, length
    if max(u, u + rate * length) <= 0.0:
        return 0.0, 0.0, 0.0
    if u < 0.0:
        low = -u / rate
    elif u + rate * length < 0.0:
        high = -u / rate
    low, high = _within_reach(scratch, which, count, normal, p, e, reach - u, rate, low, high, reach)
    if high <= low:
        return 0.0, 0.0, 0.0
    first, last = max(u + rate * low, 0.0), max(u + rate * high, 0.0)
    pressed, deepest = high - low, min(max(first, last), overlap)
    return min(pressed * (first * first + first * last + last * last) / 3.0, pressed * deepest * deepest), pressed, deepest


@device
def _bound_on_rim(scratch, which, count, p, e, length, reach):
    """Bounds of an edge, as of BOUNDS, on a cap that is a segment, taken as a line without ends, or a point."""
    w, turn = sub(p, corner_of(scratch, which, 0)), e
    if count == 2:
        side = side_of(scratch, which, 0)
        w, turn = along(w, -dot(w, side), side), along(e, -dot(e, side), side)
    low, high = pressing(w, turn, reach, 0.0, length)
    if high <= low:
        return 0.0, 0.0, 0.0
    square, rate = dot(turn, turn), -dot(w, turn)
    nearest = along(w, min(max(rate / square, low), high) if square > 0.0 else low, turn)
    deepest = 0.5 * (reach * reach - dot(nearest, nearest)) / reach
    return (high - low) * deepest * deepest, high - low, deepest


@item
def bound_edges(own, scratch, count, their, normal, reach, overlap):
    """Write the bounds of all edges of cap `own` to `scratch`; returns the largest integral of a squared overlap [m3] and its edge.

    count, their: corners of this cap and of the other, whose plane has the `normal`; reach [m]: of both dilations, less what has
    crushed; overlap [m]: the deepest there is.
    """
    which, most, strongest = 1 - own, 0.0, 0
    for i in range(count if count > 2 else count - 1):
        p, e = corner_of(scratch, own, i), side_of(scratch, own, i)
        length = dot(sub(corner_of(scratch, own, i + 1 if i + 1 < count else 0), p), e)
        if their > 2 or their == UNBOUNDED:
            bounds = _bound_on_flat(scratch, which, their, normal, p, e, length, reach, overlap)
        else:
            bounds = _bound_on_rim(scratch, which, their, p, e, length, reach)
        if bounds[0] > most:
            most, strongest = bounds[0], i
        scratch[BOUNDS + own, i, 0], scratch[BOUNDS + own, i, 1], scratch[BOUNDS + own, i, 2] = bounds
    return most, strongest


@device
def edge_counts(own, scratch, i, radius, modulus, least):
    """Whether edge i of cap `own` can have an energy of `least` [J], by its bounds; radius [m]: no less than its R*."""
    second, pressed, deepest = scratch[BOUNDS + own, i, 0], scratch[BOUNDS + own, i, 1], scratch[BOUNDS + own, i, 2]
    if second == 0.0 or least == 0.0:
        return second > 0.0
    if surely_below(modulus, second, pressed, deepest, radius, least):
        return False
    return line_bound(modulus, second, pressed, deepest, 1.0 / radius) >= least

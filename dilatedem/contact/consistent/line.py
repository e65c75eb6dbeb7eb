"""Energy of an edge that presses on the other body's cap: one law for an edge along a face, along an edge and across an edge.

Along the edge the overlap is a quadratic function of the place, piece by piece (over the cap's face, its sides, its corners), so
that three Gauss points a piece integrate it and its gradient exactly.
"""

from math import exp, log, pi, sqrt

from dilatedem.contact.consistent.cap import INTERIOR, SIDE, UNBOUNDED, corner_of, nearest, overhang, ramp, side_of
from dilatedem.contact.consistent.point import BLEND
from dilatedem.jit import device, item
from dilatedem.numerics.vector import add, along, cross, dot, scale, sub

#: constants of Lam = OFFSET + ln(L^2/(R* overlap) + SHORT) + ln Lam. OFFSET: between boundary elements for uniform lines (0.2) and
#: Hertz's elliptic contact of crossing edges (0.45); SHORT: what keeps the law finite where the line is as short as it is wide
OFFSET, SHORT = 0.3, 14.0
#: pieces of one edge: a line that crosses more regions of a cap than this is cut off
MOST_PIECES = 24
#: share of the edge's length stepped over a border between two regions, so that the next look falls on its far side
STEP = 1e-8
#: Gauss-Legendre abscissa and weights on -1..1, exact to degree 5
GAUSS, OUTER, MIDDLE = sqrt(0.6), 5.0 / 9.0, 8.0 / 9.0


@device
def line_energy(modulus, first, second, curvature):
    """Energy [J] of a line contact from the integrals of its overlap and of its square, m2 and m3, and its curvature 1/R* [1/m].

    Returns also its derivatives by the integrals and by the curvature. Uniform line: L = I1^2/I2, overlap = I2/I1, and
    F = pi E* L overlap/Lam with ln(L^2/(R* overlap)) in Lam, the energy's Lam being larger by 1/2.
    """
    ratio = first * first / second
    x = ratio * ratio * first / second * curvature
    start = OFFSET + log(x + SHORT)
    lam = start + log(start)
    lam -= (lam - log(lam) - start) / (1.0 - 1.0 / lam)
    full = lam + 0.5
    energy = 0.5 * pi * modulus * second / full
    fall = energy / (full * (1.0 - 1.0 / lam) * (x + SHORT)) * x
    return energy, -5.0 * fall / first, energy / second + 3.0 * fall / second, -fall / curvature


@item
def _exit(scratch, which, count, normal, region, place, x, e, length):
    """Way along the unit vector e from x to where the line leaves a region of the cap, at most `length`."""
    way = length
    if count == UNBOUNDED or count == 1:
        return way
    if region == INTERIOR:
        for k in range(count):
            out = cross(side_of(scratch, which, k), normal)
            rate = dot(e, out)
            if rate > 0.0:
                way = min(way, -dot(sub(x, corner_of(scratch, which, k)), out) / rate)
        return max(way, 0.0)
    if region == SIDE:
        p, side = corner_of(scratch, which, place), side_of(scratch, which, place)
        d, q = sub(x, p), corner_of(scratch, which, place + 1 if place + 1 < count else 0)
        rate, t = dot(e, side), dot(d, side)
        if rate > 0.0:
            way = min(way, (dot(sub(q, p), side) - t) / rate)
        elif rate < 0.0:
            way = min(way, -t / rate)
        if count > 2:
            out = cross(side, normal)
            rate = dot(e, out)
            if rate < 0.0:
                way = min(way, -dot(d, out) / rate)
        return max(way, 0.0)
    # a corner: until the foot runs along one of its sides
    d = sub(x, corner_of(scratch, which, place))
    for k in range(2):
        side = side_of(scratch, which, place - k if place >= k else count - 1)
        if count == 2:
            side = side_of(scratch, which, 0)
            forward = place == 0
        else:
            forward = k == 0
        rate, t = dot(e, side), dot(d, side)
        if (forward and rate > 0.0 and t < 0.0) or (not forward and rate < 0.0 and t > 0.0):
            way = min(way, -t / rate)
    return max(way, 0.0)


@item
def press_edge(p, e, length, radius, scratch, which, count, normal, other, modulus, shares):
    """Energy W [J] of an edge p + s e, s = 0..length, on cap `which`; force on the edge's body and its moment about the origin;
    length of the contact [m]; 0..1: how far it is past the border of the cap's face.

    radius, other, shares: as in `point.press_vertex`. The overlap is measured as (R^2 - d^2)/(2 R), R the sum of the radii, d the
    distance from the cap: the overlap itself but for overlap/(2 R).
    """
    reach = radius + other
    none = (0.0, 0.0, 0.0)
    low, high = 0.0, length
    if count != 1 and count != 2:
        # no closer than `reach` to the plane of the cap: nothing to press
        z, rate = dot(sub(p, corner_of(scratch, which, 0)), normal) - reach, dot(e, normal)
        if rate > 0.0:
            high = min(high, -z / rate)
        elif rate < 0.0:
            low = max(low, -z / rate)
        elif z >= 0.0:
            high = low
    first = second = third = fourth = 0.0
    f1, f2, f3, f4 = none, none, none, none
    m1, m2, m3, m4 = none, none, none, none
    width = BLEND * reach
    s = low
    for _ in range(MOST_PIECES):
        if s >= high:
            break
        x = along(p, s + STEP * length, e)
        region, place, w = nearest(scratch, which, count, normal, x)
        end = min(high, s + STEP * length + _exit(scratch, which, count, normal, region, place, x, e, high - s))
        # w is linear along the piece: its part at right angles to what the region is spanned by
        if region == INTERIOR:
            turn = scale(dot(e, normal), normal)
        elif region == SIDE:
            side = side_of(scratch, which, place)
            turn = along(e, -dot(e, side), side)
        else:
            turn = e
        a, b, c = dot(turn, turn), dot(w, turn), dot(w, w) - reach * reach
        begin, stop = s, end
        if a > 1e-24:
            root = b * b - a * c
            if root <= 0.0:
                s = end
                continue
            root = sqrt(root)
            begin, stop = max(begin, x_of(s, length) + (-b - root) / a), min(stop, x_of(s, length) + (-b + root) / a)
        elif c >= 0.0:
            s = end
            continue
        if stop > begin:
            half, middle = 0.5 * (stop - begin), 0.5 * (stop + begin)
            for g in range(3):
                at = middle + (g - 1) * GAUSS * half
                weight = half * (MIDDLE if g == 1 else OUTER)
                wg = along(w, at - x_of(s, length), turn)
                overlap = 0.5 * (reach * reach - dot(wg, wg)) / reach
                xg = along(p, at, e)
                push = scale(weight / reach, wg)
                moment = cross(xg, push)
                first += weight * overlap
                second += weight * overlap * overlap
                f1, m1 = add(f1, push), add(m1, moment)
                f2, m2 = along(f2, 2.0 * overlap, push), along(m2, 2.0 * overlap, moment)
                if region != INTERIOR:
                    side, out, side_gradient, out_gradient = overhang(
                        scratch, which, count, normal, region, place, wg, width
                    )
                    square = weight * overlap * overlap
                    third += square * side
                    pull = along(scale(2.0 * overlap * side, push), -square, side_gradient)
                    f3, m3 = add(f3, pull), add(m3, cross(xg, pull))
                    if out > 0.0:
                        fourth += square * out
                        pull = along(scale(2.0 * overlap * out, push), -square, out_gradient)
                        f4, m4 = add(f4, pull), add(m4, cross(xg, pull))
        s = end
    if second <= 0.0:
        return 0.0, none, none, 0.0, 0.0
    their = 1.0 / other if other > 0.0 else 0.0
    # how far, on the mean, the line lies beyond the border of the cap
    side, out = third / second, fourth / second
    across, across_slope = ramp(side / width)
    beyond, beyond_slope = ramp(out / width)
    energy, by_first, by_second, by_curvature = line_energy(modulus, first, second, 1.0 / radius + across * their)
    kept = exp(-shares * across) * (1.0 - 0.5 * beyond)
    by_side = (by_curvature * their - energy * shares) * kept * across_slope / (width * second)
    by_out = -0.5 * energy * exp(-shares * across) * beyond_slope / (width * second)
    by_first *= kept
    by_second = by_second * kept - by_side * side - by_out * out
    force = add(along(scale(by_first, f1), by_second, f2), along(scale(by_side, f3), by_out, f4))
    moment = add(along(scale(by_first, m1), by_second, m2), along(scale(by_side, m3), by_out, m4))
    return energy * kept, force, moment, first * first / second, across


@device
def x_of(s, length):
    """Where the region of a piece that begins at s is looked at."""
    return s + STEP * length

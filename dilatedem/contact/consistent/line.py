"""Energy of an edge that presses on the other body's cap: one law for an edge along a face, along an edge and across an edge.

Along the edge the overlap is a quadratic function of the place, piece by piece (over the cap's face, its sides, its corners), so
that it and its gradient are integrated as polynomials.
"""

from math import exp, log, pi, sqrt

from dilatedem.contact.consistent.cap import CORNER, INTERIOR, SIDE, UNBOUNDED, corner_of, nearest, overhang, side_of
from dilatedem.contact.consistent.point import BLEND
from dilatedem.jit import device, item
from dilatedem.numerics.vector import add, along, cross, dot, scale, sub

#: constants of a line's compliance, Lam + 1/2 = BASE + y + BEND y/(y + LEVEL) with y = ln(L^2/(R* overlap) + STUB): a fit between
#: boundary elements for uniform lines (validation/half_space, sharp ends: force 3 % too small at most, down to a length of half the
#: contact's width) and Hertz's elliptic contact of crossing edges (energy 3 % too large at most)
BASE, BEND, LEVEL, STUB = 2.09, 2.1, 7.4, 0.63
#: share of the edge's length stepped over a border between two regions, so that the next look falls on its far side
STEP = 1e-8
#: squared sine of the angle between an edge and the plane, or the side, below which its distance from them does not change
PARALLEL2 = 1e-24
HALVED = log(2.0)
NONE = (0.0, 0.0, 0.0)
#: Gauss-Legendre abscissae and weights of four points on -1..1, exact to degree 7
OUTER, INNER = sqrt(3.0 / 7.0 + 2.0 / 7.0 * sqrt(1.2)), sqrt(3.0 / 7.0 - 2.0 / 7.0 * sqrt(1.2))
LIGHT, HEAVY = 0.5 - sqrt(30.0) / 36.0, 0.5 + sqrt(30.0) / 36.0


@device
def line_compliance(x):
    """Lam + 1/2 of a line contact with L^2/(R* overlap) = x, and its slope; W = pi/2 E* I2/(Lam + 1/2)."""
    y = log(x + STUB)
    turn = y + LEVEL
    return BASE + y + BEND * y / turn, (1.0 + BEND * LEVEL / (turn * turn)) / (x + STUB)


@device
def line_energy(modulus, first, second, curvature):
    """Energy [J] of a line contact from the integrals of its overlap and of its square, m2 and m3, and its curvature 1/R* [1/m].

    Returns also its derivatives by the integrals and by the curvature. Uniform line: L = I1^2/I2, overlap = I2/I1, and
    F = pi E* L overlap/Lam with ln(L^2/(R* overlap)) in Lam, the energy's Lam being larger by 1/2.
    """
    ratio = first * first / second
    x = ratio * ratio * first / second * curvature
    full, slope = line_compliance(x)
    energy = 0.5 * pi * modulus * second / full
    fall = energy * slope * x / full
    return energy, -5.0 * fall / first, energy / second + 3.0 * fall / second, -fall / curvature


@item
def exit_of_region(scratch, which, count, normal, region, place, x, e, length):
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


@device
def pressing(w, turn, reach, low, high):
    """The part of low..high where |w + s turn| < reach; empty: the second is not above the first."""
    a, b, c = dot(turn, turn), dot(w, turn), dot(w, w) - reach * reach
    if a <= PARALLEL2:
        return low, (high if c < 0.0 else low)
    root = b * b - a * c
    if root <= 0.0:
        return low, low
    root = sqrt(root)
    return max(low, (-b - root) / a), min(high, (-b + root) / a)


@device
def beside_border(w, region, out, normal):
    """The part of a vector from a cap that leads beyond its border: across the side with the normal `out`, or from a corner."""
    return scale(dot(w, out), out) if region == SIDE else along(w, -dot(w, normal), normal)


@item
def _past_corner(x, e, half, w, turn, scratch, which, count, normal, place, reach, width):
    """Integral of the squared overlap times the squared way beyond a corner, minus its gradient as force and moment."""
    i4, f4, m4 = 0.0, NONE, NONE
    for g in range(4):
        at = half * (OUTER if g % 2 == 0 else INNER) * (1.0 if g < 2 else -1.0)
        from_cap, point = along(w, at, turn), along(x, at, e)
        _, corner, _, gradient = overhang(scratch, which, count, normal, CORNER, place, from_cap, width)
        if corner > 0.0:
            overlap = 0.5 * (reach * reach - dot(from_cap, from_cap)) / reach
            square = half * (LIGHT if g % 2 == 0 else HEAVY) * overlap
            pull = along(scale(2.0 * square * corner * corner / reach, from_cap), -2.0 * square * overlap * corner, gradient)
            i4, f4, m4 = i4 + square * overlap * corner * corner, add(f4, pull), add(m4, cross(point, pull))
    return i4, f4, m4


@item
def _add_piece(sums, x, e, low, high, w, turn, scratch, which, count, normal, region, place, reach, width):
    """Add low..high of the line x + s e over one region of the cap, w + s turn from the cap to it, to the sums: the integrals of
    overlap, its square, its square times the squared way beyond the border and beyond a corner, each with minus its
    gradient as force and moment on the edge's body.

    About the middle of the piece all but the last are polynomials of s whose odd powers integrate to nothing.
    """
    i1, i2, f1, f2, m1, m2, i3, f3, m3, i4, f4, m4 = sums
    half, middle = 0.5 * (high - low), 0.5 * (high + low)
    x, w = along(x, middle, e), along(w, middle, turn)
    square = half * half
    s0 = 2.0 * half
    s2 = s0 * square * (1.0 / 3.0)
    s4 = s0 * square * square * 0.2
    push = 1.0 / reach
    c0, c1, c2 = 0.5 * push * (reach * reach - dot(w, w)), -push * dot(w, turn), -0.5 * push * dot(turn, turn)
    q0, q1, q2, q3, q4 = c0 * c0, 2.0 * c0 * c1, c1 * c1 + 2.0 * c0 * c2, 2.0 * c1 * c2, c2 * c2
    d0, d1, d2 = c0 * s0 + c2 * s2, c1 * s2, c0 * s2 + c2 * s4
    second = q0 * s0 + q2 * s2 + q4 * s4
    still, mixed, turned = cross(x, w), add(cross(x, turn), cross(e, w)), cross(e, turn)
    i1, i2 = i1 + d0, i2 + second
    f1, m1 = along(f1, push * s0, w), along(along(m1, push * s0, still), push * s2, turned)
    push *= 2.0
    f2 = along(along(f2, push * d0, w), push * d1, turn)
    m2 = along(along(along(m2, push * d0, still), push * d1, mixed), push * d2, turned)
    if region == INTERIOR or count == UNBOUNDED:
        return i1, i2, f1, f2, m1, m2, i3, f3, m3, i4, f4, m4
    if count > 2:
        out = cross(side_of(scratch, which, place), normal)
        b, c = beside_border(w, region, out, normal), beside_border(turn, region, out, normal)
        b0, b1, b2 = dot(b, b), 2.0 * dot(b, c), dot(c, c)
        s6 = s0 * square * square * square * (1.0 / 7.0)
        square1, square2 = q1 * s2 + q3 * s4, q0 * s2 + q2 * s4 + q4 * s6
        p0, p1, p2, p3, p4 = c0 * b0, c0 * b1 + c1 * b0, c0 * b2 + c1 * b1 + c2 * b0, c1 * b2 + c2 * b1, c2 * b2
        p0, p1, p2 = push * (p0 * s0 + p2 * s2 + p4 * s4), push * (p1 * s2 + p3 * s4), push * (p0 * s2 + p2 * s4 + p4 * s6)
        i3 += b0 * second + b1 * square1 + b2 * square2
        f3 = along(along(along(along(f3, p0, w), p1, turn), -2.0 * second, b), -2.0 * square1, c)
        m3 = along(along(along(m3, p0, still), p1, mixed), p2, turned)
        m3 = along(along(m3, -2.0 * second, cross(x, b)), -2.0 * square1, add(cross(x, c), cross(e, b)))
        m3 = along(m3, -2.0 * square2, cross(e, c))
    if region == CORNER:
        more, force, moment = _past_corner(x, e, half, w, turn, scratch, which, count, normal, place, reach, width)
        i4, f4, m4 = i4 + more, add(f4, force), add(m4, moment)
    return i1, i2, f1, f2, m1, m2, i3, f3, m3, i4, f4, m4


@item
def press_edge(p, e, length, radius, scratch, which, count, normal, other, reach, modulus, sharp):
    """Energy W [J] of an edge p + s e, s = 0..length, on cap `which`; force on the edge's body and its moment about the origin;
    length of the contact [m]; 0..1: how far it is past the border of the cap's face.

    radius, other: dilated radius of the edge's body and of the cap's; reach: their sum R, less what has crushed; sharp: exponent of
    the join. Two edges that meet press each on the other: each gets a share of the energy, the sharper one the larger (along it,
    the contact is the longer). The overlap is measured as (R^2 - d^2)/(2 R), d the distance from the cap: the overlap itself but
    for overlap/(2 R).
    """
    width = BLEND * (radius + other)
    s, high = 0.0, length
    if count != 1 and count != 2:
        # no closer than `reach` to the plane of the cap: nothing to press
        z, rate = dot(sub(p, corner_of(scratch, which, 0)), normal) - reach, dot(e, normal)
        if rate > 0.0:
            high = min(high, -z / rate)
        elif rate < 0.0:
            s = max(s, -z / rate)
        elif z >= 0.0:
            high = 0.0
    sums = 0.0, 0.0, NONE, NONE, NONE, NONE, 0.0, NONE, NONE, 0.0, NONE, NONE
    # regions are convex: a line meets each of a side or a corner, and the interior, once (and round-off may look twice)
    for _ in range(2 * count + 4):
        if s >= high:
            break
        s += STEP * length
        x = along(p, s, e)
        region, place, w = nearest(scratch, which, count, normal, x)
        way = min(high - s, exit_of_region(scratch, which, count, normal, region, place, x, e, high - s))
        # w is linear along the piece: its part at right angles to what the region is spanned by
        turn = e
        if region == INTERIOR:
            turn = scale(dot(e, normal), normal)
        elif region == SIDE:
            side = side_of(scratch, which, place)
            turn = along(e, -dot(e, side), side)
        begin, stop = pressing(w, turn, reach, -STEP * length, way)
        if stop > begin:
            sums = _add_piece(sums, x, e, begin, stop, w, turn, scratch, which, count, normal, region, place, reach, width)
        s += max(way, 0.0)
    return _whole_line(sums, radius, other, 1 <= count <= 2, modulus, sharp)


@device
def levelled(q):
    """A value that rises from 0 and levels off at 1 for q = 1, and its slope."""
    if q >= 1.0:
        return 1.0, 0.0
    return q * (2.0 - q), 2.0 * (1.0 - q)


@item
def _whole_line(sums, radius, other, bare, modulus, sharp):
    """Energy, force, moment, length and place beyond the border of an edge from its integrals; as `press_edge` returns them.

    bare: the cap has no face, its rim is all there is.
    """
    i1, i2, f1, f2, m1, m2, i3, f3, m3, i4, f4, m4 = sums
    if i2 <= 0.0:
        return 0.0, NONE, NONE, 0.0, 0.0
    width, their = BLEND * (radius + other), 1.0 / other if other > 0.0 else 0.0
    if not bare and i3 == 0.0:  # all of it over the face: nothing of what follows but the energy
        energy, by_first, by_second, _ = line_energy(modulus, i1, i2, 1.0 / radius)
        force = along(scale(by_first, f1), by_second, f2)
        return energy, force, along(scale(by_first, m1), by_second, m2), i1 * i1 / i2, 0.0
    yielded = 0.0
    if other == radius:
        yielded = HALVED / sharp
    elif other > 0.0:
        yielded = log(1.0 + (radius / other) ** 8) / sharp
    # how far, in the mean square, the line lies beyond the border of the cap (the plain mean would have a kink where a parallel
    # line passes the border): the curvature of the rim comes in, and the share of the other's edge. To the power of 3/2, so that
    # little of it counts: the rims round which a line over the face runs out at its ends lie along it
    mean = i3 / (i2 * width * width)
    root = sqrt(mean)
    across, across_slope = levelled(1.0 if bare else mean * root)
    beyond, beyond_slope = levelled(i4 / (i2 * width * width))
    energy, by_first, by_second, by_curvature = line_energy(modulus, i1, i2, 1.0 / radius + across * their)
    share = exp(-yielded * across)
    kept = share * (1.0 - beyond)  # past a corner it is the corner that presses, a vertex of its own
    by_side = 1.5 * root * (by_curvature * their - energy * yielded) * kept * across_slope / (i2 * width * width)
    by_corner = -energy * share * beyond_slope / (width * width * i2)
    by_first *= kept
    by_second = by_second * kept - (by_side * i3 + by_corner * i4) / i2
    force = add(along(scale(by_first, f1), by_second, f2), along(scale(by_side, f3), by_corner, f4))
    moment = add(along(scale(by_first, m1), by_second, m2), along(scale(by_side, m3), by_corner, m4))
    return energy * kept, force, moment, i1 * i1 / i2, across

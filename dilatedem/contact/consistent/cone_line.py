"""Energy of a line contact with a cone: an edge on its side, or its side on the cap of another body.

As with a pile, but the cone's radius changes along its axis, so that overlaps are no polynomials of the place: what `line`
integrates in closed form is summed here at four points of every piece, which is exact where the taper is 0. The overlap is measured
as there, as (R^2 - d^2)/(2 R), R and d for the sphere that is nearest; 1/r of the cone in the law is its mean, weighted by the
squared overlap.
"""

from math import copysign, exp, log, sqrt
from typing import NamedTuple

from dilatedem.contact.consistent.cap import CORNER, INTERIOR, SIDE, nearest, overhang, side_of
from dilatedem.contact.consistent.line import HEAVY, INNER, LIGHT, OUTER, STEP, beside_border, exit_of_region, levelled, line_energy
from dilatedem.contact.search.cone import nearest_sphere
from dilatedem.jit import device
from dilatedem.numerics.vector import add, along, cross, dot, scale, sub

NONE = (0.0, 0.0, 0.0)
#: pieces of an edge at a cone: past one end, beside the side and past the other, each of which a line may leave and meet again
MOST_PIECES = 5


class Line(NamedTuple):
    """Integrals along a line contact; or the derivatives of its energy by them."""

    first: float  # of the overlap
    second: float  # of its square: the weight of what follows
    curvature: float  # weighted, of 1/r of the cone
    beside: float  # weighted, of the squared way beyond the border of a face
    past: float  # weighted, of the squared way past a corner, or the end of the cone


@device
def _interval(a, b, c, rising, low, high):
    """The part of low..high where a t^2 + 2 b t + c < 0; where that is so on both sides of a gap, that to which `rising` points."""
    square = b * b - a * c
    if square <= 0.0:
        return low, (high if c < 0.0 else low)
    q = -(b + copysign(sqrt(square), b))
    t, u = q / a, c / q
    first, last = min(t, u), max(t, u)
    if a >= 0.0:
        return max(low, first), min(high, last)
    if rising > 0.0:
        return max(low, last), high
    return low, min(high, first)


@device
def _leaving(cone, x, e, end, way):
    """Way along e, at most `way`, after which the nearest sphere of a cone passes the end of its axis at the height `end`."""
    d = sub(x, cone.middle)
    z, rise, lean = end - dot(d, cone.axis), dot(e, cone.axis), cone.taper / cone.cosine
    flat, level = along(d, z - end, cone.axis), along(e, -rise, cone.axis)
    # (z - rise t)^2 = (lean rho)^2, where z - rise t has the sign of lean
    a = rise * rise - lean * lean * dot(level, level)
    b = -z * rise - lean * lean * dot(flat, level)
    c = z * z - lean * lean * dot(flat, flat)
    square = b * b - a * c
    if square < 0.0:
        return way
    q = -(b + copysign(sqrt(square), b))
    for t in (q / a, c / q):
        if 0.0 < t < way and (z - rise * t) * lean >= 0.0:
            way = t
    return way


@device
def _pressing_cone(cone, x, e, sphere, radius, way):
    """The part of 0..way where a line x + t e, dilated by `radius`, is in a cone whose nearest sphere at its beginning is given."""
    if sphere.past != 0.0:
        reach = radius + sphere.radius
        return _interval(1.0, dot(sphere.way, e), dot(sphere.way, sphere.way) - reach * reach, 1.0, -STEP, way)
    d = sub(x, cone.middle)
    z, rise = dot(d, cone.axis), dot(e, cone.axis)
    flat, level = along(d, -z, cone.axis), along(e, -rise, cone.axis)
    # cosine rho < radius of the dilated cone, times cosine
    k, r, grows = cone.cosine * cone.cosine, radius + cone.radius + cone.taper * z, cone.taper * rise
    a, b = k * dot(level, level) - grows * grows, k * dot(flat, level) - grows * r
    return _interval(a, b, k * dot(flat, flat) - r * r, grows, -STEP, way)


@device
def _gauss(g, low, high):
    """Place and weight of the g-th of four points on low..high."""
    half = 0.5 * (high - low)
    at = (OUTER if g % 2 == 0 else INNER) * (1.0 if g < 2 else -1.0)
    return 0.5 * (high + low) + half * at, half * (LIGHT if g % 2 == 0 else HEAVY)


@device
def _at_edge(cone, x, radius, weight, line, force, moment, by):
    """Add a point x of an edge on a cone to the integrals, and to force and moment on the edge's body for the derivatives `by`."""
    sphere = nearest_sphere(cone, x)
    reach, d = radius + sphere.radius, sqrt(dot(sphere.way, sphere.way))
    overlap = reach - d
    if overlap <= 0.0:
        return line, force, moment
    q, curvature, past = overlap * (reach + d) / (2.0 * reach), 1.0 / sphere.radius, abs(sphere.past) * cone.cosine
    # what the radius grows by along the generator; past the ends it does not
    grows = cone.taper / cone.cosine if sphere.past == 0.0 else 0.0
    square = weight * q * q
    line = Line(
        line.first + weight * q, line.second + square, line.curvature + square * curvature, 0.0, line.past + square * past * past
    )
    fall = weight * (by.first + 2.0 * q * (by.second + by.curvature * curvature + by.past * past * past))
    turn = square * by.curvature * curvature * curvature * grows - 2.0 * square * by.past * past * copysign(1.0, sphere.past)
    turn -= fall * grows * overlap * overlap / (2.0 * reach * reach)
    pull = along(scale(fall / reach, sphere.way), turn, sphere.generator)
    return line, add(force, pull), add(moment, cross(x, pull))


@device
def _along_edge(cone, p, e, length, radius, by):
    """Integrals along an edge p + t e, t = 0..length, on a cone; force on its body and moment about the origin for the derivatives
    `by` of its energy."""
    line, force, moment, t = Line(0.0, 0.0, 0.0, 0.0, 0.0), NONE, NONE, 0.0
    for _ in range(MOST_PIECES):
        if t >= length:
            break
        t += STEP * length
        x = along(p, t, e)
        sphere = nearest_sphere(cone, x)
        way = length - t
        if sphere.past <= 0.0:
            way = _leaving(cone, x, e, -cone.half, way)
        if sphere.past >= 0.0:
            way = _leaving(cone, x, e, cone.half, way)
        low, high = _pressing_cone(cone, x, e, sphere, radius, way)
        if high > low:
            for g in range(4):
                at, weight = _gauss(g, low, high)
                line, force, moment = _at_edge(cone, along(x, at, e), radius, weight, line, force, moment, by)
        t += max(way, 0.0)
    return line, force, moment


@device
def _along_side(cone, radius, scratch, count, normal, width, by):
    """Integrals along the side of a cone on the cap of another body, of dilation `radius`; force on the cone and moment about the
    origin for the derivatives `by` of its energy."""
    line, force, moment = Line(0.0, 0.0, 0.0, 0.0, 0.0), NONE, NONE
    s, e, length = 0.0, cone.axis, 2.0 * cone.half
    start = along(cone.middle, -cone.half, e)
    for _ in range(2 * count + 4):
        if s >= length:
            break
        s += STEP * length
        x = along(start, s, e)
        region, place, w = nearest(scratch, 0, count, normal, x)
        way = min(length - s, exit_of_region(scratch, 0, count, normal, region, place, x, e, length - s))
        turn = e
        if region == INTERIOR:
            turn = scale(dot(e, normal), normal)
        elif region == SIDE:
            side = side_of(scratch, 0, place)
            turn = along(e, -dot(e, side), side)
        reach = radius + cone.radius + cone.taper * (s - cone.half)
        low, high = _interval(
            dot(turn, turn) - cone.taper * cone.taper, dot(w, turn) - reach * cone.taper, dot(w, w) - reach * reach, cone.taper,
            -STEP * length, way,
        )  # fmt: skip
        if high > low:
            for g in range(4):
                at, weight = _gauss(g, low, high)
                line, force, moment = _at_side(
                    cone, along(x, at, e), along(w, at, turn), reach + cone.taper * at, radius, weight * cone.cosine,
                    scratch, count, normal, region, place, width, line, force, moment, by,
                )  # fmt: skip
        s += max(way, 0.0)
    return line, force, moment


@device
def _at_side(cone, x, w, reach, radius, weight, scratch, count, normal, region, place, width, line, force, moment, by):
    """Add the sphere about x, at w from the cap of another body, to the integrals along the side; `reach`: sum of their radii."""
    square = dot(w, w)
    if square >= reach * reach:
        return line, force, moment
    q, curvature, beside, past, out, gradient = 0.5 * (reach * reach - square) / reach, 1.0 / (reach - radius), 0.0, 0.0, NONE, NONE
    if region != INTERIOR and count > 2:
        out = beside_border(w, region, cross(side_of(scratch, 0, place), normal), normal)
        beside = dot(out, out)
    if region == CORNER:
        _, past, _, gradient = overhang(scratch, 0, count, normal, region, place, w, width)
    square = weight * q * q
    line = Line(
        line.first + weight * q, line.second + square, line.curvature + square * curvature, line.beside + square * beside,
        line.past + square * past * past,
    )  # fmt: skip
    fall = by.first + 2.0 * q * (by.second + by.curvature * curvature + by.beside * beside + by.past * past * past)
    pull = scale(weight * fall / reach, w)
    pull = along(along(pull, -2.0 * square * by.beside, out), -2.0 * square * by.past * past, gradient)
    return line, add(force, pull), add(moment, cross(x, pull))


@device
def _energy(line, own, width, bare, modulus, sharp):
    """Energy [J] of a line contact of which one curvature, `own`, is constant and the other is the cone's, as `line.press_edge`
    makes it of its integrals; its derivatives by them; how far it is past the border.

    bare: the constant one is the edge's, and the cone has no face; else it is that of the border of a face on which the cone's side
    is the edge, and comes in beyond it. width [m]: way beyond a border over which curvatures come in; sharp: exponent of the join.
    """
    theirs = line.curvature / line.second
    unit, mean = 1.0 / (line.second * width * width), line.beside / (line.second * width * width)
    root = sqrt(mean)
    across, across_slope = (1.0, 0.0) if bare else levelled(mean * root)
    beyond, beyond_slope = levelled(line.past * unit)
    eighth = (theirs / own if bare else own / theirs) ** 8
    yielded, yields = log(1.0 + eighth) / sharp, 8.0 * eighth / (1.0 + eighth) / (sharp * theirs)
    curvature = own + theirs if bare else theirs + across * own
    energy, by_first, by_second, by_curvature = line_energy(modulus, line.first, line.second, curvature)
    share = exp(-yielded * across)
    kept = share * (1.0 - beyond)
    by_beside = 1.5 * root * (by_curvature * own - energy * yielded) * kept * across_slope * unit
    by_past = -energy * share * beyond_slope * unit
    by_theirs = (by_curvature + energy * (-yields if bare else across * yields)) * kept / line.second
    by_second = by_second * kept - (by_theirs * line.curvature + by_beside * line.beside + by_past * line.past) / line.second
    return energy * kept, Line(by_first * kept, by_second, by_theirs, by_beside, by_past), across


@device
def press_edge_on_cone(cone, p, e, length, radius, kept, width, modulus, sharp):
    """Energy W [J] of an edge p + t e on a cone, force on its body and moment about the origin, length of the contact [m].

    radius: of the edge's dilation [m]; kept: what crushing has left of it [m].
    """
    line, _, _ = _along_edge(cone, p, e, length, kept, Line(0.0, 0.0, 0.0, 0.0, 0.0))
    if line.second <= 0.0:
        return 0.0, NONE, NONE, 0.0
    energy, by, _ = _energy(line, 1.0 / radius, width, True, modulus, sharp)
    _, force, moment = _along_edge(cone, p, e, length, kept, by)
    return energy, force, moment, line.first * line.first / line.second


@device
def press_side(cone, radius, kept, scratch, count, normal, width, modulus, sharp):
    """Energy W [J] of a cone's side on the cap of a body of dilation `radius`, of which crushing has left `kept` [m]; force on the
    cone and moment about the origin, length of the contact [m]; 0..1: how far it is past the border of the cap's face."""
    line, _, _ = _along_side(cone, kept, scratch, count, normal, width, Line(0.0, 0.0, 0.0, 0.0, 0.0))
    if line.second <= 0.0:
        return 0.0, NONE, NONE, 0.0, 0.0
    # where the cap has no face, its rim is all there is: as far past a border as can be
    if count < 3:
        line = Line(line.first, line.second, line.curvature, line.second * width * width, line.past)
    energy, by, across = _energy(line, 1.0 / radius, width, False, modulus, sharp)
    _, force, moment = _along_side(cone, kept, scratch, count, normal, width, by)
    return energy, force, moment, line.first * line.first / line.second, across

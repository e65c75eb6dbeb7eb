"""Energy of a vertex that presses on the other body's cap: Hertz's law with the curvatures of both."""

from math import exp, log, sqrt

from dilatedem.contact.consistent.cap import nearest, overhang, ramp
from dilatedem.jit import device, item
from dilatedem.numerics.vector import along, dot, scale

#: way, in units of the sum of the radii, beyond a border over which the curvature of the rim comes in
BLEND = 0.1


@device
def elliptic(trace, determinant):
    """Factor of F = 4/3 E* factor overlap^(3/2) for a relative curvature tensor, and its derivatives by trace and determinant.

    Hertz's elliptic contact (Johnson 1985, section 4.2); a fit of its elliptic integrals, within 0.01 % up to a ratio of
    principal curvatures of 300, 0.1 % up to 1000. Circular: sqrt(R).
    """
    root = sqrt(determinant)
    x = log(0.5 * trace / root)
    factor = exp(x * (0.16597 + x * (0.0395 - 0.002636 * x))) / sqrt(root)
    rise = 0.16597 + x * (0.079 - 0.007908 * x)
    return factor, factor * rise / trace, -factor * (0.25 + 0.5 * rise) / determinant


@item
def press_vertex(x, radius, scratch, which, count, normal, other, reach, modulus, shares):
    """Energy W [J] of a vertex at x that presses on cap `which`, its force on the vertex's body [N], and 0..1, how far it is past
    a border of the cap's face, and past a corner.

    radius, other: dilated radius of the vertex's body and of the cap's; reach: their sum, less what has crushed; shares: ln 2 over
    the exponent of the join. Two vertices that meet press each on the other: each gets its share of the energy.
    """
    region, place, w = nearest(scratch, which, count, normal, x)
    distance = sqrt(dot(w, w))
    overlap = reach - distance
    if overlap <= 0.0 or distance == 0.0:
        return 0.0, (0.0, 0.0, 0.0), 0.0, 0.0
    width = BLEND * (radius + other)
    side, end, side_gradient, end_gradient = overhang(scratch, which, count, normal, region, place, w, width)
    across, across_slope = ramp(side / width)
    beyond, beyond_slope = ramp(end / width)
    own, their = 1.0 / radius, 1.0 / other if other > 0.0 else 0.0
    k1, k2 = own + beyond * their, own + across * their
    factor, by_trace, by_determinant = elliptic(k1 + k2, k1 * k2)
    energy = 8.0 / 15.0 * modulus * factor * overlap * overlap * sqrt(overlap) * exp(-shares * beyond)
    force = scale(2.5 * energy / (overlap * distance), w)
    if across_slope > 0.0:
        change = their * (by_trace + by_determinant * k1) / factor
        force = along(force, -energy * change * across_slope / width, side_gradient)
    if beyond_slope > 0.0:
        change = their * (by_trace + by_determinant * k2) / factor - shares
        force = along(force, -energy * change * beyond_slope / width, end_gradient)
    return energy, force, across, beyond

"""Circular cones: bodies whose dilation grows along their core, a segment. They are hulls of spheres along an axis.

The sphere that touches the side where another body is closest has the side's own radius of curvature, across the generator, and
its centre is on the axis: a contact sees a core that is a segment and a dilation, as with a pile, but of its own place. For the
radius r(s) = radius + taper s the gap to a point x is the least of |x - c(s)| - r(s). On the side that is
cosine rho - taper z - radius, (rho, z) from the middle of the axis: exact in closed form, convex and smooth.
"""

from math import sqrt
from typing import NamedTuple

from dilatedem.contact.search.closest import CONVERGED, MOST_ROUNDS, ROUND_OFF, TOUCHING, closest_points, farthest_vertex
from dilatedem.contact.search.penetration import any_normal
from dilatedem.contact.search.simplex import closest_on_triangle
from dilatedem.geometry.shapes import TaperedShapes
from dilatedem.jit import by_type, device
from dilatedem.numerics.vector import add, along, dot, load, scale, sub

NONE = (0.0, 0.0, 0.0)


class Cone(NamedTuple):
    """A cone in world directions; its normal leans by asin(-taper) from the plane across the axis."""

    middle: tuple  # m, of the axis
    axis: tuple  # unit vector
    half: float  # m, half the length of the axis
    radius: float  # m, of the sphere about the middle
    taper: float  # what the radius grows by along the axis, between -1 and 1
    cosine: float  # of the angle between axis and generator, sqrt(1 - taper^2)


class Sphere(NamedTuple):
    """The one of a cone's spheres that is nearest to a point."""

    place: float  # m, of its centre along the axis, from the middle
    past: float  # m, by which the place would lie past the end of an axis that goes on; negative: before the first end
    radius: float  # m
    way: tuple  # m, from its centre to the point
    generator: tuple  # unit vector along the side there, to where the axis points


@device
def cone_of(shapes, vertex, body, middle):
    """The cone that a body is, its core's vertices turned to the world; middle: of its axis [m]."""
    end = load(vertex, shapes.vertex_start[body + 1] - 1)
    half, taper = sqrt(dot(end, end)), shapes.taper[body]
    return Cone(middle, scale(1.0 / half, end), half, shapes.radius[body], taper, sqrt(1.0 - taper * taper))


@device
def nearest_sphere(cone, x):
    """The sphere of a cone nearest to a point x."""
    d = sub(x, cone.middle)
    z = dot(d, cone.axis)
    flat = along(d, -z, cone.axis)
    across = sqrt(dot(flat, flat))
    free = z + across * cone.taper / cone.cosine
    place = min(max(free, -cone.half), cone.half)
    out = scale(1.0 / across, flat) if across > 0.0 else NONE
    generator = along(scale(cone.cosine, cone.axis), cone.taper, out)
    return Sphere(place, free - place, cone.radius + cone.taper * place, along(flat, z - place, cone.axis), generator)


@device
def gap_to(cone, x):
    """Distance of a point from the surface of a cone [m]; negative inside."""
    sphere = nearest_sphere(cone, x)
    return sqrt(dot(sphere.way, sphere.way)) - sphere.radius


@device
def _nearest_to_sphere(p, e, centre):
    """Place 0..1 on the segment p + t e that is nearest to a point."""
    square = dot(e, e)
    return min(max(dot(sub(centre, p), e) / square, 0.0), 1.0) if square > 0.0 else 0.0


@device
def _nearest_on_edge(cone, p, q):
    """The place 0..1 from p to q that is nearest to the cone, and its gap."""
    e, d = sub(q, p), sub(p, cone.middle)
    rise, z = dot(e, cone.axis), dot(d, cone.axis)
    level, flat = along(e, -rise, cone.axis), along(d, -z, cone.axis)
    square, tilt = dot(level, level), rise * cone.taper / cone.cosine
    if square <= tilt * tilt:  # steeper than the side: an end
        t = 1.0 if tilt > 0.0 else 0.0
    else:
        foot = -dot(flat, level) / square
        nearest = along(flat, foot, level)
        t = min(max(foot + tilt * sqrt(dot(nearest, nearest) / (square * (square - tilt * tilt))), 0.0), 1.0)
    sphere = nearest_sphere(cone, along(p, t, e))
    least = sqrt(dot(sphere.way, sphere.way)) - sphere.radius
    if sphere.past != 0.0:
        for end in (-cone.half, cone.half):
            u = _nearest_to_sphere(p, e, along(cone.middle, end, cone.axis))
            gap = gap_to(cone, along(p, u, e))
            if gap < least:
                least, t = gap, u
    return t, least


@device
def _nearest_on_triangle(cone, p, q, r):
    """Weights of the point of a triangle that is nearest to the cone, and its gap. Beside the side that is a point of a border."""
    t, least = _nearest_on_edge(cone, p, q)
    wp, wq, wr = 1.0 - t, t, 0.0
    t, gap = _nearest_on_edge(cone, p, r)
    if gap < least:
        least, wp, wq, wr = gap, 1.0 - t, 0.0, t
    t, gap = _nearest_on_edge(cone, q, r)
    if gap < least:
        least, wp, wq, wr = gap, 0.0, 1.0 - t, t
    past = nearest_sphere(cone, _mean(p, q, r, wp, wq, wr)).past
    if past != 0.0:
        end = cone.half if past > 0.0 else -cone.half
        centre = along(cone.middle, end, cone.axis)
        v, kp, kq, kr = closest_on_triangle(sub(p, centre), sub(q, centre), sub(r, centre))
        gap = sqrt(dot(v, v)) - (cone.radius + cone.taper * end)
        if gap < least:
            least, wp, wq, wr = gap, kp, kq, kr
    return wp, wq, wr, least


@device
def _mean(p, q, r, wp, wq, wr):
    return along(along(scale(wp, p), wq, q), wr, r)


@device
def _keep(corner, weights, chosen):
    """Bring those of four chosen vertices that have a weight to the front of a row; returns their number."""
    kept = 0
    for c in range(4):
        if weights[c] > 0.0:
            corner[kept] = chosen[c]
            kept += 1
    return kept


@device
def _nearest_of(cone, vertex, corner, count):
    """The point nearest to a cone of the hull of 1 to 4 vertices (the last is new), and how many of them span it: the first."""
    i0, i1 = corner[0], corner[1] if count > 1 else corner[0]
    i2, i3 = corner[2] if count > 2 else corner[0], corner[3] if count > 3 else corner[0]
    p, q, r, s = load(vertex, i0), load(vertex, i1), load(vertex, i2), load(vertex, i3)
    w0, w1, w2, w3 = 1.0, 0.0, 0.0, 0.0
    if count == 2:
        w1, _ = _nearest_on_edge(cone, p, q)
        w0 = 1.0 - w1
    elif count > 2:
        w0, w1, w2, least = _nearest_on_triangle(cone, p, q, r)
        if count > 3:
            k0, k1, k3, gap = _nearest_on_triangle(cone, p, q, s)
            if gap < least:
                least, w0, w1, w2, w3 = gap, k0, k1, 0.0, k3
            k0, k2, k3, gap = _nearest_on_triangle(cone, p, r, s)
            if gap < least:
                least, w0, w1, w2, w3 = gap, k0, 0.0, k2, k3
            k1, k2, k3, gap = _nearest_on_triangle(cone, q, r, s)
            if gap < least:
                w0, w1, w2, w3 = 0.0, k1, k2, k3
    x = add(_mean(p, q, r, w0, w1, w2), scale(w3, s))
    return x, _keep(corner, (w0, w1, w2, w3), (i0, i1, i2, i3))


@device
def closest_to_cone(vertex, face_normal, shapes, pairs, k, a, b, offset):
    """As `closest.closest_points`; where b is a cone, the witness point on its core is the centre of the sphere that is met.

    The vertices of a that span the closest point are kept and the one that lies farthest towards the cone is added, until none lies
    nearer. Beside the cone's side two vertices do: the gap is convex and has no least value within a face.
    """
    if shapes.taper[b] == 0.0:
        return closest_points(vertex, face_normal, shapes, pairs, k, a, b, offset)
    cone, corner = cone_of(shapes, vertex, b, offset), pairs.corner_a[k]
    a0, a1 = shapes.vertex_start[a], shapes.vertex_start[a + 1]
    count = pairs.corners[k]
    if count == 0:
        corner[0] = a0
        count = 1
    elif corner[count - 1] == corner[0]:
        count = 1
    last, nothing, newest = 1e300, TOUCHING * TOUCHING * dot(offset, offset), -1
    x, sphere, square = NONE, nearest_sphere(cone, NONE), 0.0
    for searched in range(MOST_ROUNDS):
        pairs.rounds[k] = searched + 1
        x, count = _nearest_of(cone, vertex, corner, count)
        sphere = nearest_sphere(cone, x)
        square = dot(sphere.way, sphere.way)
        if square <= nothing or count == 4:
            break
        i, height = farthest_vertex(vertex, a0, a1, scale(-1.0, sphere.way))
        before = height + dot(sphere.way, x)
        if before <= CONVERGED * square:
            break
        gap = sqrt(square) - sphere.radius
        if gap >= last and before <= ROUND_OFF * (shapes.reach[a] + shapes.reach[b]) * sqrt(square):
            break
        last = gap
        known = i == newest
        for c in range(count):
            known = known or corner[c] == i
        if known:
            break
        corner[count] = newest = i
        count += 1
    _name_corners(shapes, pairs, k, b, min(count, 3), sphere.past)
    centre = along(cone.middle, sphere.place, cone.axis)
    if square <= nothing:  # far deeper than a contact can be
        return 0.0, any_normal(load(pairs.normal, k), offset), x, centre
    distance = sqrt(square)
    return distance, scale(-1.0 / distance, sphere.way), x, centre


@device
def _name_corners(shapes, pairs, k, b, count, past):
    """Write down the closest corners of pair k as of two cores: beside the side both ends of the axis span what is closest."""
    first = shapes.vertex_start[b]
    if past == 0.0:
        if count == 1:
            pairs.corner_a[k, 1] = pairs.corner_a[k, 0]
        pairs.corners[k], pairs.corner_b[k, 0], pairs.corner_b[k, 1] = 2, first, first + 1
        return
    pairs.corners[k] = count
    for c in range(count):
        pairs.corner_b[k, c] = first if past < 0.0 else first + 1


@device
def own_radius(shapes, vertex, body, place):
    """Dilated radius of a body at a place of its core, from its centroid [m]."""
    return shapes.radius[body]


@device
def _radius_on_axis(shapes, vertex, body, place):
    if shapes.taper[body] == 0.0:
        return shapes.radius[body]
    cone = cone_of(shapes, vertex, body, NONE)
    return cone.radius + cone.taper * dot(place, cone.axis)


#: Distance of two cores and where it is attained.
closest = by_type(closest_points, {TaperedShapes: closest_to_cone}, at=2)
#: Dilated radius of a body at a place of its core, from its centroid [m].
radius_at = by_type(own_radius, {TaperedShapes: _radius_on_axis})

"""Bounds for what the edges and vertices beside a patch can press, told from the border of the patch alone."""

from math import sqrt

from dilatedem.jit import device

#: sine of the angle of two sides of a patch, and length of one over that past the border, below which nothing is divided by them
NEEDLE = 1e-9
#: sine of the angle of two sides of a patch down to which a quick look tells what its rim can press
SLENDER = 0.5
#: m3 and m: no bound on what edges press, and none of its powers overflows
FAR = 1e100


@device
def bound_rim(bounds, eu, ev, before, fu, fv, d, e):
    """Add to the bounds of `any_rim` a side (fu, fv) with the overlaps d and e at its ends and the corner between it and the side
    (eu, ev) that comes before, of the squared length `before`; returns those with its own squared length."""
    longest, strongest, deepest, sharp = bounds
    square, area, mean = fu * fu + fv * fv, eu * fv - ev * fu, d * d + d * e + e * e
    # two corners in one place have no angle: <= takes them for sharp
    sharp = sharp or area * area <= SLENDER * SLENDER * before * square
    return (max(longest, square), max(strongest, square * mean * mean), max(deepest, e), sharp), square


@device
def any_rim(bounds, beyond, tilt, overlap):
    """Larger bounds than those of `strongest_rim`, for a fraction of its time: every side goes on as past a corner with the sine
    SLENDER, at the deepest overlap; FAR where a corner is sharper.

    bounds: of all sides, by `bound_rim`; tilt: slope of the overlap.
    """
    longest, strongest, deepest, sharp = bounds
    if sharp:
        return FAR, FAR
    way = beyond * (1.0 / SLENDER)
    deepest = min(deepest + tilt * way, overlap)
    return sqrt(strongest) * (1.0 / 3.0) + 2.0 * way * deepest * deepest, sqrt(longest) + 2.0 * way


@device
def bound_rims(polygon, count, beyond, tilt, overlap):
    """`any_rim` of rows 0..count-1."""
    lift, last = tilt * beyond, count - 1
    eu, ev = polygon[last, 0] - polygon[last - 1, 0], polygon[last, 1] - polygon[last - 1, 1]
    u, v, d = polygon[last, 0], polygon[last, 1], min(polygon[last, 2] + lift, overlap)
    bounds, before = (0.0, 0.0, 0.0, False), eu * eu + ev * ev
    for i in range(count):
        fu, fv, e = polygon[i, 0] - u, polygon[i, 1] - v, min(polygon[i, 2] + lift, overlap)
        bounds, before = bound_rim(bounds, eu, ev, before, fu, fv, d, e)
        u, v, eu, ev, d = polygon[i, 0], polygon[i, 1], fu, fv, e
    return any_rim(bounds, beyond, tilt, overlap)


@device
def strongest_rim(polygon, count, beyond, lift, overlap):
    """Bounds for any edge that presses where a patch has its rim: integral of the squared overlap along it [m3], its length [m].

    Every edge of one face that lies over the other is a side of the patch, and one that runs past the other face by no more than
    `beyond` [m] has a side of the patch beside it, whose overlap is smaller by up to `lift` [m], the tilt times that way. It
    goes on past the side's ends until it is `beyond` past the border of the other face: the farther, the smaller its angle with
    the side that it meets there. Its overlap goes on as along the side, but never above `overlap` [m].
    """
    most, longest = 0.0, 0.0
    x, y, d = polygon[count - 1, 0], polygon[count - 1, 1], min(polygon[count - 1, 2] + lift, overlap)
    au, av = _direction(x - polygon[count - 2, 0], y - polygon[count - 2, 1])[:2]
    bu, bv, length = _direction(polygon[0, 0] - x, polygon[0, 1] - y)
    sine = abs(au * bv - av * bu)
    for i in range(count):
        e = min(polygon[i, 2] + lift, overlap)
        j = i + 1 if i + 1 < count else 0
        cu, cv, following = _direction(polygon[j, 0] - polygon[i, 0], polygon[j, 1] - polygon[i, 1])
        sine_after = abs(bu * cv - bv * cu)
        second, further = length * (d * d + d * e + e * e) / 3.0, 0.0
        for end in range(2):
            start, fall, sharp = (d, d - e, sine) if end == 0 else (e, e - d, sine_after)
            way = beyond / max(sharp, NEEDLE)
            if fall < 0.0:  # less and less, and then nothing
                way = min(way, -start * length / fall)
                deepest = start
            else:
                deepest = min(overlap, start + fall * way / max(length, NEEDLE * beyond))
            second += way * deepest * deepest
            further += way
        most, longest = max(most, second), max(longest, length + further)
        d, bu, bv, length, sine = e, cu, cv, following, sine_after
    return most, longest


@device
def _direction(u, v):
    """Unit vector and length; no direction for two corners in one place."""
    length = sqrt(u * u + v * v)
    if length == 0.0:
        return 0.0, 0.0, 0.0
    return u / length, v / length, length

"""Clipping of convex polygons and segments in the contact plane.

A polygon is rows 0..n-1 of a workspace (m, 3): plane coordinates u, v and a height h that is carried along linearly.
"""

from math import sqrt

from dilatedem.jit import device, item
from dilatedem.numerics.vector import add, dot, load


@device
def reaches_past(polygon, count, u, v, offset):
    """Whether some corner of a polygon lies beyond u x + v y = offset."""
    for i in range(count):
        if u * polygon[i, 0] + v * polygon[i, 1] > offset:
            return True
    return False


@device
def clip_polygon(source, count, target, a, b, c, d):
    """Keep the part of a polygon where a u + b v + c h <= d; returns its corner count in `target`."""
    kept = 0
    sj = a * source[0, 0] + b * source[0, 1] + c * source[0, 2] - d
    for i in range(count):
        j = i + 1 if i + 1 < count else 0
        si = sj
        sj = a * source[j, 0] + b * source[j, 1] + c * source[j, 2] - d
        if si <= 0.0:
            for m in range(3):
                target[kept, m] = source[i, m]
            kept += 1
        if (si < 0.0 and sj > 0.0) or (si > 0.0 and sj < 0.0):
            t = si / (si - sj)
            for m in range(3):
                target[kept, m] = source[i, m] + t * (source[j, m] - source[i, m])
            kept += 1
    return kept


@item
def clip_by_face(vertex, shapes, face, origin, t1, t2, turn, rim, source, count, target):
    """Keep the part of a polygon within the sides of a face, moved out by `rim` [m]; returns its corner count, and whether it is in
    `target`.

    vertex (v, 3): turned to world directions; origin: of the face's body, t1, t2: of the plane; turn: 1 for a face seen
    counter-clockwise, -1 for clockwise.
    """
    first, last = shapes.loop_start[face], shapes.loop_start[face + 1]
    swapped = False
    q = add(origin, load(vertex, shapes.loop[first]))
    qu, qv = dot(q, t1), dot(q, t2)
    for i in range(first, last):
        pu, pv = qu, qv
        q = add(origin, load(vertex, shapes.loop[i + 1 if i + 1 < last else first]))
        qu, qv = dot(q, t1), dot(q, t2)
        eu, ev = turn * (qu - pu), turn * (qv - pv)
        limit = ev * pu - eu * pv + rim * (abs(eu) + abs(ev))
        if not reaches_past(source, count, ev, -eu, limit):
            continue
        count = clip_polygon(source, count, target, ev, -eu, 0.0, limit)
        source, target = target, source
        swapped = not swapped
        if count == 0:
            break
    return count, swapped


@device
def polygon_centroid(polygon, count):
    """Area, centroid u, v, h, and longest distance of two corners' projections from the centroid, doubled.

    Area is 0 for fewer than three corners.
    """
    if count < 3:
        return 0.0, 0.0, 0.0, 0.0, 0.0
    area = 0.0
    su = sv = sh = 0.0
    for i in range(1, count - 1):
        twice = (polygon[i, 0] - polygon[0, 0]) * (polygon[i + 1, 1] - polygon[0, 1]) - (
            polygon[i + 1, 0] - polygon[0, 0]
        ) * (polygon[i, 1] - polygon[0, 1])
        area += 0.5 * twice
        su += twice * (polygon[0, 0] + polygon[i, 0] + polygon[i + 1, 0])
        sv += twice * (polygon[0, 1] + polygon[i, 1] + polygon[i + 1, 1])
        sh += twice * (polygon[0, 2] + polygon[i, 2] + polygon[i + 1, 2])
    if area <= 0.0:
        return 0.0, 0.0, 0.0, 0.0, 0.0
    s = 1.0 / (6.0 * area)
    u, v, h = su * s, sv * s, sh * s
    far = 0.0
    for i in range(count):
        far = max(far, (polygon[i, 0] - u) ** 2 + (polygon[i, 1] - v) ** 2)
    return area, u, v, h, 2.0 * sqrt(far)


@device
def clip_interval(low, high, slope, value):
    """The part of the interval low..high of t where slope t + value <= 0 (empty: high < low)."""
    if slope > 0.0:
        high = min(high, -value / slope)
    elif slope < 0.0:
        low = max(low, -value / slope)
    elif value > 0.0:
        high = low - 1.0
    return low, high

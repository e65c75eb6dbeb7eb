"""Convex parts of polygons: they fill what the polygon does, are convex, and share whole sides."""

import numpy as np
import pytest
import shapely

from dilatedem.field.partition import convex_parts
from dilatedem.geometry.outline import area, prepare


def star(corners, seed):
    rng = np.random.default_rng(seed)
    angle, radius = np.sort(rng.uniform(0.0, 2.0 * np.pi, corners)), rng.uniform(1.0, 4.0, corners)
    return shapely.Polygon(np.column_stack([radius * np.cos(angle), radius * np.sin(angle)]))


@pytest.mark.parametrize("corners", [5, 12, 40])
@pytest.mark.parametrize("seed", range(5))
def test_parts_fill_the_polygon_and_are_convex(corners, seed):
    polygon = star(corners, seed)
    parts = convex_parts(polygon)
    assert sum(area(part.outline) for part in parts) == pytest.approx(polygon.area, rel=1e-12)
    covered = shapely.union_all([shapely.Polygon(part.outline) for part in parts])
    assert covered.symmetric_difference(polygon).area < 1e-9
    for part in parts:
        prepare(part.outline)
    points = shapely.get_coordinates(polygon)[:-1]
    (ax, ay), (bx, by) = (points - np.roll(points, 1, axis=0)).T, (np.roll(points, -1, axis=0) - points).T
    reflex = np.count_nonzero(ax * by - ay * bx < 0.0)
    assert len(parts) <= 2 * reflex + 1  # Hertel & Mehlhorn


def test_cuts_are_the_sides_within():
    parts = convex_parts(star(20, 7))
    cuts = np.concatenate([part.cuts for part in parts])
    ends = {(tuple(p), tuple(q)) for p, q in cuts}
    assert len(ends) == len(cuts) == 2 * (len(parts) - 1) and all((q, p) in ends for p, q in ends)
    sides = sum(np.linalg.norm(np.roll(part.outline, -1, axis=0) - part.outline, axis=1).sum() for part in parts)
    assert sides - sum(part.inner[0] for part in parts) == pytest.approx(star(20, 7).length)


def test_a_convex_polygon_is_one_part():
    (part,) = convex_parts(shapely.Point(0.0, 0.0).buffer(3.0))
    assert len(part.cuts) == 0 and part.inner.tolist() == [0.0, 0.0, 0.0]

"""What two faces have in common, against plane geometry by `shapely`."""

import numpy as np
import pytest
import shapely

from dilatedem.contact.shared_face import MOST, SOME
from dilatedem.geometry.polyhedron import prism
from dilatedem.geometry.shapes import BodyShape, pack_shapes
from dilatedem.state.storage import MOST_CORNERS
from tests.kernels import shared_by_pair

BELOW = [[-1.0, -1.0], [1.2, -0.8], [1.0, 1.0], [-0.9, 1.1]]
ABOVE = [[-0.5, -0.4], [0.6, -0.5], [0.1, 0.7]]
UP = (0.0, 0.0, 1.0)


def shared(shift, above=ABOVE):
    """Of the upper face of one prism and the lower face of another, which lies `shift` (2,) [m] aside."""
    cores = [prism(BELOW, -0.25, 0.25), prism(above, -0.1, 0.1)]
    shapes = pack_shapes([BodyShape(core, 0.04, None, None) for core in cores], [])
    top = int(np.argmax(cores[0].normals[:, 2]))
    bottom = len(cores[0].faces) + int(np.argmin(cores[1].normals[:, 2]))
    found = shared_by_pair(shapes, shapes.vertex, top, bottom, (*shift, 0.42), UP, np.zeros((8, MOST_CORNERS, 3)))
    polygons = shapely.Polygon(BELOW), shapely.affinity.translate(shapely.Polygon(above), *shift)
    return found, polygons[0].intersection(polygons[1]), [polygon.area for polygon in polygons]


@pytest.mark.parametrize("shift", [(0.0, 0.0), (0.9, 0.1), (-1.0, -0.7), (0.3, 1.2)])
def test_the_middle_is_that_of_the_polygon_in_common(shift):
    (found, middle, on_a, on_b), polygon, areas = shared(shift)
    assert found
    np.testing.assert_allclose(middle[:2], polygon.centroid.coords[0], atol=1e-12)
    assert middle[2] == 0.25
    for covered, area in zip((on_a, on_b), areas, strict=True):
        x = np.clip((polygon.area / area - SOME) / (MOST - SOME), 0.0, 1.0)
        assert covered == pytest.approx(x * x * (3.0 - 2.0 * x), abs=1e-12)


def test_faces_that_miss_each_other_have_none():
    (found, *_), polygon, _ = shared((2.5, 0.0))
    assert not found and polygon.is_empty


def test_a_plane_has_no_sides():
    core = prism(BELOW, -0.25, 0.25)
    shapes = pack_shapes([BodyShape(core, 0.04, None, None)], [])
    bottom = int(np.argmin(core.normals[:, 2]))
    down = (0.0, 0.0, -1.0)
    found, middle, on_a, on_b = shared_by_pair(
        shapes, shapes.vertex, bottom, -1, (0.0, 0.0, -1.0), down, np.zeros((8, MOST_CORNERS, 3))
    )
    assert found and on_a == 1.0 and on_b == 0.0
    np.testing.assert_allclose(middle, [*shapely.Polygon(BELOW).centroid.coords[0], -0.25], atol=1e-12)

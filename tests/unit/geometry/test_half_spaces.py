"""Convex solids of half spaces: the largest ball in them, their sides moved inwards, what lies between two heights."""

import numpy as np
import pytest

from dilatedem.geometry.half_spaces import between, largest_ball, moved_inwards, of_half_spaces
from dilatedem.geometry.polyhedron import convex_hull, prism, volume

CUBE = np.concatenate([np.eye(3), -np.eye(3)])


def test_a_box_of_its_planes():
    box = of_half_spaces(CUBE, np.array([1.0, 2.0, 3.0, 0.5, 0.0, 1.0]))
    assert volume(box) == pytest.approx(1.5 * 2.0 * 4.0)
    assert len(box.vertices) == 8 and len(box.faces) == 6
    middle, radius = largest_ball(CUBE, np.array([1.0, 2.0, 3.0, 0.5, 0.0, 1.0]))
    assert radius == pytest.approx(0.75) and middle[0] == pytest.approx(0.25)


def test_planes_that_enclose_nothing_are_refused():
    with pytest.raises(ValueError, match="nothing is left"):
        of_half_spaces(CUBE, np.array([1.0, 1.0, 1.0, -2.0, 1.0, 1.0]))
    with pytest.raises(ValueError, match="do not close"):
        of_half_spaces(CUBE[:1], np.ones(1))


def test_dilated_again_the_core_touches_every_side():
    rng = np.random.default_rng(3)
    solid = convex_hull(rng.normal(size=(40, 3)))
    core = moved_inwards(solid, 0.1)
    for loop, normal in zip(solid.faces, solid.normals, strict=True):
        assert (core.vertices @ normal).max() <= solid.vertices[loop[0]] @ normal - 0.1 + 1e-12
    with pytest.raises(ValueError, match=r"dilated_radius = 0.6: must be less than 0.5 m"):
        moved_inwards(prism([[0.0, 0.0], [4.0, 0.0], [4.0, 1.0], [0.0, 1.0]], 0.0, 3.0), 0.6)


def test_what_lies_between_two_heights():
    solid = prism([[0.0, 0.0], [4.0, 0.0], [4.0, 1.0], [0.0, 1.0]], -2.0, 3.0)
    points = between(solid, -1.0, 1.0)
    assert sorted(set(points[:, 2])) == [-1.0, 1.0] and len(points) == 8
    assert len(between(solid, 4.0, 5.0)) == 0
    assert len(set(map(tuple, between(solid, 0.0, 0.0).tolist()))) == 4

"""The sharp outer shape: the dilated body's volume and centroid, and the outline the floe was drawn with."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from dilatedem.geometry.mass import dilated_solid
from dilatedem.geometry.outer import SPIKE_LIMIT, outer_polyhedron
from dilatedem.geometry.outline import erode
from dilatedem.geometry.polyhedron import centroid, convex_hull, prism, volume

PENTAGON = np.array([[0.0, 0.0], [2.5, -0.3], [3.0, 1.5], [1.2, 2.4], [-0.4, 1.6]])


def outer_of(core, radius):
    solid = dilated_solid(core, radius)
    return outer_polyhedron(core.translated(-solid.centroid), radius, solid.volume), solid


def cores():
    rng = np.random.default_rng(2)
    turn = Rotation.from_rotvec([0.3, 0.8, -0.5]).as_matrix()
    block = prism(PENTAGON, -0.2, 0.2)
    return {
        "sphere": convex_hull([[0.0, 0.0, 0.0]]),
        "capsule": convex_hull([[0.0, 0.0, 0.0], [1.0, 2.0, -0.5]]),
        "plate": prism(PENTAGON, 0.0, 0.0),
        "turned plate": convex_hull(prism(PENTAGON, 0.0, 0.0).vertices @ turn.T),
        "prism": block,
        "turned prism": convex_hull(block.vertices @ turn.T),
        "tetrahedron": convex_hull(rng.normal(size=(4, 3))),
        "hull": convex_hull(rng.normal(size=(15, 3))),
        "needle": convex_hull([[0, 0, 0], [3, 0, 0], [3, 0.05, 0], [1.5, 0.02, 0.1]]),
    }


@pytest.mark.parametrize("name", cores())
def test_volume_and_centroid_are_the_dilated_body_s(name):
    outer, solid = outer_of(cores()[name], 0.1)
    assert volume(outer) == pytest.approx(solid.volume, rel=1e-13)
    assert centroid(outer) == pytest.approx(np.zeros(3), abs=1e-13)
    reach = np.linalg.norm(cores()[name].vertices - solid.centroid, axis=1).max()
    assert np.linalg.norm(outer.vertices, axis=1).max() < reach + 0.1 * (1.0 + 1.5 * SPIKE_LIMIT)


def test_floe_keeps_its_outline():
    core = prism(erode(PENTAGON, 0.04), -0.21, 0.21)
    outer, solid = outer_of(core, 0.04)
    factor = np.ptp(outer.vertices[:, 2]) / 0.5
    assert 0.99 < factor < 1.0
    drawn = PENTAGON - solid.centroid[:2]
    sides = {frozenset((factor * (drawn[i] - drawn[i - 1])).round(9).tolist()) for i in range(5)}
    plan = outer.vertices[outer.faces[1], :2]
    assert {frozenset((plan[i] - plan[i - 1]).round(9).tolist()) for i in range(5)} == sides
    assert len(outer.faces) == 7


def test_prism_and_half_spaces_agree():
    core = prism(PENTAGON, -0.2, 0.2)
    cut = convex_hull(np.vstack([core.vertices, [[1.3, 1.0, 0.2 + 1e-6]]]))  # no longer a prism, by a hair
    by_outline, _ = outer_of(core, 0.1)
    by_half_spaces, _ = outer_of(cut, 0.1)
    reach, expected = (
        np.max(by_outline.normals @ body.vertices.T, axis=1) for body in (by_half_spaces, by_outline)
    )
    assert reach == pytest.approx(expected, abs=1e-5)


def test_round_bodies_are_nearly_round():
    sphere, _ = outer_of(convex_hull([[0.0, 0.0, 0.0]]), 0.5)
    distance = np.linalg.norm(sphere.vertices, axis=1)
    assert len(sphere.vertices) > 200
    assert distance == pytest.approx(np.full(len(distance), 0.5), rel=0.011)
    capsule, solid = outer_of(convex_hull([[0.0, 0.0, 0.0], [0.0, 3.0, 0.0]]), 0.5)
    assert np.ptp(capsule.vertices, axis=0) == pytest.approx([1.0, 4.0, 1.0], rel=0.03)


def test_undilated_body_is_its_own_outer_shape():
    core = convex_hull(np.random.default_rng(4).normal(size=(10, 3)))
    outer, solid = outer_of(core, 0.0)
    assert outer.vertices == pytest.approx(core.vertices - solid.centroid)

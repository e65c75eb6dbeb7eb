"""Mass properties of dilated cores: known floe, textbook bodies, and the tetrahedra of tests/reference."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from dilatedem.geometry.mass import dilated_solid
from dilatedem.geometry.polyhedron import convex_hull, prism
from tests.reference.mass_by_tetrahedra import mass_by_tetrahedra

SQUARE = np.array([[-1.36, -1.36], [1.36, -1.36], [1.36, 1.36], [-1.36, 1.36]])


def test_floe_of_the_specification():
    floe = dilated_solid(prism(SQUARE, -0.21, 0.21), 0.04)
    assert floe.volume == pytest.approx(3.9117077, abs=5e-8)
    assert 915.0 * floe.volume == pytest.approx(3579.213, abs=5.1e-4)
    assert 915.0 * np.diag(floe.inertia) == pytest.approx([2407.511, 2407.511, 4666.408], abs=5e-4)
    assert floe.centroid == pytest.approx(np.zeros(3), abs=1e-15)


def test_sphere():
    sphere = dilated_solid(convex_hull([[1.0, -2.0, 3.0]]), 0.3)
    assert sphere.volume == pytest.approx(4.0 / 3.0 * np.pi * 0.027, rel=1e-14)
    assert sphere.centroid == pytest.approx([1.0, -2.0, 3.0], rel=1e-14)
    assert sphere.inertia == pytest.approx(0.4 * sphere.volume * 0.09 * np.eye(3), rel=1e-14)


def test_capsule():
    r, length = 0.3, 1.7
    axis = np.array([2.0, -1.0, 0.5]) / np.linalg.norm([2.0, -1.0, 0.5])
    capsule = dilated_solid(convex_hull([[0.0, 0.0, 0.0], length * axis]), r)
    cylinder, ball = np.pi * r**2 * length, 4.0 / 3.0 * np.pi * r**3
    about_axis = 0.5 * cylinder * r**2 + 0.4 * ball * r**2
    across = cylinder * (r**2 / 4 + length**2 / 12) + ball * (0.4 * r**2 + length**2 / 4 + 3 / 8 * length * r)
    expected = across * np.eye(3) + (about_axis - across) * np.outer(axis, axis)
    assert capsule.volume == pytest.approx(cylinder + ball, rel=1e-14)
    assert capsule.centroid == pytest.approx(0.5 * length * axis, rel=1e-13)
    assert capsule.inertia == pytest.approx(expected, rel=1e-13, abs=1e-15)


def cores():
    rng = np.random.default_rng(5)
    yield "needle", convex_hull([[0, 0, 0], [3, 0, 0], [3, 0.05, 0], [1.5, 0.02, 0.1]]), 0.04
    yield "plate", prism(SQUARE + [5.0, -3.0], 0.0, 0.0), 0.25
    yield "tilted triangle", convex_hull([[0, 0, 1], [2, 0.3, 0], [0.1, 1, 0.5]]), 0.3
    yield "tetrahedron", convex_hull(rng.normal(size=(4, 3))), 0.5
    for count in (5, 9, 16):
        yield f"hull of {count}", convex_hull(rng.normal(size=(count, 3)) * [1.0, 1.0, 0.3]), 0.2


@pytest.mark.parametrize(("core", "radius"), [pytest.param(c, r, id=name) for name, c, r in cores()])
def test_tetrahedra_give_the_same(core, radius):
    solid = dilated_solid(core, radius)
    volume, centroid, inertia = mass_by_tetrahedra(core, radius, steps=12)
    assert solid.volume == pytest.approx(volume, rel=1e-9)
    assert solid.centroid == pytest.approx(centroid, abs=1e-9)
    assert solid.inertia == pytest.approx(inertia, abs=1e-9 * np.trace(inertia))


def test_volume_is_steiners_polynomial():
    # box a, b, c: S0 r + M r^2 with S0 = 2(ab + bc + ca) and M = pi (a + b + c)
    box = prism([[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]], 0.0, 0.5)
    r = 0.3
    expected = 1.0 + 2.0 * (2.0 + 0.5 + 1.0) * r + np.pi * 3.5 * r**2 + 4.0 / 3.0 * np.pi * r**3
    assert dilated_solid(box, r).volume == pytest.approx(expected, rel=1e-14)


def test_undilated_box():
    box = dilated_solid(prism([[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]], 0.0, 0.5), 0.0)
    assert box.volume == pytest.approx(1.0, rel=1e-14)
    assert box.centroid == pytest.approx([1.0, 0.5, 0.25], rel=1e-14)
    expected = np.array([1.0 + 0.25, 4.0 + 0.25, 4.0 + 1.0]) / 12.0
    assert box.inertia == pytest.approx(np.diag(expected), rel=1e-13, abs=1e-15)


def test_rotation_and_distance_do_not_matter():
    points = np.random.default_rng(3).normal(size=(8, 3))
    turn, shift = Rotation.from_rotvec([0.3, -1.1, 0.7]).as_matrix(), np.array([40.0, -30.0, 2.0])
    here = dilated_solid(convex_hull(points), 0.1)
    there = dilated_solid(convex_hull(points @ turn.T + shift), 0.1)
    assert there.volume == pytest.approx(here.volume, rel=1e-12)
    assert there.centroid == pytest.approx(turn @ here.centroid + shift, rel=1e-12)
    assert there.inertia == pytest.approx(turn @ here.inertia @ turn.T, rel=1e-11, abs=1e-12)


def test_thin_core_tends_to_the_plate():
    plate, thin = (dilated_solid(prism(SQUARE, -h, h), 0.04) for h in (0.0, 1e-6))
    assert thin.volume == pytest.approx(plate.volume, rel=1e-4)
    assert thin.inertia == pytest.approx(plate.inertia, rel=1e-4, abs=1e-9)


def test_body_without_volume_is_refused():
    with pytest.raises(ValueError, match="no volume"):
        dilated_solid(prism(SQUARE, 0.0, 0.0), 0.0)
    with pytest.raises(ValueError, match="at least 0"):
        dilated_solid(prism(SQUARE, 0.0, 1.0), -0.1)

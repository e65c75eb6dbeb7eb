"""The contact laboratory's probe against the closed form of two spheres: F = (4/3) E* sqrt(R*) d^(3/2)."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from validation.contact_lab import pieces
from validation.contact_lab.probe import NO_CONTACT, Poses, Probe
from validation.contact_lab.scenes import CUBE, SPHERE, scene

RADIUS = SPHERE["dilated_radius"]


def test_two_spheres():
    probe = Probe(scene("liu2015", SPHERE, SPHERE))
    overlap = np.array([1e-5, 1e-3, -1e-3])
    way = np.array([[0.6, 0.0, 0.8], [0.0, -1.0, 0.0], [1.0, 0.0, 0.0]])
    poses = Poses.at_rest(probe, 3).moved(0, position=np.zeros(3))
    found = probe.at(poses.moved(1, position=(2.0 * RADIUS - overlap)[:, None] * way))
    force = pieces.point(overlap[:2], probe.modulus, (2.0 / RADIUS, 2.0 / RADIUS))
    assert found.force[:2] == pytest.approx(force[:, None] * way[:2], rel=1e-9, abs=1e-9)
    assert found.energy[:2] == pytest.approx(0.4 * force * overlap[:2], rel=1e-9)
    assert found.moment == pytest.approx(0.0, abs=1e-9)
    assert found.gap == pytest.approx(-overlap, abs=1e-12)
    assert found.mode[2] == NO_CONTACT and not found.force[2].any() and found.energy[2] == 0.0


def test_poses_do_not_depend_on_those_before():
    probe = Probe(scene("liu2015", CUBE, CUBE))
    random = np.random.default_rng(3)
    turn = Rotation.from_rotvec(0.02 * random.normal(size=(20, 3)))
    place = [0.58, 0.0, 0.0] + 0.002 * random.normal(size=(20, 3))
    poses = Poses.at_rest(probe, 20).moved(0, position=np.zeros(3)).moved(1, position=place, rotation=turn)
    there, back = probe.at(poses), probe.at(poses[::-1])
    assert there.strength.max() > 0.0
    for name in ("gap", "mode", "force", "moment", "energy"):
        assert np.array_equal(getattr(there, name), getattr(back, name)[::-1])

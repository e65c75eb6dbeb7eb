"""Distance and depth of cores without kernels: against the programmes of tests/reference, which share nothing with it."""

import itertools

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from dilatedem.geometry.polyhedron import Polyhedron, convex_hull
from dilatedem.geometry.separation import core_distance
from tests.reference.closest_points_qp import closest_points, depth
from tests.reference.cores import cores

CORES = cores()
KINDS = list(itertools.combinations_with_replacement(CORES, 2))
#: their differences span no volume: no depth to speak of
THIN = {"sphere", "capsule", "pile"}


def turned(core: Polyhedron, turn: Rotation, place: np.ndarray) -> Polyhedron:
    return Polyhedron(turn.apply(core.vertices) + place, core.edges, core.faces, turn.apply(core.normals.reshape(-1, 3)))


def poses(kinds: tuple[str, str], count: int = 30):
    """Pairs at random, from deep in each other to well apart; flat on the water every other time."""
    rng = np.random.default_rng(3)
    for i in range(count):
        turns = Rotation.random(2, random_state=rng)
        if i % 2:
            turns = Rotation.from_rotvec(np.column_stack((np.zeros((2, 2)), rng.uniform(-3, 3, 2))))
        offset = rng.normal(size=3) * [1.0, 1.0, 0.1 if i % 2 else 1.0]
        offset *= rng.uniform(0.05, 3.5) / np.linalg.norm(offset)
        yield turned(CORES[kinds[0]], turns[0], np.zeros(3)), turned(CORES[kinds[1]], turns[1], offset)


@pytest.mark.parametrize("kinds", KINDS, ids="-".join)
def test_agrees_with_a_quadratic_programme(kinds):
    for a, b in poses(kinds):
        expected, _, _ = closest_points(a.vertices, b.vertices)
        found = core_distance(a, b)
        if expected > 0.0:
            assert found == pytest.approx(expected, rel=1e-7, abs=1e-9)
        elif not THIN >= set(kinds):
            assert -found == pytest.approx(max(depth(a.vertices, b.vertices), 0.0), abs=1e-8)
        assert core_distance(b, a) == pytest.approx(found, abs=1e-8)


def test_points_and_segments_in_one_place_have_no_depth():
    point, other = convex_hull([[1.0, 2.0, 3.0]]), convex_hull([[0.0, 2.0, 3.0], [2.0, 2.0, 3.0]])
    assert core_distance(point, point) == 0.0
    assert core_distance(point, other) == pytest.approx(0.0, abs=1e-9)
    assert core_distance(other, other) == pytest.approx(0.0, abs=1e-9)

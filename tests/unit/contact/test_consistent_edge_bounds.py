"""What an edge can press on a cap at most: never less than what it presses, and seldom much more."""

import numpy as np
import pytest
from scipy.optimize import minimize_scalar
from scipy.spatial.transform import Rotation

from dilatedem.contact.consistent.join import SHARP
from tests.kernels import around_cap, bound_on_cap, workspace_of
from tests.reference.cores import polygon

UP = np.array([0.0, 0.0, 1.0])
#: corners of caps: a half space, a point, a segment, faces
CAPS = {
    0: np.zeros((1, 3)), 1: np.zeros((1, 3)), 2: np.array([[-0.5, 0.0, 0.0], [0.7, 0.0, 0.0]]),
    4: np.array([[-0.6, -0.2, 0.0], [0.6, -0.2, 0.0], [0.6, 0.2, 0.0], [-0.6, 0.2, 0.0]]),
    6: np.column_stack((polygon(6, 0.5, 3), np.zeros(6))),
}  # fmt: skip


def poses(count, seed):
    """Edges above and beside a cap, level and leaning, across its border or not: ends, dilated radii, deepest overlap."""
    rng, cap, made = np.random.default_rng(seed), CAPS[count], 0
    while made < 250:
        radius, other = rng.choice([0.04, 1.0]), 0.0 if count == 0 else rng.choice([0.04, 0.1])
        way = np.append(rng.normal(size=2), rng.choice([0.0, 1e-6, 1e-3, 0.1, 1.0]) * rng.normal())
        way *= 10.0 ** rng.uniform(-1.5, 0.5) / np.linalg.norm(way)
        ends = np.append(rng.normal(size=2) * rng.choice([0.05, 0.5]), 0.0) + np.outer([-rng.uniform(), rng.uniform()], way)
        scratch, reach = workspace_of(cap), radius + other

        def away(s, ends=ends, scratch=scratch, lift=0.0):
            point = ends[0] + s * (ends[1] - ends[0]) + [0.0, 0.0, lift]
            return np.linalg.norm(around_cap(scratch, count, tuple(UP), tuple(point), 0.01)[2])

        lift = max(0.0, -ends[:, 2].min()) + (0.0 if rng.uniform() < 0.3 else reach - 10.0 ** rng.uniform(-5.0, -2.3))
        ends = ends + [0.0, 0.0, lift]
        nearest = min(
            minimize_scalar(lambda s, ends=ends: away(s, ends), bounds=(0.0, 1.0), method="bounded", options={"xatol": 1e-12}).fun,
            away(0.0, ends), away(1.0, ends),
        )  # fmt: skip
        # cores must not meet; what does not press has nothing to bound
        if 0.05 * reach < nearest < reach - 1e-9:
            made += 1
            yield ends, radius, other, reach - nearest


@pytest.mark.parametrize("count", CAPS)
def test_no_edge_presses_more_than_its_bound(count):
    rng, ratios = np.random.default_rng(8), []
    for ends, radius, other, overlap in poses(count, seed=7):
        turn = Rotation.random(rng=rng)
        scratch = workspace_of(turn.apply(CAPS[count]), turn.apply(ends))
        length = np.linalg.norm(ends[1] - ends[0])
        overlap *= 1.0 + 1e-9
        energy, most, counts = bound_on_cap(
            scratch, length, radius, count, tuple(turn.apply(UP)), other, overlap, 1.0, SHARP
        )
        assert energy <= most * (1.0 + 1e-6)
        if energy > 0.0:
            assert counts or most < energy * (1.0 + 1e-6)
            ratios.append(most / energy)
    # of an edge over a face the bound is nearly what it presses; round a rim it is above; past a corner the vertex presses instead
    if count != 1:
        assert len(ratios) > 100
        assert np.median(ratios) < (4.0 if count == 2 else 1.5)

"""Submerged volume, centre of buoyancy and wetted area: closed form, clipping and the reference's hull agree at any tilt."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from dilatedem.geometry.polyhedron import prism
from dilatedem.geometry.shapes import BodyShape, pack_hulls
from tests.kernels import wet_polyhedron, wet_prism
from tests.reference.cores import cores, polygon
from tests.reference.submerged_hull import submerged

SHAPES = {name: BodyShape.of_core(core, 0.04)[0] for name, core in cores().items() if name not in ("pile", "sliver")}
HULLS = pack_hulls(list(SHAPES.values()))
NUMBER = {name: i for i, name in enumerate(SHAPES)}
WORK = np.zeros((1, 400, 4))


def by_clipping(name: str, turn: np.ndarray, z: float):
    volume, x, y, w, wetted = wet_polyhedron(z, *turn[2], HULLS, NUMBER[name], WORK)
    return volume, np.array([x, y, w]), wetted


def by_closed_form(name: str, turn: np.ndarray, z: float):
    valid, volume, x, y, w, wetted = wet_prism(z, *turn[2], HULLS, NUMBER[name])
    return (volume, np.array([x, y, w]), wetted) if valid else None


def same(found, expected, size: float = 1.0) -> None:
    assert found[0] == pytest.approx(expected[0], rel=1e-9, abs=1e-12 * size**3)
    assert found[1] == pytest.approx(expected[1], abs=1e-8 * size)
    assert found[2] == pytest.approx(expected[2], rel=1e-8)


@pytest.mark.parametrize("name", SHAPES)
def test_clipping_at_any_tilt(name):
    rng = np.random.default_rng(4)
    outer = SHAPES[name].outer
    total = met = 0
    for _ in range(25):
        turn = Rotation.random(rng=rng).as_matrix()
        z = rng.uniform(-1.0, 1.0) * np.abs(outer.vertices @ turn[2]).max()
        expected = submerged(outer, turn, z)
        total += 1
        if expected[0] < 1e-6:
            continue
        met += 1
        same(by_clipping(name, turn, z), expected)
    assert met > 0.8 * total


@pytest.mark.parametrize("name", ["box", "floe", "plate"])
def test_closed_form_of_floes(name):
    # plates are prisms, too: their thickness is twice the dilated radius
    assert HULLS.prism[NUMBER[name]]
    rng = np.random.default_rng(5)
    met = 0
    for _ in range(150):
        tilt = rng.normal(size=2) * 10.0 ** rng.uniform(-8, -0.5)
        turn = Rotation.from_rotvec([*tilt, 0.0]).as_matrix() @ Rotation.from_rotvec([0, 0, rng.uniform(-3, 3)]).as_matrix()
        half = np.abs(SHAPES[name].outer.vertices[:, 2]).max()
        z = rng.uniform(-1.1, 1.1) * half
        found = by_closed_form(name, turn, z)
        if found is not None:
            met += 1
            same(found, by_clipping(name, turn, z))
            same(found, submerged(SHAPES[name].outer, turn, z))
    assert met > 30


def test_closed_form_knows_where_it_ends():
    level, steep = np.eye(3), Rotation.from_rotvec([0.5, 0.0, 0.0]).as_matrix()
    upside_down = Rotation.from_rotvec([np.pi, 0.0, 0.0]).as_matrix()
    assert by_closed_form("box", level, 0.0) is not None
    assert by_closed_form("box", steep, 0.0) is None  # top and bottom are cut
    assert by_closed_form("box", level, 0.3) is None  # dry
    assert by_closed_form("box", level, -0.3) is None  # under water
    assert by_closed_form("box", upside_down, 0.0) is None


@pytest.mark.parametrize("name", SHAPES)
def test_wholly_under_water_and_dry(name):
    shape = SHAPES[name]
    for seed in range(5):
        turn = Rotation.random(rng=np.random.default_rng(seed)).as_matrix()
        volume, centre, wetted = by_clipping(name, turn, -10.0)
        assert volume == pytest.approx(shape.properties.volume, rel=1e-9)  # of the dilated body
        assert centre == pytest.approx(np.zeros(3), abs=1e-8)
        assert wetted == pytest.approx(submerged(shape.outer, turn, -10.0)[2], rel=1e-9)
        assert by_clipping(name, turn, 10.0)[0] == 0.0


def test_continuous_where_the_closed_form_hands_over():
    # the top edge dips under: both ways give the same on either side
    half = np.abs(SHAPES["box"].outer.vertices[:, 2]).max()
    plan = np.abs(SHAPES["box"].outer.vertices[:, 0]).max()
    for tilt in (0.01, 0.1):
        turn = Rotation.from_rotvec([0.0, tilt, 0.0]).as_matrix()
        dips = -half * np.cos(tilt) + plan * np.sin(tilt)
        around = [by_clipping("box", turn, dips + step) for step in (-1e-9, 0.0, 1e-9)]
        for one in around:
            assert one[0] == pytest.approx(around[1][0], abs=1e-7)
            assert one[2] == pytest.approx(around[1][2], abs=1e-5)


def test_floe_that_is_no_box():
    # many corners, thick: against the reference, tilted so that its bottom comes out of the water
    shape = BodyShape.of_core(prism(polygon(17, 2.0, 9), -0.6, 0.6), 0.05)[0]
    hulls = pack_hulls([shape])
    turn = Rotation.from_rotvec([0.7, 0.5, 0.1]).as_matrix()
    volume, x, y, z, wetted = wet_polyhedron(0.1, *turn[2], hulls, 0, WORK)
    same((volume, np.array([x, y, z]), wetted), submerged(shape.outer, turn, 0.1))

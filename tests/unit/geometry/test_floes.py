"""Stacks of floes are what each floe is by itself, digit for digit."""

import numpy as np
import pytest

from dilatedem.geometry import floes
from dilatedem.geometry.floes import floe_shapes
from dilatedem.geometry.outline import MITRE_LIMIT, Outlines
from dilatedem.geometry.polyhedron import convex_hull, prism, volume
from dilatedem.geometry.shapes import BodyShape, pack_hulls, pack_shapes
from tests.reference.floe_by_floe import packed_one_by_one, shapes_one_by_one

THICKNESS, RADIUS = 0.5, 0.04


def random_outlines(count, seed):
    """Convex outlines of 3 to 12 sides all over a field, some of them needles and some with a side that erosion swallows."""
    rng = np.random.default_rng(seed)
    needle = np.array([[0.0, 0.0], [8.0, 0.0], [7.9, 1.2]])
    cut = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 1.98], [1.98, 2.0], [0.0, 2.0]])
    outlines = [needle, cut]
    while len(outlines) < count:
        sides = rng.integers(3, 13)
        angle = np.sort(rng.uniform(0.0, 2.0 * np.pi, sides))
        if np.diff(angle, append=angle[0] + 2.0 * np.pi).max() > 2.8:
            continue
        circle = np.column_stack([np.cos(angle), np.sin(angle)])
        outlines.append(circle * rng.uniform(0.8, 3.0, 2) + rng.uniform(-500.0, 500.0, 2))
    return Outlines.of(outlines)


def assert_same_polyhedron(found, expected):
    np.testing.assert_array_equal(found.vertices, expected.vertices)
    np.testing.assert_array_equal(found.normals, expected.normals)
    np.testing.assert_array_equal(found.edges, expected.edges)
    assert [face.tolist() for face in found.faces] == [face.tolist() for face in expected.faces]


@pytest.mark.parametrize("thickness", [THICKNESS, 2.0 * RADIUS])  # solid cores, and plates
@pytest.mark.parametrize("stack", [7, 1024])
def test_stacks_equal_single_floes_exactly(monkeypatch, thickness, stack):
    monkeypatch.setattr(floes, "LARGEST_STACK", stack)
    outlines = random_outlines(150, seed=2)
    expected = shapes_one_by_one(outlines, thickness, RADIUS)
    met = []
    for which, shape, centroid in floe_shapes(outlines, thickness, RADIUS):
        assert shape.count == len(which) <= stack
        met += which.tolist()
        for k, floe in enumerate(which):
            single, middle = expected[floe]
            assert_same_polyhedron(shape.core.member(k), single.core)
            assert_same_polyhedron(shape.outer.member(k), single.outer)
            np.testing.assert_array_equal(centroid[k], middle)
            assert shape.properties.volume[k] == single.properties.volume
            np.testing.assert_array_equal(shape.properties.inertia[k], single.properties.inertia)
            assert volume(shape.outer)[k] == pytest.approx(single.properties.volume, rel=1e-12)
    assert sorted(met) == list(range(len(outlines)))


def test_bevelled_corners_are_among_them():
    shapes = [shape for _, shape, _ in floe_shapes(random_outlines(150, seed=2), THICKNESS, RADIUS)]
    assert any(len(shape.outer.faces) > len(shape.core.faces) for shape in shapes) and MITRE_LIMIT == 3.0


def test_a_floe_too_narrow_is_told():
    outlines = Outlines.of([np.array([[0.0, 0.0], [3.0, 0.0], [3.0, 3.0]]), np.array([[0.0, 0.0], [3.0, 0.0], [3.0, 0.05]])])
    with pytest.raises(ValueError, match="1 outlines are too narrow: moved inwards by 0.04 m"):
        list(floe_shapes(outlines, THICKNESS, RADIUS))


def mixed_bodies():
    """Shapes with single bodies and stacks among each other, the order of their bodies, and each body by itself."""
    outlines = random_outlines(40, seed=3)
    singles = [
        BodyShape.of_core(convex_hull(points), 0.1)[0]
        for points in ([[0.0, 0, 0]], [[0.0, 0, 0], [1.0, 0, 0]], np.random.default_rng(1).normal(size=(9, 3)), np.eye(3))
    ]
    shapes, order, each = [], [], dict(enumerate(singles, start=40))
    for which, shape, _ in floe_shapes(outlines, THICKNESS, RADIUS):
        shapes.append(shape)
        order += which.tolist()
    for single, number in zip(singles, (43, 41, 40, 42), strict=True):
        shapes.insert(1, single)
        order[shapes[0].count : shapes[0].count] = [number]
        each[number] = single
    one_by_one = [shape for shape, _ in shapes_one_by_one(outlines, THICKNESS, RADIUS)]
    return shapes, np.array(order), one_by_one + [each[number] for number in range(40, 44)]


def test_packed_stacks_equal_plain_loops():
    shapes, order, each = mixed_bodies()
    packed = pack_shapes(shapes, [np.array([0.0, 0.0, 1.0])], order)
    expected = packed_one_by_one([shape.core for shape in each])
    for name, values in expected.items():
        found = getattr(packed, name)
        if name in ("vertex_start", "face_start"):  # the half space has none
            values = np.append(values, values[-1])
        np.testing.assert_array_equal(found, values, err_msg=name)
    np.testing.assert_array_equal(packed.radius, [shape.radius for shape in each] + [0.0])
    alone = pack_shapes(each, [np.array([0.0, 0.0, 1.0])])
    for name, values in packed._asdict().items():
        np.testing.assert_array_equal(values, getattr(alone, name), err_msg=name)


def test_packed_hulls_equal_those_of_single_bodies():
    shapes, order, each = mixed_bodies()
    packed, alone = pack_hulls(shapes, order), pack_hulls(each)
    assert packed.prism[:40].all() and not packed.prism[40:42].any()
    for name, values in packed._asdict().items():
        np.testing.assert_array_equal(values, getattr(alone, name), err_msg=name)
    expected = packed_one_by_one([shape.outer for shape in each])
    for name in ("vertex_start", "vertex", "face_start", "loop_start", "loop"):
        np.testing.assert_array_equal(getattr(packed, name), expected[name], err_msg=name)


def test_prisms_of_different_heights_in_one_stack():
    outline = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]])
    stack = prism(np.stack([outline, outline + 5.0]), np.array([-1.0, 0.0]), np.array([1.0, 0.5]))
    assert_same_polyhedron(stack.member(0), prism(outline, -1.0, 1.0))
    assert_same_polyhedron(stack.member(1), prism(outline + 5.0, 0.0, 0.5))
    np.testing.assert_allclose(volume(stack), [4.0, 1.0])

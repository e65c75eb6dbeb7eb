"""What a floe costs does not grow with their number: calls made and memory kept, counted, not timed."""

import math
import sys
import tracemalloc

import numpy as np
import pytest

from dilatedem.case.schema import Case
from dilatedem.generate import generate
from dilatedem.scene.arrays import build_model, initial_bodies
from dilatedem.scene.place import compose

SIZE = 2.8  # m, of a floe


def field(count, **more):
    side = math.sqrt(count * SIZE**2 / 0.64)
    return Case.model_validate({
        "domain": {"size": [side, side], "y_boundary": "periodic"},
        "field": {"floe_count": count, "concentration": 0.64},
        "structure": [{"kind": "pile", "name": "pile", "center": [10.0, 0.0], "radius": 2.0}],
    } | more)  # fmt: skip


def built(case):
    scene = compose(case)
    model = build_model(case, scene)
    return scene, model, initial_bodies(case, scene, model)


def calls(work, *arguments):
    """Python and C functions that are called."""
    count = 0

    def note(frame, event, argument):
        nonlocal count
        count += event in ("call", "c_call")

    sys.setprofile(note)
    try:
        work(*arguments)
    finally:
        sys.setprofile(None)
    return count


@pytest.fixture(autouse=True)
def warm():
    built(field(20))  # what is imported or set up once counts for no floe


def test_building_calls_by_the_stack_not_by_the_floe():
    few, many = calls(built, field(500)), calls(built, field(4000))
    assert many < 3 * few  # for eight times as many floes


def test_writing_a_field_calls_little_by_the_floe(tmp_path):
    generate(field(20), tmp_path / "warm")
    few, many = (calls(generate, field(count), tmp_path / str(count)) for count in (500, 4000))
    assert many < 4 * few


def test_memory_of_a_floe():
    tracemalloc.start()
    try:
        kept = built(field(2000))
        held, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    count = kept[0].count
    assert held < 5000 * count  # 3.8 kB: vertices and normals of core and outer shape, in the scene and packed, and the motion
    assert peak < held + 5e6  # stacks are of a bounded size, and so is what they need on the way


def test_a_scene_holds_no_object_for_each_floe():
    scene = compose(field(4000))
    assert len(scene.shapes) < 80
    assert sum(shape.count for shape in scene.shapes) == scene.count
    np.testing.assert_array_equal(np.sort(scene.order), np.arange(scene.count))

"""Outlines of many points: taken up to what a face may have, thinned on request, else refused with the numbers and a way on."""

import math

import pytest

from dilatedem.case.load import case_from
from dilatedem.errors import CaseError
from dilatedem.scene.place import MOST_FACE_CORNERS, compose


def round_floe(points: int, **more) -> dict:
    angles = [2.0 * math.pi * i / points for i in range(points)]
    body = {"outline": [[14.0 * math.cos(angle), 14.0 * math.sin(angle)] for angle in angles], **more}
    return {"domain": {"size": [60.0, 60.0]}, "field": {"source": "bodies"}, "body": [body]}


def corners(data: dict) -> int:
    return int(compose(case_from(data, {})).core_vertices()[0]) // 2


def test_as_many_as_a_face_may_have():
    assert corners(round_floe(MOST_FACE_CORNERS)) == MOST_FACE_CORNERS


@pytest.mark.parametrize("points", [128, 1000, 10_000])
def test_a_refusal_says_how_many_and_what_helps(points):
    with pytest.raises(CaseError) as caught:
        compose(case_from(round_floe(points), {}))
    message = str(caught.value)
    assert message.startswith(f"body.0: a face has {points} corners, and at most 127 can be handled; leave some out, or have ")
    tolerance = float(message.partition("outline_tolerance = ")[2].partition(" ")[0])
    left = corners(round_floe(points, outline_tolerance=tolerance))
    assert message.endswith(f"which leaves {left} of {points}")
    assert 40 <= left <= MOST_FACE_CORNERS


def test_a_hull_has_no_outline_to_thin():
    hull = {"vertices": [[0.0, 0.0, 0.0]], "outline_tolerance": 0.1}
    with pytest.raises(CaseError, match="body.0.outline_tolerance = 0.1: belongs to an outline"):
        case_from({"body": [hull]}, {})


def test_more_points_than_can_be_looked_at():
    with pytest.raises(CaseError, match=r"body.0.outline = .*: must have at most 10000 items"):
        case_from(round_floe(10_001), {})
    with pytest.raises(CaseError, match=r"body.0.vertices = .*: must have at most 2000 items"):
        case_from({"body": [{"vertices": [[0.0, 0.0, 0.0]] * 2001}]}, {})

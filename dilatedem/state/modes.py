"""The seven ways in which features of two dilated bodies meet (Liu 2015, section 2)."""

from enum import IntEnum


class Feature(IntEnum):
    """What of a core is closest to the other body: a sphere, a cylinder or a plane of the dilated surface."""

    VERTEX = 0
    EDGE = 1
    FACE = 2


class Mode(IntEnum):
    """Contact mode; the law of each is in `contact.liu2015`. Contacts at a point come first, then patches."""

    VERTEX_VERTEX = 0
    VERTEX_EDGE = 1
    VERTEX_FACE = 2
    EDGE_CROSSING = 3
    EDGE_PARALLEL = 4
    EDGE_FACE = 5
    FACE_FACE = 6


MODE_COUNT = len(Mode)
MODE_NAMES = (
    "vertex-vertex", "vertex-edge", "vertex-face", "edge-edge crossing", "edge-edge parallel", "edge-face", "face-face",
)  # fmt: skip

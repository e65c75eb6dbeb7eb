"""How places on structures are laid out flat in their load maps. Constant during a run."""

from enum import IntEnum
from typing import NamedTuple

import numpy as np


class Along(IntEnum):
    """What the first coordinate of a load map runs along."""

    ANGLE = 0  # around an axis that is upright, or leans
    LINE = 1  # along a horizontal line
    OUTLINE = 2  # around a polygon in plan


class Charts(NamedTuple):
    """Of s rows of the record of loads; their outlines in plan stand one after the other."""

    center: np.ndarray  # (s, 3) m, about which moments are stated
    map: np.ndarray  # (s,) number of the load map, -1 = none
    along: np.ndarray  # (s,) Along
    origin: np.ndarray  # (s, 3) m, that places are measured from: a point of the axis or of the line, the middle of an outline
    axis: np.ndarray  # (s, 3) unit vector of a line; of an axis, what it gains in x and y per metre of height, and 1
    length: np.ndarray  # (s,) m, half that of a line, all of an outline
    heights: np.ndarray  # (s, 2) m, lowest and highest height over the water
    outline_start: np.ndarray  # (s + 1,)
    outline: np.ndarray  # (p, 2) m, corners from the origin, counter-clockwise

"""How figures look to readers who see two of three colours: which marks of a figure they would take for one another.

Machado, Oliveira & Fernandes (2009), Table 1, severity 1, on linear RGB; distances of CIE 1976 in L*a*b* under D65.
"""

from itertools import combinations
from typing import NamedTuple

import numpy as np
from matplotlib import colors
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure

#: CIE delta E from which on two colours are told apart at a glance; 2.3 is the least that is seen side by side
LEAST_DISTANCE = 12.0
SEEN = {
    "normal": np.eye(3),
    "protanopia": np.array([
        [0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998],
    ]),
    "deuteranopia": np.array([
        [0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881],
    ]),
    "tritanopia": np.array([
        [1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.303900],
    ]),
}  # fmt: skip
#: linear sRGB to XYZ, white of D65
_XYZ = np.array([[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750], [0.0193339, 0.1191920, 0.9503041]])


class Mark(NamedTuple):
    """Something that a figure tells things apart by."""

    kind: str  # line or area
    rgb: tuple[float, float, float]  # on white
    shape: str  # dash and marker of a line, hatch of an area: marks of another shape are told apart by it


def lab(rgb, sight: str = "normal") -> np.ndarray:
    """L*a*b* of sRGB colours (..., 3) as they look to somebody."""
    rgb = np.asarray(rgb, float)
    linear = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
    seen = np.clip(linear @ SEEN[sight].T, 0.0, 1.0)
    ratio = seen @ _XYZ.T / _XYZ.sum(axis=1)
    root = np.where(ratio > (6 / 29) ** 3, np.cbrt(ratio), ratio / (3 * (6 / 29) ** 2) + 4 / 29)
    return np.stack([116 * root[..., 1] - 16, 500 * (root[..., 0] - root[..., 1]), 200 * (root[..., 1] - root[..., 2])], axis=-1)


def distance(one, other, sight: str = "normal") -> float:
    """CIE 1976 delta E of two colours to somebody."""
    return float(np.linalg.norm(lab(one, sight) - lab(other, sight)))


def clashes(figure: Figure) -> list[str]:
    """Pairs of marks in one panel that somebody could not tell apart, in words."""
    found = []
    for axes in figure.axes:
        for one, other in combinations(dict.fromkeys(marks(axes)), 2):
            if one.kind != other.kind or one.shape != other.shape:
                continue
            for sight in SEEN:
                apart = distance(one.rgb, other.rgb, sight)
                if 0.0 < apart < LEAST_DISTANCE or (apart == 0.0 and one != other):
                    found.append(f"{colors.to_hex(one.rgb)} and {colors.to_hex(other.rgb)}, {sight}: {apart:.1f}")
    return found


def marks(axes: Axes) -> list[Mark]:
    """Lines and areas of a panel that mean something: what spans it, such as its zero line, and colours of a scale do not."""
    found = [
        Mark("line", on_white(line.get_color(), line.get_alpha()), f"{line._dash_pattern} {line.get_marker()}")
        for line in axes.lines
        if len(line.get_xdata()) > 1 and line.get_transform() == axes.transData
    ]
    for area in axes.collections:
        if isinstance(area, PolyCollection) and area.get_array() is None:
            found += [Mark("area", on_white(face), str(area.get_hatch())) for face in np.unique(area.get_facecolor(), axis=0)]
    filled = [patch for patch in axes.patches if patch.get_fill()]
    return found + [Mark("area", on_white(patch.get_facecolor()), str(patch.get_hatch())) for patch in filled]


def on_white(colour, alpha: float | None = None) -> tuple[float, float, float]:
    """What is seen of a colour that white shines through."""
    *rgb, own = colors.to_rgba(colour, alpha)
    return tuple(round(own * part + 1.0 - own, 4) for part in rgb)

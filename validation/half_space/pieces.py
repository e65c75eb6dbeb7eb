"""Plain laws of point, line and face contact, for comparison with the half-space: forces F/E* [m2]; and one law for all three.

Each plain law is evaluated on the *penetrating* extent of its own support, with the overlap at the centroid of that extent.
"""

import numpy as np
from scipy.optimize import brentq
from scipy.special import ellipe, ellipkm1

#: aspect ratio -> beta of a flat rectangular punch, k = 2 E* beta sqrt(area/pi), as computed here (checks.py); elsewhere by the
#: elliptic punch
BETA = {1.0: 1.0212, 2.0: 1.0472, 3.0: 1.0869, 5.6: 1.1858, 10.0: 1.3228, 20.0: 1.5532, 42.0: 1.8991, 84.0: 2.3412, 150.0: 2.8248}

#: length over contact width (2b) above which the line law is taken to hold: below, it overrates a short line by more than 30 %
SLENDER = 0.8

#: margin, in sqrt(r overlap), by which a rounded rim widens a patch: gives Hertz exactly for a patch of no size
MARGIN = (4 / 3) / (2 * BETA[1.0] / np.sqrt(np.pi))


def point(small: float, large: float, overlap: float) -> tuple[float, float]:
    """Force and energy W/E* [m3] of elliptic Hertz, exact (Johnson 1985, eqs. 4.24-4.32); curvatures [1/m] of the pair."""

    def integrals(k):  # K and E of the ellipse of semi-axis ratio k = b/a
        return ellipkm1(k * k), ellipe(1 - k * k)

    def ratio(k):  # of the curvatures, large/small
        first, second = integrals(k)
        return (second / k**2 - first) / (first - second)

    slender = 1.0
    if large / small > 1 + 1e-9:
        slender = float(np.exp(brentq(lambda log: np.log(ratio(np.exp(log)) * small / large), np.log(1e-9), np.log(1 - 1e-7))))
    if slender > 1 - 1e-6:
        force = 4 / 3 * np.sqrt(2 / (small + large)) * overlap**1.5
        return force, 0.4 * force * overlap
    first, second = integrals(slender)
    # with peak p0 and b = k a < a: overlap = p0 b K and small/2 = p0 b (K - E)/(e^2 a^2)
    semi = np.sqrt(2 * overlap * (first - second) / (small * (1 - slender**2) * first))
    force = 2 / 3 * np.pi * semi * overlap / first  # 2/3 p0 pi a b
    return force, 0.4 * force * overlap


def line(length: float, radius: float, overlap: float) -> float:
    """pi L overlap / Lam with Lam = 0.2 + ln(pi L^3/(F R)), solved; nan where it has no solution (L^2 < 2.2 R overlap)."""
    if length <= 0 or overlap <= 0:
        return np.nan
    first = 0.2 + np.log(length**2 / (radius * overlap))
    if first <= 1:
        return np.nan
    slender = brentq(lambda value: value - np.log(value) - first, 1.0, 10 * first + 10)
    return np.pi * length * overlap / slender


def slenderness(length: float, radius: float, force: float) -> float:
    """Length over the width 2b of the line contact, b^2 = 4 F R/(pi L)."""
    return length / (2 * np.sqrt(4 * force * radius / (np.pi * length)))


def beta(aspect: np.ndarray | float) -> np.ndarray | float:
    """Shape factor of a rectangular punch: that of the elliptic one times a ratio, linear in ln(aspect) between those of BETA."""
    aspect = np.maximum(aspect, 1 / np.asarray(aspect))
    ratios = [value / elliptic_beta(known) for known, value in BETA.items()]
    return elliptic_beta(aspect) * np.interp(np.log(aspect), np.log(list(BETA)), ratios)


def elliptic_beta(aspect: np.ndarray | float) -> np.ndarray | float:
    """Shape factor of a flat elliptic punch, exact: (pi/2) sqrt(a/b)/K(e)."""
    return np.pi / 2 * np.sqrt(aspect) / ellipkm1(1 / np.asarray(aspect) ** 2.0)


def face(length: float, width: float, overlap: float) -> float:
    """2 beta sqrt(area/pi) overlap."""
    if length <= 0 or width <= 0 or overlap <= 0:
        return np.nan
    return float(2 * beta(length / width) * np.sqrt(length * width / np.pi) * overlap)


def largest(point_force: float, line_force: float, face_force: float, length: float, radius: float) -> float:
    """The largest of the pieces that apply; the line law only above SLENDER."""
    if np.isfinite(line_force) and slenderness(length, radius, line_force) < SLENDER:
        line_force = np.nan
    applying = [force for force in (point_force, line_force, face_force) if np.isfinite(force)]
    return max(applying, default=np.nan)


def widened(length: float, width: float, radii: tuple[float, float], deepest: float, tilt: float) -> tuple[float, float, float]:
    """Force [m2], energy [m3] and reach [m] of one law for point, line and face: that of a face, widened by its rounded rim.

    Of all patches [0, reach] x width at the deep end, each pressed in by its mean overlap m = deepest - tilt reach/2, the one with
    the most energy counts, W = int_0^m k m' dm' with k of a rectangle reach + MARGIN sqrt(r m') by width + MARGIN sqrt(r m'). So
    force and moment are the gradient of an energy that is continuous in the pose. For a sharp patch each W is a lower bound, since
    the true pressure is the one that maximises int p overlap - 1/2 int p u. radii: of the rounding along and across the length [m].
    """
    wet = min(length, deepest / tilt) if tilt > 0 else length
    reach = np.concatenate([[0.0, wet], wet * np.geomspace(1e-4, 1, 400)])
    mean = np.maximum(deepest - tilt * reach / 2, 0.0)[:, None] * np.append((np.arange(40) + 0.5) / 40, 1.0)
    along = reach[:, None] + MARGIN * np.sqrt(radii[0] * mean)
    across = width + MARGIN * np.sqrt(radii[1] * mean)
    force = 2 * beta(along / across) * np.sqrt(along * across / np.pi) * mean
    energy = force[:, :-1].mean(axis=1) * mean[:, -1]
    best = int(energy.argmax())
    return float(force[best, -1]), float(energy[best]), float(reach[best])

"""The water that floes take along where they are accelerated: closed forms, by a floe's plan area and draught."""

import math

import numpy as np

from dilatedem.geometry.shapes import Hulls
from dilatedem.numerics.plain import angle, inverse
from dilatedem.state.bodies import Solids, WateredSolids, joined_rows

#: added mass [rho a^3] of a disc of radius a at the surface that moves along its axis, and inertia [rho a^5] of one that turns
#: about a diameter: half of those deep in water (Lamb 1932, article 108)
HEAVING, PITCHING = 4.0 / 3.0, 8.0 / 45.0
#: the thickest spheroid, by its half height over its radius; one as thick as a sphere would be a quotient of nothing and nothing
THICKEST = 0.999
#: added over displaced mass of a sphere
SPHERE = 0.5


def with_water(solids: Solids, hulls: Hulls, volume: np.ndarray, density: float) -> WateredSolids:
    """The solids with the water that each free body of `hulls` takes along; volume (n,) [m3] of these; density [kg/m3]: 0 = none.

    For a floe that lies flat, as draught counts what it displaces where it floats. Along z and about level axes that of a thin disc
    of its plan area, along x and y that of half an oblate spheroid of its plan area and displaced volume. A body that is no upright
    prism: that of a sphere which displaces as much, which takes nothing along where it turns. A floe of several parts takes along
    what one of their plan area and displacement does; each part has a share of that by its mass.
    """
    count = len(solids.mass)
    free = np.flatnonzero(solids.inverse_mass > 0.0)
    added, added_inertia, share = np.zeros((count, 2)), np.zeros(count), np.ones(count)
    inverse_mass, heave, inertia = solids.inverse_mass.copy(), solids.inverse_mass.copy(), solids.inertia.copy()
    inverse_inertia = solids.inverse_inertia.copy()
    if density > 0.0:
        whole = _whole_of(solids)[free]
        mass, flat, area = solids.mass[free], hulls.prism[free], hulls.plan[free, 0]
        displaced = np.minimum(mass, density * volume[free])
        share[free] = mass / _summed(mass, whole)
        mass, area, displaced = (_summed(values, whole) for values in (mass, area, displaced))
        added[free], added_inertia[free] = _taken_along(displaced, area, flat, density)
        inverse_mass[free] = 1.0 / (mass + added[free, 0])
        heave[free] = 1.0 / (mass + added[free, 1])
        inertia[:, 0, 0] += added_inertia
        inertia[:, 1, 1] += added_inertia
        inverse_inertia[free] = inverse(inertia[free])
    own = solids._replace(inverse_mass=inverse_mass, inertia=inertia, inverse_inertia=inverse_inertia)
    return WateredSolids(*own, heave, added * share[:, None], added_inertia * share)


def _whole_of(solids: Solids) -> np.ndarray:
    """(n,) for each body the first one of its floe: itself, unless it is part of one of several."""
    whole = np.arange(len(solids.floe))
    for first, last in joined_rows(solids.floe):
        whole[first:last] = first
    return whole


def _summed(values: np.ndarray, whole: np.ndarray) -> np.ndarray:
    """(m,) sums over all parts of the floe that each body is part of."""
    return np.bincount(whole, values)[whole]


def _taken_along(displaced: np.ndarray, area: np.ndarray, flat: np.ndarray, density: float) -> tuple[np.ndarray, np.ndarray]:
    """Added masses (m, 2) [kg] along x and y, and along z, and inertias (m,) [kg m2] about level axes, of floes that displace
    `displaced` (m,) [kg] over `area` (m,) [m2]; flat (m,): which are upright prisms."""
    added, added_inertia = np.tile(SPHERE * displaced[:, None], 2), np.zeros(len(displaced))
    radius = np.sqrt(area[flat] / math.pi)
    added[flat, 0] = spheroid_share(1.5 * displaced[flat] / (density * area[flat] * radius)) * displaced[flat]
    added[flat, 1] = HEAVING * density * radius * radius * radius
    added_inertia[flat] = PITCHING * density * radius * radius * radius * radius * radius
    return added, added_inertia


def spheroid_share(flatness: np.ndarray) -> np.ndarray:
    """Added over displaced mass of oblate spheroids that move edgewise (Lamb 1932, article 114); flatness (k,): half height over
    radius, of which more than a sphere's counts as that.
    """
    flat = np.minimum(flatness, THICKEST)
    square = 1.0 - flat * flat
    e = np.sqrt(square)
    alpha = flat * angle(e, flat) / (e * square) - flat * flat / square
    return alpha / (2.0 - alpha)

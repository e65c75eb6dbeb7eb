"""The water that floes take along where they are accelerated: closed forms, by a floe's plan area and draught."""

import math

import numpy as np

from dilatedem.geometry.shapes import Hulls
from dilatedem.numerics.plain import angle, inverse
from dilatedem.state.bodies import Solids, WateredSolids

#: added mass [rho a^3] of a disc of radius a at the surface that moves along its axis, and inertia [rho a^5] of one that turns
#: about a diameter: half of those deep in water (Lamb 1932, article 108)
HEAVING, PITCHING = 4.0 / 3.0, 8.0 / 45.0
#: the thickest spheroid, by its half height over its radius; one as thick as a sphere would be a quotient of nothing and nothing
THICKEST = 0.999
#: added over displaced mass of a sphere
SPHERE = 0.5


def with_water(solids: Solids, hulls: Hulls, volume: np.ndarray, density: float) -> WateredSolids:
    """The solids with the water that each free body of `hulls` takes along; volume (n,) [m3] of these; density [kg/m3]: 0 = none,
    as where floes are of several parts.

    For a floe that lies flat, as draught counts what it displaces where it floats. Along z and about level axes that of a thin disc
    of its plan area, along x and y that of half an oblate spheroid of its plan area and displaced volume. A body that is no upright
    prism: that of a sphere which displaces as much, which takes nothing along where it turns.
    """
    count = len(solids.mass)
    added, added_inertia = np.zeros((count, 2)), np.zeros(count)
    free = np.flatnonzero(solids.inverse_mass > 0.0)
    if density > 0.0:
        displaced = np.minimum(solids.mass[free], density * volume[free])
        added[free] = SPHERE * displaced[:, None]
        flat = hulls.prism[free]
        floes, displaced, area = free[flat], displaced[flat], hulls.plan[free[flat], 0]
        radius = np.sqrt(area / math.pi)
        added[floes, 0] = spheroid_share(1.5 * displaced / (density * area * radius)) * displaced
        added[floes, 1] = HEAVING * density * radius * radius * radius
        added_inertia[floes] = PITCHING * density * radius * radius * radius * radius * radius
    inverse_mass, heave, inertia = solids.inverse_mass.copy(), solids.inverse_mass.copy(), solids.inertia.copy()
    inverse_inertia = solids.inverse_inertia.copy()
    if density > 0.0:
        inverse_mass[free] = 1.0 / (solids.mass[free] + added[free, 0])
        heave[free] = 1.0 / (solids.mass[free] + added[free, 1])
        inertia[:, 0, 0] += added_inertia
        inertia[:, 1, 1] += added_inertia
        inverse_inertia[free] = inverse(inertia[free])
    own = solids._replace(inverse_mass=inverse_mass, inertia=inertia, inverse_inertia=inverse_inertia)
    return WateredSolids(*own, heave, added, added_inertia)


def spheroid_share(flatness: np.ndarray) -> np.ndarray:
    """Added over displaced mass of oblate spheroids that move edgewise (Lamb 1932, article 114); flatness (k,): half height over
    radius, of which more than a sphere's counts as that.
    """
    flat = np.minimum(flatness, THICKEST)
    square = 1.0 - flat * flat
    e = np.sqrt(square)
    alpha = flat * angle(e, flat) / (e * square) - flat * flat / square
    return alpha / (2.0 - alpha)

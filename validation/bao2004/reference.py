"""Beams and floating bodies in closed form: what deformable blocks are held against.

A beam of ice, `BEAM` = 10 m x 1 m x 0.5 m, E 1 GPa, nu 0.3, 915 kg/m3; bending up and down unless said.
"""

import numpy as np
from scipy.linalg import expm
from scipy.optimize import brentq

from dilatedem.deformation.elements import Material

ICE = Material(1e9, 0.3, 915.0)
LENGTH, WIDTH, THICKNESS = BEAM = (10.0, 1.0, 0.5)
GRAVITY = 9.81
#: frequencies of a free Euler-Bernoulli beam: roots of cos(x) cosh(x) = 1
ROOTS = (4.730040744862704, 7.853204624095838, 10.995607838001671)
#: a^2 w sqrt(rho h/D) of a free square plate, nu = 0.3
PLATE = (13.49, 19.79, 24.43)
#: errors of the middle deflection of a beam on two end supports under its weight by so many symmetric modes of Euler-Bernoulli
SERIES = {1: -1.33e-2, 2: -0.72e-2, 3: -0.13e-2, 4: -0.10e-2, 8: -0.013e-2}


def area() -> float:
    return WIDTH * THICKNESS


def second_moment() -> float:
    """Of the section [m4]."""
    return WIDTH * THICKNESS**3 / 12.0


def shear_stiffness() -> float:
    """kappa G A [N], Cowper's kappa = 10 (1 + nu)/(12 + 11 nu) of a rectangle."""
    nu = ICE.poisson_ratio
    return 10.0 * (1.0 + nu) / (12.0 + 11.0 * nu) * ICE.elastic_modulus / (2.0 * (1.0 + nu)) * area()


def euler_bernoulli() -> np.ndarray:
    """(3,) [Hz] of the free beam."""
    stiffness = ICE.elastic_modulus * second_moment() / (ICE.density * area())
    return np.array(ROOTS) ** 2 * np.sqrt(stiffness) / (2.0 * np.pi * LENGTH**2)


def timoshenko() -> np.ndarray:
    """(3,) [Hz] of the free beam with shear and the inertia of its sections.

    With w, psi, M, Q along the beam: w' = psi + Q/(kappa G A), psi' = M/(E I), M' = -Q - rho I w^2 psi, Q' = -rho A w^2 w; what
    leads from M = Q = 0 at one end to the same at the other has no inverse at a frequency.
    """
    flexure, inertia = ICE.elastic_modulus * second_moment(), ICE.density * second_moment()

    def ends(hertz: float) -> float:
        square = (2.0 * np.pi * hertz) ** 2
        slope = np.array([
            [0.0, 1.0, 0.0, 1.0 / shear_stiffness()], [0.0, 0.0, 1.0 / flexure, 0.0],
            [0.0, -inertia * square, 0.0, -1.0], [-ICE.density * area() * square, 0.0, 0.0, 0.0],
        ])  # fmt: skip
        return float(np.linalg.det(expm(slope * LENGTH)[2:, :2]))

    return np.array([brentq(ends, 0.8 * above, 1.02 * above, xtol=1e-10) for above in euler_bernoulli()])


def sagging() -> tuple[float, float]:
    """Deflection of the middle [m] of the beam on two end supports under its weight: by bending, and by shear."""
    load = ICE.density * GRAVITY * area()
    bending = 5.0 * load * LENGTH**4 / (384.0 * ICE.elastic_modulus * second_moment())
    return bending, load * LENGTH**2 / (8.0 * shear_stiffness())


def sagging_stress() -> float:
    """[Pa] at the surface of its middle: q L^2/8 over the section's modulus."""
    return ICE.density * GRAVITY * area() * LENGTH**2 / 8.0 * 0.5 * THICKNESS / second_moment()


def floating_moment(x: np.ndarray, load: float) -> np.ndarray:
    """Bending moment [N m] at x [m] from the loaded end of a rigid floe on water: P x (1 - x/L)^2, 4/27 P L at L/3.

    The water bears P by q(x) = P/L (4 - 6 x/L).
    """
    return load * x * (1.0 - x / LENGTH) ** 2

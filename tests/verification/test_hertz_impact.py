"""Hertz impact: delta = (5 m* v^2/(4 K))^(2/5), F = K delta^(3/2), t = 2.943 delta/v, with F = K delta^(3/2) of the contact mode.

K = 4/3 E* sqrt(R) with R of Liu 2015, Eqs. (10)-(13): R1 R2/(R1 + R2) for two corners (spheres), r for a corner on a face,
sqrt(R1 R2) for edges (capsules) that cross at right angles, sqrt(r R*) for a corner (sphere) on an edge (the pile).
"""

from math import pi, sqrt

from scipy.special import gamma

from tests.verification.comparison import Comparison, check, start
from tests.verification.point_impact import impacts

CASE = "hertz_impact"
SPEED, ICE = 0.3, 915.0
ICE_ICE, ICE_STEEL = 1e9 / (2 * 0.91), 1 / (0.91 / 1e9 + 0.91 / 210e9)
#: t v/delta of a Hertz impact: 2 sqrt(pi) Gamma(7/5)/Gamma(9/10) = 2.943
DURATION = 2 * sqrt(pi) * gamma(7 / 5) / gamma(9 / 10)


def hertz(stiffness: float, mass: float, speed: float) -> tuple[float, float, float]:
    """Largest overlap [m], force [N] and duration [s] of an elastic impact."""
    overlap = (1.25 * mass * speed**2 / stiffness) ** 0.4
    return overlap, stiffness * overlap**1.5, DURATION * overlap / speed


def expected() -> dict[tuple[int, int], tuple[str, float, float]]:
    """Per pair: its name, K [N/m^1.5] and m* [kg]."""
    ball = ICE * 4 / 3 * pi * 0.2**3
    cube = ICE * (0.4**3 + 6 * 0.16 * 0.04 + 3 * pi * 0.4 * 0.04**2 + 4 / 3 * pi * 0.04**3)
    capsule = ICE * (pi * 0.1**2 + 4 / 3 * pi * 0.1**3)
    return {
        (0, 1): ("sphere on sphere", 4 / 3 * ICE_ICE * sqrt(0.1), ball / 2),
        (2, 3): ("corner on face", 4 / 3 * ICE_ICE * sqrt(0.04), cube / 2),
        (4, 5): ("capsule across capsule", 4 / 3 * ICE_ICE * sqrt(0.1), capsule / 2),
        (6, 7): ("sphere on pile", 4 / 3 * ICE_STEEL * sqrt(sqrt(0.2 * 0.2 * 2 / 2.2)), ball),
    }


def compare() -> list[Comparison]:
    found = impacts(start(CASE))
    rows = []
    for pair, (name, stiffness, mass) in expected().items():
        overlap, force, duration = hertz(stiffness, mass, SPEED)
        rows += [
            Comparison(CASE, f"{name}: overlap, m", overlap, found[pair].overlap),
            Comparison(CASE, f"{name}: force, N", force, found[pair].force),
            Comparison(CASE, f"{name}: duration, s", duration, found[pair].duration),
        ]
    return rows


def test_hertz_impact():
    check(compare())


def test_nothing_else_collides():
    assert set(impacts(start(CASE))) == set(expected())


def test_constant_of_the_duration():
    assert round(DURATION, 3) == 2.943

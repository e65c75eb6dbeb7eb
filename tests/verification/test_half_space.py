"""The half-space solver of validation/half_space against closed forms, on small grids.

Hertz: F = 4/3 sqrt(R) overlap^(3/2), W = 2/5 F overlap (circle); elliptic by elliptic integrals. Flat punch of any plan:
F = pi C overlap, C its capacitance over 4 pi eps0 (square of unit side: 0.3667896, Read 1997). All in units of E*.
"""

import numpy as np
import pytest

from validation.half_space import checks
from validation.half_space.contact import resolve
from validation.half_space.profile import rounded_core

#: cells of the finest grid: forces to about 0.1 %
CELLS = 2**12


def test_hertz_circular_and_elliptic():
    for check in checks.hertz(CELLS):
        assert check.computed == pytest.approx(check.known, rel=1e-3), check.what


def test_flat_punches():
    for check in checks.flat_punches(CELLS):
        assert check.computed == pytest.approx(check.known, rel=5e-3), check.what


def test_a_steeply_tilted_edge_is_a_sphere():
    """A tilt of 0.3 lifts all of the edge but its rounded end: Hertz with R = r."""
    contact = resolve(rounded_core(0.42, 0.0, 0.04, 1e-4, tilt=0.3), CELLS).contact
    assert contact.force == pytest.approx(4 / 3 * np.sqrt(0.04) * 1e-4**1.5, rel=2e-3)
    assert contact.energy_moment == pytest.approx(contact.force * 0.21, rel=1e-3)

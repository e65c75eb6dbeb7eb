"""Modes of a beam against closed forms, and against elements."""

from math import cos, cosh, exp, pi, sin, sinh, sqrt

import numpy as np
import pytest

from dilatedem.numerics.plain import exponential
from dilatedem.structures.beam import Beam, beam_modes
from tests.reference.beam_elements import element_modes

HEIGHT, MASS, BENDS = 20.0, 6e3, 1e10
UNIT = sqrt(BENDS / (MASS * HEIGHT**4))


def roots(beam: Beam, count: int) -> np.ndarray:
    return np.sqrt(beam_modes(beam, count, beam.height).frequency / UNIT)


def test_exponential():
    x = np.linspace(-90.0, 90.0, 7001)
    assert exponential(x) == pytest.approx(np.exp(x), rel=1e-15)
    assert exponential([-1000.0, 0.0, 1.0]).tolist() == [0.0, 1.0, pytest.approx(exp(1.0), rel=1e-15)]


def test_a_clamped_cantilever():
    """cos l cosh l = -1, sizes of the shapes at the top 2/sqrt(m L)."""
    beam = Beam(HEIGHT, MASS, BENDS)
    found = roots(beam, 5)
    assert found[:3] == pytest.approx([1.8751040687, 4.6940911330, 7.8547574382], rel=1e-10)
    assert [cos(root) * cosh(root) for root in found] == pytest.approx([-1.0] * 5, rel=1e-7)
    modes = beam_modes(beam, 5, HEIGHT)
    assert modes.shape == pytest.approx(2.0 / sqrt(MASS * HEIGHT), rel=1e-12)
    # participation of the first: 0.783 sqrt(m L), its moment 0.569 m L of that
    assert modes.shear[0] == pytest.approx(0.7829917 * sqrt(MASS * HEIGHT), rel=1e-6)
    assert modes.moment[0] == pytest.approx(2.0 / 1.8751040687**2 * sqrt(MASS * HEIGHT) * HEIGHT, rel=1e-9)


@pytest.mark.parametrize("top", [0.0, 0.6, 20.0])
@pytest.mark.parametrize(("shift", "turn"), [(3.0, np.inf), (np.inf, 2.0), (40.0, 0.7), (0.5, 0.2), (np.inf, np.inf)])
def test_a_foot_on_springs_under_a_mass(shift, turn, top):
    """The closed characteristic equation for k = shift E I/L^3, k_r = turn E I/L, M = top m L; of top = 0

    1 + c C - r (s C - c S) - t (s C + c S) + t r (1 - c C) = 0,   t = l^3/shift, r = l/turn, s = sin l, S = sinh l, ...
    """
    beam = Beam(HEIGHT, MASS, BENDS, top * MASS * HEIGHT, shift * BENDS / HEIGHT**3, turn * BENDS / HEIGHT)
    for root in roots(beam, 5).tolist():
        c, s, C, S, t, r = cos(root), sin(root), cosh(root), sinh(root), root**3 / shift, root / turn
        light = 1.0 + c * C - r * (s * C - c * S) - t * (s * C + c * S) + t * r * (1.0 - c * C)
        heavy = (c * S - s * C) - 2.0 * r * s * S - 2.0 * t * c * C - t * r * (c * S - s * C)
        assert abs(light + root * top * heavy) < 1e-9 * C * (1.0 + t) * (1.0 + r) * (1.0 + root * top)


def test_against_elements():
    """Frequencies and shapes at any height of beams of all sorts."""
    rng = np.random.default_rng(3)
    for _ in range(12):
        height, stiffness = 10.0 ** rng.uniform(0.5, 2.0), 10.0 ** rng.uniform(8.0, 12.0)
        foot = [rng.choice([np.inf, stiffness / height**power * 10.0 ** rng.uniform(-1.0, 3.0)]) for power in (3, 1)]
        mass = 10.0 ** rng.uniform(2.0, 5.0)
        beam, place = Beam(height, mass, stiffness, mass * height * rng.uniform(0.0, 5.0), *foot), height * rng.uniform(0.3, 1.0)
        found, (frequency, shape) = beam_modes(beam, 4, place), element_modes(beam, 4, place, 30)
        assert found.frequency == pytest.approx(frequency, rel=2e-5)
        assert found.shape == pytest.approx(shape, abs=1e-5 * shape.max())


@pytest.mark.parametrize("beam", [
    Beam(HEIGHT, MASS, BENDS), Beam(HEIGHT, MASS, BENDS, 3e5, 1e8, 2e9), Beam(HEIGHT, MASS, BENDS, 0.0, 1e6),
    Beam(HEIGHT, MASS, BENDS, 1e6),
])  # fmt: skip
def test_many_modes_are_the_beam(beam):
    """Their flexibility is the beam's, their slowness the trace, and their moments add up to the lever of the load."""
    place = 15.0
    modes = beam_modes(beam, 200, place)
    assert modes.flexibility() == pytest.approx(beam.flexibility(place), rel=1e-7)
    assert (modes.frequency**-2.0).sum() * UNIT**2 == pytest.approx(beam.slowness(), rel=1e-7)
    assert (np.diff(modes.frequency) > 0.0).all() and modes.frequency[-1] == pytest.approx(UNIT * (199.0 * pi) ** 2, rel=0.01)
    assert (modes.moment * modes.shape).sum() == pytest.approx(place, rel=1e-3)


def test_a_foot_that_holds_hardly():
    with pytest.raises(ValueError, match="hardly holds"):
        beam_modes(Beam(HEIGHT, MASS, BENDS, 0.0, 1e-6 * BENDS / HEIGHT**3), 3, HEIGHT)

"""The set-up's own algebra and functions against NumPy's, and where they must be exact."""

import math

import numpy as np
import pytest

from dilatedem.numerics import plain

RANDOM = np.random.default_rng(7)
MATRICES = RANDOM.normal(size=(200, 3, 3))
VECTORS = RANDOM.normal(size=(200, 3))


def test_products_norms_and_determinants_are_those_of_numpy():
    u, v = VECTORS, MATRICES[:, 1]
    assert np.allclose(plain.dot(u, v), np.einsum("ni,ni->n", u, v), rtol=0, atol=1e-15)
    assert np.allclose(plain.norm(u), np.linalg.norm(u, axis=1), rtol=1e-15)
    assert np.allclose(plain.turned(MATRICES, u), np.einsum("nij,nj->ni", MATRICES, u), rtol=0, atol=1e-14)
    assert np.allclose(plain.determinant(MATRICES), np.linalg.det(MATRICES), rtol=0, atol=1e-13)


def test_the_inverse_of_an_inertia_times_it_is_the_unit_matrix():
    inertia = MATRICES @ np.swapaxes(MATRICES, 1, 2) + np.eye(3)
    assert np.allclose(plain.inverse(inertia) @ inertia, np.eye(3), rtol=0, atol=1e-13)


def test_angles_are_those_of_numpy_in_all_four_quarters():
    y, x = RANDOM.normal(size=(2, 20000))
    x[:1000] *= 1e-12
    y[1000:2000] *= 1e-12
    found, asked = plain.angle(y, x), np.arctan2(y, x)
    assert (np.abs(found - asked) <= 8.0 * np.spacing(np.abs(asked))).all()


@pytest.mark.parametrize("y, x", [(0.0, 1.0), (0.0, -1.0), (1.0, 0.0), (-1.0, 0.0), (0.0, 0.0), (1.0, 1.0)])
def test_angles_of_the_axes(y, x):
    assert plain.angle(y, x) == pytest.approx(math.atan2(y, x), rel=2e-16, abs=0.0)


@pytest.mark.parametrize("turns", [1.0, 100.0, 1e6])
def test_sines_and_cosines_are_those_of_numpy(turns):
    x = 2.0 * np.pi * turns * RANDOM.uniform(-1.0, 1.0, 20000)
    sine, cosine = plain.sine_cosine(x)
    assert np.abs(sine - np.sin(x)).max() <= 2.3e-16
    assert np.abs(cosine - np.cos(x)).max() <= 2.3e-16


def test_no_angle_has_no_sine_and_a_cosine_of_one():
    assert plain.sine_cosine(0.0) == (0.0, 1.0)


@pytest.mark.parametrize("degree", [2, 3, 5])
def test_the_power_of_a_root_is_the_number(degree):
    for x in [0.0, 1.0, 2.0**degree, *RANDOM.lognormal(0.0, 20.0, 200)]:
        assert plain.nth_root(float(x), degree) ** degree == pytest.approx(x, rel=1e-15 * degree)

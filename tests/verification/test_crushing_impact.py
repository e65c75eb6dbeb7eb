"""A body that hits a structure and crushes: closed forms of rigid-plastic impact, and of elasticity and crushing in series.

Crushed ice bears P(d) = C A(d)^(1+q) at a crushed depth d, A the nominal area, V(d) the volume. In the limit of stiff ice

    integral of P over 0..d = m v^2/2,    F = P(d),    T = integral of dx/v(x) over 0..d,

with A = 2 h sqrt(2 R d - d^2) of a flat side on a pile, h times the chord of two circles of a round floe, h w(d) of an edge with
the width w of the rounded wedge, pi d (2 r - d) of a sphere, and a constant push added to the energy: the weight of a floe that
falls on a horizontal brace. With an elastic law F(x), W(x) in series, which is looked up in the program as it has no linear spring,

    W(x) + integral of P = m v^2/2,    F(x) = P(d),    e^2 = W/(m v^2/2),

also of a second hit on what has crushed. Whatever the elasticity, peak = P(d) and loss = integral of P.
"""

import numpy as np
import pytest

from validation.crushing import closed_forms, collisions
from validation.crushing.references import crushed_side

STIFF = {each.name: each for each in closed_forms.RIGID}
#: plain forms of what is meant, N: where edges are sharp, to a percent
PLAIN = {"A1a": 98914.2, "A1b": 157030.8, "A1c": 220506.0, "A2": 75313.7, "A3a": 17967.5, "A3b": 23646.5, "A3c": 41371.1,
         "A4": 54544.5, "A6a": 160973.4, "A6b": 62327.3, "A8a": 99923.8, "A8b": 104172.1}  # fmt: skip


@pytest.mark.parametrize("name", PLAIN)
def test_stiff_ice_that_crushes(name):
    case = STIFF[name]
    hit = case.hit()
    expected = case.rigid(hit.mass)
    assert expected.force == pytest.approx(PLAIN[name], rel=0.015 if name == "A6b" else 0.002)
    assert hit.peak == pytest.approx(expected.force, rel=0.01)
    assert hit.depth == pytest.approx(expected.depth, rel=0.01)
    assert hit.rise == pytest.approx(expected.time, rel=0.01)
    assert hit.peak == pytest.approx(case.crushing.bears(hit.depth), rel=1e-3)
    assert hit.lost == pytest.approx(case.crushing.costs(hit.depth), rel=1e-3)
    assert abs(hit.residual) < 1e-4


def test_stiffer_ice_comes_nearer():
    case = STIFF["A1b"]
    errors = []
    for modulus in (1e9, 1e10, 1e11):
        hit = case.hit(f"ice.elastic_modulus={modulus:g}")
        errors.append(1.0 - hit.peak / case.rigid(hit.mass).force)
        assert hit.lost == pytest.approx(case.pressure * crushed_side(hit.depth, closed_forms.HEIGHT, closed_forms.PILE), rel=1e-3)
    assert errors[0] > 5.0 * errors[1] > 25.0 * errors[2] > 0.0
    assert errors[2] < 0.003


@pytest.mark.parametrize("model", ["liu2015", "consistent"])
def test_elasticity_and_crushing_in_series(model):
    for each in closed_forms.in_series(model):
        hit, expected = each.hit, each.expected
        assert hit.peak == pytest.approx(expected.force, rel=1e-3), each.what
        assert hit.depth == pytest.approx(expected.depth, rel=1e-3), each.what
        assert hit.restitution == pytest.approx(expected.restitution, rel=2e-3), each.what
        assert hit.lost == pytest.approx(expected.lost, rel=1e-3), each.what
        assert abs(hit.residual) < 1e-4, each.what


@pytest.mark.parametrize("model", ["liu2015", "consistent"])
def test_random_collisions_lose_what_the_ledger_knows(model):
    found = collisions.survey(model, range(60))
    assert (found.crushed > 0.0).sum() > 50
    assert np.abs(found.residual).max() < 1e-4
    assert (found.kept - found.gained).max() < 1.0 + 1e-6

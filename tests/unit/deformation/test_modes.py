"""Modes: kept on disk, the same every time, stress as the displacements have it."""

import numpy as np
import pytest

from dilatedem.deformation import elements as finite
from dilatedem.deformation import kept
from dilatedem.deformation.elements import Material, assembled, interpolation, shares
from dilatedem.deformation.mesh import meshed
from dilatedem.deformation.modes import STRAINS, free_modes, rigid_motions
from dilatedem.deformation.stress import corner_stress, tension, tensors, von_mises
from dilatedem.errors import CaseError
from dilatedem.geometry.polyhedron import prism

ICE = Material(1e9, 0.3, 915.0)
FLOE = prism([[-1.0, -0.8], [1.0, -0.8], [1.2, 0.7], [-0.9, 0.9]], -0.25, 0.25)


@pytest.fixture(scope="module")
def elements():
    pytest.importorskip("skfem")
    return assembled(meshed(FLOE, 0.5), ICE)


def test_rigid_motions_strain_nothing_and_weigh_the_body(elements):
    rigid = rigid_motions(elements)
    assert np.abs(elements.stiffness @ rigid).max() < 1e-7 * np.abs(elements.stiffness).max()
    assert elements.scalar_mass.sum() == pytest.approx(915.0 * meshed(FLOE, 0.5).volumes.sum())


def test_modes_are_those_of_the_matrices(elements):
    modes = free_modes(elements, 6)
    for square, shape in zip(modes.frequency**2, modes.shape, strict=True):
        force, inertia = elements.stiffness @ shape.ravel(), square * (elements.mass @ shape.ravel())
        assert np.abs(force - inertia).max() < 1e-8 * np.abs(force).max()
    assert (np.diff(modes.frequency) >= 0.0).all()


def compressed(elements, modes, pressure):
    """(n, 3) [m] what modes make, at rest, of a pressure [Pa] on the ends of a prism along z; and the exact displacement.

    The load on nodes is K u of that, u, as elements have it; what moves and turns the body as a whole is taken out.
    """
    exact = elements.nodes * [0.3, 0.3, -1.0] * (pressure / 1e9)
    load = elements.stiffness @ exact.ravel()
    coordinate = modes.shape.reshape(modes.count, -1) @ load / modes.frequency**2
    rigid = rigid_motions(elements)
    free = exact.ravel() - rigid @ (rigid.T @ (elements.mass @ exact.ravel()))
    return np.einsum("m,mni->ni", coordinate, modes.shape), free.reshape(-1, 3)


def test_uniform_strains_make_a_block_that_is_pressed_as_short_as_it_is(elements):
    plain, strained = free_modes(elements, 6), free_modes(elements, 6, strains=True)
    assert strained.count == 6 + STRAINS and (np.diff(strained.frequency) >= 0.0).all()
    found, exact = compressed(elements, strained, 1e6)
    np.testing.assert_allclose(found, exact, atol=1e-8 * np.abs(exact).max())
    without, _ = compressed(elements, plain, 1e6)
    assert np.abs(without - exact).max() > 0.5 * np.abs(exact).max(), "what bends alone is not what shortens"
    shapes = strained.shape.reshape(strained.count, -1)
    np.testing.assert_allclose(shapes @ (elements.mass @ shapes.T), np.eye(strained.count), atol=1e-9)
    assert kept.digest(FLOE, ICE, 0.5, 6, True) != kept.digest(FLOE, ICE, 0.5, 6)


def test_they_are_the_same_every_time(elements):
    one, other = free_modes(elements, 6), free_modes(assembled(meshed(FLOE, 0.5), ICE), 6)
    np.testing.assert_array_equal(one.shape, other.shape)
    few = free_modes(elements, 3)  # another search, the same modes, signs and all
    np.testing.assert_allclose(few.shape, one.shape[:3], atol=1e-7 * np.abs(one.shape).max())


def test_modes_of_one_frequency_are_told_apart_by_where_they_move():
    """Two of a square bar's modes bend it alike, one along y, one along z."""
    pytest.importorskip("skfem")
    side = np.array([[-2.0, -0.25], [2.0, -0.25], [2.0, 0.25], [-2.0, 0.25]])
    found = [free_modes(assembled(meshed(prism(side, -0.25, 0.25), 0.5), ICE), count) for count in (2, 5)]
    np.testing.assert_allclose(found[0].frequency, found[1].frequency[:2], rtol=1e-9)
    np.testing.assert_allclose(found[0].shape, found[1].shape[:2], atol=1e-5 * np.abs(found[0].shape).max())


def test_stress_of_a_linear_field_is_hookes(elements):
    slope = np.array([[1e-4, 3e-5, -2e-5], [1e-5, -2e-4, 4e-5], [6e-5, 0.0, 5e-5]])
    stress = corner_stress(elements, elements.nodes @ slope.T)
    strain, shear = 0.5 * (slope + slope.T), 1e9 / 2.6
    expected = 2.0 * shear * strain + 2.0 * shear * 0.3 / 0.4 * np.trace(strain) * np.eye(3)
    np.testing.assert_allclose(tensors(stress), np.broadcast_to(expected, (len(stress), 3, 3)), rtol=1e-8, atol=1e-2)
    deviator = expected - np.trace(expected) / 3.0 * np.eye(3)
    np.testing.assert_allclose(von_mises(stress), np.sqrt(1.5 * (deviator**2).sum()), rtol=1e-8)
    np.testing.assert_allclose(tension(stress), np.linalg.eigvalsh(expected).max(), rtol=1e-8)


def test_values_between_nodes_are_quadratic(elements):
    points = np.random.default_rng(3).uniform([-0.8, -0.7, -0.25], [0.8, 0.6, 0.25], (20, 3))
    between = interpolation(elements.nodes, elements.elements, points)

    def field(x):
        return 1.0 + x[:, 0] - 2.0 * x[:, 1] * x[:, 2] + x[:, 2] ** 2

    np.testing.assert_allclose(between @ field(elements.nodes), field(points), atol=1e-12)
    assert shares(np.array([0.25, 0.25, 0.25, 0.25])).sum() == pytest.approx(1.0)


def test_they_are_computed_once(tmp_path, monkeypatch):
    pytest.importorskip("skfem")
    first = kept.modes_of(FLOE, ICE, 0.5, 3, folder=tmp_path)
    (file,) = tmp_path.glob("*.npz")
    monkeypatch.setattr(kept, "free_modes", lambda *_: pytest.fail("computed again"))
    again = kept.modes_of(FLOE, ICE, 0.5, 3, folder=tmp_path)
    np.testing.assert_array_equal(again.shape, first.shape)
    monkeypatch.undo()
    file.write_bytes(file.read_bytes()[:1000])  # damaged
    np.testing.assert_array_equal(kept.modes_of(FLOE, ICE, 0.5, 3, folder=tmp_path).shape, first.shape)
    denser, larger = ICE._replace(density=916.0), FLOE.scaled(2.0)
    others = ((FLOE, denser, 0.5, 3), (FLOE, ICE, 0.4, 3), (FLOE, ICE, 0.5, 4), (larger, ICE, 0.5, 3))
    assert len({kept.digest(FLOE, ICE, 0.5, 3), *(kept.digest(*other) for other in others)}) == 5


def test_a_folder_that_takes_nothing_costs_time_alone(tmp_path):
    pytest.importorskip("skfem")
    (tmp_path / "file").write_text("in the way")
    assert kept.modes_of(FLOE, ICE, 0.5, 2, folder=tmp_path / "file").count == 2


def test_without_the_extra_it_says_what_to_install(monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "skfem", None)
    with pytest.raises(CaseError, match=r"need scikit-fem: pip install 'dilatedem\[deformation\]'"):
        finite.assembled(meshed(FLOE, 0.5), ICE)


def test_more_modes_than_a_mesh_has_are_refused(elements):
    with pytest.raises(ValueError, match="10000 modes were asked for"):
        free_modes(elements, 10000)

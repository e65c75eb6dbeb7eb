"""What holds for any two bodies: swapping them flips the normal, moving both changes nothing, action equals reaction, also
through the seam.
"""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from dilatedem.case.schema import Case
from dilatedem.run.simulation import Simulation
from tests.pair_in_place import PairInPlace
from tests.reference.closest_points_qp import closest_points
from tests.reference.cores import cores

CORES = cores()
RADII = {"a": 0.04, "b": 0.07}
KINDS = st.sampled_from([name for name in CORES if name != "pile"])
SEEDS = st.integers(0, 2**32 - 1)
EASY = settings(max_examples=60, deadline=None, derandomize=True)


def touching(kind_a: str, kind_b: str, seed: int, *, flat: bool) -> PairInPlace:
    """Two bodies at random, b moved along the line between the cores until the dilated bodies overlap by up to 10 mm."""
    rng = np.random.default_rng(seed)
    pair = PairInPlace(CORES[kind_a], CORES[kind_b], radii=(RADII["a"], RADII["b"]))
    turns = [
        Rotation.from_rotvec([*rng.normal(size=2) * 10.0 ** rng.uniform(-12, -1), rng.uniform(-3, 3)])
        if flat
        else Rotation.random(rng=rng)
        for _ in range(2)
    ]
    pair.place(0, rng.uniform(-5, 5, 3), turns[0])
    direction = rng.normal(size=3) * ([1.0, 1.0, 0.02] if flat else [1.0, 1.0, 1.0])
    start = pair.bodies.position[0] + 6.0 * direction / np.linalg.norm(direction)
    pair.place(1, start, turns[1])
    distance, on_a, on_b = closest_points(pair.vertices(0), pair.vertices(1))
    overlap = rng.uniform(1e-5, 0.01)
    pair.place(1, start + (on_b - on_a) * ((sum(pair.shapes.radius) - overlap) / distance - 1.0), turns[1])
    return pair


def swapped(pair: PairInPlace) -> PairInPlace:
    other = PairInPlace(*reversed(pair.cores), radii=tuple(reversed(pair.shapes.radius)))
    for body in range(2):
        other.place(body, pair.bodies.position[1 - body], pair.rotation(1 - body))
    return other


def moved(pair: PairInPlace, turn: Rotation, shift: np.ndarray) -> PairInPlace:
    other = PairInPlace(*pair.cores, radii=tuple(pair.shapes.radius))
    for body in range(2):
        other.place(body, turn.apply(pair.bodies.position[body]) + shift, turn * pair.rotation(body))
    return other


def same_patch(found, expected, turn: Rotation, shift) -> None:
    assert found.mode == expected.mode
    # the normal, and with it the edge of a patch on slightly tilted faces, is known to 3e-7 rad
    assert found.overlap == pytest.approx(expected.overlap, rel=2e-3, abs=1e-8)
    assert found.size == pytest.approx(expected.size, rel=2e-3, abs=1e-5)
    assert found.point == pytest.approx(turn.apply(expected.point) + shift, abs=2e-3)


@EASY
@given(KINDS, KINDS, SEEDS, st.booleans())
def test_swapping_the_bodies_flips_the_normal(kind_a, kind_b, seed, flat):
    pair = touching(kind_a, kind_b, seed, flat=flat)
    other = swapped(pair)
    one, two = pair.closest(), other.closest()
    assert one.distance == pytest.approx(two.distance, abs=1e-10)
    assert one.normal == pytest.approx(-two.normal, abs=2e-6)
    same_patch(other.patch(), pair.patch(), Rotation.identity(), np.zeros(3))


@EASY
@given(KINDS, KINDS, SEEDS, st.booleans())
def test_moving_both_bodies_changes_nothing(kind_a, kind_b, seed, flat):
    pair = touching(kind_a, kind_b, seed, flat=flat)
    rng = np.random.default_rng(seed + 1)
    turn, shift = Rotation.random(rng=rng), rng.uniform(-30, 30, 3)
    other = moved(pair, turn, shift)
    one, two = pair.closest(), other.closest()
    assert one.distance == pytest.approx(two.distance, abs=1e-10)
    assert turn.apply(one.normal) == pytest.approx(two.normal, abs=2e-6)
    same_patch(other.patch(), pair.patch(), turn, shift)


@EASY
@given(KINDS, KINDS, SEEDS)
def test_gap_is_that_of_the_programme(kind_a, kind_b, seed):
    pair = touching(kind_a, kind_b, seed, flat=bool(seed % 2))
    expected, _, _ = closest_points(pair.vertices(0), pair.vertices(1))
    assert pair.closest().distance == pytest.approx(expected, abs=1e-9)


#: two floes that overlap by some millimetres, the second above the first in y, tilted a little
FLOES = ([[-1.5, -1.2], [0.8, -1.5], [1.4, 0.3], [0.2, 1.6], [-1.3, 1.1]], [[-1.0, -1.0], [1.1, -0.9], [1.3, 0.8], [-0.9, 1.2]])
APART = np.array([0.2, 2.52, 0.03])


def two_floes(middle: float, turn: float) -> Simulation:
    """Floes whose contact is near y = `middle` in a domain of 20 m that is periodic along y, at rest but for spins."""
    places = [np.array([0.0, middle - 1.3, 0.0]), np.array([0.0, middle - 1.3, 0.0]) + APART]
    bodies = [
        {"outline": outline, "position": list(place), "rotation": [0.002, 0.004, angle], "angular_velocity": [0.0, 0.0, spin]}
        for outline, place, angle, spin in zip(FLOES, places, (0.0, turn), (0.5, -0.3), strict=True)
    ]
    case = {
        "domain": {"size": [20.0, 20.0], "y_boundary": "periodic"},
        "field": {"source": "bodies"},
        "water": {"enabled": False},
        "gravity": {"acceleration": 0.0},
        "body": bodies,
    }
    simulation = Simulation.of_case(Case.model_validate(case))
    simulation.evaluate()
    return simulation


@pytest.mark.parametrize("turn", [0.0, 0.05, -0.1])
def test_action_is_reaction_through_the_seam(turn):
    loads = []
    for middle in (0.0, 10.0, -10.0, 9.0, 30.0):
        simulation = two_floes(middle, turn)
        bodies = simulation.state.bodies
        simulation.advance(200)  # friction and damping have built up
        assert simulation.contacts == 1
        force, torque = bodies.contact_force[:2].copy(), bodies.contact_torque[:2].copy()
        assert np.abs(force[0]).max() > 1.0
        assert force[0] == pytest.approx(-force[1], rel=1e-14)
        # one point of application: moments about it cancel, the second floe taken where it touches
        apart = bodies.position[1] - bodies.position[0]
        apart[1] -= 20.0 * round(apart[1] / 20.0)
        assert torque.sum(axis=0) + np.cross(apart, force[1]) == pytest.approx(np.zeros(3), abs=1e-9 * np.abs(torque).max())
        loads.append(np.concatenate((force, torque)))
    for other in loads[1:]:
        assert other == pytest.approx(loads[0], rel=1e-6, abs=1e-6 * np.abs(loads[0]).max())

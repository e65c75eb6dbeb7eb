"""The spring of friction: what it keeps, where it slips, and that it never gives back more than it was given."""

import numpy as np
import pytest

from dilatedem.case.schema import Case
from dilatedem.run.simulation import Simulation
from dilatedem.state.clock import Status
from tests.kernels import carried_spring, rescaled_spring, share_of_dashpot, slid_spring

NO_LIMIT = 1e300
RNG = np.random.default_rng


def vectors(rng, count: int, size=1.0) -> np.ndarray:
    return size * rng.normal(size=(count, 3))


def test_a_carried_spring_keeps_its_length_and_lies_in_the_plane():
    for slip, normal in zip(vectors(RNG(1), 50), vectors(RNG(2), 50), strict=True):
        normal = normal / np.linalg.norm(normal)
        carried = np.array(carried_spring(tuple(slip), tuple(normal)))
        assert abs(carried @ normal) < 1e-12
        assert np.linalg.norm(carried) == pytest.approx(np.linalg.norm(slip), rel=1e-12)
        assert carried @ slip >= 0.0  # turned by no more than a right angle
    assert carried_spring((0.0, 0.0, 0.0), (0.0, 0.0, 1.0)) == (0.0, 0.0, 0.0)
    assert carried_spring((0.0, 0.0, 2.0), (0.0, 0.0, 1.0)) == (0.0, 0.0, 0.0)


def test_the_spring_slips_at_the_limit_and_keeps_its_direction():
    rng, slipped = RNG(3), 0
    for slip, sliding in zip(vectors(rng, 200, 1e-4), vectors(rng, 200, 1e-4), strict=True):
        turned, turning, stiffness, limit = (
            1e-4 * rng.normal(),
            1e-4 * rng.normal(),
            10.0 ** rng.uniform(5, 8),
            rng.uniform(0.0, 1e4),
        )
        found, wrung, way = slid_spring(tuple(slip), turned, tuple(sliding), turning, stiffness, limit)
        whole = np.append(slip + sliding, turned + turning)
        found = np.append(found, wrung)
        assert stiffness * np.linalg.norm(found) <= limit * (1.0 + 1e-12) or way == 0.0
        assert np.cross(whole[:3], found[:3]) == pytest.approx(np.zeros(3), abs=1e-16)
        if stiffness * np.linalg.norm(whole) <= limit:
            assert (way, found) == (0.0, pytest.approx(whole))
        else:
            slipped += 1
            # at the limit, the same direction in all four components, and the rest has slipped
            assert stiffness * np.linalg.norm(found) == pytest.approx(limit, rel=1e-12)
            assert found / np.linalg.norm(found) == pytest.approx(whole / np.linalg.norm(whole), abs=1e-9)
            assert way + np.linalg.norm(found) == pytest.approx(np.linalg.norm(whole), rel=1e-12)
    assert 20 < slipped < 180


def test_a_stiffer_spring_keeps_its_force_and_a_softer_one_its_elongation():
    for old, new in ((1e6, 2e6), (1e6, 1e9), (3.0, 3.0000001)):
        shrink, stretch = rescaled_spring(old, new)
        assert shrink * new == pytest.approx(old, rel=1e-12)
        # the force rises by the displacement times the mean stiffness
        assert stretch * new == pytest.approx(0.5 * (old + new), rel=1e-12)
    for old, new in ((2e6, 1e6), (1e6, 0.0), (5.0, 5.0), (0.0, 1e6)):
        assert rescaled_spring(old, new) == (1.0, 1.0)


class Spring:
    """The spring as `collide` moves it: rescaled, stretched, limited; `lost` [J]: what the bodies paid less what it holds."""

    def __init__(self, stiffness: float):
        self.stiffness, self.slip, self.turned, self.lost, self.peak = stiffness, np.zeros(3), 0.0, 0.0, 0.0

    @property
    def stretch(self) -> np.ndarray:
        return np.append(self.slip, self.turned)

    def step(self, way, turning: float, stiffness: float, limit: float = NO_LIMIT) -> float:
        """The energy lost in this step."""
        moved, before = np.append(way, turning), self.stretch
        held, force = 0.5 * self.stiffness * before @ before, self.stiffness * before
        shrink, share = rescaled_spring(self.stiffness, stiffness)
        slip, turned, _ = slid_spring(
            tuple(shrink * self.slip), shrink * self.turned, tuple(share * np.asarray(way)), share * turning, stiffness, limit
        )
        self.slip, self.turned, self.stiffness = np.array(slip), turned, stiffness
        kept = 0.5 * stiffness * self.stretch @ self.stretch
        lost = 0.5 * (force + stiffness * self.stretch) @ moved - (kept - held)
        self.lost, self.peak = self.lost + lost, max(self.peak, kept)
        return lost


def waves(rng, turn: np.ndarray) -> np.ndarray:
    """A smooth random function of period 2 pi."""
    return sum(rng.normal() * np.sin((k + 1) * turn + rng.uniform(0.0, 2 * np.pi)) for k in range(3))


@pytest.mark.parametrize("steps", [50, 200])
@pytest.mark.parametrize("friction", [NO_LIMIT, 0.3])
def test_no_cycle_of_loads_makes_energy(steps, friction):
    """The normal force (and with it the stiffness) goes up and down by factors while the tangent displacement goes round, in smooth
    random cycles of 50 steps and more, the time step's aim: not one of them, and no part from the start on, gives energy."""
    rng = RNG(5)
    for _ in range(60):
        turn = np.linspace(0.0, 6.0 * np.pi, 3 * steps + 1)
        stiffness = 1e6 * np.exp(rng.uniform(0.1, 2.0) * waves(rng, turn))
        way = np.column_stack([1e-4 * waves(rng, turn) for _ in range(2)] + [0.0 * turn, 1e-4 * waves(rng, turn)])
        spring, lost = Spring(stiffness[0]), []
        for i in range(1, len(turn)):
            step = way[i] - way[i - 1]
            limit = NO_LIMIT if friction == NO_LIMIT else friction * 1e-10 * stiffness[i] ** 2  # Hertz: F as the cube of it, or so
            spring.step(step[:3], step[3], stiffness[i], limit)
            lost.append(spring.lost)
        cycles = lost[steps - 1 :: steps]
        assert min(lost) >= -1e-9 * spring.peak
        # a cycle after the first begins and ends in the same state of the load
        assert np.diff(cycles).min() >= -1e-9 * spring.peak


def test_loading_and_unloading_one_by_one_make_no_energy():
    # any displacement while the spring hardens; a spring that softens, at any displacement that does not turn it round in the step
    rng = RNG(6)
    for _ in range(500):
        spring = Spring(10.0 ** rng.uniform(4, 7))
        spring.slip, spring.turned = np.append(rng.normal(size=2), 0.0) * 1e-4, 1e-4 * rng.normal()
        way, before = np.append(rng.normal(size=2), 0.0) * 1e-4, spring.stretch
        turning, factor = 1e-4 * rng.normal(), 10.0 ** rng.uniform(-2, 2)
        limit = rng.choice([NO_LIMIT, spring.stiffness * np.linalg.norm(before)])
        if factor < 1.0 and before @ (before + np.append(way, turning)) < 0.0:
            continue
        size = 0.5 * spring.stiffness * max(factor, 1.0) * (before @ before + way @ way + turning**2)
        assert spring.step(way, turning, factor * spring.stiffness, limit) >= -1e-12 * size


def test_a_spring_of_one_stiffness_loses_nothing():
    rng, spring = RNG(7), Spring(1e6)
    for _ in range(200):
        assert spring.step(np.append(rng.normal(size=2), 0.0) * 1e-4, 1e-4 * rng.normal(), 1e6) == pytest.approx(0.0, abs=1e-12)
    assert spring.peak > 1e-3


def test_a_spring_that_is_loaded_while_it_is_stretched_loses_energy():
    # Mindlin and Deresiewicz: new contact is not sheared yet. Not nothing, lest the tests above hold by default
    spring = Spring(1e6)
    spring.step((1e-4, 0.0, 0.0), 0.0, 1e6)
    held = 0.5 * 1e6 * 1e-8
    assert spring.step((0.0, 0.0, 0.0), 0.0, 4e6) == pytest.approx(0.75 * held, rel=1e-12)
    assert spring.step((0.0, 0.0, 0.0), 0.0, 2e6) == pytest.approx(0.5 * 0.25 * held, rel=1e-12)


def test_the_dashpot_has_the_largest_share_that_the_limit_leaves():
    rng, cut = RNG(8), 0
    for _ in range(300):
        stiffness, dashpot, limit = 10.0 ** rng.uniform(5, 8), 10.0 ** rng.uniform(2, 5), 10.0 ** rng.uniform(0, 4)
        spring = rng.normal(size=4)
        spring *= rng.choice([0.0, rng.uniform(), 1.0]) * limit / stiffness / np.linalg.norm(spring)
        rate = rng.normal(size=4) * 10.0 ** rng.uniform(-4, 0)
        share = share_of_dashpot(tuple(spring[:3]), spring[3], tuple(rate[:3]), rate[3], stiffness, dashpot, limit)
        assert 0.0 <= share <= 1.0
        force = np.linalg.norm(stiffness * spring + share * dashpot * rate)
        assert force <= limit * (1.0 + 1e-9)
        if share < 1.0:
            cut += 1
            assert force == pytest.approx(limit, rel=1e-6)
            # no larger share would do
            assert np.linalg.norm(stiffness * spring + (share + 1e-3) * dashpot * rate) > limit
    assert 50 < cut < 290


def test_the_dashpot_of_a_contact_at_rest_or_at_its_limit():
    assert share_of_dashpot((1e-4, 0.0, 0.0), 0.0, (0.0, 0.0, 0.0), 0.0, 1e6, 1e3, 100.0) == 1.0
    # at the limit and sliding on: nothing; sliding back: all of it
    assert share_of_dashpot((1e-4, 0.0, 0.0), 0.0, (0.1, 0.0, 0.0), 0.0, 1e6, 1e3, 100.0) == pytest.approx(0.0, abs=1e-12)
    assert share_of_dashpot((1e-4, 0.0, 0.0), 0.0, (-0.1, 0.0, 0.0), 0.0, 1e6, 1e3, 100.0) == 1.0
    # no friction: no dashpot either
    assert share_of_dashpot((0.0, 0.0, 0.0), 0.0, (0.1, 0.0, 0.0), 0.0, 1e6, 1e3, 0.0) == 0.0


PLANE = {"kind": "plane", "point": [0.0, 0.0, 0.0], "normal": [0.0, 0.0, 1.0]}


def on_a_plane(body: dict, **contact) -> Simulation:
    """A body of the model `consistent` above the plane z = 0, under gravity."""
    case = {
        "field": {"source": "bodies"},
        "water": {"enabled": False},
        "contact": {"model": "consistent", **contact},
        "structure": [PLANE],
        "body": [body],
    }
    simulation = Simulation.of_case(Case.model_validate(case))
    assert simulation.evaluate() == Status.DONE
    return simulation


def slab(x: float, y: float, height: float) -> list[list[float]]:
    """Corners of a box that its dilation by 0.04 m makes x by y by height on the outside [m]."""
    half = 0.5 * np.array([x, y, height]) - 0.04
    return (np.array([[i, j, k] for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)]) * half).tolist()


@pytest.mark.parametrize("sliding", [0.0, 0.5])
def test_a_patch_resists_turning_by_friction_times_its_grip(sliding):
    # a slab that spins on its face about the vertical, and slides: spring and limit are shared
    x, y, height, friction, spin = 1.4, 0.6, 0.3, 0.3, 3.0
    simulation = on_a_plane(
        {
            "vertices": slab(x, y, height), "dilated_radius": 0.04, "position": [0.0, 0.0, 0.5 * height],
            "velocity": [sliding, 0.0, 0.0], "angular_velocity": [0.0, 0.0, spin],
        },
        friction=friction, damping=0.36,
    )  # fmt: skip
    state, solids = simulation.state, simulation.model.solids
    grip = np.sqrt(((x - 0.08) ** 2 + (y - 0.08) ** 2) / 12.0)
    seen = []
    for _ in range(40):
        assert simulation.advance(20) == Status.DONE
        pairs = state.pairs
        limit = friction * pairs.normal_force[0]
        along = pairs.force[0] @ [0.0, 0.0, 1.0]
        tangential = np.linalg.norm(pairs.force[0] - [0.0, 0.0, along])
        assert pairs.grip[0] == pytest.approx(grip, rel=0.05)
        moment = abs(pairs.couple[0, 2])
        # together they stay within the limit, and sliding they use all of it
        used = np.hypot(tangential, moment / pairs.grip[0])
        assert used <= limit * (1.0 + 1e-3) + 1e-9
        seen.append((simulation.time_s, state.bodies.angular_velocity[0, 2], used / limit, moment, limit))
    times, spins, used, moments, limits = np.array(seen).T
    late = slice(20, None)
    assert used[late].min() > 0.99
    inertia = np.linalg.inv(solids.inverse_inertia[0])[2, 2]
    mean = np.polyfit(times[late], spins[late], 1)[0]
    if sliding == 0.0:
        assert mean == pytest.approx(-friction * 9.81 * solids.mass[0] * grip / inertia, rel=0.02)
    else:
        assert 0.3 < -mean / (friction * 9.81 * solids.mass[0] * grip / inertia) < 0.95
    assert np.abs(moments).max() <= limits.max() * grip * 1.05


def test_a_point_does_not_resist_turning():
    simulation = on_a_plane(
        {"vertices": [[0.0, 0.0, 0.0]], "dilated_radius": 0.2, "position": [0.0, 0.0, 0.2], "angular_velocity": [0.0, 0.0, 3.0]},
        friction=0.5, damping=0.36,
    )  # fmt: skip
    assert simulation.advance(400) == Status.DONE
    assert simulation.contacts == 1
    assert simulation.state.bodies.angular_velocity[0, 2] == pytest.approx(3.0, rel=1e-12)


BODIES = {
    "sphere": {"vertices": [[0.0, 0.0, 0.0]], "dilated_radius": 0.2},
    "capsule": {"vertices": [[-0.3, 0.0, 0.0], [0.3, 0.0, 0.0]], "dilated_radius": 0.1},
    "slab": {"vertices": slab(0.8, 0.5, 0.3), "dilated_radius": 0.04},
    "tetrahedron": {"vertices": [[0.0, 0.0, 0.0], [0.9, 0.1, 0.0], [0.2, 0.8, 0.1], [0.3, 0.2, 0.7]], "dilated_radius": 0.05},
}


@pytest.mark.parametrize("kind", BODIES)
@pytest.mark.parametrize("seed", [1, 2])
def test_friction_gives_a_bouncing_body_no_energy(kind, seed):
    """Thrown on a plane with spin and undamped, a body bounces, sticks, rolls and slips; its energy (with that of the contacts)
    only falls, and the ledger says by how much."""
    rng = RNG(seed)
    simulation = on_a_plane(
        BODIES[kind] | {
            "position": [0.0, 0.0, 1.2], "rotation": rng.normal(size=3).tolist(),
            "velocity": [*rng.normal(size=2), -3.0], "angular_velocity": (3.0 * rng.normal(size=3)).tolist(),
        },
        friction=0.4, damping=0.0,
    )  # fmt: skip
    totals, rubbed = [], []
    for _ in range(150):
        assert simulation.advance(100) == Status.DONE
        energy = simulation.energies()
        totals.append(energy["kinetic"] + energy["gravity"] + energy["elastic"])
        rubbed.append(energy["loss_friction"])
    start = totals[0]
    assert max(rubbed) > 0.01 * start
    # from any instant on; while it touches, the normal law's own error of order dt^2 comes in
    highest_later = np.maximum.accumulate(totals[::-1])[::-1]
    assert (highest_later - totals).max() < 1e-4 * start
    assert np.diff(rubbed).min() >= -1e-6 * start
    assert np.array(totals) + np.array(rubbed) == pytest.approx(np.full(len(totals), start + rubbed[0]), abs=1e-3 * start)

"""Structures that are not held, against what is known of oscillators, collisions and frames of reference.

Alone: u = v0/w_d exp(-zeta w t) sin(w_d t), w^2 = K/M, w_d = w sqrt(1 - zeta^2).
Hit by a ball (Liu 2015, Eqs. (3), (4), (12)), two degrees of freedom, integrated by SciPy:

    m x'' = -F,   M u'' + C u' + K u = F,   F = max(0, k d^(3/2) + zeta_n sqrt(2 m* k) d^(1/2) d'),   1/m* = 1/m + 1/M

without springs: as a free body of that mass. Driven at -v through floes at rest: as held in floes that move at v.
"""

from math import cos, exp, pi, sin, sqrt

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from dilatedem.case.schema import Case
from dilatedem.run.simulation import Simulation

RADIUS, BALL = 2.0, 0.5
BALL_MASS = 915.0 * 4 / 3 * pi * BALL**3
START = -(RADIUS + BALL) - 1e-4  # of the ball, just off the pile
SPEED = 0.4
MODELS = ("liu2015", "consistent")


def scene(
    support: dict, model: str = "liu2015", *, structure: dict | None = None, bodies: list | None = None, **more
) -> Simulation:
    """A pile at the origin, and a ball that flies at it along x, without water and weight."""
    ball = {"vertices": [[0.0, 0.0, 0.0]], "dilated_radius": BALL, "position": [START, 0.0, 0.0], "velocity": [SPEED, 0.0, 0.0]}
    contact = {"model": model, "friction": 0.0} | more.pop("contact", {})
    return Simulation.of_case(Case.model_validate({
        "field": {"source": "bodies"}, "water": {"enabled": False}, "gravity": {"acceleration": 0.0}, "contact": contact,
        "structure": [(structure or {"kind": "pile", "center": [0.0, 0.0], "radius": RADIUS}) | {"support": support}],
        "body": bodies or [ball], "time": {"step": 2e-5}, **more,
    }))  # fmt: skip


def total(simulation: Simulation) -> float:
    """Energy [J] that is stored, less what came in, with what went out: the same at all times."""
    e = simulation.energy
    stored = sum(e[name] for name in ("kinetic", "elastic", "structure_kinetic", "structure_elastic") if name in e)
    gone = sum(e[name] for name in ("loss_damping", "loss_friction", "loss_support") if name in e)
    return stored + gone - e["work_structure"] - e["gain_law"]


@pytest.mark.parametrize("ratio", [0.0, 0.05, 0.7])
def test_an_oscillator_alone(ratio):
    mass, stiffness, v0 = 2e5, 5e7, 0.1
    support = {"kind": "sprung", "mass": mass, "stiffness": [stiffness, 0.25 * stiffness], "damping_ratio": ratio}
    simulation = scene(support, bodies=[{"vertices": [[0.0, 0.0, 0.0]], "dilated_radius": BALL, "position": [-9.0, 0.0, 0.0]}],
                       time={"step": 1e-4})  # fmt: skip
    simulation.state.excursions.velocity[0, :2] = v0
    simulation.evaluate()
    before, largest = total(simulation), 0.0
    for _ in range(40):
        simulation.step(100)
        for axis, w in enumerate((sqrt(stiffness / mass), 0.5 * sqrt(stiffness / mass))):
            damped = w * sqrt(1.0 - ratio**2)
            expected = v0 / damped * exp(-ratio * w * simulation.time) * sin(damped * simulation.time)
            assert simulation.structures["pile"].displacement[axis] == pytest.approx(expected, abs=1e-5 * v0 / w)
        largest = max(largest, abs(total(simulation) - before))
    assert largest < 1e-6 * before
    assert ratio == 0.0 or simulation.energy["loss_support"] > 0.1 * before


def hit_by_the_ball(mass: float, stiffness: float, damping: float, ratio: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Time, force [N] and displacement [m] of the pile, by SciPy."""
    modulus = 1.0 / (0.91 / 1e9 + 0.91 / 210e9)
    k = 4 / 3 * modulus * sqrt(sqrt(BALL * BALL * RADIUS / (BALL + RADIUS)))
    c, reduced = 2.0 * ratio * sqrt(stiffness * mass), 1.0 / (1.0 / BALL_MASS + 1.0 / mass)

    def force(x, v, u, w):
        d = max(x - u - 1e-4, 0.0)
        return max(k * d**1.5 + damping * sqrt(2.0 * reduced * k) * sqrt(d) * (v - w), 0.0) if d > 0.0 else 0.0

    def rate(_, y):
        x, v, u, w = y
        f = force(x, v, u, w)
        return [v, -f / BALL_MASS, w, (f - c * w - stiffness * u) / mass]

    times = np.linspace(0.0, 0.08, 4001)
    found = solve_ivp(rate, (0.0, 0.08), [0.0, SPEED, 0.0, 0.0], t_eval=times, rtol=1e-9, atol=1e-14, max_step=1e-5).y
    return times, np.array([force(*y) for y in found.T]), found[2]


@pytest.mark.parametrize(("mass", "stiffness", "damping", "ratio"), [
    (2e3, 1e7, 0.0, 0.0), (2e3, 1e7, 0.36, 0.05), (300.0, 5e6, 0.36, 0.0), (1e5, 0.0, 0.36, 0.0),
])  # fmt: skip
def test_a_ball_that_hits_a_sprung_pile(mass, stiffness, damping, ratio):
    support = {"kind": "sprung", "mass": mass, "stiffness": [stiffness, stiffness], "damping_ratio": ratio}
    simulation = scene(support, contact={"damping": damping})
    times, force, shift = hit_by_the_ball(mass, stiffness, damping, ratio)
    simulation.evaluate()
    before, load, displacement = total(simulation), [0.0], [0.0]
    for _ in times[1:]:
        simulation.step(1)
        load.append(simulation.structures["pile"].load[0])
        displacement.append(simulation.structures["pile"].displacement[0])
    assert max(load) == pytest.approx(force.max(), rel=5e-3)
    assert np.array(load) == pytest.approx(force, abs=5e-3 * force.max())
    assert np.array(displacement) == pytest.approx(shift, abs=5e-3 * np.abs(shift).max())
    assert abs(total(simulation) - before) < 1e-5 * before


@pytest.mark.parametrize("model", MODELS)
def test_without_springs_it_is_a_free_body_of_its_mass(model):
    mass, half = 400.0, 3.0
    simulation = scene({"kind": "sprung", "mass": mass, "stiffness": [0.0, 0.0]}, model)
    volume = pi * RADIUS**2 * 2.0 * half + 4 / 3 * pi * RADIUS**3
    ball = {"vertices": [[0.0, 0.0, 0.0]], "dilated_radius": BALL, "position": [START, 0.0, 0.0], "velocity": [SPEED, 0.0, 0.0]}
    free = {"vertices": [[0.0, 0.0, -half], [0.0, 0.0, half]], "dilated_radius": RADIUS, "density": mass / volume,
            "elastic_modulus": 210e9}  # fmt: skip
    other = scene({"kind": "held"}, model, structure={"kind": "pile", "center": [50.0, 0.0]}, bodies=[ball, free])
    for each in (simulation, other):
        each.strides = False  # which a body on a support does not take
        each.step(3000)
    assert simulation.floes.velocity[0, 0] < 0.5 * SPEED, "it has hit"
    assert simulation.structures["pile"].velocity[0] == pytest.approx(other.floes.velocity[1, 0], rel=1e-9)
    assert simulation.structures["pile"].displacement[0] == pytest.approx(other.floes.position[1, 0], rel=1e-9)
    momentum = BALL_MASS * simulation.floes.velocity[0, 0] + mass * simulation.structures["pile"].velocity[0]
    assert momentum == pytest.approx(BALL_MASS * SPEED, rel=1e-12)


def box(name: str = "box", **sizes) -> dict:
    return {"kind": "box", "name": name, "center": [0.0, 0.0], "bottom": -1.0, "top": 1.0} | sizes


def of_parts(*parts: dict) -> dict:
    return {"kind": "parts", "name": "box", "part": list(parts)}


WALL = box(size=[1.0, 4.0])
HALVES = of_parts(box("left", center=[0.0, 1.0], size=[1.0, 2.0]), box("right", center=[0.0, -1.0], size=[1.0, 2.0]))


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("structure", [WALL, HALVES], ids=["one", "of two parts"])
def test_one_that_turns_keeps_momentum_and_energy(model, structure):
    mass, inertia = 900.0, 1500.0
    ball = {"vertices": [[0.0, 0.0, 0.0]], "dilated_radius": BALL, "position": [-1.01, 1.2, 0.0], "velocity": [SPEED, 0.0, 0.0]}
    support = {"kind": "sprung", "mass": mass, "stiffness": [0.0, 0.0], "inertia": inertia, "stiffness_yaw": 0.0}
    simulation = scene(support, model, structure=structure, bodies=[ball], contact={"damping": 0.0})

    def of_the_whole() -> np.ndarray:
        (u, v), place = simulation.structures["box"].velocity[:2], simulation.structures["box"].displacement
        spin, ball_at, ball_v = simulation.structures["box"].velocity[2], simulation.floes.position[0], simulation.floes.velocity[0]
        turning = BALL_MASS * (ball_at[0] * ball_v[1] - ball_at[1] * ball_v[0]) + mass * (place[0] * v - place[1] * u)
        turning += inertia * spin + 0.4 * BALL_MASS * BALL**2 * simulation.floes.angular_velocity[0, 2]
        return np.array([BALL_MASS * ball_v[0] + mass * u, BALL_MASS * ball_v[1] + mass * v, turning])

    simulation.evaluate()
    before, energy = of_the_whole(), total(simulation)
    simulation.step(4000)
    spin = simulation.structures["box"].velocity[2]
    # one central blow: along n with 1/m* = 1/m + 1/M + y^2/J, e = 1
    reduced = 1.0 / (1.0 / BALL_MASS + 1.0 / mass + 1.2**2 / inertia)
    assert spin == pytest.approx(-2.0 * reduced * SPEED * 1.2 / inertia, rel=5e-3)
    assert of_the_whole() == pytest.approx(before, rel=1e-6, abs=1e-6 * abs(before[0]))
    assert total(simulation) == pytest.approx(energy, rel=1e-4)


def test_parts_go_and_turn_about_the_place_of_their_structure():
    support = {"kind": "sprung", "mass": 900.0, "stiffness": [2e4, 0.0], "inertia": 1500.0, "stiffness_yaw": 0.0}
    ball = {"vertices": [[0.0, 0.0, 0.0]], "dilated_radius": BALL, "position": [-1.01, 1.2, 0.0], "velocity": [SPEED, 0.0, 0.0]}
    simulation = scene(support, structure=HALVES, bodies=[ball])
    simulation.step(4000)
    x, y, yaw = simulation.structures["box"].displacement
    assert x > 1e-3 and yaw < -1e-3
    for body, (name, side) in enumerate((("left", 1.0), ("right", -1.0)), start=1):
        assert simulation.structures[f"box/{name}"].displacement == pytest.approx([x, y, yaw], rel=1e-15)
        expected = [x - side * sin(yaw), y + side * cos(yaw), 0.0]
        assert simulation.state.bodies.position[body] == pytest.approx(expected, abs=1e-12)


@pytest.mark.parametrize("model", MODELS)
def test_a_turning_wing_throws_a_ball(model):
    """Of infinite mass and without damping: the ball leaves at twice the speed of the place that hits it."""
    spin, arm = 0.2, 1.5
    ball = {"vertices": [[0.0, 0.0, 0.0]], "dilated_radius": BALL, "position": [-1.0005, arm, 0.0]}
    simulation = scene({"kind": "driven", "turning": spin}, model, structure=WALL, bodies=[ball], contact={"damping": 0.0})
    simulation.step(2500)
    speed = np.hypot(*simulation.floes.velocity[0, :2])
    assert speed == pytest.approx(2.0 * spin * arm, rel=0.01)
    assert simulation.energy["work_structure"] == pytest.approx(0.5 * BALL_MASS * speed**2, rel=1e-4)


@pytest.mark.parametrize("structure", [box(size=[4.0, 1.0]), of_parts(box("long", size=[4.0, 1.0]))], ids=["one", "a part"])
def test_a_load_map_goes_and_turns_with_its_structure(structure):
    """A box of 4 m by 1 m turns by a right angle, then meets a ball with its long side, 1.5 m from its middle."""
    ball = {"vertices": [[0.0, 0.0, 0.0]], "dilated_radius": BALL, "position": [-2.0, 1.5, 0.0]}
    way = [[0.0, 0.0, 0.0, 0.0], [0.5, 0.0, 0.0, pi / 2], [0.6, 0.0, 0.0, pi / 2], [2.0, -1.4, 0.0, pi / 2]]
    simulation = scene({"kind": "driven", "table": way}, structure=structure, bodies=[ball], time={"step": 1e-4})
    for _ in range(20_000):
        simulation.step(1)
        load = simulation.structures["box"].load
        assert load[5] == pytest.approx(-1.5 * load[0], rel=1e-6), "moments are about where its place is now"
    (along,), _ = np.nonzero(simulation.state.loads.impulse_map[0])
    # around the box from its own corner at +x, +y: half a metre along the side that looks to +y, and now to -x
    assert 10.0 * along / 72 <= 0.5 < 10.0 * (along + 1) / 72


@pytest.mark.parametrize("model", MODELS)
def test_driven_through_ice_at_rest_is_held_in_ice_that_moves(model):
    speed = 1.5
    common = {
        "domain": {"size": [14.0, 14.0]}, "field": {"floe_count": 50, "concentration": 0.85, "seed": 7},
        "contact": {"model": model}, "time": {"duration": 1.0, "step": 1e-4},
    }  # fmt: skip

    def pile(**support) -> list[dict]:
        return [{"kind": "pile", "center": [1.0, 0.0], "radius": 1.0, "support": support}]

    water, still, way = {"velocity": [speed, 0.0]}, {"velocity": [0.0, 0.0]}, (-speed, 0.0)
    held = Simulation.of_case(Case.model_validate(common | {"structure": pile(kind="held"), "water": water}))
    driven = Simulation.of_case(Case.model_validate(common | {"structure": pile(kind="driven", velocity=way), "water": still}))
    loads = []
    for simulation in (held, driven):
        simulation.strides = False  # which what touches a structure that moves does not take
        simulation.evaluate()
        history = []
        for _ in range(500):
            simulation.step(10)
            history.append(simulation.structures["pile"].load[:3])
        loads.append(np.array(history))
    highest = np.abs(loads[0]).max()
    assert highest > 1e4, "it was hit"
    assert loads[1] == pytest.approx(loads[0], abs=1e-6 * highest)
    apart = driven.floes.position[:, 0] + speed * driven.time - held.floes.position[:, 0]
    assert np.abs(apart).max() < 1e-8
    # and what the drive has done is what the ice has: in its frame the water has worked
    assert driven.energy["work_structure"] > 0.0
    residuals = [residual(simulation) for simulation in (held, driven)]
    assert residuals[1] < max(2.0 * residuals[0], 1e-4 * driven.energy["work_structure"])


def residual(simulation: Simulation) -> float:
    """Of the ledger [J], of a simulation that began with its own case."""
    begin = Simulation.of_case(simulation.case)
    begin.evaluate()
    change = {name: value - begin.energy[name] for name, value in simulation.energy.items()}
    stored = sum(change[name] for name in ("kinetic", "gravity", "buoyancy", "elastic"))
    spent = change["loss_damping"] + change["loss_friction"] - change["gain_law"]
    return abs(stored + spent - change["work_drag"] - change["work_structure"])

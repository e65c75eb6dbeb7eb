"""Loads where water and wind vary: waves by the tilted plane of their surface, drag by skin and form, tables of time, water taken
along; and still water, in which they are those of the paper.
"""

import csv

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from dilatedem.case.schema import Case
from dilatedem.run import loop
from dilatedem.run.simulation import Simulation
from dilatedem.state.clock import Status
from tests.reference.cores import polygon
from tests.reference.submerged_hull import submerged

OUTLINE = polygon(7, 2.6, 2)
SQUARE = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
HULL = (np.random.default_rng(7).normal(size=(14, 3)) * [1.0, 0.8, 0.5]).tolist()
BODIES = {"floe": {"outline": OUTLINE.tolist()}, "hull": {"vertices": HULL, "dilated_radius": 0.05}}
RHO, G = 1025.0, 9.81
WAVES = [
    {"amplitude": 0.3, "period": 5.0, "direction": 20.0, "phase": 30.0, "rise": 0.0},
    {"amplitude": 0.1, "period": 4.0, "direction": -70.0, "rise": 0.5},
]
NO_DRAG = {"drag_force_coefficient": 0.0, "drag_moment_coefficient": 0.0}
STILL = NO_DRAG | {"velocity": [0.0, 0.0]}


def afloat(body: dict, water: dict, *, at: float = 0.0, **more) -> Simulation:
    """A body at its place at the time `at` [s], its loads evaluated."""
    case = {"field": {"source": "bodies"}, "body": [body], "water": water, "ice": {"dilated_radius": 0.01}, **more}
    simulation = Simulation.of_case(Case.model_validate(case))
    simulation.state.clock.time[0] = at
    assert simulation.evaluate() == Status.DONE
    assert simulation.time == at
    return simulation


def water_at(x: float, y: float, time: float, current=(0.0, 0.0)):
    """Height and slopes of the surface, and by depth its velocity and acceleration, by the sums of the theory."""
    found = np.zeros(3)
    components = []
    for wave in WAVES:
        omega, heading = 2 * np.pi / wave["period"], np.radians(wave.get("direction", 0.0))
        along, k = np.array([np.cos(heading), np.sin(heading)]), omega**2 / G
        theta = k * along @ (np.array([x, y]) - np.array(current) * time) - omega * time + np.radians(wave.get("phase", 0.0))
        a = wave["amplitude"]
        found += [a * np.cos(theta), *(-a * k * along * np.sin(theta))]
        components.append((a, omega, k, along, theta))

    def moving(depth: float):
        velocity, acceleration = np.zeros(3), np.zeros(3)
        for a, omega, k, along, theta in components:
            fall = np.exp(-k * depth)
            velocity += a * omega * fall * np.array([*(along * np.cos(theta)), np.sin(theta)])
            acceleration += a * omega**2 * fall * np.array([*(along * np.sin(theta)), -np.cos(theta)])
        return velocity, acceleration

    return found, moving


@pytest.mark.parametrize("name", BODIES)
@pytest.mark.parametrize("tilt", [0.0, 0.2, 2.5])
def test_waves_press_like_accelerated_water_under_the_plane_of_their_surface(name, tilt):
    turn = Rotation.from_rotvec([0.6 * tilt, 0.8 * tilt, 0.4])
    body = BODIES[name] | {"position": [3.0, -2.0, -0.1], "rotation": turn.as_rotvec().tolist()}
    simulation = afloat(body, STILL, at=1.7, wave=WAVES)
    (level, *slope), moving = water_at(3.0, -2.0, 1.7)
    normal = np.array([-slope[0], -slope[1], 1.0]) / np.sqrt(1.0 + slope[0] ** 2 + slope[1] ** 2)
    # turned into a frame in which the surface is level
    upright = Rotation.align_vectors([[0.0, 0.0, 1.0]], [normal])[0]
    volume, centre, _ = submerged(simulation.scene.shapes[0].outer, (upright * turn).as_matrix(), (-0.1 - level) * normal[2])
    arm = turn.apply(centre)
    depth = -((-0.1 - level) * normal[2] + normal @ arm)
    press = RHO * volume * (moving(depth)[1] + [0.0, 0.0, G])
    weight = simulation.model.solids.mass[0] * G
    assert simulation.state.bodies.force[0] == pytest.approx(press - [0.0, 0.0, weight], abs=1e-8 * weight)
    assert simulation.state.bodies.torque[0] == pytest.approx(np.cross(arm, press), abs=1e-8 * weight)


def test_the_waters_own_acceleration_pushes_what_is_taken_along():
    body = {"outline": SQUARE, "position": [3.0, -2.0, -0.1]}
    alone, along = (afloat(body, STILL | {"added_mass": added}, at=1.7, wave=WAVES) for added in (False, True))
    solids = along.model.solids
    _, moving = water_at(3.0, -2.0, 1.7)
    wet = along.workspace.wet[0]
    acceleration = wet[14:17]
    assert acceleration == pytest.approx(moving(0.5 * wet[5] / along.model.hulls.plan[0, 0])[1], rel=1e-2, abs=1e-3)
    pushed = along.state.bodies.force[0] - alone.state.bodies.force[0]
    assert pushed == pytest.approx(solids.added_mass[0, [0, 0, 1]] * acceleration, rel=1e-9)
    turned = along.state.bodies.torque[0] - alone.state.bodies.torque[0]
    # how a level plane of water turns: w_y about x, -w_x about y, and the rate of that
    depth, h = 0.5 * wet[5] / along.model.hulls.plan[0, 0], 1e-5
    upwards = [
        [water_at(3.0 + sign * h * dx, -2.0 + sign * h * dy, 1.7)[1](depth)[1][2] for sign in (1.0, -1.0)]
        for dx, dy in ((1.0, 0.0), (0.0, 1.0))
    ]
    slope_x, slope_y = ((ahead - behind) / (2 * h) for ahead, behind in upwards)
    expected = solids.added_inertia[0] * np.array([slope_y, -slope_x, 0.0])
    assert turned == pytest.approx(expected, rel=1e-2, abs=1e-6 * abs(turned).max())


def test_waves_ride_on_the_current():
    """In water that moves along, steady or not, a floe that moves along bears the same."""
    body = {"outline": SQUARE, "velocity": [0.1, 0.0, 0.05]}
    at_rest = afloat(body | {"position": [3.0, -2.0, -0.1]}, {"velocity": [0.0, 0.0]}, at=8.0, wave=WAVES)
    table = [[2.0, 0.5, 0.2], [6.0, -0.3, 0.4]]
    way = 2.0 * np.array([0.5, 0.2]) + 4.0 * np.array([0.1, 0.3]) + 2.0 * np.array([-0.3, 0.4])
    moving = body | {"position": [3.0 + way[0], -2.0 + way[1], -0.1], "velocity": [0.1 - 0.3, 0.4, 0.05]}
    along = afloat(moving, {"velocity_table": table}, at=8.0, wave=WAVES)
    np.testing.assert_allclose(along.state.bodies.force[0], at_rest.state.bodies.force[0], rtol=1e-9)
    np.testing.assert_allclose(along.state.bodies.torque[0], at_rest.state.bodies.torque[0], rtol=1e-6, atol=1e-6)


def test_the_drag_of_the_paper_is_against_the_water_of_the_waves():
    """A floe that moves and turns as the water there does is not braked."""
    place = {"outline": SQUARE, "position": [3.0, -2.0, -0.1]}
    wet = afloat(place, {}, at=1.7, wave=WAVES).workspace.wet[0].copy()
    spin = [*wet[17:19], 0.0]
    there = place | {"velocity": [wet[11] + 0.3, wet[12], wet[13]], "angular_velocity": spin}
    free, braked = (afloat(there, water, at=1.7, wave=WAVES) for water in (NO_DRAG, {}))
    np.testing.assert_allclose(braked.state.bodies.force[0], free.state.bodies.force[0], atol=1e-9)
    np.testing.assert_allclose(braked.state.bodies.torque[0], free.state.bodies.torque[0], atol=1e-9)
    still = afloat(place, {}, at=1.7, wave=WAVES)
    pushed = np.linalg.norm(still.state.bodies.force[0] - afloat(place, NO_DRAG, at=1.7, wave=WAVES).state.bodies.force[0])
    assert pushed == pytest.approx(0.5 * 0.6 * RHO * wet[9] * np.sum((wet[11:14] + [0.3, 0.0, 0.0]) ** 2), rel=1e-9)


def test_waves_rise():
    """Halfway they are half as high, and do half as much."""
    place, rising, low = {"outline": SQUARE}, [WAVES[0] | {"rise": 3.4}], [WAVES[0] | {"amplitude": 0.15}]
    found, expected = (afloat(place, {}, at=1.7, wave=waves) for waves in (rising, low))
    np.testing.assert_allclose(found.workspace.wet, expected.workspace.wet, rtol=1e-12)
    assert not afloat(place, {}, at=0.0, wave=rising).workspace.wet[0, 10:].any()


def test_where_nothing_varies_loads_are_those_of_the_paper():
    body = BODIES["floe"] | {"velocity": [0.1, 0.2, -0.1], "angular_velocity": [0.1, -0.2, 0.3], "rotation": [0.05, 0.02, 0.3]}
    wind = {"wind": {"velocity": [8.0, -3.0]}}
    paper, sea = (afloat(body, {"velocity": [0.3, 0.1], **more}, **wind) for more in ({}, {"shear": [[0.0, 1.0]]}))
    for name in ("force", "torque", "power"):
        found, expected = getattr(sea.state.bodies, name)[0], getattr(paper.state.bodies, name)[0]
        np.testing.assert_allclose(found[: len(expected)], expected, rtol=1e-13, atol=1e-10)


def test_skin_and_form_act_where_they_are():
    shear = [[0.0, 1.0], [0.2, 0.9], [0.6, 0.3]]
    body = {"outline": SQUARE, "velocity": [0.1, -0.2, 0.15], "angular_velocity": [0.2, -0.1, 0.4]}
    water = {"velocity": [0.5, 0.1], "drag": "skin_form", "shear": shear}
    without = afloat(body, water | {"skin_coefficient": 0.0, "form_coefficient": 0.0})
    found = afloat(body, water)
    hulls, rows = found.model.hulls, np.array(shear).T
    area, width, bottom = hulls.plan[0, 0], hulls.plan[0, 4] / np.pi, hulls.height[0, 0]
    deep = found.workspace.wet[0, 5] / area
    places = np.linspace(0.0, deep, 100_001)
    low, mean = np.interp(deep, *rows), np.trapezoid(np.interp(places, *rows), places) / deep
    v, w, c = np.array([0.1, -0.2]), np.array(body["angular_velocity"]), np.array([0.5, 0.1])

    def braked(strength, past):
        return -0.5 * RHO * strength * np.linalg.norm(past) * np.asarray(past)

    skin, form = braked(0.004 * area, [*(v - low * c), 0.0]), braked(0.8 * width * deep, [*(v - mean * c), 0.0])
    force = skin + form + braked(0.8 * area, [0.0, 0.0, 0.15])
    radius = np.sqrt(area / np.pi)
    torque = np.cross([0.0, 0.0, bottom], skin) + np.cross([0.0, 0.0, bottom + 0.5 * deep], form)
    torque += braked(0.004 * 0.4 * np.pi * radius**5 + 0.8 * deep * width**4 / 32.0, [0.0, 0.0, w[2]])
    torque += braked(0.8 * 8 / 15 * radius**5, [w[0], w[1], 0.0])
    np.testing.assert_allclose(found.state.bodies.force[0] - without.state.bodies.force[0], force, rtol=1e-8)
    np.testing.assert_allclose(found.state.bodies.torque[0] - without.state.bodies.torque[0], torque, rtol=1e-8)
    assert found.state.bodies.power[0, 0] == pytest.approx(force @ [*v, 0.15] + torque @ w, rel=1e-8)


def test_the_wind_of_a_table_blows_over_the_surface_there_is():
    wind = {"velocity_table": [[0.0, 10.0, 0.0], [4.0, 2.0, -8.0]]}
    for time, waves in ((1.0, []), (3.0, WAVES)):
        sea = afloat({"outline": SQUARE}, STILL, at=time, wind=wind, wave=waves)
        calm = afloat({"outline": SQUARE}, STILL, at=time, wave=waves)
        air = np.array([10.0 - 2.0 * time, -2.0 * time])
        hulls, level = sea.model.hulls, water_at(0.0, 0.0, time)[0][0] if waves else 0.0
        dry = hulls.height[0, 1] - max(level - sea.state.bodies.position[0, 2], hulls.height[0, 0])
        areas = 0.002 * hulls.plan[0, 0] + 0.8 * hulls.plan[0, 4] / np.pi * dry
        force = 0.5 * 1.3 * areas * np.linalg.norm(air) * air
        np.testing.assert_allclose((sea.state.bodies.force - calm.state.bodies.force)[0, :2], force, rtol=1e-6)


def test_above_the_waves_there_is_no_water():
    simulation = afloat({"outline": SQUARE, "position": [0.0, 0.0, 3.0]}, {"drag": "skin_form", "added_mass": True}, wave=WAVES)
    assert simulation.state.bodies.force[0] == pytest.approx([0.0, 0.0, -simulation.model.solids.mass[0] * G])
    assert not simulation.state.bodies.torque[0].any()


def test_energies_have_columns_for_what_a_case_has(tmp_path):
    common = {"field": {"source": "bodies"}, "body": [{"outline": SQUARE}], "time": {"duration": 0.2}}
    columns = {}
    for name, more in {"drag": {"water": {"drag": "skin_form"}}, "all": {"water": {"added_mass": True}, "wave": WAVES}}.items():
        out = loop.run(Case.model_validate(common | more), tmp_path / name, quiet=True)
        with open(out / "energy.csv", newline="") as file:
            columns[name] = csv.DictReader(file).fieldnames
    assert not {"work_wave", "kinetic_water"} & set(columns["drag"])
    assert {"work_wave", "kinetic_water"} <= set(columns["all"])


def test_free_floes_take_short_steps_where_loads_change_fast():
    from dilatedem.water.loads import shortest_time

    def shortest(**case) -> float:
        return shortest_time(Case.model_validate(case))

    assert shortest() == 1.0
    assert shortest(wave=[{"amplitude": 0.01, "period": 0.8}, {"amplitude": 0.1, "period": 3.0}]) == pytest.approx(0.4)
    assert shortest(wind={"velocity_table": [[0.0, 1.0, 0.0], [0.3, 2.0, 0.0], [9.0, 0.0, 0.0]]}) == pytest.approx(0.3)
    assert shortest(water={"velocity_table": [[0.0, 1.0, 0.0], [0.2, 2.0, 0.0]]}) == pytest.approx(0.2)

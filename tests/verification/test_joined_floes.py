"""Floes of several convex parts move as one rigid body: parts stay together, laws of motion hold, the bay of one is open.

m = rho h A, J = rho h int r^2 dA, whatever the floe is cut into. A blow of an off-centre contact turns the whole: a floe at rest,
hit so that it takes up a momentum p at an arm b, has v = p/m and w = p b/J.
"""

import json

import numpy as np
import pytest
import shapely

from dilatedem.case.load import case_from
from dilatedem.run.simulation import Simulation
from dilatedem.state.ledger import STORED, TERMS

BAY = shapely.Polygon([(0, 0), (6, 0), (6, 6), (4, 6), (4, 2), (2, 2), (2, 6), (0, 6)])


def simulation_of(tmp_path, areas, velocities, *, water=False, gravity=0.0, structures=(), threads=1, **overrides) -> Simulation:
    features = [
        {"type": "Feature", "properties": {"velocity": velocity}, "geometry": json.loads(shapely.to_geojson(area))}
        for area, velocity in zip(areas, velocities, strict=True)
    ]
    (tmp_path / "floes.geojson").write_text(json.dumps({"type": "FeatureCollection", "features": features}))
    case = {
        "domain": {"size": [80.0, 80.0]},
        "field": {"source": "file", "file": str(tmp_path / "floes.geojson"), "tolerance": 0.0},
        "water": {"enabled": water, "velocity": [0.0, 0.0]}, "gravity": {"acceleration": gravity},
        "contact": {"friction": 0.0, "damping": 0.0}, "structure": list(structures),
    }  # fmt: skip
    return Simulation.of_case(case_from(case, overrides), threads=threads)


def balance(simulation) -> float:
    """Energy there is and energy lost, less what loads and laws made [J]: stays as it is."""
    now = simulation.energies()
    return sum((1.0 if term.sign == STORED else -term.sign) * now[term.name] for term in TERMS if term.name in now)


def parts_move_as_one(simulation, first, last):
    bodies = simulation.state.bodies
    for rows in (bodies.position, bodies.orientation, bodies.velocity, bodies.angular_momentum, bodies.force):
        assert (rows[first:last] == rows[first]).all()


def test_a_hit_floe_takes_up_momentum_and_spin_of_the_whole(tmp_path):
    ball = shapely.box(-3.0, 4.5, -0.5, 5.5)  # hits the left arm, above the centroid
    simulation = simulation_of(tmp_path, [BAY, ball], [[0.0, 0.0], [0.5, 0.0]], **{"time.step_fraction": 0.02})
    bodies, solids, (first, last) = simulation.state.bodies, simulation.model.solids, simulation.model.joined[0]
    simulation.run(until=0.01)
    before = balance(simulation)
    simulation.run(until=3.0)
    parts_move_as_one(simulation, first, last)
    hit, mass = last, 1.0 / solids.inverse_mass[first]
    v, w = bodies.velocity[first], bodies.angular_velocity[first]
    p = solids.mass[hit] * (np.array([0.5, 0.0, 0.0]) - bodies.velocity[hit])
    assert p[0] > 0.1 * solids.mass[hit] and simulation.contacts == 0
    assert v == pytest.approx(p / mass, abs=1e-9 * v[0])
    # moment of momentum about the origin of all, which starts with the ball alone: nothing is lost
    begun = solids.mass[hit] * -0.5 * 5.0
    place, moving = bodies.position, bodies.velocity
    now = sum(m * (place[i, 0] * moving[i, 1] - place[i, 1] * moving[i, 0]) for i, m in ((first, mass), (hit, solids.mass[hit])))
    assert now + bodies.angular_momentum[first, 2] + bodies.angular_momentum[hit, 2] == pytest.approx(begun, rel=1e-9)
    assert bodies.angular_momentum[first, 2] == pytest.approx(solids.inertia[first, 2, 2] * w[2], rel=1e-9) and w[2] < 0.0
    kinetic = 0.5 * (mass * v @ v + solids.inertia[first, 2, 2] * w[2] ** 2)
    kinetic += 0.5 * (solids.mass[hit] * moving[hit] @ moving[hit] + bodies.angular_momentum[hit] @ bodies.angular_velocity[hit])
    assert simulation.energies()["kinetic"] == pytest.approx(kinetic, rel=1e-9)
    assert balance(simulation) == pytest.approx(before, rel=1e-4)


def test_a_floe_drifts_into_the_bay_of_another(tmp_path):
    block = shapely.box(2.5, 6.5, 3.5, 7.5)
    simulation = simulation_of(tmp_path, [BAY, block], [[0.0, 0.0], [0.0, -1.0]])
    bodies, last = simulation.state.bodies, int(simulation.model.joined[0, 1])
    simulation.run(until=4.0)
    assert simulation.contacts == 0 and bodies.velocity[last, 1] == pytest.approx(-1.0)  # in the bay, and nothing touched yet
    assert bodies.position[last, 1] == pytest.approx(3.0)
    simulation.run(until=6.0)
    assert bodies.velocity[last, 1] > -0.9  # the bottom of the bay threw it back
    assert bodies.velocity[0, 1] < 0.0
    parts_move_as_one(simulation, 0, last)


def test_a_floe_of_parts_floats_level_and_at_rest(tmp_path):
    simulation = simulation_of(tmp_path, [BAY], [[0.0, 0.0]], water=True, gravity=9.81)
    bodies, before = simulation.state.bodies, simulation.state.bodies.position.copy()
    weight = 9.81 / simulation.model.solids.inverse_mass[0]
    assert np.abs(bodies.force[0]).max() < 1e-6 * weight and np.abs(bodies.torque[0]).max() < 1e-6 * weight
    simulation.run(until=5.0)
    assert np.abs(bodies.position - before).max() < 1e-4 and np.abs(bodies.orientation[:, 1:]).max() < 1e-5


def test_threads_and_a_pile_change_nothing_of_that(tmp_path):
    pile = {"kind": "pile", "center": [9.0, 1.0], "radius": 1.0}
    states = []
    for threads in (1, 2):
        simulation = simulation_of(
            tmp_path, [BAY, shapely.box(2.5, 3.0, 3.5, 4.0)], [[0.6, 0.0], [0.0, 0.0]], water=True, gravity=9.81,
            structures=[pile], threads=threads, **{"water.velocity": [0.5, 0.1], "contact.friction": 0.2, "contact.damping": 0.3},
        )  # fmt: skip
        simulation.run(until=0.01)
        before = balance(simulation)
        simulation.run(until=6.0)
        parts_move_as_one(simulation, 0, int(simulation.model.joined[0, 1]))
        states.append(np.concatenate([rows.ravel() for rows in simulation.state.bodies]))
        lost = simulation.energies()["loss_damping"]
        assert lost > 0.0 and abs(balance(simulation) - before) < 1e-3 * lost
    assert np.array_equal(*states)

"""Bodies that go: who stays keeps its number, its motion, its contacts and their memory, and the ledger closes."""

from pathlib import Path

import numpy as np
import pytest

from dilatedem.case.load import load
from dilatedem.events.repack import joined, of_rows, without
from dilatedem.run.simulation import Simulation
from dilatedem.state.bodies import Bodies
from dilatedem.state.clock import Status
from dilatedem.state.pairs import in_use

CROWDED = Path(__file__).parents[2] / "cases" / "crowded.toml"


def in_contact() -> Simulation:
    """Floes of which several touch each other and the pile."""
    simulation = Simulation.of_case(load(CROWDED))
    while simulation.contacts < 4:
        assert simulation.advance(200) == Status.DONE
    simulation.evaluate()  # a spring that slides holds as much as the force of now, after a step as that of the velocity foreseen
    return simulation


def partners(simulation: Simulation) -> dict[tuple[int, int], tuple]:
    """By the ids of an open contact's bodies (structures: -1): mode, overlap, slip, and where its closest corners lie."""
    pairs, ids, vertex = simulation.state.pairs, simulation.state.ids.body, simulation.model.shapes.vertex
    found = {}
    for k in np.flatnonzero(pairs.overlap[: pairs.count[0]] > 0.0):
        a, b, used = pairs.a[k], pairs.b[k], pairs.corners[k]
        corners = vertex[pairs.corner_a[k, :used]], vertex[pairs.corner_b[k, :used]]
        name = (int(ids[a]), int(ids[b]) if b < len(ids) else -1)
        found[name] = (pairs.mode[k], pairs.overlap[k], pairs.slip[k].copy(), *corners)
    return found


def test_who_stays_keeps_number_motion_and_contacts():
    simulation = in_contact()
    touching = partners(simulation)
    gone = np.zeros(simulation.model.floating, np.bool_)
    gone[[0, 7]] = True
    loser, _ = next(name for name in touching if name[1] >= 0)
    gone[loser] = True
    before = {number: simulation.state.bodies.position[number].copy() for number in np.flatnonzero(~gone)}
    without(simulation, gone)
    assert list(simulation.state.ids.body) == list(before)
    np.testing.assert_array_equal(simulation.state.bodies.position[: simulation.model.floating], list(before.values()))
    stayed = {name: found for name, found in touching.items() if not gone[name[0]] and (name[1] < 0 or not gone[name[1]])}
    now = partners(simulation)
    assert now.keys() == stayed.keys() and 0 < len(now) < len(touching)
    for name, (mode, overlap, slip, *corners) in stayed.items():
        assert now[name][0] == mode and now[name][1] == pytest.approx(overlap, rel=1e-11)  # by the same corners in another order
        np.testing.assert_allclose(now[name][2], slip, rtol=1e-12, atol=1e-18)
        for found, expected in zip(now[name][3:], corners, strict=True):
            np.testing.assert_array_equal(np.sort(found, axis=0), np.sort(expected, axis=0))
    listed = in_use(simulation.state.pairs)
    assert np.all(np.diff(listed.a * 10_000 + listed.b) > 0), "the list keeps its order"
    assert simulation.advance(500) == Status.DONE


def balance(simulation: Simulation) -> float:
    """What is stored and was lost or carried out, less what came in [J]."""
    e = simulation.energies()
    stored = e["kinetic"] + e["gravity"] + e["buoyancy"] + e["elastic"] + float(simulation.state.ledger.carried_out[0])
    return stored + e["loss_damping"] + e["loss_friction"] - e["work_drag"] - e["gain_law"]


def test_what_bodies_take_with_them_is_on_the_books():
    simulation = in_contact()
    start = balance(simulation)
    kinetic, done = simulation.energies()["kinetic"], simulation.energies()["work_drag"]
    gone = np.zeros(simulation.model.floating, np.bool_)
    gone[::3] = True
    without(simulation, gone)
    assert abs(balance(simulation) - start) < 1e-9 * kinetic
    assert simulation.energies()["kinetic"] < 0.9 * kinetic
    assert abs(simulation.energies()["work_drag"] - done) < 1e-12 * abs(done)
    assert simulation.advance(2000) == Status.DONE
    assert abs(balance(simulation) - start) < 1e-4 * kinetic


def test_all_may_go():
    simulation = in_contact()
    without(simulation, np.ones(simulation.model.floating, np.bool_))
    assert simulation.model.floating == 0 and simulation.contacts == 0
    assert simulation.advance(100) == Status.DONE


def test_who_was_there_keeps_its_contacts_when_others_come_and_the_list_has_them():
    simulation, far = in_contact(), 200.0
    other = Simulation.of_case(load(CROWDED))
    touching, floating, start = partners(simulation), simulation.model.floating, balance(simulation)
    rows = np.concatenate([[2, 5, 6], np.arange(floating, len(other.model.structure_of))])
    bodies = Bodies(*(values[rows] for values in other.state.bodies))
    bodies.position[:3, 0] -= far
    brought = joined(simulation, of_rows(other.model, rows), bodies, np.array([90, 91, 95]))
    model, state = simulation.model, simulation.state
    assert model.floating == floating + 3 and list(state.ids.body[-3:]) == [90, 91, 95]
    came, there = other.state.bodies.position[[2, 5, 6]] - [far, 0.0, 0.0], state.bodies.position[floating : floating + 3]
    np.testing.assert_array_equal(there, came)
    now = partners(simulation)
    assert now.keys() == touching.keys()
    for name, (mode, overlap, slip, *corners) in touching.items():
        assert now[name][0] == mode and now[name][1] == pytest.approx(overlap, rel=1e-11)  # by the same corners in another order
        np.testing.assert_allclose(now[name][2], slip, rtol=1e-12, atol=1e-18)
        for found, expected in zip(now[name][3:], corners, strict=True):
            np.testing.assert_array_equal(np.sort(found, axis=0), np.sort(expected, axis=0))
    kinetic = 0.5 * other.model.solids.mass[[2, 5, 6]] @ (np.hypot(0.8, 0.15) ** 2 * np.ones(3))
    assert brought > kinetic and abs(balance(simulation) - start - brought) < 1e-9 * brought
    own = simulation.floes.outline[floating]
    np.testing.assert_allclose(own + [far, 0.0], other.floes.outline[2], atol=1e-9)
    assert simulation.advance(500) == Status.DONE
    assert abs(balance(simulation) - start - brought) < 1e-4 * brought


def test_bodies_that_came_and_went_leave_the_same_model():
    simulation, other = in_contact(), Simulation.of_case(load(CROWDED))
    model, floating = simulation.model, simulation.model.floating
    joined(simulation, other.model, other.state.bodies, 100 + np.arange(floating))
    without(simulation, np.arange(2 * floating) >= floating)
    for name in ("shapes", "hulls", "solids"):
        for values, expected in zip(getattr(simulation.model, name), getattr(model, name), strict=True):
            np.testing.assert_array_equal(values, expected)
            assert np.asarray(values).dtype == np.asarray(expected).dtype

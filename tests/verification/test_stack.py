"""A stack of ten blocks under gravity stands: no drift, no spin, no kinetic energy after it has settled, for 10 s.

Released where they touch, the blocks sink by their own weights (0.2 mm at the top) and lose that energy to damping. Two stacks: one
exactly aligned, where nothing but the vertical can move, and one with the blocks shifted and turned, so that weights act beside the
middle of the faces and the blocks have to lean on each other.

`liu2015` passes the first and not the second: its force on a tilted face is no gradient of an energy, so that the law itself keeps
the blocks rocking and creeping (`gain_law`). What it does is recorded. `consistent` has to stand in both: the aligned stack is
still to round-off after 2 s. The shifted one sways as a tower: its slowest mode (7.6 Hz, against some 100 Hz of one block on its
face) meets dashpots made for impacts, and its energy fades with a time constant of 1.8 s. What counts there is that it fades, that
the blocks do not wander off in the mean of a sway, and that none turns about the vertical.
"""

from math import inf

import numpy as np
import pytest

from tests.verification.comparison import MODELS, Comparison, advance_to, by_model, check, start

CASE = "stack"
STACKS = {"aligned": slice(0, 10), "shifted": slice(10, 20)}
#: s from which the stacks must have settled, and between two looks
SETTLED, LOOK = 2.0, 0.02
#: largest drift aside, of the block's 1 m; largest spin, rad/s; largest kinetic energy, of the elastic energy of a standing stack
STILL = 1e-6, 1e-6, 1e-9
#: of the shifted stack in its last 2 s: change of the mean place since the 2 s before, m; spin about the vertical, rad/s; largest
#: kinetic energy, of that in its first 2 s after settling (exp(-6/1.8) = 0.04)
FADED = 1e-6, 1e-6, 0.05


def elastic_at_rest(simulation, stack: slice) -> float:
    """Scale of the elastic energy [J] of a stack: half of weight times sinking, as they lie now."""
    mass, z = simulation.model.solids.mass[stack], simulation.state.bodies.position[stack, 2]
    level = 0.15 + 0.3 * np.arange(10)
    return float(0.5 * 9.81 * (mass * (level - z)).sum())


def compare_model(model: str) -> list[Comparison]:
    simulation = start(CASE, model=model)
    bodies, mass = simulation.state.bodies, simulation.model.solids.mass
    advance_to(simulation, SETTLED)
    place = bodies.position[:20, :2].copy()
    scale = {name: abs(elastic_at_rest(simulation, stack)) for name, stack in STACKS.items()}
    gain = simulation.energies()["gain_law"]
    times = np.arange(SETTLED + LOOK, 10.0 + 0.5 * LOOK, LOOK)
    drift, spin, kinetic, places = [], [], [], []
    for time in times:
        advance_to(simulation, time)
        drift.append(np.linalg.norm(bodies.position[:20, :2] - place, axis=1))
        spin.append(bodies.angular_velocity[:20].copy())
        energy = 0.5 * (mass[:20] * (bodies.velocity[:20] ** 2).sum(axis=1))
        kinetic.append(energy + 0.5 * (bodies.angular_momentum[:20] * bodies.angular_velocity[:20]).sum(axis=1))
        places.append(bodies.position[:20, :2].copy())
    drift, spin, kinetic, places = map(np.array, (drift, spin, kinetic, places))
    stack, rows = STACKS["aligned"], []
    rows += [
        Comparison(CASE, "aligned: drift aside in 8 s, m", 0.0, drift[:, stack].max(), STILL[0], 1.0),
        Comparison(CASE, "aligned: largest spin, rad/s", 0.0, np.linalg.norm(spin[:, stack], axis=2).max(), STILL[1], 1.0),
        Comparison(
            CASE, "aligned: largest kinetic energy, J", 0.0, kinetic[:, stack].sum(axis=1).max(), STILL[2], scale["aligned"]
        ),
    ]
    stack, allowed = STACKS["shifted"], [inf] * 3 if model == "liu2015" else FADED
    first, before, last = times <= 4.0, (times > 6.0) & (times <= 8.0), times > 8.0
    wander = np.linalg.norm(places[last].mean(axis=0) - places[before].mean(axis=0), axis=1)[stack].max()
    sway = kinetic[:, stack].sum(axis=1)
    rows += [
        Comparison(CASE, "shifted: mean place, from 6-8 s to 8-10 s, m", 0.0, wander, allowed[0], 1.0),
        Comparison(
            CASE, "shifted: spin about the vertical, 8-10 s, rad/s", 0.0, np.abs(spin[last][:, stack, 2]).max(), allowed[1], 1.0
        ),
        Comparison(CASE, "shifted: kinetic energy, 8-10 s over 2-4 s", 0.0, sway[last].max() / sway[first].max(), allowed[2], 1.0),
    ]
    gain = simulation.energies()["gain_law"] - gain
    allowed = inf if model == "liu2015" else STILL[2]
    return rows + [Comparison(CASE, "both: energy made by the law in 8 s, J", 0.0, gain, allowed, scale["aligned"])]


def compare() -> list[Comparison]:
    return by_model(compare_model)


@pytest.mark.parametrize("model", MODELS)
def test_stack_stands(model):
    check(compare_model(model))

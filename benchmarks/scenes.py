"""The scenes, as Simulations. Three are fixed, of 200 floes each, or a rectangle of copies of them:

drift   196 floes at 63 % concentration drift at 0.3 m/s past a pile
jam     the same field, shoved on until its front stands at the pile
packed  195 floes at 97 %, nearly all face on face, the 52 at the border held fast; no current

Two the program makes itself, as it makes those of a user:

field    floes of any number in the order in which `generate` numbers them, brought together until they touch face on face
rocking  189 floes that a current presses between walls against a pile; some twenty rock on each other
"""

import json
from dataclasses import replace
from math import sqrt
from pathlib import Path

import numpy as np

from benchmarks.tiling import (
    repeated_bodies,
    repeated_charts,
    repeated_hulls,
    repeated_shapes,
    repeated_solids,
    repeated_structures,
    repeated_wholes,
)
from dilatedem.case.schema import Case
from dilatedem.geometry.outline import centroid
from dilatedem.run.simulation import PAIRS_PER_BODY, Simulation, State
from dilatedem.state.bodies import Bodies, Ids
from dilatedem.state.clock import Status, clock_at_start
from dilatedem.state.hits import no_hits
from dilatedem.state.ledger import empty_ledger
from dilatedem.state.loads import empty_loads
from dilatedem.state.pairs import empty_pairs
from dilatedem.state.records import records_of
from dilatedem.state.supports import all_held, excursions_at_start

SCENES = ("drift", "jam", "packed")
MADE = ("field", "rocking")
ALL = (*SCENES, *MADE)
MODELS = ("liu2015", "consistent")
FOLDER = Path(__file__).parent / "scenes"

#: time step, s: the one at which the other codes' published figures were taken
STEP = 1e-4
#: steps until a scene has settled
SETTLING = 2000
#: velocity of the water, m/s, where floes drift; those of `packed` stand in still water
CURRENT = {"drift": 0.3, "jam": 0.3, "packed": 0.0}
#: of `field`: mean floe [m], concentration as it is generated, and how much nearer floes come than to touch, as a share
FLOE, CONCENTRATION, CLOSER = 2.8, 0.9, 3e-6
#: of `rocking`: time that it takes to press the floes together, s
PRESSING = 11.0
#: floe-steps in which a generated field settles at most
LONGEST_SETTLING = 20_000_000
#: how far a scene may reach beyond its own square and still stand edge to edge with its copy, m (the border of `packed`, held fast)
SLACK = 0.01


def scene_case(name: str, model: str = "liu2015") -> Case:
    """The case of a fixed scene: explicit floes at their floating height, a steel pile, water, friction, open boundaries."""
    drawn = json.loads((FOLDER / f"{name}200.json").read_text(encoding="utf-8"))
    middle = 0.5 * drawn["domain_m"]
    pile = drawn["pile"]
    return Case.model_validate({
        "title": f"benchmark scene {name}",
        "domain": {"size": [drawn["domain_m"]] * 2, "x_boundary": "open", "y_boundary": "open"},
        "field": {"source": "bodies"},
        "ice": {
            "density": 915.0, "thickness": drawn["thickness_m"], "dilated_radius": drawn["dilated_radius_m"],
            "elastic_modulus": 1e9, "poisson_ratio": 0.3,
        },
        "water": {"velocity": [CURRENT[name], 0.0]},
        "structure": [{
            "kind": "pile", "name": "pile", "center": [pile["center_m"][0] - middle, pile["center_m"][1] - middle],
            "radius": pile["radius_m"], "elastic_modulus": 210e9, "poisson_ratio": 0.3,
        }],
        "contact": {"model": model, "damping": 0.36, "friction": 0.1, "stiffness_ratio": 0.7},
        "time": {"step": STEP},
        "body": [
            {
                "outline": [[x - middle, y - middle] for x, y in floe["outline"]], "fixed": floe["fixed"],
                "velocity": [0.0, 0.0, 0.0] if floe["fixed"] else drawn["velocity_m_s"],
            }
            for floe in drawn["floes"]
        ],
    })  # fmt: skip


def scene_simulation(name: str, model: str = "liu2015", *, threads: int = 1) -> Simulation:
    """A fixed scene at t = 0, its loads not evaluated yet."""
    return Simulation.of_case(scene_case(name, model), threads=threads)


def tiles_for(floes: int, per_tile: int) -> tuple[int, int]:
    """Copies along x and y: the rectangle, square or nearly so, whose floes come closest to the number asked for."""
    wanted = max(1, round(floes / per_tile))
    across = max(1, round(sqrt(wanted)))
    return max(1, round(wanted / across)), across


def pitch_of(tile: Simulation) -> np.ndarray:
    """Distance of neighbouring copies along x and y [m]: the scene's own size, or the length of its ice where that is longer."""
    corners = tile.scene.outlines.points
    extent = corners.max(axis=0) - corners.min(axis=0)
    size = np.array(tile.case.domain.size)
    return np.where(extent > size + SLACK, np.ceil(extent), size)


def tiled(tile: Simulation, along_x: int, along_y: int, *, threads: int = 1) -> Simulation:
    """Copies of a scene as it stands side by side, each with its own pile; a copy's floes stand together in the arrays.

    So the work per floe is that of the scene itself, and what is left of a difference is memory and search.
    """
    copies, floating = along_x * along_y, tile.model.floating
    steps = np.indices((along_x, along_y)).reshape(2, -1).T * pitch_of(tile)
    moves = np.column_stack([steps - steps.mean(axis=0), np.zeros(copies)])
    model = tile.model._replace(
        floating=copies * floating,
        shapes=repeated_shapes(tile.model.shapes, floating, copies),
        hulls=repeated_hulls(tile.model.hulls, copies),
        solids=repeated_solids(tile.model.solids, floating, copies),
        structure_of=repeated_structures(tile.model.structure_of, floating, copies),
        whole_of=repeated_wholes(tile.model.whole_of, copies),
        charts=repeated_charts(tile.model.charts, moves),
        records=records_of([
            tuple(member + copy * len(tile.scene.structures) for member in record.members)
            for copy in range(copies) for record in tile.scene.records[: len(tile.scene.structures)]
        ]),
        supports=all_held(np.concatenate([tile.model.supports.place + move for move in moves])),
    )
    bodies: Bodies = repeated_bodies(tile.state.bodies, floating, moves)
    loads = empty_loads(len(model.charts.center), int(model.charts.map.max(initial=-1)) + 1)
    pairs = empty_pairs(PAIRS_PER_BODY * len(bodies.path) + 64)
    ledger = empty_ledger(len(tile.state.ledger.departed_work))
    excursions = excursions_at_start(model.charts.center, np.zeros(model.charts.center.shape))
    state = State(Ids(np.arange(model.floating)), bodies, pairs, ledger, loads, no_hits(0), clock_at_start(), excursions)
    return replace(tile, model=model, state=state, threads=threads)


def settled(name: str, model: str) -> Simulation:
    """A fixed scene after the unrest of its first fifth of a second: the overlaps that it was drawn with have given way."""
    return _settled(scene_simulation(name, model), SETTLING, name)


def _settled(simulation: Simulation, steps: int, name: str) -> Simulation:
    simulation.evaluate()
    status = simulation.advance(steps)
    if status != Status.DONE:
        raise RuntimeError(f"scene {name} stopped: {status.name}")
    return simulation


def packed_field(floes: int, model: str, *, threads: int = 1) -> Simulation:
    """A packed field as `generate` makes it, settled: cells shrunk about their centroids, which are brought as much nearer;
    those at the border are held fast.

    Floes side by side have nothing but space in common with their numbers, as in any field of a user.
    """
    side = sqrt(floes * FLOE**2 / CONCENTRATION)
    simulation = Simulation.from_case({
        "domain": {"size": [side, side], "x_boundary": "open", "y_boundary": "open"},
        "field": {"floe_count": floes, "concentration": CONCENTRATION, "seed": 1},
        "ice": {"dilated_radius": 0.04, "elastic_modulus": 1e9},
        "contact": {"model": model, "damping": 0.36, "friction": 0.1, "stiffness_ratio": 0.7},
        "time": {"step": STEP},
    }, threads=threads)  # fmt: skip
    field, place, solids = simulation.scene.field, simulation.state.bodies.position, simulation.model.solids
    held = np.flatnonzero((np.abs(place[:floes, :2]) > 0.5 * side - FLOE).any(axis=1))
    solids.inverse_mass[held], solids.inverse_inertia[held] = 0.0, 0.0
    for row, outline in enumerate(field.outlines):
        place[row, :2] += (field.factor * (1.0 - CLOSER) - 1.0) * centroid(outline)
    return _settled(simulation, max(200, min(SETTLING, LONGEST_SETTLING // floes)), "field")


def rocking(model: str, *, threads: int = 1) -> Simulation:
    """Floes that rock between walls before a pile."""
    simulation = Simulation.from_case({
        "domain": {"size": [30.0, 20.0], "x_boundary": "open", "y_boundary": "wall"},
        "field": {"floe_count": 190, "concentration": 0.8, "seed": 3},
        "ice": {"dilated_radius": 0.04, "elastic_modulus": 1e9, "initial_velocity": "current"},
        "water": {"velocity": [0.3, 0.0]},
        "structure": [{"kind": "pile", "name": "pile", "center": [5.0, 0.0], "radius": 2.0, "elastic_modulus": 210e9}],
        "contact": {"model": model, "damping": 0.36, "friction": 0.1, "stiffness_ratio": 0.7},
        "time": {"step": STEP},
    }, threads=threads)  # fmt: skip
    return _settled(simulation, round(PRESSING / STEP), "rocking")


def sized(tile: Simulation, floes: int, *, threads: int = 1) -> Simulation:
    """About so many floes in copies of a settled scene, their loads evaluated; friction springs start anew."""
    along_x, along_y = tiles_for(floes, tile.model.floating)
    simulation = tiled(tile, along_x, along_y, threads=threads)
    simulation.evaluate()
    return simulation

"""Whether bodies that are to come would stand in others: in plan, with their dilations, across periodic sides, too."""

import numpy as np
import shapely

from dilatedem.geometry.packing import entries
from dilatedem.geometry.shapes import Shapes
from dilatedem.numerics.frames import matrix_from_quaternion
from dilatedem.numerics.plain import turned
from dilatedem.state.bodies import Bodies
from dilatedem.state.model import Model


def is_clear(simulation, model: Model, bodies: Bodies) -> bool:
    """Whether the floating bodies of another model touch none of a simulation's, and no structure that moves."""
    own, there = simulation.model, simulation.state.bodies
    floating = np.arange(model.floating)
    coming = _cores(model.shapes, bodies, floating)
    tree, reach = shapely.STRtree(coming), float(model.shapes.radius[floating].max(initial=0.0))
    around = shapely.total_bounds(coming)
    period = np.array([own.surroundings.period_x, own.surroundings.period_y])
    for step in (-1, 0, 1) if period.any() else (0,):
        place = there.position[:, :2] + period * (step - np.round(there.position[:, :2] / np.where(period > 0.0, period, 1.0)))
        most = own.shapes.plan_reach + reach
        near = ((place + most[:, None] > around[:2]) & (place - most[:, None] < around[2:])).all(axis=1)
        rows = np.flatnonzero(near[: own.floating])
        moved = there._replace(position=np.column_stack([place, there.position[:, 2]]))
        parts = np.flatnonzero(near & own.solids.carried)
        others = np.concatenate([_cores(own.shapes, moved, rows), shapely.points(place[parts])])
        within = np.concatenate([own.shapes.radius[rows], own.shapes.plan_reach[parts]])
        if len(tree.query(others, predicate="dwithin", distance=within + reach)[0]):
            return False
    return True


def _cores(shapes: Shapes, bodies: Bodies, rows: np.ndarray) -> np.ndarray:
    """The cores of some bodies as polygons in plan."""
    vertices, start = entries(shapes.vertex_start, rows)
    owner = np.repeat(np.arange(len(rows)), np.diff(start))
    turns, place = matrix_from_quaternion(bodies.orientation[rows]), bodies.position[rows]
    corners = turned(turns[owner], shapes.vertex[vertices]) + place[owner]
    return shapely.convex_hull(shapely.multipoints(corners[:, :2], indices=owner)) if len(rows) else np.zeros(0, object)

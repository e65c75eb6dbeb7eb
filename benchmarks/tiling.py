"""Packed arrays of one scene, repeated: all floes of the first copy, of the second ..., then all piles.

Building a floe's shape takes a millisecond, and a hundred thousand of them two minutes; copying takes none.
"""

import numpy as np

from dilatedem.geometry.packing import selected
from dilatedem.geometry.shapes import Hulls, Shapes
from dilatedem.state.bodies import Bodies, Solids
from dilatedem.state.charts import Charts


def _repeat(array: np.ndarray, first: int, copies: int) -> np.ndarray:
    """The rows before `first` (of floes) so many times, then the rest (of structures) as many times."""
    return np.concatenate([*[array[:first]] * copies, *[array[first:]] * copies])


def repeated_shapes(shapes: Shapes, floating: int, copies: int) -> Shapes:
    """Cores of `copies` scenes of `floating` floes each."""
    return selected(shapes, _repeat(np.arange(len(shapes.radius)), floating, copies))


def repeated_hulls(hulls: Hulls, copies: int) -> Hulls:
    """Outer polyhedra of `copies` scenes."""
    return selected(hulls, np.tile(np.arange(len(hulls.prism)), copies))


def repeated_solids(solids: Solids, floating: int, copies: int) -> Solids:
    """Masses of `copies` scenes of `floating` floes each."""
    return type(solids)(*(_repeat(array, floating, copies) for array in solids))


def repeated_bodies(bodies: Bodies, floating: int, moves: np.ndarray) -> Bodies:
    """Bodies of one scene per row of moves (n, 3) [m], shifted by it."""
    copies, structures = len(moves), len(bodies.path) - floating
    repeated = Bodies(*(_repeat(array, floating, copies) for array in bodies))
    shifts = np.concatenate([np.repeat(moves, floating, axis=0), np.repeat(moves, structures, axis=0)])
    repeated.position[:] += shifts
    return repeated


def repeated_structures(structure_of: np.ndarray, floating: int, copies: int) -> np.ndarray:
    """The structure that each body of `copies` scenes belongs to."""
    count = int(structure_of.max(initial=-1)) + 1
    turns = np.arange(copies)[:, None] * count
    parts = [np.where(own >= 0, own + turns, -1).ravel() for own in (structure_of[:floating], structure_of[floating:])]
    return np.concatenate(parts).astype(structure_of.dtype)


def repeated_wholes(whole_of: np.ndarray, copies: int) -> np.ndarray:
    """The structure that each structure of `copies` scenes is a part of."""
    return np.concatenate([np.where(whole_of >= 0, whole_of + copy * len(whole_of), -1) for copy in range(copies)])


def repeated_charts(charts: Charts, moves: np.ndarray) -> Charts:
    """Charts of one scene per row of moves (n, 3) [m], shifted by it."""
    copies, structures = len(moves), len(charts.center)
    corners = np.diff(charts.outline_start)
    repeated = {name: np.concatenate([array] * copies) for name, array in charts._asdict().items() if name != "outline_start"}
    for name in ("center", "origin"):
        repeated[name] = repeated[name] + np.repeat(moves, structures, axis=0)
    mapped = repeated["map"] >= 0
    repeated["map"] = np.where(mapped, np.cumsum(mapped) - 1, -1)
    return Charts(**repeated, outline_start=np.concatenate([[0], np.cumsum(np.tile(corners, copies))]).astype(np.int64))

"""Floes for a tank: square and irregular ones of one size, shaken as hard bodies until they lie at random."""

from pathlib import Path

import numpy as np
import shapely
from scipy.spatial import cKDTree

from dilatedem.field.laguerre import cells_of_weights, nuclei_of_areas
from dilatedem.field.lattice import squares
from dilatedem.files.atomic import write_text

SHAPES = ("square", "irregular")
#: rounds in which every floe is tried to be moved once, by so much of its size at most and turned by so much [rad]
ROUNDS, SHIFT, TURN = 200, 0.15, 0.15
WALLS = (False, False)


def drawn(shape: str, size: tuple[float, float], floe: float, concentration: float, seed: int) -> list[np.ndarray]:
    """Outlines (k, 2) [m] of floes of about `floe` [m], the root of their area, that cover `concentration` of a tank of `size` [m].

    There are as many as a lattice of squares has, all of one area, whatever their shape: fields of two shapes differ in it alone.
    """
    generator, size = np.random.default_rng(seed), np.asarray(size, float)
    middles = (squares(size, round(concentration * float(np.prod(size)) / floe**2), WALLS) - 0.5) * size
    area = float(np.prod(size)) / len(middles)
    if shape == "square":
        corners = 0.5 * np.sqrt(concentration * area) * np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
        floes = [middle + corners for middle in middles]
    else:
        points = (generator.random((len(middles), 2)) - 0.5) * size
        cells = cells_of_weights(*nuclei_of_areas(points, np.full(len(points), area), size, WALLS, 0), size, WALLS)
        floes = [shrunk(cell, concentration) for cell in cells]
    return shaken(floes, size, generator)


def shrunk(cell: np.ndarray, share: float) -> np.ndarray:
    """A cell (k, 2) shrunk about its centroid to a share of its area."""
    middle = shapely.get_coordinates(shapely.Polygon(cell).centroid)
    return middle + np.sqrt(share) * (cell - middle)


def shaken(floes: list[np.ndarray], size: np.ndarray, generator: np.random.Generator) -> list[np.ndarray]:
    """Floes as hard bodies that have moved and turned at random in a tank: a step of Metropolis et al. (1953) each and round."""
    ice, tank = shapely.polygons([shapely.linearrings(floe) for floe in floes]), shapely.box(*(-0.5 * size), *(0.5 * size))
    floe = float(np.sqrt(shapely.area(ice).mean()))
    across = 2.0 * max(float(np.linalg.norm(each - each.mean(axis=0), axis=1).max()) for each in floes)
    for _ in range(ROUNDS):
        middles = shapely.get_coordinates(shapely.centroid(ice))
        near = cKDTree(middles).query_ball_point(middles, across + 2.0 * SHIFT * floe)
        for i in generator.permutation(len(ice)):
            shift, turn = SHIFT * floe * generator.uniform(-1.0, 1.0, 2), TURN * generator.uniform(-1.0, 1.0)
            moved = _moved(ice[i], shift, turn)
            others = ice[[k for k in near[i] if k != i]]
            if tank.covers(moved) and not shapely.intersects(moved, others).any():
                ice[i] = moved
    return [shapely.get_coordinates(each)[:-1] for each in ice]


def _moved(floe: shapely.Polygon, shift: np.ndarray, turn: float) -> shapely.Polygon:
    corners = shapely.get_coordinates(floe)
    middle = shapely.get_coordinates(floe.centroid)
    rotation = np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])
    return shapely.Polygon((corners - middle) @ rotation + middle + shift)


def written(folder: Path, shape: str, size: tuple[float, float], floe: float, concentration: float, seed: int) -> Path:
    """The WKT file of a field, drawn where it is not there."""
    path = folder / f"{shape}_{floe:g}_{concentration:g}_{seed}.wkt"
    if not path.exists():
        path.parent.mkdir(parents=True, exist_ok=True)
        outlines = drawn(shape, size, floe, concentration, seed)
        write_text(path, "".join(f"{shapely.Polygon(outline).wkt}\n" for outline in outlines))
    return path.resolve()

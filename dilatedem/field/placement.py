"""The ice field at t = 0: floes cut from Voronoi cells, of exact concentration, clear of the structures.

Each cell is shrunk about its centroid by one common factor (physics 7). What counts as ice is the plan of the
*dilated* floe, whose corners are round: its core outline, of area A and perimeter L, covers A + L r + pi r^2.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from itertools import product

import numpy as np
import shapely
from numpy.typing import ArrayLike

from dilatedem.field.obstacles import Disk, HalfPlane, Obstacle
from dilatedem.field.recipe import PLAIN, Recipe
from dilatedem.geometry import outline as plan
from dilatedem.geometry.polyhedron import Polyhedron
from dilatedem.numerics.blocks import place
from dilatedem.numerics.plain import dot
from dilatedem.numerics.root import bracketed_root

# A floe whose core vanishes when it is made smaller by this part counts as too small.
VANISHING = 1e-12
EPSILON = float(np.finfo(float).eps)


Groups = list[tuple[np.ndarray, np.ndarray]]  # cells (m,) of n sides and their corners (m, n, 2), for each n


@dataclass(frozen=True, eq=False)
class Parts:
    """Outlines that are parts of floes.

    floe   (outlines,) the floe that each is part of; its parts come one after another
    every  (outlines and those left out,) the same before some were left out
    inner  (outlines, 3) length [m] of an outline's sides that lie within its floe, and its first moments about the origin [m2]
    """

    floe: np.ndarray
    every: np.ndarray
    inner: np.ndarray


@dataclass(frozen=True, eq=False)
class FloeField:
    """Floes in plan.

    outlines       outer outlines (k, 2) [m] in world coordinates, centroids inside a periodic domain
    plan_area      (floes,) plan area of each dilated floe [m2]
    every_area     (floes and those left out,) the same of all floes that were made
    factor         by which the cells were shrunk
    concentration  dilated plan area of all floes, those left out included, over the area of the domain
    kept           (floes and those left out,) which were not left out for touching an obstacle
    parts          of floes of several convex parts: which outline is part of which floe; None: each is one by itself
    """

    outlines: plan.Outlines
    plan_area: np.ndarray
    every_area: np.ndarray
    factor: float
    concentration: float
    kept: np.ndarray
    parts: Parts | None = None

    @property
    def left_out(self) -> int:
        """Number of floes left out."""
        return len(np.unique(self.parts.every[~self.kept])) if self.parts else int(np.count_nonzero(~self.kept))

    @property
    def floe_area(self) -> np.ndarray:
        """(floes,) plan area of each floe, its parts together [m2]."""
        if not self.parts:
            return self.plan_area
        floe = np.unique(self.parts.floe, return_inverse=True)[1]
        return np.bincount(floe, self.plan_area, int(floe.max(initial=-1)) + 1)


def ice_field(
    size: ArrayLike,
    count: int,
    concentration: float,
    *,
    periodic: Sequence[bool],
    seed: int,
    dilated_radius: float,
    obstacles: Sequence[Obstacle] = (),
    recipe: Recipe = PLAIN,
    ragged: Sequence[bool] = (False, False),
) -> FloeField:
    """`count` floes of `concentration` (between 0 and 1) in a domain of `size` (2,) [m] about the origin.

    ragged: whether floes stick out of the sides along x and along y that are not periodic, as they come; else they end there.

    The concentration is met by all floes together, before those that touch an obstacle are left out. Raises
    ValueError when a floe gets too small for the dilated radius [m], or when the concentration cannot be
    reached.
    """
    size = np.asarray(size, dtype=float)
    if not 0.0 < concentration < 1.0:
        raise ValueError(f"concentration = {concentration:g}: must lie between 0 and 1")
    whole = np.logical_or(periodic, ragged)  # cells beyond a ragged side are left out, none is cut
    cells = recipe.nuclei(size, count, whole, np.random.default_rng(seed)).cells(size, whole)
    groups, count = cells.by_sides(), len(cells)
    domain_area = float(np.prod(size))
    factor = shrink_factor(groups, concentration * domain_area, domain_area, dilated_radius)
    plan_area, _ = dilated_areas(groups, count, factor, dilated_radius)
    # a hair below, where a floe whose core is just vanishing shows itself: the area jumps there
    _, too_small = dilated_areas(groups, count, factor * (1.0 - VANISHING), dilated_radius)
    if too_small.any():
        raise ValueError(
            f"{too_small.sum()} of {count} floes are too narrow for the dilated radius {dilated_radius:g} m: "
            "take a smaller dilated_radius, larger floes, or another seed"
        )

    outlines = shrunk(cells, factor, np.where(whole, size, 0.0))
    touching = touching_obstacles(outlines, obstacles, size, periodic)
    return FloeField(
        outlines=outlines.where(~touching),
        plan_area=plan_area[~touching],
        every_area=plan_area,
        factor=factor,
        concentration=float(plan_area.sum() / domain_area),
        kept=~touching,
    )


def shrunk(cells: plan.Outlines, factor: float, period: np.ndarray) -> plan.Outlines:
    """Each cell shrunk about its centroid, which is brought into the domain where that has a period (2,) [m], 0 = none."""
    outlines = plan.Outlines(np.empty_like(cells.points), cells.start)
    for index, corners in cells.by_sides():
        middle = plan.centroid(corners)
        smaller = middle[:, None] + factor * (corners - middle[:, None])
        home = np.where(period > 0.0, -period * np.floor(middle / np.where(period > 0.0, period, 1.0) + 0.5), 0.0)
        place(outlines.points, cells.start[index], smaller + home[:, None])
    return outlines


def equilibrium_height(outer: Polyhedron, density: float | np.ndarray, water_density: float) -> float | np.ndarray:
    """z [m] of the centroid of a floe that floats flat: exact for a right prism centred on the origin; (m,) for a stack.

    outer is the sharp outer polyhedron in body coordinates; its draft is the part density / water_density of
    its height. Raises ValueError for ice too heavy to float.
    """
    if not np.all(density < water_density):
        raise ValueError(f"density = {np.max(density):g} kg/m3: must be below that of the water, {water_density:g} kg/m3, to float")
    bottom, top = outer.vertices[..., 2].min(axis=-1), outer.vertices[..., 2].max(axis=-1)
    return -bottom - (top - bottom) * density / water_density


def dilated_areas(groups: Groups, count: int, factor: float, radius: float) -> tuple[np.ndarray, np.ndarray]:
    """(count,) plan areas [m2] of dilated floes made of cells shrunk by `factor`, and which have no core.

    One without a core counts with its sharp outline, so that the search for the factor can go on.
    """
    area = np.zeros(count)
    without_core = np.ones(count, dtype=bool)
    for index, corners in groups:
        area[index] = factor * factor * plan.area(corners)
        # shrinking, then eroding by r, is eroding by r/factor, then shrinking
        for eroded in plan.erode_together(corners, radius / factor):
            core_area, core_perimeter = plan.area(eroded.corners), plan.perimeter(eroded.corners)
            floe = index[eroded.index]
            area[floe] = factor * factor * core_area + factor * core_perimeter * radius + np.pi * radius * radius
            without_core[floe] = False
    return area, without_core


def shrink_factor(groups: Groups, ice_area: float, domain_area: float, radius: float) -> float:
    """The factor at which the dilated floes cover `ice_area` [m2] together."""
    count = sum(len(index) for index, _ in groups)

    @cache  # the ends of the range are asked for more than once
    def excess(factor: float) -> float:
        return float(dilated_areas(groups, count, factor, radius)[0].sum()) - ice_area

    # Sharp outlines cover factor^2 of the domain, and round corners only take away from that.
    lowest = math.sqrt(ice_area / domain_area)
    if excess(1.0) <= 0.0:
        reached = (excess(1.0) + ice_area) / domain_area
        raise ValueError(
            f"concentration = {ice_area / domain_area:g} cannot be reached: the round corners of the floes "
            f"leave at most {reached:.6g}; take a lower concentration or a smaller dilated_radius"
        )
    if excess(lowest) >= 0.0:  # sharp corners (radius 0), up to round-off
        return lowest
    return bracketed_root(excess, lowest, 1.0, absolute=1e-15, relative=4.0 * EPSILON)


def touching_obstacles(
    outlines: plan.Outlines, obstacles: Sequence[Obstacle], size: np.ndarray, periodic: Sequence[bool]
) -> np.ndarray:
    """(floes,) whether an outline touches or overlaps an obstacle or a periodic image of one."""
    corners, start, sides = outlines.points, outlines.start[:-1], outlines.sides
    touching = np.zeros(len(outlines), dtype=bool)
    polygons = shapely.polygons(shapely.linearrings(corners, indices=np.repeat(np.arange(len(sides)), sides)))
    for obstacle in obstacles:
        if isinstance(obstacle, HalfPlane):
            height = dot(corners - np.asarray(obstacle.point), obstacle.normal)
            touching |= np.minimum.reduceat(height, start) <= 0.0
            continue
        if isinstance(obstacle, Disk):
            solid, reach = shapely.Point(obstacle.center), obstacle.radius
        else:
            solid, reach = shapely.convex_hull(shapely.multipoints(obstacle.outline)), obstacle.reach
        for shift in _image_shifts(np.array(solid.centroid.coords[0]), size, periodic):
            image = shapely.transform(solid, lambda xy, by=shift: xy + by)
            touching |= shapely.dwithin(polygons, image, reach)
    return touching


def _image_shifts(centre: np.ndarray, size: np.ndarray, periodic: Sequence[bool]) -> list[np.ndarray]:
    """Shifts (2,) [m] that bring something at `centre` into the domain and to its images beside it."""
    home = np.where(periodic, -size * np.floor(centre / size + 0.5), 0.0)
    steps = [(-1.0, 0.0, 1.0) if is_periodic else (0.0,) for is_periodic in periodic]
    return [home + size * np.array(step) for step in product(*steps)]

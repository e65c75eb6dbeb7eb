"""Bodies that are in each other at t = 0: the contact laws would throw them apart within a few steps, with energy out of nothing.

Generated floes are apart from each other by the way they are made (`field.placement`), so that pairs with a body of the list or a
structure are looked at, and nothing is compiled. Boxes along the axes tell who may meet, then outlines in plan, then the cores.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product

import numpy as np
import shapely

from dilatedem.errors import CaseError
from dilatedem.geometry.polyhedron import Polyhedron
from dilatedem.geometry.separation import cone_distance, core_distance
from dilatedem.geometry.shapes import tapers
from dilatedem.numerics.frames import matrix_from_quaternion
from dilatedem.numerics.plain import dot, norm, turned
from dilatedem.scene.place import Scene
from dilatedem.state.bodies import Bodies
from dilatedem.state.model import Model

#: overlap over the smaller dilated radius up to which two bodies touch. Bodies laid on each other by their drawn sizes overlap by
#: round-off, those laid down at rest by what their weight presses in (1e-4), those of validation/closed_forms, whose forces are
#: looked up at 0.1 mm, by 2.5e-3. Effect: floes of 2.8 m and 4 cm fly apart at up to 3 cm/s, a tenth of a usual current
TOUCHING = 4e-3
#: overlaps that are told one by one
MOST_TOLD = 10
#: overlaps after which the search ends: such a case is wrong as a whole
MOST_FOUND = 1000


@dataclass(frozen=True)
class Overlap:
    """Two bodies in each other, `depth` [m] at t = 0; a < b, structures last; `seam`: across a periodic boundary."""

    a: int
    b: int
    depth: float
    seam: bool = False


def require_apart(scene: Scene, model: Model, bodies: Bodies) -> None:
    """Raises CaseError that names the bodies of a case that start in each other, in structures or in walls."""
    found = sorted(overlaps(scene, model, bodies), key=lambda overlap: (overlap.a, overlap.b))
    if not found:
        return
    count = f"more than {MOST_FOUND}" if len(found) > MOST_FOUND else str(len(found))
    pairs = "1 pair of bodies overlaps" if len(found) == 1 else f"{count} pairs of bodies overlap"
    told = [_sentence(overlap, scene, model, bodies) for overlap in found[:MOST_TOLD]]
    more = ["  ..."] if len(found) > MOST_TOLD else []
    head = f"{pairs} at t = 0 and would be thrown apart; move them apart, or leave one of each pair out:"
    raise CaseError("\n".join([head, *told, *more]))


def overlaps(scene: Scene, model: Model, bodies: Bodies) -> list[Overlap]:
    """All of them, but no more than MOST_FOUND + 1."""
    here = _Place(scene, model, bodies)
    found: list[Overlap] = []
    for search in (_half_spaces(here), _cores(here)):
        for overlap in search:
            found.append(overlap)
            if len(found) > MOST_FOUND:
                return found
    return found


class _Place:
    """Cores in world directions at t = 0, those of periodic directions in the domain.

    vertex (v, 3) [m], start (n + 1,) of n convex bodies; low, high (n, 3) [m]: of their dilated bodies.
    """

    def __init__(self, scene: Scene, model: Model, bodies: Bodies):
        self.scene, self.model, self.shapes = scene, model, model.shapes
        self.count = int(np.count_nonzero(self.shapes.kind == 0))
        self.position = bodies.position[: self.count].copy()
        self.period = np.array([model.surroundings.period_x, model.surroundings.period_y])
        for axis in np.flatnonzero(self.period):
            self.position[:, axis] -= self.period[axis] * np.round(self.position[:, axis] / self.period[axis])
        self.start = self.shapes.vertex_start[: self.count + 1]
        self.turn = matrix_from_quaternion(bodies.orientation[: self.count])
        owner = np.repeat(np.arange(self.count), np.diff(self.start))
        self.vertex = turned(self.turn[owner], self.shapes.vertex) + self.position[owner]
        self.radii = self._radii(owner)
        self.widest = np.maximum.reduceat(self.radii, self.start[:-1])
        self.low = np.minimum.reduceat(self.vertex - self.radii[:, None], self.start[:-1])
        self.high = np.maximum.reduceat(self.vertex + self.radii[:, None], self.start[:-1])
        self.points = bodies.position[self.count :]
        self.held = model.solids.inverse_mass == 0.0

    def _radii(self, owner: np.ndarray) -> np.ndarray:
        """(v,) dilated radii at the vertices [m]; owner (v,): the body of each."""
        radii = self.shapes.radius[owner]
        taper = tapers(self.shapes)[owner]
        ahead = np.arange(len(owner)) == self.start[owner + 1] - 1  # of two corners, the second
        return radii + np.where(ahead, 1.0, -1.0) * taper * norm(self.vertex - self.position[owner])

    def distance(self, a: int, b: int, shift: np.ndarray) -> float:
        """Distance [m] of the core of a, moved by `shift` (3,) [m], from the dilated surface of b; negative inside."""
        if tapers(self.shapes)[b] == 0.0:
            return core_distance(self.core(a, shift), self.core(b, np.zeros(3))) - self.shapes.radius[b]
        return cone_distance(self.core(a, shift), self.vertices(b), self.radii[self.start[b] : self.start[b + 1]])

    def vertices(self, i: int) -> np.ndarray:
        return self.vertex[self.start[i] : self.start[i + 1]]

    def core(self, i: int, shift: np.ndarray) -> Polyhedron:
        """Core i, moved by `shift` (3,) [m]; its faces by their normals alone."""
        shapes, (first, last) = self.shapes, self.start[i : i + 2]
        normals = turned(self.turn[i], shapes.face_normal[shapes.face_start[i] : shapes.face_start[i + 1]])
        corner = np.repeat(np.arange(first, last), np.diff(shapes.neighbour_start[first : last + 1]))
        other = shapes.neighbour[shapes.neighbour_start[first] : shapes.neighbour_start[last]]
        edges = np.column_stack((corner, other))[corner < other] - first
        return Polyhedron(self.vertices(i) + shift, edges, (), normals)

    def outline(self, i: np.ndarray, shift: np.ndarray) -> np.ndarray:
        """Cores in plan (m,), moved by `shift` (2,) [m]."""
        sizes = np.diff(self.start)[i]
        rows = np.repeat(self.start[i] - np.concatenate([[0], np.cumsum(sizes)[:-1]]), sizes) + np.arange(sizes.sum())
        points = shapely.points(self.vertex[rows, :2] + shift)
        return shapely.convex_hull(shapely.multipoints(points, indices=np.repeat(np.arange(len(i)), sizes)))


def _half_spaces(here: _Place) -> Iterator[Overlap]:
    """Bodies in or behind a plane."""
    floating, shapes = here.scene.count, here.shapes
    for k, point in enumerate(here.points, start=here.count):
        height = dot(here.vertex[: here.start[floating]] - point, shapes.plane_normal[k])
        radius = shapes.radius[:floating]
        depth = radius - np.minimum.reduceat(height, here.start[:floating])
        for i in np.flatnonzero((depth > TOUCHING * radius) & ~here.held[:floating]):
            yield Overlap(int(i), k, float(depth[i]))


def _cores(here: _Place) -> Iterator[Overlap]:
    """Bodies of the list in each other, in a generated floe or in the core of a structure."""
    radius = here.shapes.radius
    for a, b, shift in _near(here):
        depth = radius[a] - here.distance(a, b, shift)
        if depth > TOUCHING * min(radius[a], radius[b]):
            yield Overlap(int(a), int(b), float(depth), bool(shift.any()))


def _near(here: _Place) -> Iterator[tuple[int, int, np.ndarray]]:
    """Pairs whose dilated outlines in plan and heights meet, a < b, and the shift (3,) [m] of a that brings it to b."""
    low, high, radius = here.low, here.high, here.widest
    tree = shapely.STRtree(shapely.box(low[:, 0], low[:, 1], high[:, 0], high[:, 1]))
    sought = np.concatenate([np.arange(here.scene.explicit), np.arange(here.scene.count, here.count)])
    is_sought = np.isin(np.arange(here.count), sought)
    steps = [(-1.0, 0.0, 1.0) if period else (0.0,) for period in here.period]
    for step in product(*steps):
        shift = here.period * step
        first, b = tree.query(shapely.box(*(low[sought, :2] + shift).T, *(high[sought, :2] + shift).T))
        a = sought[first]
        # two that are both sought are met twice: from a with the shift, and from b with the opposite one
        once = (a != b) & ((a < b) | ~is_sought[b]) & ~(here.held[a] & here.held[b])
        once &= (low[a, 2] < high[b, 2]) & (low[b, 2] < high[a, 2])
        a, b = a[once], b[once]
        if not len(a):
            continue
        near = shapely.distance(here.outline(a, shift), here.outline(b, np.zeros(2))) < radius[a] + radius[b]
        for i, j in zip(a[near], b[near], strict=True):
            yield (i, j, np.array([*shift, 0.0])) if i < j else (j, i, -np.array([*shift, 0.0]))


def structures_in_each_other(scene: Scene, model: Model, bodies: Bodies) -> list[tuple[str, str, float]]:
    """Names of two structures, parts of one apart, whose cores are in each other's dilations, and the depth [m].

    Half spaces are left out: what stands on a sea bed or in a wall stands in it.
    """
    wholes = [structure.whole or structure for structure in scene.structures]
    names = [wholes[s].name for s in model.structure_of[scene.count :]]
    if len(set(names)) < 2:
        return []
    here, radius = _Place(scene, model, bodies), model.shapes.radius
    own = np.arange(scene.count, here.count)
    low, high = here.low[own], here.high[own]
    boxes = shapely.box(low[:, 0], low[:, 1], high[:, 0], high[:, 1])
    deepest: dict[tuple[str, str], float] = {}
    for i, j in shapely.STRtree(boxes).query(boxes).T:
        if i >= j or names[i] == names[j] or low[i, 2] > high[j, 2] or low[j, 2] > high[i, 2]:
            continue
        a, b = own[i], own[j]
        depth = radius[a] + radius[b] - core_distance(here.core(a, np.zeros(3)), here.core(b, np.zeros(3)))
        if depth > TOUCHING * min(radius[a], radius[b]):
            pair = (names[i], names[j])
            deepest[pair] = max(depth, deepest.get(pair, 0.0))
    return [(*pair, float(depth)) for pair, depth in deepest.items()]


def _sentence(overlap: Overlap, scene: Scene, model: Model, bodies: Bodies) -> str:
    first, second = (body_name(i, scene, model, bodies, np.arange(model.floating)) for i in (overlap.a, overlap.b))
    return f"  {first} and {second}, by {overlap.depth:.3g} m{' across the periodic seam' if overlap.seam else ''}"


def body_name(body: int, scene: Scene, model: Model, bodies: Bodies, ids: np.ndarray) -> str:
    """A body, or the structure that it is part of, for a message; ids: numbers of the bodies that float."""
    if body >= model.floating:
        return f'structure "{scene.structures[model.structure_of[body]].name}"'
    x, y = np.round(bodies.position[body, :2], 2) + 0.0  # no -0.00
    return f"body {ids[body]} at ({x:.2f}, {y:.2f})"

"""Who stands where at t = 0: explicit bodies, generated floes, structures."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from dilatedem.case.bodies import Body
from dilatedem.case.names import WALL_NAMES
from dilatedem.case.schema import Case
from dilatedem.errors import CaseError
from dilatedem.field.obstacles import Region
from dilatedem.field.placement import FloeField, equilibrium_height
from dilatedem.field.stream import Stream
from dilatedem.field.survey import Report
from dilatedem.geometry import outline as plan
from dilatedem.geometry.floes import floe_shapes
from dilatedem.geometry.packing import numbered
from dilatedem.geometry.polyhedron import convex_hull, prism
from dilatedem.geometry.shapes import BodyShape
from dilatedem.numerics.frames import matrix_from_quaternion, quaternion_from_rotation_vector
from dilatedem.numerics.plain import turned
from dilatedem.scene.ice import Floes, IceProperties, floes_of
from dilatedem.scene.joined import Joints, joined, moved_shapes
from dilatedem.scene.records import Record, records_of
from dilatedem.scene.room import MOST_FACE_CORNERS
from dilatedem.state.bodies import joined_rows
from dilatedem.structures.held import HeldBody
from dilatedem.structures.kind import Chart, Part, Structure, member_name
from dilatedem.structures.plane import Plane
from dilatedem.structures.support import Support

#: of an outline's size, where the search for a tolerance that thins it enough begins
FIRST_TOLERANCE = 1e-5


@dataclass(frozen=True, eq=False)
class PlacedBody:
    """An entry of the case's `[[body]]` list at t = 0.

    outline: (k, 2) [m] as seen from above, world coordinates; plan_area [m2]; core_outline: (c, 2) [m] its core's corners, too.
    """

    shape: BodyShape
    position: np.ndarray  # (3,) centroid, m
    orientation: np.ndarray  # (4,) unit quaternion, body to world
    outline: np.ndarray
    plan_area: float
    core_outline: np.ndarray


@dataclass(frozen=True, eq=False)
class PlacedStructure:
    """A structure, its bodies, how its load map is laid out, and the structure that it is a part of, if there is one."""

    about: Structure | HeldBody
    parts: list[Part]
    chart: Chart | None
    whole: PlacedStructure | None = None

    @property
    def name(self) -> str:
        return member_name(self.whole.name, self.about.name) if self.whole else self.about.name

    @property
    def place(self) -> np.ndarray:
        """(3,) [m] the point about which its moments are stated: of all parts of a structure the same."""
        return self.whole.place if self.whole else self.about.place

    @property
    def support(self) -> Support:
        """What carries it: all parts of a structure together."""
        return self.whole.support if self.whole else self.about.support


@dataclass(frozen=True, eq=False)
class Scene:
    """All n bodies of a case in place at t = 0, and its structures (those of the case, then the domain's walls).

    Bodies are numbered from 0: those of the case's `[[body]]` list in their order, then the generated floes. Structures whose parts
    are half spaces come last, as their bodies do; then bodies of the list that are held fast.
    """

    explicit: int  # bodies of the list
    shapes: list[BodyShape]  # bodies of one topology together
    order: np.ndarray  # (n,) number of each body, shape by shape
    position: np.ndarray  # (n, 3) centroid, m
    orientation: np.ndarray  # (n, 4) unit quaternion, body to world
    outlines: plan.Outlines  # as seen from above, world coordinates, m
    plan_area: np.ndarray  # (n,) m2
    density: np.ndarray  # (n,) kg/m3
    joints: Joints  # which of them are parts of one floe
    structures: list[PlacedStructure]
    records: list[Record]  # rows of the record of loads: the structures, and sums over them
    field: FloeField
    ice: IceProperties  # of the generated floes
    report: Report | None  # what was changed in outlines of a file
    stream: Stream | None = None  # what the field is a part of, where ice enters

    @property
    def count(self) -> int:
        return len(self.order)

    def standing(self) -> list[tuple[PlacedStructure, list[Part]]]:
        """The structures that are no parts of others, each with all bodies of it and of its parts."""
        found = {id(structure): (structure, list(structure.parts)) for structure in self.structures if structure.whole is None}
        for structure in self.structures:
            if structure.whole is not None:
                found[id(structure.whole)][1].extend(structure.parts)
        return list(found.values())

    def whole_of(self) -> np.ndarray:
        """The structure that each structure is a part of, by number; -1 = none."""
        number = {id(structure): s for s, structure in enumerate(self.structures)}
        return np.array([number[id(structure.whole)] if structure.whole else -1 for structure in self.structures], np.int64)

    def floe_area(self) -> np.ndarray:
        """(n,) plan area [m2] of each body, or of the floe that it is part of."""
        area = self.plan_area.copy()
        for first, last in joined_rows(self.joints.floe):
            area[first:last] = area[first:last].sum()
        return area

    def volume(self) -> np.ndarray:
        """(n,) of the dilated bodies [m3]."""
        return self._in_order([np.reshape(shape.properties.volume, -1) for shape in self.shapes])

    def mass(self) -> np.ndarray:
        """(n,) [kg]."""
        return self.volume() * self.density

    def unit_inertia(self) -> np.ndarray:
        """(n, 3, 3) [m5] about the centroid, body frame, for unit density."""
        return self._in_order([np.reshape(shape.properties.inertia, (-1, 3, 3)) for shape in self.shapes])

    def core_vertices(self) -> np.ndarray:
        """(n,) vertices of each core."""
        return self._in_order([np.full(shape.count, shape.core.stacked().vertices.shape[1]) for shape in self.shapes])

    def _in_order(self, parts: list[np.ndarray]) -> np.ndarray:
        values = np.concatenate(parts)
        ordered = np.empty_like(values)
        ordered[self.order] = values
        return ordered


def compose(case: Case) -> Scene:
    """Place every body of a case. Raises CaseError where the field, a body or a structure cannot be built."""
    explicit = [_explicit_body(case, number, body) for number, body in enumerate(case.body)]
    structures = _structures(case)
    try:
        generated = floes_of(case, [Region(body.core_outline, body.shape.radius) for body in explicit])
        return _scene(case, explicit, generated, [*structures, *_held(case, explicit)])
    except ValueError as fault:
        raise CaseError(f"the ice field cannot be built: {fault}") from fault


def scene_of_floes(case: Case, floes: Floes, structures: list[PlacedStructure]) -> Scene:
    """Generated floes alone in their places beside structures. Raises ValueError for one that has no shape or does not float."""
    return _scene(case, [], floes, [structure for structure in structures if not isinstance(structure.about, HeldBody)])


def _scene(case: Case, explicit: list[PlacedBody], generated: Floes, structures: list[PlacedStructure]) -> Scene:
    """Explicit bodies and floes in one numbering. Raises ValueError for a floe that has no shape or does not float."""
    first, field, ice = len(explicit), generated.field, generated.ice
    position, orientation = np.zeros((first + len(field.outlines), 3)), np.zeros((first + len(field.outlines), 4))
    orientation[:] = quaternion_from_rotation_vector(np.zeros(3))
    for number, body in enumerate(explicit):
        position[number], orientation[number] = body.position, body.orientation
    shapes, order = [body.shape for body in explicit], [np.arange(first)]
    for floes, shape, centroid in floe_shapes(field.outlines, ice.thickness, case.ice.dilated_radius):
        order.append(first + floes)
        shapes.append(shape)
        position[order[-1]] = centroid
        position[order[-1], 2] = _floating_height(case, shape, ice.density[floes])
    density = np.concatenate([[body.density for body in case.body[:first]], ice.density])
    numbers = list(numbered([shape.count for shape in shapes], np.concatenate(order)))
    joints, place = joined(first, field.parts, shapes, numbers, density, position)
    return Scene(
        explicit=first,
        shapes=moved_shapes(shapes, numbers, joints),
        order=np.concatenate(order),
        position=place,
        orientation=orientation,
        outlines=plan.Outlines.of([*(body.outline for body in explicit), *field.outlines]) if explicit else field.outlines,
        plan_area=np.concatenate([[body.plan_area for body in explicit], field.plan_area]),
        density=density,
        joints=joints,
        structures=structures,
        records=records_of(case, structures),
        field=field,
        ice=ice,
        report=generated.report,
        stream=generated.stream,
    )


def _structures(case: Case) -> list[PlacedStructure]:
    """The structures of a case and its walls with their bodies, those of half spaces last. Raises CaseError that names one."""
    placed, extent = [], math.hypot(*case.domain.size)
    for number, structure in enumerate([*case.structure, *_walls(case)]):
        placed += _placed(structure, extent, f"structure.{number}")
    return sorted(placed, key=lambda structure: any(part.is_half_space for part in structure.parts))


def _placed(structure: Structure, extent: float, where: str, whole: PlacedStructure | None = None) -> Iterator[PlacedStructure]:
    """A structure, then its members. Raises CaseError, which says where in the case the fault is."""
    try:
        placed = PlacedStructure(structure, structure.parts(), structure.chart(extent), whole)
        if (most := max((_most_corners(part.shape) for part in placed.parts if part.shape), default=0)) > MOST_FACE_CORNERS:
            raise ValueError(f"a face has {most} corners, and at most {MOST_FACE_CORNERS} can be handled; draw it with fewer")
    except ValueError as fault:
        raise CaseError(f"{where}: {fault}") from fault
    yield placed
    for number, member in enumerate(structure.members):
        yield from _placed(member, extent, f"{where}.part.{number}", placed)


def _held(case: Case, explicit: list[PlacedBody]) -> list[PlacedStructure]:
    """The bodies of the list that are held fast, as what they are to the record of loads."""
    held = [HeldBody(i, body.position) for i, body in enumerate(explicit) if case.body[i].fixed]
    return [PlacedStructure(body, [], None) for body in held]


def _walls(case: Case) -> list[Structure]:
    """Rigid planes where a boundary of the domain is a wall, with the default elasticity of a structure."""
    walls: list[Structure] = []
    for axis, boundary in enumerate(case.domain.boundaries):
        if boundary != "wall":
            continue
        for side, name in zip((-1.0, 1.0), WALL_NAMES[2 * axis : 2 * axis + 2], strict=True):
            point, normal = [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]
            point[axis], normal[axis] = 0.5 * side * case.domain.size[axis], -side
            plane = {"point": tuple(point), "normal": tuple(normal), "friction": case.domain.wall_friction}
            walls.append(Plane(kind="plane", name=name, **plane))
    return walls


def _explicit_body(case: Case, number: int, body: Body) -> PlacedBody:
    """A [[body]] entry in its place at t = 0. Raises CaseError that names it."""
    try:
        if body.outline is not None:
            shape, centroid = _floe_shape(_corners(body), body.thickness, body.dilated_radius)
            height = 0.0
            if case.water.enabled and (body.position is None or len(body.position) == 2):
                height = _floating_height(case, shape, body.density)
            position = np.array([*centroid[:2], height])
        else:
            shape, centroid = BodyShape.of_core(convex_hull(np.array(body.vertices)), body.dilated_radius)
            position = np.zeros(3)
    except ValueError as fault:
        raise CaseError(f"body.{number}: {fault}") from fault
    if (most := _most_corners(shape)) > MOST_FACE_CORNERS:
        raise CaseError(f"body.{number}: a face has {most} corners, and at most {MOST_FACE_CORNERS} can be handled{_way_on(body)}")
    if body.position is not None:
        position[: len(body.position)] = body.position
    orientation = quaternion_from_rotation_vector(body.rotation)
    turn = matrix_from_quaternion(orientation)
    corners, core = turned(turn, shape.outer.vertices) + position, turned(turn, shape.core.vertices) + position
    seen = convex_hull(corners * [1.0, 1.0, 0.0]).vertices[:, :2]
    seen = seen if plan.area(seen) > 0.0 else seen[::-1]
    return PlacedBody(shape, position, orientation, seen, float(plan.area(seen)), core[:, :2])


def _most_corners(shape: BodyShape) -> int:
    """Corners of its face that has most."""
    return max((len(face) for face in shape.core.faces), default=0)


def _corners(body: Body) -> np.ndarray:
    """The outline (k, 2) [m] of a body that is drawn in plan, thinned where it asks for that. Raises ValueError for a bad one."""
    outline = plan.prepare(body.outline)
    return outline if body.outline_tolerance is None else plan.thinned(outline, body.outline_tolerance)


def _way_on(body: Body) -> str:
    """What to do about an outline of too many corners, with a tolerance that is enough."""
    if body.outline is None:
        return "; give it fewer vertices"
    outline = plan.prepare(body.outline)
    tolerance = 10.0 ** math.floor(math.log10(FIRST_TOLERANCE * float(np.ptp(outline, axis=0).max())))
    while len(left := plan.thinned(outline, tolerance)) > MOST_FACE_CORNERS:
        tolerance *= 2.0
    leaves = f"which leaves {len(left)} of {len(outline)}"
    return f"; leave some out, or have that done by outline_tolerance = {tolerance:g} (m), {leaves}"


def _floe_shape(outline: np.ndarray, thickness: float, radius: float) -> tuple[BodyShape, np.ndarray]:
    half = 0.5 * thickness - radius
    return BodyShape.of_core(prism(plan.erode(outline, radius), -half, half), radius)


def _floating_height(case: Case, shape: BodyShape, density: float | np.ndarray) -> float | np.ndarray:
    return equilibrium_height(shape.outer, density, case.water.density) if case.water.enabled else 0.0

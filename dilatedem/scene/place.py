"""From a case to bodies in place: explicit bodies, generated floes, structures, packed into the arrays that kernels work on."""

import math
from dataclasses import dataclass

import numpy as np

from dilatedem.case.schema import WALL_NAMES, Case
from dilatedem.case.solids import Body, PileStructure, PlaneStructure
from dilatedem.errors import CaseError
from dilatedem.field.placement import Disk, FloeField, HalfPlane, Obstacle, Region, equilibrium_height, ice_field
from dilatedem.field.sizes import floe_count
from dilatedem.geometry import outline as plan
from dilatedem.geometry.floes import floe_shapes
from dilatedem.geometry.polyhedron import convex_hull, prism
from dilatedem.geometry.shapes import BodyShape, pack_hulls, pack_shapes
from dilatedem.numerics.frames import matrix_from_quaternion, quaternion_from_rotation_vector
from dilatedem.state.bodies import Bodies, Solids, bodies_at_rest
from dilatedem.state.model import Model
from dilatedem.state.setting import CONTACT_SETTINGS, ContactSetting, Surroundings
from dilatedem.state.storage import MOST_CORNERS

Structure = PileStructure | PlaneStructure

#: half the length of a pile's core, m: "reaching beyond any floe above and below"
PILE_HALF_LENGTH = 200.0
#: a load map's heights reach from so many ice thicknesses below the water level to so many above
MAP_HEIGHTS = (-1.5, 1.0)
#: corners of a face after clipping by another: both counts together have to fit into the workspace
MOST_FACE_CORNERS = MOST_CORNERS // 2 - 1


@dataclass(frozen=True, eq=False)
class PlacedBody:
    """An entry of the case's `[[body]]` list at t = 0.

    outline: (k, 2) [m] as seen from above, world coordinates; plan_area [m2].
    """

    shape: BodyShape
    position: np.ndarray  # (3,) centroid, m
    orientation: np.ndarray  # (4,) unit quaternion, body to world
    outline: np.ndarray
    plan_area: float


@dataclass(frozen=True, eq=False)
class Scene:
    """All n bodies of a case in place at t = 0, and its structures (those of the case, then the domain's walls).

    Bodies are numbered from 0: those of the case's `[[body]]` list in their order, then the generated floes.
    """

    explicit: int  # bodies of the list
    shapes: list[BodyShape]  # bodies of one topology together
    order: np.ndarray  # (n,) number of each body, shape by shape
    position: np.ndarray  # (n, 3) centroid, m
    orientation: np.ndarray  # (n, 4) unit quaternion, body to world
    outlines: plan.Outlines  # as seen from above, world coordinates, m
    plan_area: np.ndarray  # (n,) m2
    structures: list[Structure]
    field: FloeField

    @property
    def count(self) -> int:
        return len(self.order)

    def volume(self) -> np.ndarray:
        """(n,) of the dilated bodies [m3]."""
        return self._in_order([np.reshape(shape.properties.volume, -1) for shape in self.shapes])

    def unit_inertia(self) -> np.ndarray:
        """(n, 3, 3) [m5] about the centroid, body frame, for unit density."""
        return self._in_order([np.reshape(shape.properties.inertia, (-1, 3, 3)) for shape in self.shapes])

    def _in_order(self, parts: list[np.ndarray]) -> np.ndarray:
        values = np.concatenate(parts)
        ordered = np.empty_like(values)
        ordered[self.order] = values
        return ordered


def compose(case: Case) -> Scene:
    """Place every body of a case. Raises CaseError where the field or a body cannot be built."""
    explicit = [_explicit_body(case, number, body) for number, body in enumerate(case.body)]
    try:
        field = _floe_field(case, explicit)
        return _scene(case, explicit, field)
    except ValueError as fault:
        raise CaseError(f"the ice field cannot be built: {fault}") from fault


def _scene(case: Case, explicit: list[PlacedBody], field: FloeField) -> Scene:
    """Explicit bodies and floes in one numbering. Raises ValueError for a floe that has no shape or does not float."""
    first = len(explicit)
    position, orientation = np.zeros((first + len(field.outlines), 3)), np.zeros((first + len(field.outlines), 4))
    orientation[:] = quaternion_from_rotation_vector(np.zeros(3))
    for number, body in enumerate(explicit):
        position[number], orientation[number] = body.position, body.orientation
    shapes, order = [body.shape for body in explicit], [np.arange(first)]
    for floes, shape, centroid in floe_shapes(field.outlines, case.ice.thickness, case.ice.dilated_radius):
        order.append(first + floes)
        shapes.append(shape)
        position[order[-1]] = centroid
        position[order[-1], 2] = _floating_height(case, shape, case.ice.density)
    return Scene(
        explicit=first,
        shapes=shapes,
        order=np.concatenate(order),
        position=position,
        orientation=orientation,
        outlines=plan.Outlines.of([*(body.outline for body in explicit), *field.outlines]) if explicit else field.outlines,
        plan_area=np.concatenate([[body.plan_area for body in explicit], field.plan_area]),
        structures=[*case.structure, *_walls(case)],
        field=field,
    )


def _periodic(case: Case) -> tuple[bool, bool]:
    return case.domain.x_boundary == "periodic", case.domain.y_boundary == "periodic"


def _floe_field(case: Case, explicit: list[PlacedBody]) -> FloeField:
    """The generated floes of a case, clear of its structures and of its explicit bodies."""
    if case.field.source == "bodies":
        return FloeField(plan.Outlines.of([]), np.zeros(0), 1.0, 0.0, 0)
    size = case.domain.size
    count = case.field.floe_count or floe_count(size, case.field.concentration, case.field.floe_size)
    return ice_field(
        size,
        count,
        case.field.concentration,
        periodic=_periodic(case),
        seed=case.field.seed,
        dilated_radius=case.ice.dilated_radius,
        obstacles=[*_structure_obstacles(case), *(Region(body.outline) for body in explicit)],
    )


def _structure_obstacles(case: Case) -> list[Obstacle]:
    obstacles: list[Obstacle] = []
    for structure in case.structure:
        if structure.kind == "pile":
            obstacles.append(Disk(structure.center, structure.radius))
        elif math.hypot(*structure.normal[:2]) > 0.0:  # a level plane bounds no floe in plan
            level = math.hypot(*structure.normal[:2])
            across, slope = np.array(structure.normal[:2]) / level, structure.normal[2] / level
            # where it stands out farthest towards the ice, over the heights that a floe can take up
            reach = slope * structure.point[2] + abs(slope) * case.ice.thickness
            obstacles.append(HalfPlane(tuple(np.array(structure.point[:2]) + across * reach), tuple(across)))
    return obstacles


def _walls(case: Case) -> list[PlaneStructure]:
    """Rigid planes where a boundary of the domain is a wall, with the default elasticity of a structure."""
    walls = []
    for axis, boundary in enumerate((case.domain.x_boundary, case.domain.y_boundary)):
        if boundary != "wall":
            continue
        for side, name in zip((-1.0, 1.0), WALL_NAMES[2 * axis : 2 * axis + 2], strict=True):
            point, normal = [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]
            point[axis], normal[axis] = 0.5 * side * case.domain.size[axis], -side
            walls.append(PlaneStructure(kind="plane", name=name, point=tuple(point), normal=tuple(normal)))
    return walls


def _explicit_body(case: Case, number: int, body: Body) -> PlacedBody:
    """A [[body]] entry in its place at t = 0. Raises CaseError that names it."""
    try:
        if body.outline is not None:
            shape, centroid = _floe_shape(plan.prepare(body.outline), body.thickness, body.dilated_radius)
            height = 0.0
            if case.water.enabled and (body.position is None or len(body.position) == 2):
                height = _floating_height(case, shape, body.density)
            position = np.array([*centroid[:2], height])
        else:
            shape, centroid = BodyShape.of_core(convex_hull(np.array(body.vertices)), body.dilated_radius)
            position = np.zeros(3)
    except ValueError as fault:
        raise CaseError(f"body.{number}: {fault}") from fault
    if any(len(face) > MOST_FACE_CORNERS for face in shape.core.faces):
        raise CaseError(f"body.{number}: a face has too many corners; at most {MOST_FACE_CORNERS} can be handled")
    if body.position is not None:
        position[: len(body.position)] = body.position
    orientation = quaternion_from_rotation_vector(body.rotation)
    corners = shape.outer.vertices @ matrix_from_quaternion(orientation).T + position
    seen = convex_hull(corners * [1.0, 1.0, 0.0]).vertices[:, :2]
    seen = seen if plan.area(seen) > 0.0 else seen[::-1]
    return PlacedBody(shape, position, orientation, seen, float(plan.area(seen)))


def _floe_shape(outline: np.ndarray, thickness: float, radius: float) -> tuple[BodyShape, np.ndarray]:
    half = 0.5 * thickness - radius
    return BodyShape.of_core(prism(plan.erode(outline, radius), -half, half), radius)


def _floating_height(case: Case, shape: BodyShape, density: float) -> float | np.ndarray:
    return equilibrium_height(shape.outer, density, case.water.density) if case.water.enabled else 0.0


def build_model(case: Case, scene: Scene) -> Model:
    """The constant arrays of a run."""
    # convex structures (piles) must come before half spaces, as `pack_shapes` puts those last
    piles = [s for s in scene.structures if s.kind == "pile"]
    planes = [s for s in scene.structures if s.kind == "plane"]
    column = np.array([[0.0, 0.0, -PILE_HALF_LENGTH], [0.0, 0.0, PILE_HALF_LENGTH]])
    columns = [BodyShape.of_core(convex_hull(column), pile.radius)[0] for pile in piles]
    normals = [np.array(plane.normal) / np.linalg.norm(plane.normal) for plane in planes]
    order = np.concatenate([scene.order, np.arange(scene.count, scene.count + len(columns))])
    shapes = pack_shapes(scene.shapes + columns, normals, order)
    water, periodic = case.water, _periodic(case)
    _require_one_image(case, scene, shapes.reach[: scene.count], periodic)
    current = water.velocity if water.enabled else (0.0, 0.0)
    return Model(
        floating=scene.count,
        shapes=shapes,
        hulls=pack_hulls(scene.shapes, scene.order),
        solids=_solids(case, scene, [*piles, *planes]),
        contact=_contact_setting(case),
        surroundings=Surroundings(
            case.gravity.acceleration, water.enabled, water.density, *current, water.drag_force_coefficient,
            water.drag_moment_coefficient, *np.where(periodic, case.domain.size, 0.0).tolist(),
        ),
    )  # fmt: skip


def _contact_setting(case: Case) -> ContactSetting:
    contact = case.contact
    return CONTACT_SETTINGS[contact.model](contact.damping, contact.friction, contact.stiffness_ratio)


def _require_one_image(case: Case, scene: Scene, reach: np.ndarray, periodic: tuple[bool, bool]) -> None:
    """A pair of bodies, `reach` (n,) [m], may meet in one periodic image only. Raises CaseError where a period is too short."""
    reaches = np.sort(reach)[::-1]
    partners = [*reaches[1:2], *(structure.radius for structure in scene.structures if structure.kind == "pile")]
    if not partners:
        return
    least = 2.0 * (reaches[0] + max(partners))
    for axis, wraps in enumerate(periodic):
        if wraps and case.domain.size[axis] <= least:
            raise CaseError(
                f"domain.size.{axis} = {case.domain.size[axis]:g}: is periodic and must be more than {least:.3g} m, or the two "
                "largest bodies could meet on both sides at once"
            )


def ordered_structures(scene: Scene) -> list[Structure]:
    """Structures in the order of their bodies: piles, then planes."""
    return sorted(scene.structures, key=lambda structure: structure.kind == "plane")


def _solids(case: Case, scene: Scene, structures: list[Structure]) -> Solids:
    """Masses and elasticity; structures are of infinite mass."""
    count, bodies = scene.count + len(structures), scene.count
    mass, inverse_mass, compliance = np.zeros(count), np.zeros(count), np.zeros(count)
    inertia, inverse_inertia = np.zeros((count, 3, 3)), np.zeros((count, 3, 3))
    density = np.full(bodies, case.ice.density)
    free = np.ones(bodies, np.bool_)
    compliance[:] = _compliance(case.ice)
    for i, given in enumerate(case.body):
        density[i], free[i], compliance[i] = given.density, not given.fixed, _compliance(given)
    for i, structure in enumerate(structures, start=bodies):
        compliance[i] = _compliance(structure)
    mass[:bodies] = scene.volume() * density
    inertia[:bodies] = scene.unit_inertia() * density[:, None, None]
    moving = np.flatnonzero(free)
    inverse_mass[moving] = 1.0 / mass[moving]
    inverse_inertia[moving] = np.linalg.inv(inertia[moving])
    return Solids(inverse_mass, mass, inertia, inverse_inertia, compliance)


def _compliance(material) -> float:
    """A body's term of Liu 2015, Eq. (7) [1/Pa]."""
    return (1.0 - material.poisson_ratio**2) / material.elastic_modulus


def initial_bodies(case: Case, scene: Scene, model: Model) -> Bodies:
    """All bodies where and as fast as the case says."""
    structures = ordered_structures(scene)
    bodies = bodies_at_rest(scene.count + len(structures))
    ice_velocity = case.ice.initial_velocity
    if ice_velocity == "current":
        ice_velocity = (*case.water.velocity, 0.0) if case.water.enabled else (0.0, 0.0, 0.0)
    bodies.position[: scene.count], bodies.orientation[: scene.count] = scene.position, scene.orientation
    bodies.velocity[scene.explicit : scene.count] = ice_velocity
    for i, given in enumerate(case.body):
        bodies.velocity[i], bodies.angular_velocity[i] = given.velocity, given.angular_velocity
        if not given.fixed:
            turn = matrix_from_quaternion(scene.orientation[i])
            bodies.angular_momentum[i] = turn @ model.solids.inertia[i] @ turn.T @ given.angular_velocity
    for i, structure in enumerate(structures, start=scene.count):
        bodies.position[i] = structure.point if structure.kind == "plane" else (*structure.center, 0.0)
    bodies.middle_velocity[:] = bodies.velocity
    bodies.middle_angular_velocity[:] = bodies.angular_velocity
    bodies.middle_angular_momentum[:] = bodies.angular_momentum
    return bodies


def load_map_geometry(case: Case, scene: Scene) -> tuple[np.ndarray, np.ndarray]:
    """map_origin (s, 6) and map_span (s, 3) of `state.loads.Loads` for the structures in their order [m]."""
    low, high = (factor * case.ice.thickness for factor in MAP_HEIGHTS)
    structures = ordered_structures(scene)
    origin, span = np.zeros((len(structures), 6)), np.zeros((len(structures), 3))
    for s, structure in enumerate(structures):
        span[s] = 0.0, low, high
        if structure.kind == "pile":
            origin[s, :2] = structure.center
            continue
        across = np.cross([0.0, 0.0, 1.0], structure.normal)
        length = np.linalg.norm(across)
        origin[s, :3] = structure.point
        origin[s, 3:] = across / length if length > 0.0 else (1.0, 0.0, 0.0)
        span[s, 0] = 0.5 * math.hypot(*case.domain.size)
    return origin, span

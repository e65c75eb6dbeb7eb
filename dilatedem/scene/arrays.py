"""From a scene to the arrays that kernels work on: what is constant, and how all bodies move at the start."""

import numpy as np

from dilatedem.case.schema import Case
from dilatedem.contact.consistent.dashpot import touch_damping
from dilatedem.errors import CaseError
from dilatedem.geometry.outline import perimeter
from dilatedem.geometry.shapes import Hulls, Shapes, pack_hulls, pack_shapes, tapered
from dilatedem.numerics.blocks import offsets
from dilatedem.numerics.frames import matrix_from_quaternion
from dilatedem.numerics.plain import inverse, turned
from dilatedem.scene.added_mass import with_water
from dilatedem.scene.carriage import pack_supports, places, velocities_at_start
from dilatedem.scene.joined import join_hulls, join_inertia
from dilatedem.scene.place import Scene
from dilatedem.scene.recipe import periodic_axes
from dilatedem.scene.records import flow_direction
from dilatedem.state.bodies import Bodies, Solids, WateredSolids, bodies_at_rest, joined_rows
from dilatedem.state.charts import Along, Charts
from dilatedem.state.modal import ModalSolids, bending
from dilatedem.state.model import Model
from dilatedem.state.records import records_of
from dilatedem.state.setting import CONTACT_SETTINGS, ContactSetting, Surroundings
from dilatedem.state.supports import Excursions, Supports, excursions_at_start, with_modes
from dilatedem.structures.held import HeldBody
from dilatedem.structures.kind import Part
from dilatedem.water.loads import WORKS, load_setting

#: a load map's heights reach from so many ice thicknesses below the water level to so many above
MAP_HEIGHTS = (-1.5, 1.0)


def build_model(case: Case, scene: Scene) -> Model:
    """The constant arrays of a run."""
    parts = _parts(scene)
    cores = [part for part in parts if not part.is_half_space]
    order = np.concatenate([scene.order, np.arange(scene.count, scene.count + len(cores))])
    normals = [part.normal for part in parts if part.is_half_space]
    shapes = pack_shapes(scene.shapes + [part.shape for part in cores], normals, order)
    shapes.plan_reach[scene.count :] = [part.plan_reach for part in parts]
    periodic = periodic_axes(case)
    _require_one_image(case, shapes.reach[: scene.count], cores, periodic)
    supports, hulls = pack_supports(scene), _hulls(scene)
    return Model(
        floating=scene.count,
        structure_of=np.concatenate([_held(scene), _numbers(scene)]).astype(np.int64),
        whole_of=scene.whole_of(),
        joined=joined_rows(scene.joints.floe),
        shapes=tapered(shapes, np.concatenate([np.zeros(scene.count), [part.taper for part in parts]])),
        hulls=hulls,
        solids=_solids_as_they_bend(case, scene, _solids(case, scene, supports, hulls), shapes),
        contact=_contact_setting(case),
        loads=load_setting(case),
        surroundings=Surroundings(*np.where(periodic, case.domain.size, 0.0).tolist()),
        charts=_pack_charts(case, scene),
        records=records_of([record.members for record in scene.records], flow_direction(case)),
        supports=supports,
    )


def _parts(scene: Scene) -> list[Part]:
    return [part for structure in scene.structures for part in structure.parts]


def _numbers(scene: Scene) -> np.ndarray:
    """The structure that each part belongs to, by number."""
    return np.repeat(np.arange(len(scene.structures)), [len(structure.parts) for structure in scene.structures])


def _held(scene: Scene) -> np.ndarray:
    """The structure that each body is by itself, being held fast; -1 = it is none."""
    found = np.full(scene.count, -1)
    for s, structure in enumerate(scene.structures):
        if isinstance(structure.about, HeldBody):
            found[structure.about.number] = s
    return found


def _hulls(scene: Scene) -> Hulls:
    hulls = pack_hulls(scene.shapes, scene.order)
    join_hulls(scene.joints, hulls)
    return hulls


def _contact_setting(case: Case) -> ContactSetting:
    contact = case.contact
    pressure, exponent = case.ice.crushing_pressure, case.ice.crushing_exponent
    setting, touch = CONTACT_SETTINGS[contact.model, pressure is not None], contact.damping_law == "touch"
    damping = touch_damping(contact.damping) if touch else contact.damping
    return setting(damping, touch, contact.stiffness_ratio, *([] if pressure is None else [pressure, exponent]))


def _require_one_image(case: Case, reach: np.ndarray, cores: list[Part], periodic: tuple[bool, bool]) -> None:
    """A pair of bodies, `reach` (n,) [m], may meet in one periodic image only, and no body its own.

    Raises CaseError where a period is too short.
    """
    largest, second, *_ = [*np.sort(reach)[::-1], 0.0]
    partner = max([second, *(part.plan_reach for part in cores)])
    least = 2.0 * (largest + partner)
    for axis, wraps in enumerate(periodic):
        if not wraps or case.domain.size[axis] > least:
            continue
        where = f"domain.size.{axis} = {case.domain.size[axis]:g}: is periodic and must be more than {least:.3g} m, or "
        if case.domain.size[axis] <= 2.0 * largest:
            number = int(np.argmax(reach))
            raise CaseError(f"{where}body {number}, {2.0 * largest:.3g} m across, could meet its own image")
        raise CaseError(f"{where}the two largest bodies could meet on both sides at once")


def _solids_as_they_bend(case: Case, scene: Scene, solids: Solids | WateredSolids, shapes: Shapes) -> Solids | ModalSolids:
    """The same bodies, with their modes where a case has bodies that bend."""
    if not case.bends:
        return solids
    from dilatedem.scene.bending import bent_solids  # it loads half of SciPy

    return bent_solids(case, scene, solids, shapes)


def _solids(case: Case, scene: Scene, supports: Supports, hulls: Hulls) -> Solids | WateredSolids:
    """Masses, elasticity and friction; structures give way by what their supports let them. At sea, with the water taken along."""
    bodies = scene.count
    of_structures = [_compliance(structure.about) for structure in scene.structures for _ in structure.parts]
    count = bodies + len(of_structures)
    mass, inverse_mass, compliance = np.zeros(count), np.zeros(count), np.zeros(count)
    inertia, inverse_inertia = np.zeros((count, 3, 3)), np.zeros((count, 3, 3))
    free = np.ones(bodies, np.bool_)
    compliance[scene.explicit : bodies], compliance[bodies:] = _compliance(scene.ice), of_structures
    for i, given in enumerate(case.body[: scene.explicit]):
        free[i], compliance[i] = not given.fixed, _compliance(given)
    mass[:bodies] = scene.mass()
    inertia[:bodies] = scene.unit_inertia() * scene.density[:, None, None]
    moving = np.flatnonzero(free)
    inverse_mass[moving] = 1.0 / mass[moving]
    inverse_inertia[moving] = inverse(inertia[moving])
    carried, give, seat = np.zeros(count, np.bool_), np.zeros((count, 2)), np.zeros((count, 3))
    parts, of_part = bodies + supports.part, np.repeat(supports.moving, np.diff(supports.part_start))
    carried[parts], give[parts] = True, supports.inverse_mass[of_part][:, [0, 2]]
    seat[parts] = turned(matrix_from_quaternion(supports.upright).swapaxes(1, 2), supports.seat)
    join_inertia(scene.joints, mass[:bodies], inertia[:bodies], inverse_mass[:bodies], inverse_inertia[:bodies])
    floe = np.concatenate([scene.joints.floe, np.full(count - bodies, -1)])
    solids = Solids(
        inverse_mass, mass, inertia, inverse_inertia, compliance, _friction(case, scene), carried, give, floe, seat
    )  # fmt: skip
    water = case.water
    density = water.density if water.enabled and water.added_mass else 0.0
    return with_water(solids, hulls, scene.volume(), density) if case.at_sea else solids


def _friction(case: Case, scene: Scene) -> np.ndarray:
    """(n,) coefficients of friction; a structure has that of the contacts unless it has its own."""
    usual = case.contact.friction
    own = [structure.about.friction for structure in scene.structures for _ in structure.parts]
    return np.array([usual] * scene.count + [usual if given is None else given for given in own])


def _compliance(material) -> float | np.ndarray:
    """A body's term of Liu 2015, Eq. (7) [1/Pa]."""
    return (1.0 - material.poisson_ratio * material.poisson_ratio) / material.elastic_modulus


def initial_bodies(case: Case, scene: Scene, model: Model) -> Bodies:
    """All bodies where and as fast as the case says."""
    parts = _parts(scene)
    bodies = bodies_at_rest(scene.count + len(parts), len(WORKS))
    bodies.position[: scene.count], bodies.orientation[: scene.count] = scene.position, scene.orientation
    bodies.velocity[scene.explicit : scene.count] = scene.ice.velocity
    for i, given in enumerate(case.body[: scene.explicit]):
        bodies.velocity[i], bodies.angular_velocity[i] = given.velocity, given.angular_velocity
        if not given.fixed:
            turn = matrix_from_quaternion(scene.orientation[i])
            spin = turned(turn.T, np.asarray(given.angular_velocity, float))
            bodies.angular_momentum[i] = turned(turn, turned(model.solids.inertia[i], spin))
    for i, part in enumerate(parts, start=scene.count):
        bodies.position[i], bodies.orientation[i] = part.position, part.orientation
    _start_driven(scene, model, bodies)
    bodies.middle_velocity[:] = bodies.velocity
    bodies.middle_angular_velocity[:] = bodies.angular_velocity
    bodies.middle_angular_momentum[:] = bodies.angular_momentum
    if isinstance(model.solids, ModalSolids):
        return bending(bodies, model.solids.mode_square.shape[1])
    return bodies


def _start_driven(scene: Scene, model: Model, bodies: Bodies) -> None:
    """The parts of structures that are driven, as fast as they are at the start."""
    supports = model.supports
    part = scene.count + supports.part
    u, v, spin = velocities_at_start(scene)[np.repeat(supports.moving, np.diff(supports.part_start))].T
    bodies.velocity[part, 0], bodies.velocity[part, 1] = u - spin * supports.seat[:, 1], v + spin * supports.seat[:, 0]
    bodies.angular_velocity[part, 2] = spin


def initial_excursions(scene: Scene, supports: Supports) -> Excursions:
    """All structures at their places, those that are driven as fast as their supports say; beams at rest."""
    return with_modes(supports, excursions_at_start(places(scene), velocities_at_start(scene)))


def _pack_charts(case: Case, scene: Scene) -> Charts:
    charts = [record.chart for record in scene.records]
    count = len(charts)
    mapped = np.array([chart is not None for chart in charts], np.bool_)
    outlines = [np.zeros((0, 2)) if chart is None or chart.outline is None else chart.outline for chart in charts]
    along, length = np.zeros(count, np.int64), np.zeros(count)
    origin, axis = np.zeros((count, 3)), np.zeros((count, 3))
    for s in np.flatnonzero(mapped):
        chart = charts[s]
        along[s] = chart.along
        origin[s] = scene.structures[s].about.place if chart.origin is None else chart.origin
        if chart.along == Along.LINE:
            axis[s], length[s] = chart.axis, chart.half
        elif chart.along == Along.ANGLE:
            axis[s] = [*chart.lean, 1.0]
        elif chart.along == Along.OUTLINE:
            length[s] = perimeter(chart.outline)
    return Charts(
        center=places(scene),
        map=np.where(mapped, np.cumsum(mapped) - 1, -1),
        along=along,
        origin=origin,
        axis=axis,
        length=length,
        heights=np.tile([factor * scene.ice.thickness.max(initial=case.ice.thickness) for factor in MAP_HEIGHTS], (count, 1)),
        outline_start=offsets([len(outline) for outline in outlines]),
        outline=np.concatenate([np.zeros((0, 2)), *outlines]),
    )

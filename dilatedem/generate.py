"""The ice field alone: field.vtu, field.png and field.json, without a simulation."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from dilatedem.case.schema import Case
from dilatedem.case.solids import Body
from dilatedem.errors import CaseError
from dilatedem.field.placement import (
    Disk,
    FloeField,
    HalfPlane,
    Obstacle,
    Region,
    equilibrium_height,
    ice_field,
)
from dilatedem.field.sizes import floe_count
from dilatedem.geometry import outline as outer_outline
from dilatedem.geometry.polyhedron import Polyhedron, convex_hull, prism
from dilatedem.geometry.shapes import BodyShape
from dilatedem.output.atomic import replacing
from dilatedem.output.folder import holds_run
from dilatedem.output.summary import write_json
from dilatedem.output.vtu import rotation_matrices, write_shapes

SIZE_MAP = "viridis"


@dataclass(frozen=True, eq=False)
class PlacedBody:
    """A body at t = 0.

    outer        outer shape in its own frame
    position     (3,) centroid [m]
    orientation  (4,) unit quaternion, body to world
    outline      (n, 2) [m] as seen from above, world coordinates
    plan_area    [m2]
    """

    outer: Polyhedron
    position: np.ndarray
    orientation: np.ndarray
    outline: np.ndarray
    plan_area: float


def generate(case: Case, out: Path, *, overwrite: bool = False) -> dict:
    """Write the ice field of `case` into the folder `out`; what is returned stands in field.json.

    An earlier field in the folder is replaced. Raises CaseError, with nothing written, if the folder holds a
    run (unless `overwrite`) or the field cannot be built.
    """
    out = Path(out)
    if holds_run(out) and not overwrite:
        raise CaseError(
            f"{out}: holds a run, which a new field could contradict; choose another folder (--out)"
        )
    try:
        explicit = [explicit_body(case, body) for body in case.body]
        field = floe_field(case, explicit)
        outlines = zip(field.outlines, field.plan_area, strict=True)
        bodies = explicit + [floating_floe(case, outline, area) for outline, area in outlines]
    except ValueError as fault:
        raise CaseError(f"the ice field cannot be built: {fault}") from fault
    facts = field_facts(case, field, explicit)
    save_picture = _picture(case, bodies)

    out.mkdir(parents=True, exist_ok=True)
    size = np.sqrt([body.plan_area for body in bodies])
    write_shapes(
        out / "field.vtu",
        [body.outer for body in bodies],
        np.reshape([body.position for body in bodies], (-1, 3)),
        np.reshape([body.orientation for body in bodies], (-1, 4)),
        {"body": np.arange(len(bodies)), "floe_size": size},
    )
    with replacing(out / "field.png") as temporary:
        save_picture(temporary)
    write_json(out / "field.json", facts)
    return facts


def floe_field(case: Case, explicit: list[PlacedBody]) -> FloeField:
    """The generated floes of a case, clear of its structures and of its explicit bodies."""
    if case.field.source == "bodies":
        return FloeField([], np.zeros(0), 1.0, 0.0, 0)
    size = case.domain.size
    count = case.field.floe_count
    if count is None:
        count = floe_count(size, case.field.concentration, case.field.floe_size)
    return ice_field(
        size,
        count,
        case.field.concentration,
        periodic=[side == "periodic" for side in (case.domain.x_boundary, case.domain.y_boundary)],
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
            # Where it stands out furthest towards the ice, over the heights that a floe can take up.
            reach = slope * structure.point[2] + abs(slope) * case.ice.thickness
            foot = np.array(structure.point[:2]) + across * reach
            obstacles.append(HalfPlane(tuple(foot), tuple(across)))
    return obstacles


def floating_floe(case: Case, outline: np.ndarray, plan_area: float) -> PlacedBody:
    """A floe of the case's ice over an outer outline (n, 2) [m]; plan_area [m2] that of the dilated floe."""
    shape, centroid = _floe_shape(outline, case.ice.thickness, case.ice.dilated_radius)
    height = _floating_height(case, shape, case.ice.density)
    position = np.array([centroid[0], centroid[1], height])
    return PlacedBody(shape.outer, position, np.array([1.0, 0.0, 0.0, 0.0]), outline, float(plan_area))


def explicit_body(case: Case, body: Body) -> PlacedBody:
    """A [[body]] entry in its place at t = 0."""
    if body.outline is not None:
        shape, centroid = _floe_shape(
            outer_outline.prepare(body.outline), body.thickness, body.dilated_radius
        )
        position = np.array([*centroid[:2], _floating_height(case, shape, body.density)])
    else:
        shape, centroid = BodyShape.of_core(convex_hull(body.vertices), body.dilated_radius)
        position = np.zeros(3)
    if body.position is not None:
        position[: len(body.position)] = body.position
    orientation = _quaternion(body.rotation)
    corners = shape.outer.vertices @ rotation_matrices(orientation)[0].T + position
    shadow = convex_hull(corners * [1.0, 1.0, 0.0])
    seen = shadow.vertices[:, :2]
    if outer_outline.area(seen) < 0.0:
        seen = seen[::-1]
    return PlacedBody(shape.outer, position, orientation, seen, float(outer_outline.area(seen)))


def _floe_shape(outline: np.ndarray, thickness: float, radius: float) -> tuple[BodyShape, np.ndarray]:
    half = 0.5 * thickness - radius
    return BodyShape.of_core(prism(outer_outline.erode(outline, radius), -half, half), radius)


def _floating_height(case: Case, shape: BodyShape, density: float) -> float:
    return equilibrium_height(shape.outer, density, case.water.density) if case.water.enabled else 0.0


def _quaternion(rotation_vector) -> np.ndarray:
    angle = math.hypot(*rotation_vector)
    axis = np.array(rotation_vector) / angle if angle > 0.0 else np.zeros(3)
    return np.array([math.cos(0.5 * angle), *(math.sin(0.5 * angle) * axis)])


def field_facts(case: Case, field: FloeField, explicit: list[PlacedBody]) -> dict:
    """What field.json says: counts, concentration, sizes (square roots of plan areas) and seed."""
    domain_area = math.prod(case.domain.size)
    generated = case.field.source == "voronoi"
    areas = field.plan_area if generated else np.array([body.plan_area for body in explicit])
    size = np.sqrt(areas)
    return {
        "source": case.field.source,
        "seed": case.field.seed if generated else None,
        "count": len(areas),
        "explicit_bodies": len(explicit),
        "left_out_at_structures": field.left_out,
        "concentration_asked": case.field.concentration if generated else None,
        "concentration": field.concentration if generated else float(areas.sum() / domain_area),
        "concentration_without_left_out": float(areas.sum() / domain_area),
        "floe_size_m": {
            "asked": case.field.floe_size if generated else None,
            "root_of_mean_area": float(np.sqrt(areas.mean())) if len(areas) else None,
            "mean": float(size.mean()) if len(areas) else None,
            "median": float(np.median(size)) if len(areas) else None,
            "min": float(size.min()) if len(areas) else None,
            "max": float(size.max()) if len(areas) else None,
        },
    }


def _picture(case: Case, bodies: list[PlacedBody]) -> Callable[[Path], None]:
    """The plan of the field, floes coloured by size; call the result with a path to save it there as PNG."""
    # Imported here: matplotlib takes half a second, which a wrong case should not wait for.
    from dilatedem.post import canvas, plan
    from dilatedem.post.figures_field import panel_height
    from dilatedem.post.read import RunFolder

    # The figures of a run are drawn from its folder; this is one that holds nothing but the case.
    scene = RunFolder(
        path=Path(),
        case=case.model_dump(mode="json"),
        summary={},
        forces={},
        energy={},
        snapshots=[],
    )

    @canvas.styled
    def draw() -> canvas.Drawing:
        outlines = [body.outline for body in bodies]
        view = plan.choose_view(scene, [outlines])
        figure = canvas.new_figure(6.4, panel_height(view, 5.6))
        axes = figure.add_subplot()
        plan.dress(axes, scene, view, water=canvas.WATER)
        plan.draw_domain(axes, scene)
        size = np.sqrt([body.plan_area for body in bodies])
        style = {"cmap": SIZE_MAP, "edgecolors": canvas.ICE_EDGE, "linewidths": 0.4}
        floes = plan.draw_floes(axes, scene, view, outlines, array=size, **style)
        plan.draw_structures(axes, scene, view)
        plan.draw_current(axes, scene)
        bar = figure.colorbar(floes, ax=axes, shrink=0.85, pad=0.02)
        bar.set_label("Floe size, root of the plan area (m)")
        axes.set_title(_title(case, len(bodies)))
        return canvas.Drawing("field", "Ice field", "", figure)

    drawing = draw()
    return lambda path: drawing.figure.savefig(
        path, format="png", dpi=canvas.PNG_DPI, metadata={"Software": None}
    )


def _title(case: Case, count: int) -> str:
    floes = count - len(case.body)
    parts = [f"{floes} floes"] if case.field.source == "voronoi" else []
    if case.body:
        parts.append(f"{len(case.body)} {'body' if len(case.body) == 1 else 'bodies'}")
    return " and ".join(parts) + (f", seed {case.field.seed}" if case.field.source == "voronoi" else "")

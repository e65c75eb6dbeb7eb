"""The generated ice of a case: floes in plan, and what each is made of."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace

import numpy as np

from dilatedem.case.schema import Case
from dilatedem.errors import CaseError
from dilatedem.field.distribution import thicknesses
from dilatedem.field.drawing import VELOCITY, read
from dilatedem.field.endless import natural
from dilatedem.field.obstacles import Obstacle
from dilatedem.field.placement import FloeField, Parts, dilated_areas, ice_field, touching_obstacles
from dilatedem.field.stream import Stream
from dilatedem.field.survey import CHANGES, Report, Wishes, surveyed
from dilatedem.geometry import outline as plan
from dilatedem.scene.inflow import field_of, stream_of
from dilatedem.scene.recipe import periodic_axes, ragged_axes, recipe_of, whole_axes
from dilatedem.scene.room import MOST_FACE_CORNERS, generated_floes

#: of the two sequences of random numbers of a seed, that of thicknesses: with them or without, the field is the same in plan
THICKNESS = 1


@dataclass(frozen=True, eq=False)
class IceProperties:
    """Of n floes: thickness [m], density [kg/m3], elastic_modulus [Pa], poisson_ratio, all (n,), and velocity (n, 3) [m/s]."""

    thickness: np.ndarray
    density: np.ndarray
    elastic_modulus: np.ndarray
    poisson_ratio: np.ndarray
    velocity: np.ndarray

    @classmethod
    def of_case(cls, case: Case, count: int) -> IceProperties:
        """What floes have that say nothing of their own."""
        ice = case.ice
        each = [np.full(count, value) for value in (ice.thickness, ice.density, ice.elastic_modulus, ice.poisson_ratio)]
        return cls(*each, np.tile(np.array(case.ice_velocity, float), (count, 1)))

    def where(self, wanted: np.ndarray) -> IceProperties:
        """Of those floes that are `wanted`, a mask (n,) or numbers (m,)."""
        return IceProperties(*(getattr(self, field.name)[wanted] for field in fields(self)))


@dataclass(frozen=True, eq=False)
class Floes:
    """The generated floes of a case, what was changed in outlines of a file, and the stream that floes are part of that enter."""

    field: FloeField
    ice: IceProperties
    report: Report | None = None
    stream: Stream | None = None


def floes_of(case: Case, bodies: Sequence[Obstacle]) -> Floes:
    """The generated floes, clear of structures and explicit bodies. Raises ValueError or CaseError if they cannot be."""
    return {"voronoi": _cut, "file": _drawn, "bodies": _none}[case.field.source](case, bodies)


def _none(case: Case, bodies: Sequence[Obstacle]) -> Floes:
    nothing = np.zeros(0)
    return Floes(FloeField(plan.Outlines.of([]), nothing, nothing, 1.0, 0.0, nothing.astype(bool)), IceProperties.of_case(case, 0))


def _cut(case: Case, bodies: Sequence[Obstacle]) -> Floes:
    """Cells of the case's recipe, shrunk to its concentration."""
    count, recipe = generated_floes(case), recipe_of(case)
    if case.domain.inflow is not None:
        return _entered(case, stream_of(case, count), bodies)
    made = recipe.count(np.array(case.domain.size), count, whole_axes(case))
    ice = replace(IceProperties.of_case(case, made), thickness=varied(case, made))
    field = ice_field(
        case.domain.size,
        count,
        case.field.concentration,
        periodic=periodic_axes(case),
        seed=case.field.seed,
        dilated_radius=case.ice.dilated_radius,
        obstacles=_obstacles(case, ice.thickness, bodies),
        recipe=recipe,
        ragged=ragged_axes(case),
    )
    return Floes(field, ice.where(field.kept))


def _entered(case: Case, stream: Stream, bodies: Sequence[Obstacle]) -> Floes:
    """What is there at t = 0 of ice without an end."""
    obstacles = _obstacles(case, varied(case, stream.count), bodies)
    field, which = field_of(case, stream, obstacles, periodic_axes(case))
    return Floes(field, ice_of_stream(case, stream, which), stream=stream)


def ice_of_stream(case: Case, stream: Stream, which: np.ndarray) -> IceProperties:
    """What floes of a stream are made of; which (n,): their numbers among its cells. So many in a row have the thicknesses of as
    large a field that ends."""
    ice, thickness = IceProperties.of_case(case, len(which)), np.empty(len(which))
    row, place = np.divmod(which, stream.count)
    for number in np.unique(row):
        own = row == number
        thickness[own] = varied(case, stream.count, int(number))[place[own]]
    return replace(ice, thickness=thickness)


def _drawn(case: Case, bodies: Sequence[Obstacle]) -> Floes:
    """Outlines of the case's file."""
    field, size, radius = case.field, np.array(case.domain.size), case.ice.dilated_radius
    walls = [boundary == "wall" for boundary in (case.domain.x_boundary, case.domain.y_boundary)]
    origin = None if field.origin == "centred" else field.origin
    wishes = Wishes(field.scale, origin, field.tolerance, field.smallest, field.not_convex == "parts")
    try:
        found = surveyed(read(field.file), wishes, size, periodic_axes(case), walls, radius)
    except ValueError as fault:
        raise CaseError(f"field.file: {field.file} {fault}") from fault
    outlines, floe = found.outlines, found.floe
    if not len(outlines):
        raise CaseError(_no_floe(case, found.report))
    if (most := int(outlines.sides.max(initial=0))) > MOST_FACE_CORNERS:
        raise CaseError(
            f"field.tolerance = {field.tolerance:g}: leaves an outline with {most} corners, and at most {MOST_FACE_CORNERS} can be "
            "handled; take a larger one"
        )
    count = len(found.properties)
    ice = replace(IceProperties.of_case(case, count), thickness=varied(case, count))
    ice = _told(ice, found.properties, 2.0 * radius).where(floe)
    areas, _ = dilated_areas(outlines.by_sides(), len(outlines), 1.0, radius)
    touching = touching_obstacles(outlines, _obstacles(case, ice.thickness, bodies), size, periodic_axes(case))
    kept = ~np.isin(floe, floe[touching])  # a floe goes as a whole
    parts = Parts(floe[kept], floe, found.inner[kept])
    made = FloeField(outlines.where(kept), areas[kept], areas, 1.0, float(areas.sum() / np.prod(size)), kept, parts)
    return Floes(made, ice.where(kept), found.report)


def _no_floe(case: Case, report: Report) -> str:
    """What to say where nothing is left of a file."""
    low_x, low_y, high_x, high_y = report.bounds
    gone = {CHANGES[name]: change.outlines for name, change in report.changes.items() if change.outlines and not change.after}
    why = "; ".join(f"{what}: {count}" for what, count in gone.items())
    return (
        f"field.file: {case.field.file} leaves no floe in the domain ({why}): its outlines lie at x = {low_x:.6g} to {high_x:.6g} "
        f'm and y = {low_y:.6g} to {high_y:.6g} m; see field.scale (metres per unit), field.origin = "centred" and field.smallest'
    )


def _obstacles(case: Case, thickness: np.ndarray, bodies: Sequence[Obstacle]) -> list[Obstacle]:
    """What no floe may touch at the start; thickness (n,) [m] of the floes."""
    thickest = float(thickness.max(initial=case.ice.thickness if not len(thickness) else 0.0))
    return [*(obstacle for structure in case.structure for obstacle in structure.obstacles(thickest)), *bodies]


def _told(ice: IceProperties, told: Sequence[dict], least: float) -> IceProperties:
    """The same with what a file says of floes (n,) by themselves. Raises CaseError for one thinner than `least` [m]."""
    values = {field.name: getattr(ice, field.name).copy() for field in fields(ice)}
    for floe, properties in enumerate(told):
        for name, value in properties.items():
            values[name][floe] = (*value, 0.0) if name == VELOCITY else value
    thin = values["thickness"] <= least
    if thin.any() and len(set(values["thickness"])) > 1:
        raise CaseError(
            f"field.file: {int(thin.sum())} of {len(thin)} floes are no thicker than twice the dilated radius, {least:g} m, the "
            f"thinnest {values['thickness'].min():.3g} m: take a smaller ice.dilated_radius, or leave them out"
        )
    return IceProperties(**values)


def varied(case: Case, count: int, number: int = 0) -> np.ndarray:
    """(count,) thicknesses [m] that the case asks for. Raises ValueError for one that its rounded edges do not fit into.

    number: of several such sets the ones that differ in their order.
    """
    mean, spread, least = case.ice.thickness, case.ice.thickness_spread, 2.0 * case.ice.dilated_radius
    generator = np.random.default_rng([case.field.seed, THICKNESS, *([natural(number)] if number else [])])
    thickness = thicknesses(count, mean, spread, generator)
    if spread and (thin := int(np.count_nonzero(thickness <= least))):
        raise ValueError(
            f"{thin} of {len(thickness)} floes are thinner than twice the dilated radius, {least:g} m, the thinnest "
            f"{thickness.min():.3g} m: take a smaller ice.thickness_spread or ice.dilated_radius"
        )
    return thickness


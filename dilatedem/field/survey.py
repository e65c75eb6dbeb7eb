"""From areas drawn elsewhere to floes: mended, thinned, convex and apart, every change counted with the areas before and after."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import product
from typing import Any

import numpy as np
import shapely

from dilatedem.field.drawing import Drawing
from dilatedem.field.partition import Part, convex_parts
from dilatedem.field.placement import VANISHING, dilated_areas
from dilatedem.geometry import outline as plan
from dilatedem.numerics.plain import dot, norm

#: share of the smaller of two outlines up to which an overlap is cut in two; with more the smaller one is left out
MOST_SHARED = 0.5
#: the same below which it is round-off
NEGLIGIBLE = 1e-12
#: areas that differ by less than this part of them are the same
ROUND_OFF = 1e-9


@dataclass
class Change:
    """What was done to how many outlines, and their areas [m2] before and after."""

    outlines: int = 0
    before: float = 0.0
    after: float = 0.0

    def of(self, before: Sequence | np.ndarray, after: Sequence | np.ndarray) -> None:
        """Counts outlines, by their areas."""
        self.outlines += len(before)
        self.before += float(np.sum(before))
        self.after += float(np.sum(after))


#: what is done, in this order; the words of reports
CHANGES = {
    "multipolygons": "areas of several polygons split",
    "mended": "outlines that cross themselves mended",
    "holes": "outlines with holes filled",
    "thinned": "outlines thinned",
    "hulls": "outlines that are not convex replaced by their hulls",
    "parts": "outlines that are not convex cut into convex parts",
    "overlaps": "outlines cut where they overlap",
    "covered": "outlines left out that others cover",
    "slivers": "outlines left out that are too small",
    "outside": "outlines left out that lie outside of the domain",
    "at_walls": "outlines left out at walls",
}


@dataclass
class Report:
    """What was changed; areas in m2. no_areas: entries that are points or lines; points, area: of all polygons as drawn, then of
    the floes that came out of them; bounds [m]: least x and y, largest x and y of what was drawn, in place."""

    entries: int
    no_areas: int = 0
    polygons: int = 0
    points: tuple[int, int] = (0, 0)
    area: tuple[float, float] = (0.0, 0.0)
    floes: int = 0
    bounds: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0)
    unused: tuple[str, ...] = ()
    changes: dict[str, Change] = field(default_factory=lambda: {name: Change() for name in CHANGES})

    def facts(self) -> dict:
        """For files: everything that happened."""
        told = {
            name: {"outlines": change.outlines, "area_before_m2": change.before, "area_after_m2": change.after}
            for name, change in self.changes.items()
            if change.outlines
        }
        return {
            "entries": self.entries, "no_areas": self.no_areas, "polygons": self.polygons, "floes": self.floes,
            "points_before": self.points[0], "points_after": self.points[1],
            "area_before_m2": self.area[0], "area_after_m2": self.area[1], "changes": told, "unused": list(self.unused),
        }  # fmt: skip

    def sentences(self) -> list[str]:
        """For the screen, a line each."""
        return sentences(self.facts())


def sentences(facts: dict) -> list[str]:
    """Lines of what a `Report` holds; facts: as it gives them for files."""
    counts = (facts["polygons"], "outline"), (facts["floes"], "floe")
    before, after = (f"{count} {word}{'s' * (count != 1)}" for count, word in counts)
    areas = f"of {facts['area_before_m2']:.5g} m2 became {after} of {facts['area_after_m2']:.5g} m2"
    lines = [f"{before} {areas} ({facts['points_before']} points, now {facts['points_after']})"]
    if facts["no_areas"]:
        lines.append(f"entries left out that are points or lines, no areas: {facts['no_areas']}")
    for name, change in facts["changes"].items():
        areas = f"of {change['area_before_m2']:.5g} m2, now {change['area_after_m2']:.5g} m2"
        lines.append(f"{CHANGES[name]}: {change['outlines']}, {areas}")
    if facts["unused"]:
        lines.append(f"properties that are not taken: {', '.join(facts['unused'])}")
    return lines


@dataclass(frozen=True, eq=False)
class Survey:
    """Floes in plan, of one or several convex parts each.

    outlines    of all parts [m], those of a floe one after another
    floe        (parts,) the floe that each is part of, from 0 on
    inner       (parts, 3) length [m] of the sides that lie within the floe, and its first moments about the origin [m2]
    properties  of each floe, as far as they are given
    """

    outlines: plan.Outlines
    floe: np.ndarray
    inner: np.ndarray
    properties: list[dict]
    report: Report


@dataclass(frozen=True)
class Wishes:
    """How areas are taken: metres per unit; where the file's origin goes (2,) [m], None = the middle of all areas comes to that of
    the domain; tolerance [m] within which points are left out; size [m], root of the area, of the smallest floe; whether outlines
    that are not convex are cut into parts, or become their hulls."""

    scale: float
    origin: tuple[float, float] | None
    tolerance: float
    smallest: float
    parts: bool


def surveyed(
    drawing: Drawing, wishes: Wishes, size: np.ndarray, periodic: Sequence[bool], walls: Sequence[bool], radius: float
) -> Survey:
    """The floes of a drawing in a domain of `size` (2,) [m], apart from each other.

    walls: whether sides along x and along y are walls, which no floe may touch; radius: dilated radius [m]: floes that are narrower
    than their round edges are left out.
    """
    report = Report(drawing.entries, drawing.entries - len(drawing.outlines), unused=drawing.unused)
    polygons, owner = _polygons(drawing, wishes, report)
    polygons = _thinned(polygons, wishes.tolerance, report)
    if not wishes.parts:
        polygons = _convex(polygons, report)
    polygons, stay = _at_home(polygons, size, periodic, walls, report)
    owner = owner[stay]
    polygons = _apart(polygons, np.where(periodic, size, 0.0), report)
    parts, floe = _wide_enough(polygons, wishes.smallest, radius, report)
    stay, floe = np.unique(floe, return_inverse=True)
    outlines = plan.Outlines.of([part.outline for part in parts])
    report.floes, report.points = len(stay), (report.points[0], len(outlines.points))
    report.area = (report.area[0], float(sum(plan.area(outline) for outline in outlines)))
    properties = [drawing.outlines[number].properties for number in owner[stay]]
    return Survey(outlines, floe, np.array([part.inner for part in parts]).reshape(-1, 3), properties, report)


def _polygons(drawing: Drawing, wishes: Wishes, report: Report) -> tuple[np.ndarray, np.ndarray]:
    """Single polygons [m] in place, without holes and crossings, and the number of the outline that each belongs to."""
    areas = np.array([outline.area for outline in drawing.outlines])
    areas = shapely.transform(areas, lambda points: points * wishes.scale)
    if wishes.origin is None:
        low_x, low_y, high_x, high_y = shapely.total_bounds(areas)
        shift = -0.5 * np.array([low_x + high_x, low_y + high_y])
    else:
        shift = np.array(wishes.origin)
    areas = _moved(areas, shift)
    several = shapely.get_num_geometries(areas) > 1
    report.changes["multipolygons"].of(shapely.area(areas[several]), shapely.area(areas[several]))
    polygons, owner = shapely.get_parts(areas, return_index=True)
    report.bounds = tuple(shapely.total_bounds(areas).tolist())
    report.polygons, report.area = len(polygons), (float(shapely.area(polygons).sum()), 0.0)
    report.points = (int(shapely.get_num_coordinates(polygons).sum()) - len(polygons), 0)
    crossing = ~shapely.is_valid(polygons)
    if crossing.any():
        mended = np.where(crossing, shapely.make_valid(polygons, method="structure", keep_collapsed=False), polygons)
        report.changes["mended"].of(shapely.area(polygons[crossing]), shapely.area(mended[crossing]))
        polygons, index = shapely.get_parts(mended, return_index=True)
        is_area = (shapely.get_type_id(polygons) == shapely.GeometryType.POLYGON) & ~shapely.is_empty(polygons)
        polygons, owner = polygons[is_area], owner[index[is_area]]
    holed = shapely.get_num_interior_rings(polygons) > 0
    filled = shapely.polygons(shapely.get_exterior_ring(polygons))
    report.changes["holes"].of(shapely.area(polygons[holed]), shapely.area(filled[holed]))
    return filled, owner


def _thinned(polygons: np.ndarray, tolerance: float, report: Report) -> np.ndarray:
    """Without points that lie within `tolerance` [m] of what is left (Douglas & Peucker 1973)."""
    if tolerance == 0.0:
        return polygons
    thin = shapely.simplify(polygons, tolerance, preserve_topology=True)
    fewer = shapely.get_num_coordinates(thin) < shapely.get_num_coordinates(polygons)
    report.changes["thinned"].of(shapely.area(polygons[fewer]), shapely.area(thin[fewer]))
    return thin


def _convex(polygons: np.ndarray, report: Report) -> np.ndarray:
    """Hulls of those that are not convex."""
    hulls, bent = shapely.convex_hull(polygons), _is_bent(polygons)
    report.changes["hulls"].of(shapely.area(polygons[bent]), shapely.area(hulls[bent]))
    return hulls


def _is_bent(polygons: np.ndarray) -> np.ndarray:
    """(n,) whether polygons are not convex."""
    return shapely.area(shapely.convex_hull(polygons)) > (1.0 + ROUND_OFF) * shapely.area(polygons)


def _at_home(
    polygons: np.ndarray, size: np.ndarray, periodic: Sequence[bool], walls: Sequence[bool], report: Report
) -> tuple[np.ndarray, np.ndarray]:
    """Those whose centroids lie in the domain and that touch no wall, and their numbers."""
    middle = shapely.get_coordinates(shapely.centroid(polygons))
    inside = (np.abs(middle) <= 0.5 * size).all(axis=1)
    reach = np.abs(shapely.bounds(polygons)).reshape(-1, 2, 2).max(axis=1)
    free = (~np.array(walls) | (reach < 0.5 * size)).all(axis=1)
    for name, gone in (("outside", ~inside), ("at_walls", inside & ~free)):
        report.changes[name].of(shapely.area(polygons[gone]), np.zeros(int(gone.sum())))
    stay = np.flatnonzero(inside & free)
    return polygons[stay], stay


def _apart(polygons: np.ndarray, period: np.ndarray, report: Report) -> np.ndarray:
    """The same polygons, which no longer share anything; empty ones are covered by others.

    Of two convex ones that overlap each keeps what lies on its side of the line through the points where the outlines cross: both
    stay convex. Of others the smaller one loses what they share, and what that cuts off. Where they share more than MOST_SHARED of
    the smaller one, or convex ones cross more often, it becomes empty.
    """
    apart = polygons.copy()
    for i, j, shift in _overlapping(polygons, period):
        a, b = apart[i], _moved(apart[j], shift)
        shared, least = shapely.area(shapely.intersection(a, b)), min(shapely.area(a), shapely.area(b))
        if shared <= NEGLIGIBLE * least:
            continue
        kept = _halves if not _is_bent(np.array([a, b])).any() else _without_shared
        halves = kept(a, b) if shared <= MOST_SHARED * least else None
        if halves is None:
            apart[i if shapely.area(a) <= shapely.area(b) else j] = shapely.Polygon()
        else:
            apart[i], apart[j] = halves[0], _moved(halves[1], -shift)
    before, after = shapely.area(polygons), shapely.area(apart)
    covered, cut = after == 0.0, (after > 0.0) & (after < (1.0 - ROUND_OFF) * before)
    report.changes["overlaps"].of(before[cut], after[cut])
    report.changes["covered"].of(before[covered], after[covered])
    return apart


def _overlapping(polygons: np.ndarray, period: np.ndarray) -> Iterator[tuple[int, int, np.ndarray]]:
    """Pairs i < j of which j, moved by a shift (2,) [m], may overlap i; first those that need no shift."""
    tree = shapely.STRtree(polygons)
    for step in product(*((0.0, -1.0, 1.0) if length else (0.0,) for length in period)):
        shift = period * step
        j, i = tree.query(_moved(polygons, shift), predicate="intersects")
        for pair in sorted(zip(i.tolist(), j.tolist(), strict=True)):
            if pair[0] < pair[1]:
                yield *pair, shift


def _halves(a: shapely.Geometry, b: shapely.Geometry) -> tuple[shapely.Geometry, shapely.Geometry] | None:
    """What two convex polygons keep that overlap; None where their outlines cross more than twice."""
    rests = shapely.difference(a, b), shapely.difference(b, a)
    ends = shapely.get_coordinates(shapely.intersection(a.exterior, b.exterior))
    if len(ends) < 2 or any(rest.geom_type != "Polygon" for rest in rests):
        return None
    length = norm(ends[:, None] - ends)
    first, second = ends[list(np.unravel_index(length.argmax(), length.shape))]
    return _side(a, first, second, rests[0]), _side(b, first, second, rests[1])


def _without_shared(a: shapely.Geometry, b: shapely.Geometry) -> tuple[shapely.Geometry, shapely.Geometry]:
    """Two polygons, the smaller one without what they share; of several pieces it keeps the largest."""
    if shapely.area(a) < shapely.area(b):
        return _without_shared(b, a)[::-1]
    pieces = shapely.get_parts(shapely.difference(b, a))
    return a, shapely.polygons(pieces[shapely.area(pieces).argmax()].exterior)


def _side(polygon: shapely.Geometry, first: np.ndarray, second: np.ndarray, rest: shapely.Geometry) -> shapely.Geometry:
    """The part of a convex polygon on that side of the line through two points (2,) [m] on which `rest` lies."""
    along = (second - first) / norm(second - first)
    across = np.array([-along[1], along[0]])
    if dot(shapely.get_coordinates(rest.centroid)[0] - first, across) < 0.0:
        across = -across
    low_x, low_y, high_x, high_y = polygon.bounds
    far = (high_x - low_x) + (high_y - low_y)  # no point of it is farther from one on it
    corners = [first - far * along, first + far * along, first + far * (along + across), first - far * (along - across)]
    return shapely.intersection(polygon, shapely.Polygon(corners))


def _wide_enough(polygons: np.ndarray, smallest: float, radius: float, report: Report) -> tuple[list[Part], np.ndarray]:
    """Convex parts of those polygons that are no smaller than `smallest`, as far as they are wider than their round edges, and the
    number of the polygon that each is part of."""
    large = np.flatnonzero((shapely.area(polygons) >= smallest**2) & ~shapely.is_empty(polygons))
    bent = large[_is_bent(polygons[large])]
    cut = [(number, part) for number in large for part in (convex_parts if number in bent else _whole)(polygons[number])]
    found = [(number, Part(outline, part.cuts)) for number, part in cut if (outline := _prepared(part.outline)) is not None]
    outlines = plan.Outlines.of([part.outline for _, part in found])
    _, narrow = dilated_areas(outlines.by_sides(), len(outlines), 1.0 - VANISHING, radius)
    parts = [part for (_, part), left_out in zip(found, narrow, strict=True) if not left_out]
    number = np.array([number for number, _ in found], np.int64)[~narrow]
    gone = np.setdiff1d(np.flatnonzero(~shapely.is_empty(polygons)), number)
    report.changes["slivers"].of(shapely.area(polygons[gone]), np.zeros(len(gone)))
    areas = np.bincount(number, [plan.area(part.outline) for part in parts], len(polygons))
    bent = np.intersect1d(bent, number)
    report.changes["parts"].of(shapely.area(polygons[bent]), areas[bent])
    return parts, number


def _whole(polygon: shapely.Geometry) -> list[Part]:
    return [Part(shapely.get_coordinates(polygon.exterior), np.zeros((0, 2, 2)))]


def _prepared(outline: np.ndarray) -> np.ndarray | None:
    """The corners of a convex outline, counter-clockwise; None for one that is thinner than round-off."""
    try:
        return plan.prepare(outline)
    except ValueError:
        return None


def _moved(shapes: Any, shift: np.ndarray) -> Any:
    return shapely.transform(shapes, lambda points: points + shift)

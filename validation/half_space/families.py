"""The families of poses from point to line to face: a case is its geometry, its overlap profile and the plain pieces for it."""

from dataclasses import dataclass

import numpy as np

from validation.half_space import pieces
from validation.half_space.profile import Profile, crossing, curvatures, cylinder, rounded_core

#: dilated radius [m], height of a floe's edge (core) [m], width of its side face (core) [m]
RADIUS, HEIGHT, WIDTH = 0.04, 0.42, 1.0
OVERLAPS = (1e-3, 1e-4)
TILTS = (0.0, 1e-4, 3e-4, 1e-3, 3e-3, 1e-2, 3e-2, 0.1, 0.3)
ANGLES = (90, 45, 20, 10, 5, 2, 1)
NONE = float("nan")


@dataclass(frozen=True)
class Case:
    """geometry: what the columns of reference.csv say [m, rad, degrees]; point, line, face, pieces: F/E* [m2] of the plain laws,
    `pieces` the one that a choice among them takes; widened: force and energy W/E* [m3] of the one law for all."""

    family: str
    profile: Profile
    geometry: dict[str, float | str]
    point: float
    pieces: float
    line: float = NONE
    face: float = NONE
    widened: tuple[float, float] = (NONE, NONE)


def lines() -> list[Case]:
    """1: parallel line contact of finite length, from short to long."""
    cases = []
    for radius in (0.02, 0.04, 2.0):
        for overlap in OVERLAPS:
            for ends in ("rounded", "cut"):
                for length in (0.01, 0.02, 0.05, 0.1, 0.2, HEIGHT):
                    end = RADIUS if ends == "rounded" else None
                    point = pieces.point(1 / max(radius, RADIUS), 1 / min(radius, RADIUS), overlap)[0]
                    line = pieces.line(length, radius, overlap)
                    best = pieces.largest(point if end else NONE, line, NONE, length, radius)
                    widened = pieces.widened(length, 0.0, (RADIUS, radius), overlap, 0.0)[:2] if end else (NONE, NONE)
                    geometry = {"radius": radius, "end_radius": end or 0.0, "length": length, "ends": ends, "overlap": overlap}
                    profile = cylinder(length, radius, end, overlap)
                    cases.append(Case("line", profile, geometry, point if end else NONE, best, line, widened=widened))
    return cases


def core(family: str, length: float, width: float, overlap: float, tilt: float = 0.0) -> Case:
    """A rounded core (an edge if width = 0) on a flat, its depth falling along `length` by `tilt`."""
    wet = min(length, overlap / tilt) if tilt > 0 else length
    middle = overlap - tilt * wet / 2
    point = pieces.point(1 / RADIUS, 1 / RADIUS, overlap)[0]
    if width == 0:
        along, face = (wet, middle), NONE
    else:  # the deepest edge: the rim at x = 0, or the longer side when nothing tilts
        along, face = (width if tilt > 0 else max(length, width), overlap), pieces.face(wet, width, middle)
    line = pieces.line(along[0], RADIUS, along[1])
    geometry = {"radius": RADIUS, "end_radius": RADIUS, "length": length, "width": width, "tilt": tilt, "overlap": overlap}
    best = pieces.largest(point, line, face, along[0], RADIUS)
    widened = pieces.widened(length, width, (RADIUS, RADIUS), overlap, tilt)[:2]
    return Case(family, rounded_core(length, width, RADIUS, overlap, tilt=tilt), geometry, point, best, line, face, widened)


def tilted_edges() -> list[Case]:
    """2: from a line to its corner."""
    return [core("tilted edge", HEIGHT, 0.0, overlap, tilt) for overlap in OVERLAPS for tilt in TILTS]


def rolled_faces() -> list[Case]:
    """3: from a face to its vertical edge (0.42 m), and to its long edge (1 m)."""
    sides = ((WIDTH, HEIGHT), (HEIGHT, WIDTH))
    return [core("rolled face", *side, overlap, tilt) for side in sides for overlap in OVERLAPS for tilt in TILTS]


def strips() -> list[Case]:
    """4: from a line to a face by its width."""
    return [core("strip", HEIGHT, width, overlap) for overlap in OVERLAPS for width in (0.0, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2)]


def crossings() -> list[Case]:
    """5: cylinders crossing at their middles, without end and (but for a pile, radius 2 m) 0.42 m long."""
    cases = []
    overlap = 1e-3
    for other in (RADIUS, 2.0):
        for limited in (False, True):
            for angle in ANGLES:
                length = HEIGHT if limited else np.inf
                second = (other, length if other == RADIUS else np.inf)
                small, large, _ = curvatures(RADIUS, other, np.radians(angle))
                point = pieces.point(small, large, overlap)[0]
                line = pieces.line(HEIGHT, 1 / (1 / RADIUS + 1 / other), overlap) if limited else NONE
                geometry = {"radius": RADIUS, "radius_other": other, "length": length, "angle": angle, "overlap": overlap}
                profile = crossing((RADIUS, length), second, np.radians(angle), overlap)
                best = float(np.nanmin([point, line]))
                cases.append(Case("crossing", profile, geometry, point, best, line))
    return cases


def squares() -> list[Case]:
    """6: from a point to a face by its size."""
    sides = (0.0, 0.001, 0.002, 0.005, 0.01, 0.02, 0.05)
    return [core("square", side, side, overlap) for overlap in OVERLAPS for side in sides]


#: title -> its cases, and what its figure shows along x
FAMILIES = {
    "tilted edge": (tilted_edges, "tilt"),
    "rolled face": (rolled_faces, "tilt"),
    "strip": (strips, "width"),
    "crossing": (crossings, "angle"),
    "square": (squares, "length"),
    "line": (lines, "length"),
}

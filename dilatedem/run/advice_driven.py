"""What of structures that are driven is hardly meant: where they go in the course of a run, and what they come to there."""

import numpy as np

from dilatedem.case.schema import Case
from dilatedem.scene.place import PlacedStructure, Scene
from dilatedem.scene.recipe import periodic_axes
from dilatedem.state.supports import Carried
from dilatedem.structures.kind import Part

#: times at which a driven structure is looked at, besides the rows of its table
LOOKS = 400

#: a structure that is no part of another, and all its bodies
Standing = tuple[PlacedStructure, list[Part]]


def extent(parts: list[Part]) -> tuple[np.ndarray, float]:
    """Centre in plan (2,) and radius [m] of a circle that holds the parts of a structure, at rest."""
    centre = np.mean([part.position[:2] for part in parts], axis=0)
    return centre, max(float(np.hypot(*(part.position[:2] - centre))) + part.plan_reach for part in parts)


def farthest(case: Case, structure: PlacedStructure) -> float:
    """How far [m] a driven structure gets from where it starts; 0 of all others."""
    return float(np.hypot(*way_of(case, structure, _times(case, structure)).T).max())


def about_driven(case: Case, scene: Scene) -> list[str]:
    """A sentence for each structure that is driven out of the ice, into its own wake or through another."""
    standing = [(structure, parts) for structure, parts in scene.standing() if parts]
    driven = [each for each in standing if each[0].support.carriage().kind == Carried.DRIVEN]
    found = [_about_way(case, structure, parts) for structure, parts in driven]
    bounded = [each for each in standing if not any(part.is_half_space for part in each[1])]
    return [*filter(None, found), *_about_meeting(case, driven, bounded)]


def _times(case: Case, structure: PlacedStructure) -> np.ndarray:
    """Times [s] of a run, in order."""
    rows = structure.support.carriage().times
    within = rows[(rows > 0.0) & (rows < case.time.duration)]
    return np.unique(np.concatenate([np.linspace(0.0, case.time.duration, LOOKS), within]))


def way_of(case: Case, structure: PlacedStructure, times: np.ndarray) -> np.ndarray:
    """(n, 2) [m] how far a structure has moved at times (n,) [s]."""
    return structure.support.carriage().at(times)[0][:, :2]


def _about_way(case: Case, structure: PlacedStructure, parts: list[Part]) -> str:
    """It leaves the domain, or goes round a periodic one."""
    times = _times(case, structure)
    (centre, reach), way = extent(parts), way_of(case, structure, times)
    for axis, (name, wraps) in enumerate(zip("xy", periodic_axes(case), strict=True)):
        size, places = case.domain.size[axis], centre[axis] + way[:, axis]
        if wraps:
            span = float(np.ptp(way[:, axis]))
            if span + 2.0 * reach > size:
                return (
                    f'structure "{structure.name}" is driven {span:.3g} m along {name}, where the domain repeats after {size:g} m: '
                    "it comes to ice that it has met before; shorten time.duration or lengthen domain.size"
                )
            continue
        inside = np.abs(places) - reach < 0.5 * size
        left = np.flatnonzero(inside[:-1] & ~inside[1:])
        if len(left):
            side = f"{name} = {np.sign(places[left[0] + 1]) * 0.5 * size:+g} m"
            return (
                f'structure "{structure.name}" is driven out of the domain across {side} at t = {times[left[0] + 1]:.3g} s: '
                "nothing is there to meet; shorten time.duration or lengthen domain.size"
            )
    return ""


def _about_meeting(case: Case, driven: list[Standing], bounded: list[Standing]) -> list[str]:
    """Structures do not feel each other, so that a driven one goes through what stands in its way."""
    period = np.where(periodic_axes(case), case.domain.size, np.inf)
    found = []
    for k, (structure, parts) in enumerate(driven):
        times, earlier = _times(case, structure), [each for each, _ in driven[: k + 1]]
        (centre, reach), way = extent(parts), way_of(case, structure, times)
        for other, their_parts in bounded:
            if other in earlier:
                continue
            place, theirs = extent(their_parts)
            apart = centre + way - place - way_of(case, other, times)
            apart -= np.where(np.isfinite(period), np.round(apart / period) * np.where(np.isfinite(period), period, 0.0), 0.0)
            near = np.flatnonzero(np.hypot(*apart.T) < reach + theirs)
            if len(near):
                found.append(
                    f'structure "{structure.name}" is driven so close to "{other.name}" at t = {times[near[0]]:.3g} s that they '
                    "may stand in each other: structures do not feel each other"
                )
    return found

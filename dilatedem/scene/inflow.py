"""Ice that enters through a side: which way it comes, what of it is there at t = 0, and the floes of a strip as bodies.

At t = 0 the ice reaches a margin beyond the upstream side, which it drifts through in two looks of the event that lets it enter.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from dilatedem.case.schema import Case
from dilatedem.field.endless import Course
from dilatedem.field.obstacles import Obstacle
from dilatedem.field.placement import FloeField, touching_obstacles
from dilatedem.field.stream import Stream
from dilatedem.scene.recipe import recipe_of, whole_axes

#: s between two looks whether a strip is to enter
LOOK = 1.0
#: looks before it would drift into the domain, at least, that a strip enters
EARLY = 2.0


def course_of(case: Case) -> Course:
    """Which way the ice of a case comes in."""
    axis = case.domain.inflow
    upstream = -1 if case.ice_velocity[axis] > 0.0 else 1
    return Course(case.domain.size, axis, upstream, whole_axes(case)[1 - axis])


def drift_speed(case: Case) -> float:
    """How fast ice enters [m/s]."""
    return abs(case.ice_velocity[case.domain.inflow])


def entrance(case: Case) -> float:
    """How far upstream of the downstream side the ice begins to be there [m]."""
    return case.domain.size[case.domain.inflow] + EARLY * LOOK * drift_speed(case)


def stream_of(case: Case, count: int) -> Stream:
    """The ice of a case, without an end; count: floes to the area of its domain. Raises ValueError as `field.stream.Stream`."""
    field, radius = case.field, case.ice.dilated_radius
    return Stream(course_of(case), count, field.concentration, seed=field.seed, radius=radius, recipe=recipe_of(case))


def strips_at_start(case: Case, stream: Stream) -> range:
    """Numbers of the strips that are there at t = 0."""
    return stream.until(entrance(case))


def field_of(
    case: Case, stream: Stream, obstacles: Sequence[Obstacle], periodic: tuple[bool, bool]
) -> tuple[FloeField, np.ndarray]:
    """The floes of a stream that are there at t = 0, clear of obstacles, and the number of each among its cells."""
    floes = stream.floes(strips_at_start(case, stream))
    outlines = floes.outlines
    inside = np.maximum.reduceat(stream.course.ahead(outlines.points), outlines.start[:-1]) > 0.0
    outlines, plan_area = outlines.where(inside), floes.plan_area[inside]
    touching = touching_obstacles(outlines, obstacles, np.asarray(case.domain.size), periodic)
    clear = ~touching
    field = FloeField(outlines.where(clear), plan_area[clear], plan_area, stream.factor, stream.concentration, clear)
    return field, floes.which[inside][clear]

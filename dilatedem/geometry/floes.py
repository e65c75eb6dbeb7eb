"""Shapes of ice floes, right prisms over their outlines, worked in stacks: no floe costs more than its numbers."""

from collections.abc import Iterator

import numpy as np

from dilatedem.geometry import outline as plan
from dilatedem.geometry.mass import SolidProperties, dilated_solid
from dilatedem.geometry.outer import outer_prisms
from dilatedem.geometry.polyhedron import Polyhedron, prism
from dilatedem.geometry.shapes import BodyShape

#: floes that are worked together at most: their arrays should fit into the processor's cache, and into little memory
LARGEST_STACK = 1024


def floe_shapes(
    outlines: plan.Outlines, thickness: float | np.ndarray, radius: float
) -> Iterator[tuple[np.ndarray, BodyShape, np.ndarray]]:
    """The shapes of floes over outer outlines, in world coordinates, of outer `thickness`, one or (floes,), and dilated radius [m].

    Yields which floes (m,), their shapes as a stack, and their centroids (m, 3) [m] in the frame of the outlines, z from
    mid-thickness; every floe once, stack by stack. Raises ValueError for an outline of which erosion leaves nothing.
    """
    half = np.broadcast_to(0.5 * np.asarray(thickness) - radius, len(outlines))
    for index, corners in outlines.by_sides():
        left = 0
        for first in range(0, len(index), LARGEST_STACK):
            for eroded in plan.erode_together(corners[first : first + LARGEST_STACK], radius):
                left += len(eroded.index)
                floes = index[first + eroded.index]
                for which, shape, centroid in _of_cores(prism(eroded.corners, -half[floes], half[floes]), radius):
                    yield floes[which], shape, centroid
        if left < len(index):
            raise ValueError(f"{len(index) - left} outlines are too narrow: moved inwards by {radius:g} m, nothing is left of them")


def _of_cores(cores: Polyhedron, radius: float) -> Iterator[tuple[np.ndarray, BodyShape, np.ndarray]]:
    """Shapes of a stack of prisms, by the topology of their outer shapes: which of them, the shapes, the centroids."""
    properties = dilated_solid(cores, radius)
    centred = cores.translated(-properties.centroid)
    for which, outer in outer_prisms(centred, radius, properties.volume):
        about_origin = SolidProperties(properties.volume[which], np.zeros((len(which), 3)), properties.inertia[which])
        yield which, BodyShape(centred.member(which), radius, outer, about_origin), properties.centroid[which]
